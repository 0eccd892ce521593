"""Bodies on the vertices of their convex hull: rocking, sliding, flight and falls in space."""

from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.engine import HullEngine
from rocking.dynamics.hull.ground import HullGround
from rocking.dynamics.hull.histories import hull_histories
from rocking.dynamics.hull.history import HullSettings
from rocking.dynamics.hull.motion import standing
from rocking.dynamics.hull.response import HullResponse

__all__ = [
    "HullBody",
    "HullEngine",
    "HullGround",
    "HullResponse",
    "HullSettings",
    "hull_histories",
    "standing",
]
