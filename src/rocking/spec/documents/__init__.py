"""Question files other than those of studies: one class per file."""
