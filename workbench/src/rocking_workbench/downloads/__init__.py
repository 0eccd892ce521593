"""Exports: figures, tables, report, animation, and inputs as a file for the command line."""
