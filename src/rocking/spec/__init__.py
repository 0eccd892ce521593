"""Input files: their tables, and the bodies, motions and restitutions of the tables."""
