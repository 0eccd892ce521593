"""What the batch engine in space is told beside bodies and motions."""

from dataclasses import dataclass, fields
from typing import Any

from rocking import conventions
from rocking.dynamics.spatial.settings import SpatialSettings
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class SpatialBatchSettings:
    """How to integrate many bodies in space.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    rest_speed : float
        As in `SpatialSettings`: speed, over sqrt(g R), at which a vertex that would fall back at once stays [-].
    most_events : int
        A history with more impacts and changes of contact is stopped, with a status that says so.
    tolerance : float
        What a step may leave out of its series: the order of every step, from 4 to 16, follows from it [-].
    longest_step : float
        Longest step as p + |angular velocity| times time [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    gravity: float = conventions.g
    rest_speed: float = 1e-5
    most_events: int = 100_000
    tolerance: float = 1e-13
    longest_step: float = 0.6

    def __post_init__(self) -> None:
        """Check every value."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        checked = SpatialSettings(**given)
        for field in fields(self):
            object.__setattr__(self, field.name, getattr(checked, field.name))

    @classmethod
    def of(cls, gravity: float, options: dict[str, Any]) -> "SpatialBatchSettings":
        """Return settings from keyword arguments.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].
        options : dict of str to Any
            Other fields by name.

        Returns
        -------
        SpatialBatchSettings
            The settings.

        Raises
        ------
        InvalidValueError
            If there is no such field, or a value is outside its range.
        """
        known = {field.name for field in fields(cls)} - {"gravity"}
        unknown = sorted(set(options) - known)
        if unknown:
            raise InvalidValueError(f"no option named {unknown[0]!r}; there are {', '.join(sorted(known))}")
        return cls(gravity=gravity, **options)

    @property
    def limits(self) -> dict[str, Any]:
        """Arguments of the compiled engine."""
        return {
            "gravity": self.gravity,
            "rest_speed": self.rest_speed,
            "tolerance": self.tolerance,
            "longest": self.longest_step,
            "most_events": self.most_events,
        }
