"""Restraints of plane bodies: tendons, dampers, fuses, springs and walls, which act on a point of the body."""

import copy
import math
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.bodies.body import Body
from rocking.bodies.frame import Frame
from rocking.bodies.section import Section
from rocking.conventions import FEET
from rocking.errors import InvalidValueError

Point = tuple[float, float]
COINCIDENT = 1e-9
"""Largest distance of coincident points / largest coordinate of the body [-]."""

_EXACT = "exact change of the distance between two points; the force acts along the current line"
_UNLIMITED = {"yield_force", "rupture_elongation", "stroke"}  # constants that are infinite without a limit
_CONNECTION = ("x", "length", "ground", "point", "name")


@dataclass(frozen=True, kw_only=True)
class Restraint:
    """A device between a point of the ground and a point of the body.

    Give `x` alone for a device with both ends at the base of the upright body, such as a tendon in a duct. Give `x` and
    `length` for a device below the base. Give `ground` and `point` for any other device, such as a tie at a height.
    Coordinates are those of the body: x as for its feet, z upwards from the ground. The tension is positive.

    Parameters
    ----------
    x : float, optional
        Position of the point on the base [m].
    length : float
        Distance of the anchor below the base at `x` [m]; 0 for an anchor at the base.
    ground : (float, float), optional
        Point (x, z) of the ground [m].
    point : (float, float), optional
        Point (x, z) of the body in its upright position [m].
    name : str
        Name in results; the default is the kind with a number.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the position is missing or stated twice.
    """

    kind: ClassVar[str] = ""
    force_law: ClassVar[str] = ""  # force law as text
    source: ClassVar[str] = ""
    domain: ClassVar[str] = ""

    x: float | None = None
    length: float = 0.0
    ground: Point | None = None
    point: Point | None = None
    name: str = ""

    def __post_init__(self) -> None:
        self._check_position()
        checks.of_kind("name", self.name, str, "text")
        if self.name != self.name.strip() or set(self.name) & set(',"\\\n'):
            raise InvalidValueError(
                parameter="name", allowed="text without commas, quotation marks and outer spaces", value=self.name
            )

    def _check_position(self) -> None:
        ends = (self.ground, self.point)
        if (self.x is None) == (None in ends) or (self.x is not None and ends != (None, None)):
            raise InvalidValueError(
                "{restraint} needs x, or ground and point", parameter="x", value=self.x,
                restraint=self.kind.replace("_", " "),
            )  # fmt: skip
        self._set("length", checks.within("length", self.length, 0.0, checks.LARGEST, unit="m"))
        if self.x is not None:
            self._set("x", checks.number("x", self.x, "m"))
        for name, end in zip(("ground", "point"), ends, strict=True):
            if end is not None:
                checks.of_kind(name, end, (tuple, list), "two numbers [m]")
                if len(end) != 2:
                    raise InvalidValueError(parameter=name, allowed="two numbers [m]", value=end)
                self._set(name, tuple(checks.number(name, value, "m") for value in end))

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)

    def _check(self, low: float, unit: str, *names: str, open_low: bool = False) -> None:
        for name in names:
            value = getattr(self, name)
            if not (value == math.inf and name in _UNLIMITED):
                self._set(name, checks.within(name, value, low, 1e30, unit=unit, open_low=open_low))

    @property
    def ends(self) -> tuple[Point, Point]:
        """Points of the ground and of the upright body [m]."""
        if self.x is not None:
            return (self.x, -self.length), (self.x, 0.0)
        assert self.ground is not None
        assert self.point is not None
        return self.ground, self.point

    def placed_on(self, body: Body) -> "Restraint":
        """Return the restraint with the values that depend on the body.

        Parameters
        ----------
        body : Body
            The body.

        Returns
        -------
        Restraint
            A copy.
        """
        return copy.copy(self)

    @property
    def damages(self) -> tuple[str, ...]:
        """Kinds of damage that the restraint can have: ``yield``, ``rupture``."""
        limits = {"yield": ("yield_force",), "rupture": ("rupture_elongation", "stroke")}
        return tuple(
            damage for damage, names in limits.items()
            if any(getattr(self, name, math.inf) < math.inf for name in names)
        )  # fmt: skip

    @property
    def constants(self) -> dict[str, Any]:
        """Constants of the force law by name; without the position."""
        values = {entry.name: getattr(self, entry.name) for entry in fields(self) if entry.name not in _CONNECTION}
        return {name: value for name, value in values.items() if value is not None and value != math.inf}


@dataclass(frozen=True, kw_only=True)
class Tendon(Restraint):
    """An unbonded tendon: elastic, perfectly plastic or hardening, slack without tension.

    The force is N = P + k (e - ep), from 0 to the yield force. The plastic elongation ep grows at the yield force and
    reduces the prestress. A slack tendon has no force until its elongation exceeds the slack. At the rupture
    elongation the tendon breaks and its stored energy is lost.

    Parameters
    ----------
    x, length, ground, point, name
        Position and name, as for `Restraint`.
    stiffness : float, optional
        k [N/m]; or state `area`, `modulus` and `free_length`.
    area : float, optional
        Cross section [m2].
    modulus : float, optional
        Modulus of elasticity [Pa].
    free_length : float, optional
        Length between the anchors [m].
    prestress : float
        Force P of the tendon while the body is upright [N].
    loss : float
        Fraction of the prestress lost before the motion, by creep and relaxation [-].
    yield_force : float
        Largest elastic force [N]; infinite for an elastic tendon.
    hardening : float
        Stiffness after yielding over k [-].
    rupture_elongation : float
        Elongation from the prestressed upright state at which the tendon breaks [m].

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the stiffness is missing or stated twice.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.Tendon(x=0.5, area=1e-3, modulus=200e9, free_length=8.0, prestress=50e3).stiffness
    25000000.0
    """

    kind: ClassVar[str] = "tendon"
    force_law: ClassVar[str] = "N = P + k (e - ep), 0 <= N <= Ny + H ep"
    source: ClassVar[str] = "Dimitrakopoulos & Giouvanidis (2015); Vassiliou & Makris (2015)"
    domain: ClassVar[str] = "no friction in the duct, no mass, no relaxation during the motion; " + _EXACT

    stiffness: float | None = None
    area: float | None = None
    modulus: float | None = None
    free_length: float | None = None
    prestress: float = 0.0
    loss: float = 0.0
    yield_force: float = math.inf
    hardening: float = 0.0
    rupture_elongation: float = math.inf

    def __post_init__(self) -> None:
        super().__post_init__()
        stated = [self.area, self.modulus, self.free_length]
        if self.stiffness is None and None not in stated:
            for name in ("area", "modulus", "free_length"):
                self._set(name, checks.positive(name, getattr(self, name)))
            area, modulus, free_length = (float(getattr(self, name)) for name in ("area", "modulus", "free_length"))
            self._set("stiffness", modulus * area / free_length)
        elif self.stiffness is None or stated != [None, None, None]:
            raise InvalidValueError(
                "{parameter} must be {allowed}", parameter="stiffness",
                allowed="stated, or area, modulus and free_length", value=self.stiffness,
            )  # fmt: skip
        self._check(0.0, "N/m", "stiffness")
        self._check(0.0, "N", "prestress")
        self._set("loss", checks.within("loss", self.loss, 0.0, 1.0))
        self._set("hardening", checks.within("hardening", self.hardening, 0.0, 1.0, open_high=True))
        self._check(0.0, "N", "yield_force", open_low=True)
        self._check(0.0, "m", "rupture_elongation", open_low=True)
        if self.force_at_rest > self.yield_force:
            raise InvalidValueError(
                "prestress must be <= yield_force, got {value} N", parameter="prestress", value=self.force_at_rest
            )

    @property
    def force_at_rest(self) -> float:
        """Prestress after its loss [N]."""
        return self.prestress * (1.0 - self.loss)


@dataclass(frozen=True, kw_only=True)
class ViscousDamper(Restraint):
    """A viscous damper, ``F = c |e'|^a sgn e'``.

    Parameters
    ----------
    x, length, ground, point, name
        Position and name, as for `Restraint`.
    coefficient : float
        c [N (s/m)^a].
    exponent : float
        a, from 0.05 to 5 [-]; 1 for a linear damper.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.ViscousDamper(x=0.0, length=0.5, coefficient=4e3, exponent=0.5).exponent
    0.5
    """

    kind: ClassVar[str] = "viscous_damper"
    force_law: ClassVar[str] = "F = c |e'|^a sgn e'"
    source: ClassVar[str] = "Constantinou & Symans (1993); Dimitrakopoulos & DeJong (2012)"
    domain: ClassVar[str] = "no stiffness of the damper and its supports, no end of the stroke; " + _EXACT

    coefficient: float
    exponent: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check(0.0, "N (s/m)^a", "coefficient")
        self._set("exponent", checks.within("exponent", self.exponent, 0.05, 5.0))


@dataclass(frozen=True, kw_only=True)
class FrictionDamper(Restraint):
    """A rigid friction damper, F = Fs sgn e', which sticks at smaller forces.

    The damper delays uplift. At the end of the ground motion, the damper can also hold the body at a rotation. The
    outcome is then HELD.

    Parameters
    ----------
    x, length, ground, point, name
        Position and name, as for `Restraint`.
    slip_force : float
        Fs [N].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.FrictionDamper(x=0.0, length=0.5, slip_force=3e3).slip_force
    3000.0
    """

    kind: ClassVar[str] = "friction_damper"
    force_law: ClassVar[str] = "F = Fs sgn e', |F| <= Fs if e' = 0"
    source: ClassVar[str] = "Coulomb's law; Pall & Marsh (1982)"
    domain: ClassVar[str] = (
        "rigid before slip: a small series stiffness changes the rotation at which it sticks; " + _EXACT
    )

    slip_force: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check(0.0, "N", "slip_force")


@dataclass(frozen=True, kw_only=True)
class Fuse(Restraint):
    """A yielding fuse: bilinear with kinematic hardening, ``F = k (e - ep)``, ``|F - H ep| <= Fy``.

    A buckling-restrained fuse has the same law in compression. With `tension_only`, the fuse buckles in compression
    without force. The fuse breaks at its stroke.

    Parameters
    ----------
    x, length, ground, point, name
        Position and name, as for `Restraint`.
    stiffness : float
        k [N/m].
    yield_force : float
        Fy [N]; infinite for an elastic fuse.
    hardening : float
        Stiffness after yielding over k, in [0, 1) [-].
    stroke : float
        Elongation, and shortening unless `tension_only`, at which the fuse breaks [m].
    tension_only : bool
        True for a slender bar, which buckles without force.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.Fuse(x=0.2, length=0.5, stiffness=2e6, yield_force=8e3, hardening=0.02).tension_only
    False
    """

    kind: ClassVar[str] = "fuse"
    force_law: ClassVar[str] = "F = k (e - ep), |F - H ep| <= Fy, H = a k / (1 - a)"
    source: ClassVar[str] = "bilinear kinematic hardening (Prager 1956); Marriott, Pampanin & Palermo (2009)"
    domain: ClassVar[str] = "no low-cycle fatigue, no bond slip, no bending of the bar; " + _EXACT

    stiffness: float
    yield_force: float = math.inf
    hardening: float = 0.0
    stroke: float = math.inf
    tension_only: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check(0.0, "N/m", "stiffness")
        self._check(0.0, "N", "yield_force", open_low=True)
        self._set("hardening", checks.within("hardening", self.hardening, 0.0, 1.0, open_high=True))
        self._check(0.0, "m", "stroke", open_low=True)
        checks.of_kind("tension_only", self.tension_only, bool, "True or False")


ACTIONS = ("both", "tension", "compression")


@dataclass(frozen=True, kw_only=True)
class Spring(Restraint):
    """An elastic spring, optionally with a gap or a hook.

    The force is k (e - gap) beyond the gap in tension, and k (e + gap) beyond the gap in compression.

    Parameters
    ----------
    x, length, ground, point, name
        Position and name, as for `Restraint`.
    stiffness : float
        k [N/m].
    gap : float
        Elongation and shortening without force [m].
    action : {"both", "tension", "compression"}
        Direction of the force: a hook acts in tension, a buffer in compression.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    A tie of a facade at a height of 6 m:

    >>> import rocking as rk
    >>> rk.Spring(ground=(-2.0, 6.0), point=(0.0, 6.0), stiffness=1e6, action="tension").ends
    ((-2.0, 6.0), (0.0, 6.0))
    """

    kind: ClassVar[str] = "spring"
    force_law: ClassVar[str] = "F = k (e - gap) for e > gap, k (e + gap) for e < -gap, otherwise 0"
    source: ClassVar[str] = "Hooke's law; ties of facades: Giresini et al. (2018)"
    domain: ClassVar[str] = "elastic, no impact in the gap; " + _EXACT

    stiffness: float
    gap: float = 0.0
    action: str = "both"

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check(0.0, "N/m", "stiffness")
        self._check(0.0, "m", "gap")
        checks.one_of("action", self.action, ACTIONS)


WALL_LAWS = ("compliant", "plastic", "sorrentino")


@dataclass(frozen=True, kw_only=True)
class Wall(Restraint):
    """A wall next to the body, at a right angle to the floor. The wall is frictionless, and it only pushes.

    A compliant wall has the force F = max(0, k d + c d'), with the displacement d of a point of the body into the wall,
    parallel to the floor. With damping, the contact ends before the body is upright. The floor must not pull the body:
    otherwise the response contains the time from which the model does not hold.

    A rigid wall touches the upright body from the floor to the point. The body rocks only away from this wall, and hits
    floor and wall together. With ``law="plastic"`` the body stops: this is the only solution without rebound and
    without tensile forces. With ``law="sorrentino"`` the body rebounds about the same foot. This law is empirical: it
    needs friction between body and wall, and a floor that pulls the body.

    Parameters
    ----------
    x : float, optional
        Position of the point, as for the feet; the default is the end of the body at the height, on the side of the
        wall [m].
    length, ground, point
        Parameters of other restraints, which do not apply to a wall.
    name : str
        Name in results, as for `Restraint`.
    side : {"left", "right"}
        Side of the body on which the wall is.
    gap : float
        Distance between the wall and the point of the upright body; 0 for a rigid wall [m].
    height : float, optional
        Height z of the point of the body; the default is the top of the body [m].
    stiffness : float, optional
        k of a compliant wall [N/m].
    damping : float
        c of a compliant wall [N s/m].
    law : {"compliant", "plastic", "sorrentino"}
        Compliant wall, stop at a rigid wall, or the coefficient of restitution
        (1 - 1.5 sin^2 alpha)^2 (1 - 1.5 cos^2 alpha) of Sorrentino et al. (2008) for a homogeneous rectangle.

    Raises
    ------
    InvalidValueError
        If a value is outside its range or does not apply to the law, or the stiffness is missing.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=0.5, height=2.0, mass=500.0)
    >>> adjacent = rk.Restrained(block, rk.Wall(side="left", height=1.2, stiffness=4e4, damping=600.0))
    >>> response = rk.free_rocking(adjacent, rotation=0.1, restitution="housner", duration=1.0)
    >>> response.restraint_events.columns["restraint_phase"]
    ['contact', 'released', 'open']
    """

    kind: ClassVar[str] = "wall"
    force_law: ClassVar[str] = (
        "compliant: F = max(0, k d + c d'); plastic: stop at theta = 0; sorrentino: rebound at theta = 0"
    )
    source: ClassVar[str] = "Giresini et al. (2018); complementarity of rigid impacts; Sorrentino et al. (2008)"
    domain: ClassVar[str] = (
        "the point is fixed to the body; no friction at the wall; the floor must not pull the body; sorrentino: "
        "empirical, it needs friction at the wall and a floor that pulls"
    )

    side: str
    gap: float = 0.0
    height: float | None = None
    stiffness: float | None = None
    damping: float = 0.0
    law: str = "compliant"

    def _check_position(self) -> None:
        for name, usual in (("length", 0.0), ("ground", None), ("point", None)):
            if getattr(self, name) != usual:
                raise InvalidValueError("{parameter} does not apply to a wall", parameter=name)
        checks.one_of("side", self.side, FEET)
        checks.one_of("law", self.law, WALL_LAWS)
        self._check(0.0, "m", "gap")
        if self.x is not None:
            self._set("x", checks.number("x", self.x, "m"))
        if self.height is not None:
            self._check(0.0, "m", "height", open_low=True)
        if self.law == "compliant":
            if self.stiffness is None:
                raise InvalidValueError("a compliant wall needs stiffness", parameter="stiffness")
            self._check(0.0, "N/m", "stiffness", open_low=True)
            self._check(0.0, "N s/m", "damping")
        elif self.gap or self.damping or self.stiffness is not None:
            raise InvalidValueError(
                "a rigid wall has no gap, stiffness and damping", parameter="law", value=self.law,
                hint="use a compliant wall for a gap",
            )  # fmt: skip

    @property
    def sign(self) -> int:
        """Direction parallel to the floor away from the wall: 1 for a wall on the left, -1 for a wall on the right."""
        return 1 if self.side == "left" else -1

    @property
    def ends(self) -> tuple[Point, Point]:
        """Points of the wall and of the upright body [m]."""
        assert self.x is not None
        assert self.height is not None
        return (self.x - self.sign * self.gap, self.height), (self.x, self.height)

    def placed_on(self, body: Body) -> "Wall":
        """Return the wall with the position of its point on the body.

        Parameters
        ----------
        body : Body
            The body next to the wall.

        Returns
        -------
        Wall
            A copy with `x` and `height`.

        Raises
        ------
        InvalidValueError
            If the law is not for this body, as in `rebound`.
        """
        top = body.local_box[3]
        height = top if self.height is None else checks.within("height", self.height, 0.0, top, unit="m", open_low=True)
        left, right = (body.origin_x + end for end in ends_at(body, height))
        face = left if self.side == "left" else right
        x = face if self.x is None else checks.within("x", self.x, left, right, unit="m")
        if self.law != "compliant":
            self._check_face(body, x, height)
        self.rebound(body)
        return replace(self, x=x, height=height)

    def _check_face(self, body: Body, x: float, height: float) -> None:
        """Raise an error if the face of the body is not vertical from the foot to the point."""
        levels = np.unique([0.0, height, *levels_of(body)])
        levels = levels[levels <= height]
        between = 0.5 * (levels[:-1] + levels[1:])
        faces = [ends_at(body, float(level))[self.side == "right"] for level in (*levels, *between)]
        if np.ptp([*faces, x - body.origin_x]) > COINCIDENT * body.local_box[3]:
            raise InvalidValueError(
                "a rigid wall needs a vertical face of the body from the floor to the point", parameter="law",
                value=self.law, hint="use a compliant wall",
            )  # fmt: skip

    def rebound(self, body: Body) -> float | None:
        """Return the ratio of the angular velocities after and before an impact at a rigid wall [-].

        Parameters
        ----------
        body : Body
            The body next to the wall.

        Returns
        -------
        float or None
            0 if the body stops, negative if it rebounds; None for a compliant wall.

        Raises
        ------
        InvalidValueError
            If a rigid wall is at a frame, the law is Sorrentino's and the body is not a homogeneous rectangle, or the
            law is plastic and floor and wall do not stop this body without tensile forces.
        """
        if self.law == "compliant":
            return None
        if isinstance(body, Frame):
            raise InvalidValueError(
                "the law of a rigid wall is not for a frame",
                parameter="law",
                value=self.law,
                hint="use a compliant wall",
            )
        left, right = (body.side(foot) for foot in FEET)
        centre, inertia = left.centre_height, left.moment_of_inertia / left.mass - left.semi_diagonal**2
        height = body.local_box[3] if self.height is None else self.height
        if self.law == "plastic":
            if inertia > (left.half_width * right.half_width + centre * (height - centre)) * (1.0 + 1e-9):  # Eq. 366
                raise InvalidValueError(
                    "floor and wall do not stop this body without tensile forces", parameter="law", value=self.law,
                    hint="use a compliant wall, or a larger height",
                )  # fmt: skip
            return 0.0
        is_rectangle = math.isclose(3.0 * inertia, left.semi_diagonal**2, rel_tol=1e-9)
        if not (is_rectangle and math.isclose(left.half_width, right.half_width, rel_tol=1e-9)):
            raise InvalidValueError(
                "this law is for a homogeneous rectangle", parameter="law", value=self.law, hint="use a compliant wall"
            )
        sine, cosine = math.sin(left.slenderness_angle), math.cos(left.slenderness_angle)
        return (1.0 - 1.5 * sine**2) ** 2 * (1.0 - 1.5 * cosine**2)  # Eq. 367


def ends_at(body: Body, height: float) -> tuple[float, float]:
    """Return the left and the right end of a body at a height above the ground, in the local frame [m].

    Blocks, frames and mass points have the ends of their bounding box.
    """
    left, _, right, _ = body.local_box
    if not isinstance(body, Section):
        return left, right
    crossings: list[float] = []
    for region in body.regions:
        start, end = region.outline, np.roll(region.outline, -1, axis=0)
        low, high = np.minimum(start[:, 1], end[:, 1]), np.maximum(start[:, 1], end[:, 1])
        crosses = (low <= height) & (height <= high)
        rise = np.where(crosses & (high > low), end[:, 1] - start[:, 1], 1.0)
        at = start[:, 0] + (height - start[:, 1]) / rise * (end[:, 0] - start[:, 0])
        level = crosses & (high == low)
        crossings += [*at[crosses & ~level].tolist(), *start[level, 0].tolist(), *end[level, 0].tolist()]
    return min(crossings, default=left), max(crossings, default=right)


def levels_of(body: Body) -> list[float]:
    """Return the heights of the vertices of a section above the ground [m]; empty for other bodies."""
    return [z for region in body.regions for z in region.outline[:, 1].tolist()] if isinstance(body, Section) else []


KINDS: dict[str, type[Restraint]] = {
    kind.kind: kind for kind in (Tendon, ViscousDamper, FrictionDamper, Fuse, Spring, Wall)
}
"""Classes of restraints by the name in files."""
