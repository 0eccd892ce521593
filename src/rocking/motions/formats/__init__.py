"""Reading ground-motion files and writing them, one format a file."""
