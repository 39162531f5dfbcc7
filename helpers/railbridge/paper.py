"""The door for ``python -m railbridge.paper``; see `railbridge.validation.paper`."""

from .validation.paper import main

if __name__ == "__main__":
    main()
