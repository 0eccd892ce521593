"""Plane bodies on each other, with joints that open."""
