"""Settings of the integration of a plane body with restraints."""

from dataclasses import dataclass, field
from typing import Any

from rocking import checks
from rocking.bodies.restrained import Restrained
from rocking.dynamics.plane.settings import checked_linear
from rocking.dynamics.settings import Settings, checked, ranged


@dataclass(frozen=True)
class RestrainedSettings(Settings):
    """Settings of the integration of a plane body with restraints.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    linear : bool
        True for the slender-linear equations. The elongations then also assume small rotations.
    rest_speed : float
        Largest speed after an impact / (p alpha), for which rest is considered [-]. The body comes to rest only if it
        is proven that the next impacts decay before the next uplift.
    tolerance : float
        Bound on the last two terms of a Taylor step, divided by the angle alpha [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking.dynamics import RestrainedSettings
    >>> RestrainedSettings(gravity=9.81).linear
    False
    """

    linear: bool = checked(False, checked_linear)
    rest_speed: float = ranged(0.001, 0.0, 0.1, hint="the sum of impacts holds for small speeds")
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)


def _checked_body(name: str, value: Any) -> Restrained:
    checks.of_kind(name, value, Restrained, "Restrained(body, restraints)")
    body: Restrained = value
    return body


@dataclass(frozen=True)
class RestrainedStudySettings(RestrainedSettings):
    """Settings of a study of one body with restraints, and this body. The rows of a study have no restraints."""

    body: Any = field(default=None, metadata={"check": _checked_body})

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the names of the settings, without the body."""
        return RestrainedSettings.names()

    @property
    def identity(self) -> dict[str, Any]:
        """Settings, and the body with its restraints as text."""
        from rocking.bodies.formats.body_file import body_to_toml

        return super().identity | {"restrained": body_to_toml(self.body)}
