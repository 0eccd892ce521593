"""What may stand in requests."""
