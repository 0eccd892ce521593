"""Input files that are not studies: one class per kind of file."""
