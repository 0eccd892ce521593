"""Force laws of restraints as phases. Between events, the force is n + K e + c |e'|^a sgn e' for the elongation e."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import singledispatch

from rocking.bodies.restraints import FrictionDamper, Fuse, Restraint, Spring, Tendon, ViscousDamper, Wall

_INF = math.inf


@dataclass(frozen=True, slots=True)
class Phase:
    """A smooth phase of a law."""

    name: str
    constant: float = 0.0  # n [N]
    stiffness: float = 0.0  # K [N/m]
    low: float = -_INF  # elongations at which the phase ends [m]
    high: float = _INF
    direction: int = 0  # required sign of e' during the phase; 0 for any sign

    def force(self, elongation: float) -> float:
        """Return the force without the viscous force [N]."""
        return self.constant + self.stiffness * elongation

    def work(self, start: float, end: float) -> float:
        """Return the work from one elongation to another [J]."""
        return (self.constant + 0.5 * self.stiffness * (start + end)) * (end - start)


class ForceLaw(ABC):
    """State of one restraint: its phase and plastic elongation."""

    phase: Phase
    coefficient, exponent = 0.0, 1.0  # coefficient c and exponent a of the viscous force
    slip_force = 0.0  # slip force of a rigid friction damper [N]
    plastic = 0.0  # plastic elongation [m]
    yields = 0
    lost = 0.0  # energy lost by rupture [J]
    rebound: float | None = None  # coefficient of restitution at a rigid wall [-]

    def settle(self, elongation: float, direction: int) -> None:  # noqa: B027 - most laws have one phase
        """Choose the phase for a sign of e', after uplift, impact, turning point, or reversal of the lever."""

    def cross(self, elongation: float, *, upwards: bool) -> None:  # noqa: B027
        """Choose the phase beyond a limit of the present phase."""

    def stored(self, elongation: float) -> float:
        """Return the elastic energy, including the energy of hardening [J]."""
        return 0.0

    def margin(self, elongation: list[float], rate: list[float]) -> list[float] | None:
        """Return the series that is positive until a force ends the phase; `rate` is e' [m/s]."""
        return None

    def named(self, name: str) -> Phase:
        """Return the phase with a given name in the present state."""
        return self.phase

    @property
    def residual_force(self) -> float:
        """Force of the upright body at rest [N]."""
        return 0.0

    @property
    def residual_slack(self) -> float:
        """Elongation that a slack restraint of the upright body needs before a force appears [m]."""
        return 0.0

    @property
    def broken(self) -> bool:
        """True after rupture."""
        return self.phase.name == "broken"

    @abstractmethod
    def row(self) -> tuple[float, ...]:
        """Return kind and constants for the compiled engine."""


class Bilinear(ForceLaw):
    """Elastic-plastic law with kinematic hardening until rupture.

    The restraint is symmetric, or slack in compression.
    """

    def __init__(
        self, stiffness: float, prestress: float, limit: float, ratio: float, rupture: float, symmetric: bool
    ) -> None:
        self.stiffness, self.prestress, self.limit, self.rupture = stiffness, prestress, limit, rupture
        self.ratio, self.symmetric = ratio, symmetric
        self.hardening = ratio * stiffness / (1.0 - ratio)  # H
        self.phase = self._elastic()

    def _bounded(self, name: str, constant: float, stiffness: float, low: float, high: float, direction: int) -> Phase:
        lowest = -self.rupture if self.symmetric else -_INF
        return Phase(name, constant, stiffness, max(low, lowest), min(high, self.rupture), direction)

    def _at(self, force: float) -> float:
        """Return the elongation of the elastic phase at a force [m]."""
        if not self.stiffness:
            return math.copysign(_INF, force - self.prestress) if force != self.prestress else -_INF
        return self.plastic + (force - self.prestress) / self.stiffness

    def _elastic(self) -> Phase:
        middle = self.hardening * self.plastic
        low = self._at(middle - self.limit) if self.symmetric else self._at(0.0)
        constant = self.prestress - self.stiffness * self.plastic
        return self._bounded("elastic", constant, self.stiffness, low, self._at(middle + self.limit), 0)

    def _flowing(self, sign: int) -> Phase:
        total = self.stiffness + self.hardening
        constant = sign * self.limit + self.hardening * (self.prestress - sign * self.limit) / total
        slope = self.stiffness * self.hardening / total  # Eq. 349
        name = "yields in tension" if sign > 0 else "yields in compression"
        return self._bounded(name, constant, slope, -_INF, _INF, sign)

    def named(self, name: str) -> Phase:
        if name == "slack":
            return self._bounded("slack", 0.0, 0.0, -_INF, self._at(0.0), 0)
        return self._elastic() if name == "elastic" else self._flowing(1 if "tension" in name else -1)

    def _flow(self, elongation: float) -> None:
        """Update the plastic elongation of a plastic phase."""
        if sign := self.phase.direction:
            total = self.stiffness + self.hardening
            self.plastic = (self.prestress + self.stiffness * elongation - sign * self.limit) / total  # Eq. 350

    def settle(self, elongation: float, direction: int) -> None:
        if self.phase.direction * direction < 0:
            self._flow(elongation)
            self.phase = self._elastic()

    def cross(self, elongation: float, *, upwards: bool) -> None:
        self._flow(elongation)
        if abs(self.rupture) < _INF and (self.phase.high if upwards else -self.phase.low) == self.rupture:
            self.lost = self.stored(elongation)
            self.phase = Phase("broken")
        elif self.phase.name == "slack":
            self.phase = self._elastic()
        elif upwards or self.symmetric:
            self.yields += 1
            self.phase = self._flowing(1 if upwards else -1)
        else:
            self.phase = self.named("slack")

    def stored(self, elongation: float) -> float:
        if self.broken or not self.stiffness:
            return 0.0
        self._flow(elongation)
        return 0.5 * self.phase.force(elongation) ** 2 / self.stiffness + 0.5 * self.hardening * self.plastic**2

    @property
    def residual_force(self) -> float:
        if self.broken:
            return 0.0
        force = self.prestress - self.stiffness * self.plastic
        return force if self.symmetric else max(force, 0.0)

    @property
    def residual_slack(self) -> float:
        return 0.0 if self.symmetric or self.broken or not self.stiffness else max(self._at(0.0), 0.0)

    def row(self) -> tuple[float, ...]:
        return 0.0, self.stiffness, self.prestress, self.limit, self.ratio, self.rupture, float(self.symmetric)


class Viscous(ForceLaw):
    """Viscous force, which depends on the rate only."""

    def __init__(self, coefficient: float, exponent: float) -> None:
        self.coefficient, self.exponent = coefficient, exponent
        self.phase = Phase("viscous")

    def row(self) -> tuple[float, ...]:
        return 1.0, self.coefficient, self.exponent, 0.0, 0.0, 0.0, 0.0


class Friction(ForceLaw):
    """Rigid friction."""

    def __init__(self, slip_force: float) -> None:
        self.slip_force = slip_force
        self.phase = Phase("sticks")

    def named(self, name: str) -> Phase:
        direction = {"slips in tension": 1, "slips in compression": -1}.get(name, 0)
        return Phase(name, direction * self.slip_force, direction=direction)

    def settle(self, elongation: float, direction: int) -> None:
        if direction:
            self.phase = self.named("slips in tension" if direction > 0 else "slips in compression")

    def row(self) -> tuple[float, ...]:
        return 2.0, self.slip_force, 0.0, 0.0, 0.0, 0.0, 0.0


class Elastic(ForceLaw):
    """A spring with a gap."""

    def __init__(self, stiffness: float, gap: float, action: str) -> None:
        self.stiffness, self.gap, self.action = stiffness, gap, action
        in_tension, in_compression = action != "compression", action != "tension"
        self._tension = Phase("tension", -stiffness * gap, stiffness, low=gap)
        self._compression = Phase("compression", stiffness * gap, stiffness, high=-gap)
        self._open = Phase(
            "open", low=-gap if in_compression else -_INF, high=gap if in_tension else _INF,
        )  # fmt: skip
        self.phase = Phase("elastic", 0.0, stiffness) if action == "both" and not gap else self._open

    def named(self, name: str) -> Phase:
        phases = (self._open, self._tension, self._compression, self.phase)
        return next(phase for phase in phases if phase.name == name)

    def settle(self, elongation: float, direction: int) -> None:
        if direction > 0 and elongation >= self.phase.high:
            self.cross(elongation, upwards=True)
        elif direction < 0 and elongation <= self.phase.low:
            self.cross(elongation, upwards=False)

    def cross(self, elongation: float, *, upwards: bool) -> None:
        outer = self._tension if upwards else self._compression
        self.phase = outer if self.phase is self._open else self._open

    def stored(self, elongation: float) -> float:
        return 0.5 * self.phase.force(elongation) ** 2 / self.stiffness if self.stiffness else 0.0

    def row(self) -> tuple[float, ...]:
        return (
            3.0,
            self.stiffness,
            self.gap,
            float(self.action != "compression"),
            float(self.action != "tension"),
            0.0,
            0.0,
        )


class Contact(ForceLaw):
    """A compliant wall, which only pushes. A rigid wall has no stiffness and no force."""

    def __init__(self, stiffness: float, damping: float, gap: float, rebound: float | None = None) -> None:
        self.stiffness, self.damping, self.gap, self.rebound = stiffness, damping, gap, rebound
        self.phase = self.named("open")

    def named(self, name: str) -> Phase:
        self.coefficient = self.damping if name == "contact" else 0.0
        if name == "contact":
            return Phase(name, self.stiffness * self.gap, self.stiffness)
        if name == "released":  # the point of the body leaves the wall more slowly than the dashpot allows
            return Phase(name, high=-self.gap)
        return Phase("open", low=-self.gap if self.stiffness else -_INF)

    def settle(self, elongation: float, direction: int) -> None:
        if direction < 0 and elongation <= self.phase.low:
            self.cross(elongation, upwards=False)
        elif direction > 0 and elongation >= -self.gap and self.phase.name != "open":
            self.phase = self.named("open")

    def cross(self, elongation: float, *, upwards: bool) -> None:
        is_released = upwards and self.phase.name == "contact" and self.damping
        self.phase = self.named("released" if is_released else "open" if upwards else "contact")

    def stored(self, elongation: float) -> float:
        return 0.5 * self.stiffness * min(elongation + self.gap, 0.0) ** 2

    def margin(self, elongation: list[float], rate: list[float]) -> list[float] | None:
        if self.phase.name == "open":
            return None
        sign = -1.0 if self.phase.name == "contact" else 1.0
        force = [self.stiffness * e + self.damping * v for e, v in zip(elongation, rate, strict=True)]
        force[0] += self.stiffness * self.gap
        return [sign * c for c in force]  # Eq. 365

    def row(self) -> tuple[float, ...]:
        is_rigid = self.rebound is not None
        return 4.0, self.stiffness, self.damping, self.gap, float(is_rigid), self.rebound or 0.0, 0.0


@singledispatch
def law_of(restraint: Restraint) -> ForceLaw:
    """Return the force law of a restraint in its state before the motion."""
    raise NotImplementedError(type(restraint).__name__)


@law_of.register
def _(restraint: Tendon) -> ForceLaw:
    stiffness = restraint.stiffness or 0.0
    return Bilinear(
        stiffness,
        restraint.force_at_rest,
        restraint.yield_force,
        restraint.hardening,
        restraint.rupture_elongation,
        False,
    )


@law_of.register
def _(restraint: Fuse) -> ForceLaw:
    return Bilinear(
        restraint.stiffness,
        0.0,
        restraint.yield_force,
        restraint.hardening,
        restraint.stroke,
        not restraint.tension_only,
    )


@law_of.register
def _(restraint: ViscousDamper) -> ForceLaw:
    return Viscous(restraint.coefficient, restraint.exponent)


@law_of.register
def _(restraint: FrictionDamper) -> ForceLaw:
    return Friction(restraint.slip_force)


@law_of.register
def _(restraint: Spring) -> ForceLaw:
    return Elastic(restraint.stiffness, restraint.gap, restraint.action)


@law_of.register
def _(restraint: Wall) -> ForceLaw:
    return Contact(restraint.stiffness or 0.0, restraint.damping, restraint.gap)
