"""What every call answers, for the schema of the API: shapes, units and meanings; nothing is checked at run time."""
