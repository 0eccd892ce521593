"""`python -m rocking`: the command line without the command `rocking` on the path."""

from rocking.cli import main

if __name__ == "__main__":
    main(unnamed_file=globals().get("unnamed_file", ""))  # set by `runpy` for a temporary file
