"""Bodies on the vertices of their convex hull: rocking, sliding, flight and falls in space; the reference engine."""

from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.engine import HullEngine, HullSettings, standing
from rocking.dynamics.hull.ground import HullGround

__all__ = ["HullBody", "HullEngine", "HullGround", "HullSettings", "standing"]
