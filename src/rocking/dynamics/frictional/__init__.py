"""Bodies on the vertices of their convex hull: rocking, sliding, flight and falls in space."""
