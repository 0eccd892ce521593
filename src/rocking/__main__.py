"""`python -m rocking`: the command line, where the command itself is not on the path."""

from rocking.cli import main

if __name__ == "__main__":
    main(unnamed_file=globals().get("unnamed_file", ""))  # which `runpy` sets for a file that it has written
