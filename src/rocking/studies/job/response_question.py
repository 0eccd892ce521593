"""One body, one motion or first rotation, some restitutions: the question that commands and the application ask."""

import warnings
from dataclasses import dataclass, field
from typing import Any

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.conventions import DEFAULT_FRICTION
from rocking.dynamics.histories import free_rocking, simulate
from rocking.dynamics.response import Motion, Response
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, PureRockingWarning


@dataclass(frozen=True, slots=True)
class ResponseQuestion:
    """Everything that a response depends on."""

    body: Body
    motion: Motion | None  # the motion, not scaled; None for free rocking
    # restitutions by label, as `simulate` takes them
    choices: dict[str, Any] = field(default_factory=lambda: {"ked": "ked"})
    settings: Settings = field(default_factory=Settings)  # how to integrate
    engine: str = "auto"  # which engine
    friction: float = DEFAULT_FRICTION  # coefficient of friction between body and ground [-]
    free: float | None = None  # first rotation over the slenderness angle of the side it leans to, for free rocking [-]
    scale: float = 1.0  # factor on the motion [-]

    def __post_init__(self) -> None:
        """Check what the engines do not check."""
        plausibility.warn(plausibility.of_friction(checks.positive("friction", self.friction)))
        if self.free is not None:
            checks.number("free", self.free)
        if (self.motion is None) != (self.free is not None):
            raise InvalidValueError("give either a motion or a first rotation (free), got both or neither")

    @property
    def rotation(self) -> float:
        """Rotation at the start, positive to the right [rad]."""
        if self.free is None:
            return 0.0
        side = self.body.side("right" if self.free > 0.0 else "left", self.settings.gravity)
        return self.free * side.slenderness_angle

    def answered_with(self, restitution: Any) -> Response:
        """Return the response with one restitution."""
        how = {**vars(self.settings), "engine": self.engine}
        with warnings.catch_warnings():  # whoever shows the response shows its doubts
            warnings.simplefilter("ignore", PureRockingWarning)
            if self.motion is None:
                return free_rocking(self.body, self.rotation, restitution, **how)
            return simulate(self.body, self.motion, restitution, scale=self.scale, **how)
