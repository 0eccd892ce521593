"""Questions as they are asked in files: what may stand in them, and bodies, motions and restitutions made of it."""
