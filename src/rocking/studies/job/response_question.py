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
    """Everything that a response depends on.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse, optional
        The motion, not scaled; None for free rocking.
    choices : dict of str to Any
        Restitutions by label, as `simulate` takes them.
    settings : Settings
        How to integrate.
    engine : {"auto", "fast", "reference"}
        Which engine.
    friction : float
        Coefficient of friction between body and ground [-].
    free : float, optional
        First rotation over the slenderness angle of the side it leans to, for free rocking [-].
    scale : float
        Factor on the motion [-].

    Raises
    ------
    InvalidValueError
        If there is a motion and a first rotation or neither, or a number is not allowed.
    """

    body: Body
    motion: Motion | None
    choices: dict[str, Any] = field(default_factory=lambda: {"ked": "ked"})
    settings: Settings = field(default_factory=Settings)
    engine: str = "auto"
    friction: float = DEFAULT_FRICTION
    free: float | None = None
    scale: float = 1.0

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
        """Return the response with one restitution.

        Parameters
        ----------
        restitution : str, RestitutionModel, float, mapping or ImpactLaw
            As `simulate` takes it.

        Returns
        -------
        Response
            The response.
        """
        how = {**vars(self.settings), "engine": self.engine}
        with warnings.catch_warnings():  # whoever shows the response shows its doubts
            warnings.simplefilter("ignore", PureRockingWarning)
            if self.motion is None:
                return free_rocking(self.body, self.rotation, restitution, **how)
            return simulate(self.body, self.motion, restitution, scale=self.scale, **how)
