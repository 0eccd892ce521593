"""Projects, stored on this computer with their history."""
