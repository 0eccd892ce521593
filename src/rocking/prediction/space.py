"""What is drawn for a body in space on the vertices of its hull, and what becomes of it by the compiled engine."""

import math
from collections.abc import Mapping
from copy import copy
from typing import Any

import numpy as np

from rocking.bodies import MassPoints, Solid
from rocking.conventions import FloatArray, percent
from rocking.dynamics.hull import histories
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.histories import HullRows, numbers_of_rows
from rocking.dynamics.hull.motion import standing
from rocking.dynamics.hull.restitution import FixedPosition
from rocking.dynamics.hull.settings import HullSettings
from rocking.dynamics.settings import thread_count
from rocking.dynamics.space.attitude import product, turn
from rocking.dynamics.space.ground import ground_of
from rocking.errors import InvalidValueError
from rocking.evidence import restitution_distribution
from rocking.messages import Message
from rocking.outcome import Status
from rocking.prediction.mechanics import (
    AZIMUTH_WHY,
    CENTRE,
    CENTRE_WHY,
    DENSITY_WHY,
    FRICTION,
    FRICTION_WHY,
    MEASURED,
    MEASURED_WHY,
    Endings,
    SampledBodies,
    Uncertain,
    as_measured,
    because,
    parts,
)

INSIDE, ABOVE, THICK = 0.01, 0.005, 0.005
"""How far corners of the base lie inside of the drawn ones, over its mean radius, and how high points are that touch
too, over the height, where nobody says otherwise; at most so high [m]."""

ANOTHER = math.cos(math.radians(10.0))
"""Cosine of the angle from which on a stable pose is another way to stand: rough bodies have many that are alike."""

_UPRIGHT = -1.0 + 1e-12
_SETTINGS = HullSettings(tolerance=1e-8)

NOT_SAMPLED = {
    "placement": Message("the ground is level and the body stands by itself"),
    "density": DENSITY_WHY,
}

_WHY = {
    "friction": FRICTION_WHY,
    "base": Message(
        "below zero: how far its corners lie inside of the drawn ones, for wear and chips; above zero: how high points "
        "lie that touch the ground too, for what a scan or a floor is uneven by"
    ),
    "centre": CENTRE_WHY,
    "azimuth": AZIMUTH_WHY,
}
_LAWS = {
    "housner": histories.HOUSNER, "housner-3d": histories.HOUSNER,
    "ked": histories.KED, "ked-3d": histories.KED,
}  # fmt: skip


class SampledInSpace(SampledBodies):
    """A body in space that may slide, hop, fly and fall onto another side."""

    why, never_sampled = _WHY, NOT_SAMPLED

    def __init__(self, solid: Solid, motions: Any, given: Mapping[str, Any], gravity: float) -> None:
        super().__init__(motions, given)
        if given.get("polarity") is not None:
            raise InvalidValueError("polarity is of plane bodies: in space azimuth turns a body to either side")
        if solid.equilibria().settling((0.0, 0.0, -1.0)).down[2] > _UPRIGHT:
            solid = solid.settled()
        self._gravity, self.solid, found = gravity, solid, solid.equilibria()
        self.pose, self._mass, self._flat = found.settling((0.0, 0.0, -1.0)), found.mass, found.flatness
        turned = self.pose.rotation
        self.corners, self._surface = (points @ turned.T for points in (found.hull.vertices, found.surface))
        self.inertia = turned @ solid.local_moments.inertia @ turned.T
        self._shapes: dict[tuple[float, float], _Shape] = {}
        radius, height = float(np.linalg.norm(self.pose.support, axis=1).mean()), self.pose.height
        turn_round = 2.0 * math.pi
        self.assumed |= dict.fromkeys(solid.assumed, "")
        self._take({
            "friction": FRICTION,
            "base": ((-INSIDE * radius, min(ABOVE * height, THICK)), -0.5 * radius, 0.5 * height, "m"),
            "centre": CENTRE,
            "azimuth": ((0.0, turn_round), -turn_round, turn_round, "rad"),
        })  # fmt: skip
        self._set_restitution(given.get("restitution"))

    def with_restitution(self, told: Any) -> "SampledInSpace":
        """Return the same with other impacts."""
        other = copy(self)
        other.inputs = {name: each for name, each in self.inputs.items() if name != "restitution"}
        other.assumed = dict(self.assumed)
        other._set_restitution(told)
        return other

    def law(self, level: float) -> Any:
        """Return what an impact costs at a probability of its distribution, as `simulate` takes it."""
        named = {histories.HOUSNER: "housner", histories.KED: "ked"}
        value = float(self.inputs["restitution"].quantile(np.array([level]))[0])
        return named.get(self._law) or (FixedPosition(value) if self._law == histories.POSITION else value)

    def _set_restitution(self, told: Any) -> None:
        """Take a law of impacts, and the distribution of its number."""
        word = told if isinstance(told, str) else MEASURED[0] if told is None else ""
        if word in MEASURED:
            self._law, (found, words) = histories.POSITION, self._measured()
            at = np.linspace(0.0, 1.0, found.size)
            one = Uncertain(words, lambda u: np.interp(u, at, found))
            self.assumed["restitution"] = because(words, MEASURED_WHY)
        elif word:
            if word not in _LAWS:
                raise InvalidValueError(
                    "restitution in space must be {allowed}, got {value}", parameter="restitution",
                    allowed=f"one of {', '.join([*MEASURED, *_LAWS])}, or a coefficient",
                    value=word,
                )  # fmt: skip
            self._law, one = _LAWS[word], Uncertain(word, lambda u: np.zeros(u.shape), fixed=True)
        else:
            self._law, one = histories.COEFFICIENT, Uncertain.of("restitution", told, 0.0, 1.0)
        self.inputs = {"restitution": one, **self.inputs}

    def _measured(self) -> tuple[FloatArray, str]:
        """Return quantiles of the position k of the impulse, as measured, over the nearest edge of the base."""
        support, nearest = self.pose.support, int(np.argmin(self.pose.edge_distances))
        chord = np.roll(support, -1, axis=0)[nearest] - support[nearest]
        edge = np.append(chord / np.linalg.norm(chord), 0.0)
        reach = support @ np.array([edge[1], -edge[0]])  # outward across the edge
        new, old, height = float(reach.max()), float(-reach.min()), self.pose.height
        inertia = float(edge @ self.inertia @ edge)
        # the body may be wider than its base, so no block has its moments: two equal masses about the centre have
        far, half = math.sqrt(inertia / self._mass), 0.5 * self._mass
        plane = MassPoints([(old - far, height), (old + far, height)], [half, half], feet=(0.0, old + new))
        found = restitution_distribution(plane)
        r = found.tables["right"]
        ahead = (inertia / self._mass + height**2) * (1.0 - r) / (r * new + old)  # Eq. 4
        k = np.clip((2.0 * ahead - (new - old)) / (new + old), 0.0, 1.0)  # Eq. 104
        ends = {"low": float(r[25]), "high": float(r[-26])}
        words = Message("{low:.3f} to {high:.3f} over the edge that is nearest to the centre in 95 % of draws", ends)
        if (k == 1.0).any():
            words = Message(
                "{words}, of which {share} lose more than Housner's impact and are taken as that",
                {"words": words, "share": percent(float((k == 1.0).mean()))},
            )
        return k, as_measured(words, extrapolated=found.extrapolated)

    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> Endings:
        """Return what becomes of bodies under a motion times a factor."""
        drawn = {name: values[:, 0] for name, values in self.values(draws).items()}
        shapes = [self._shape(*pair) for pair in zip(drawn["base"].tolist(), drawn["centre"].tolist(), strict=True)]
        several = list(dict.fromkeys(shapes))
        number = {shape: k for k, shape in enumerate(several)}
        place = np.array([number[shape] for shape in shapes])
        ground = ground_of(*parts(self.motions[motion]))
        turned = zip(shapes, drawn["azimuth"].tolist(), strict=True)
        state = np.array([shape.state(azimuth) for shape, azimuth in turned])
        numbers = numbers_of_rows(drawn["restitution"], factor, drawn["friction"], state, self._gravity)
        stood = np.array([shape.facet for shape in shapes])
        choices = np.column_stack([place, np.zeros_like(place), np.full_like(place, self._law), stood])
        bodies = [shape.body for shape in several]
        rows = HullRows(bodies, [ground], _SETTINGS, histories.chosen("auto"), {self._law})
        found = rows.run(numbers, choices, thread_count(threads))
        known = found["status"] == Status.GOOD.code
        pairs = zip(shapes, found["pose"].tolist(), strict=True)
        elsewhere = np.array([shape.left(pose) for shape, pose in pairs], dtype=np.float64)
        columns = (np.isfinite(found["first_uplift"]), found["sliding_distance"], elsewhere, found["peak_tilt"],
                   found["direction"])  # fmt: skip
        return Endings(*(np.where(known, each, np.nan) for each in columns))

    def _shape(self, base: float, centre: float) -> "_Shape":
        """Return the body with a base and a centre, as it stands."""
        key = (base, centre)
        if key not in self._shapes:
            points, height = self.corners.copy(), self.pose.height
            if base > 0.0:
                near = self._surface[self._surface[:, 2] + height <= max(base, self._flat)]
                points = np.concatenate([points, near])
                points[points[:, 2] + height <= max(base, self._flat), 2] = -height
            else:
                corners = points[:, 2] + height <= self._flat
                far = np.linalg.norm(points[corners, :2], axis=1, keepdims=True)
                points[corners, :2] *= 1.0 + np.maximum(base / far, -0.9)
            middle = np.array([0.0, 0.0, (centre - 1.0) * height])
            self._shapes[key] = _Shape(HullBody(points, self._mass, middle, self.inertia, self.solid))
        return self._shapes[key]


class _Shape:
    """A body as it stands, and which of its poses are others than that one."""

    def __init__(self, body: HullBody) -> None:
        self.body = body
        facet = int(body.hull.rolls[body.under((0.0, 0.0, 1.0))])
        self.start, self.facet = standing(body, facet=facet), facet

    def state(self, azimuth: float) -> list[float]:
        """Return attitude, place and velocities at the start."""
        attitude = product(turn([0.0, 0.0, 1.0], azimuth), np.array(self.start.attitude))
        return [*attitude.tolist(), *self.start.place, *self.start.velocity, *self.start.spin]

    def left(self, pose: int) -> bool:
        """Return whether a pose, by its number, is another one than that in which it stood."""
        if pose < 0:
            return False
        hull, numbers = self.body.hull, np.array(self.body.poses)
        facet = int(np.flatnonzero(hull.stable & (numbers == pose))[0])
        return float(hull.normals[facet] @ hull.normals[self.facet]) < ANOTHER
