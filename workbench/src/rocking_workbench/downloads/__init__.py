"""Exports: pictures, tables, report, animation, and inputs as a file of the command line."""
