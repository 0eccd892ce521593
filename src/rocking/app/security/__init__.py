"""Who may ask, and what may be asked."""
