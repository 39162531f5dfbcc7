"""The door for ``python -m railbridge.paper``; everything stands in `railbridge.validation.paper`."""

from .validation.paper import main

if __name__ == "__main__":
    main()
