"""`python -m rocking`: the command line, where the command itself is not on the path."""

from rocking.cli import main

if __name__ == "__main__":
    main()
