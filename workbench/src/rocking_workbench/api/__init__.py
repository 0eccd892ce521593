"""The JSON API of body, impact, records, motion and response."""
