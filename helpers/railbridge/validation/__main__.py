"""``python -m railbridge.validation`` prints the table of `verification`."""

from .verification import main

if __name__ == "__main__":
    main()
