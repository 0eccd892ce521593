"""Sampled 3D bodies with contact at the vertices of the hull, and their outcomes by the compiled engine."""

import math
from collections.abc import Mapping
from copy import copy
from typing import Any

import numpy as np

from rocking.bodies import MassPoints, Solid
from rocking.conventions import FloatArray, percent
from rocking.decision.prediction.mechanics import (
    AZIMUTH_REASON,
    CENTRE,
    CENTRE_REASON,
    DENSITY_REASON,
    FRICTION,
    FRICTION_REASON,
    MEASURED,
    MEASURED_REASON,
    BodyOutcomes,
    SampledBodies,
    Uncertain,
    as_measured,
    ground_components,
    with_reason,
)
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.histories import HullRows, numbers_of_rows
from rocking.dynamics.frictional.motion import standing
from rocking.dynamics.frictional.restitution import FixedPosition
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.rolling.attitude import product, turn
from rocking.dynamics.rolling.ground import ground_of
from rocking.dynamics.settings import thread_count
from rocking.errors import InvalidValueError
from rocking.evidence import restitution_distribution
from rocking.messages import Message
from rocking.outcome import Status

INSIDE, ABOVE, THICK = 0.01, 0.005, 0.005
"""Defaults: inset of the base corners over the mean radius of the base, height of further contact points over the
height of the centre of mass, and its limit [m]."""

ANOTHER = math.cos(math.radians(10.0))
"""Cosine of the smallest angle between two different stable poses; rough bodies have many similar poses."""

_UPRIGHT = -1.0 + 1e-12
_SETTINGS = HullSettings(tolerance=1e-8)

NOT_SAMPLED = {
    "placement": Message("the ground is level and the body is free-standing"),
    "density": DENSITY_REASON,
}

_REASONS = {
    "friction": FRICTION_REASON,
    "base": Message(
        "negative: inset of the base corners from the nominal ones, for wear and chips; positive: height of further "
        "contact points, for an uneven scan or floor"
    ),
    "centre": CENTRE_REASON,
    "azimuth": AZIMUTH_REASON,
}
_LAWS = {
    "housner": histories.HOUSNER, "housner-3d": histories.HOUSNER,
    "ked": histories.KED, "ked-3d": histories.KED,
}  # fmt: skip


class SampledInSpace(SampledBodies):
    """A 3D body that may slide, hop, fly and overturn onto another side."""

    reasons, never_sampled = _REASONS, NOT_SAMPLED

    def __init__(self, solid: Solid, motions: Any, inputs: Mapping[str, Any], gravity: float) -> None:
        super().__init__(motions, inputs)
        if inputs.get("polarity") is not None:
            raise InvalidValueError("polarity applies to plane bodies only; use azimuth for a 3D body")
        if solid.equilibria().settling((0.0, 0.0, -1.0)).down[2] > _UPRIGHT:
            solid = solid.settled()
        self._gravity, self.solid, equilibria = gravity, solid, solid.equilibria()
        self.pose, self._mass, self._flat = equilibria.settling((0.0, 0.0, -1.0)), equilibria.mass, equilibria.flatness
        rotation = self.pose.rotation
        self.corners, self._surface = (points @ rotation.T for points in (equilibria.hull.vertices, equilibria.surface))
        self.inertia = rotation @ solid.local_moments.inertia @ rotation.T
        self._shapes: dict[tuple[float, float], _Shape] = {}
        radius, height = float(np.linalg.norm(self.pose.support, axis=1).mean()), self.pose.height
        full_turn = 2.0 * math.pi
        self.assumed |= dict.fromkeys(solid.assumed, "")
        self._set_inputs({
            "friction": FRICTION,
            "base": ((-INSIDE * radius, min(ABOVE * height, THICK)), -0.5 * radius, 0.5 * height, "m"),
            "centre": CENTRE,
            "azimuth": ((0.0, full_turn), -full_turn, full_turn, "rad"),
        })  # fmt: skip
        self._set_restitution(inputs.get("restitution"))

    def with_restitution(self, stated: Any) -> "SampledInSpace":
        """Return a copy with another restitution."""
        other = copy(self)
        other.inputs = {name: uncertain for name, uncertain in self.inputs.items() if name != "restitution"}
        other.assumed = dict(self.assumed)
        other._set_restitution(stated)
        return other

    def law(self, level: float) -> Any:
        """Return the restitution at a probability of its distribution, as for `simulate`."""
        names = {histories.HOUSNER: "housner", histories.KED: "ked"}
        value = float(self.inputs["restitution"].quantile(np.array([level]))[0])
        return names.get(self._law) or (FixedPosition(value) if self._law == histories.POSITION else value)

    def _set_restitution(self, stated: Any) -> None:
        """Set the law of impacts, and the distribution of its parameter."""
        name = stated if isinstance(stated, str) else MEASURED[0] if stated is None else ""
        if name in MEASURED:
            self._law, (positions, text) = histories.POSITION, self._measured()
            levels = np.linspace(0.0, 1.0, positions.size)
            uncertain = Uncertain(text, lambda u: np.interp(u, levels, positions))
            self.assumed["restitution"] = with_reason(text, MEASURED_REASON)
        elif name:
            if name not in _LAWS:
                raise InvalidValueError(
                    "restitution of a 3D body must be {allowed}, got {value}", parameter="restitution",
                    allowed=f"one of {', '.join([*MEASURED, *_LAWS])}, or a coefficient",
                    value=name,
                )  # fmt: skip
            self._law, uncertain = _LAWS[name], Uncertain(name, lambda u: np.zeros(u.shape), fixed=True)
        else:
            self._law, uncertain = histories.COEFFICIENT, Uncertain.of("restitution", stated, 0.0, 1.0)
        self.inputs = {"restitution": uncertain, **self.inputs}

    def _measured(self) -> tuple[FloatArray, str]:
        """Return measured quantiles of the impulse position k over the nearest edge of the base, and their text."""
        support, nearest = self.pose.support, int(np.argmin(self.pose.edge_distances))
        chord = np.roll(support, -1, axis=0)[nearest] - support[nearest]
        edge = np.append(chord / np.linalg.norm(chord), 0.0)
        reach = support @ np.array([edge[1], -edge[0]])  # outward across the edge
        new, old, height = float(reach.max()), float(-reach.min()), self.pose.height
        inertia = float(edge @ self.inertia @ edge)
        # two equal masses about the centre have the body's moments; no block has if the body is wider than its base
        far, half = math.sqrt(inertia / self._mass), 0.5 * self._mass
        plane = MassPoints([(old - far, height), (old + far, height)], [half, half], feet=(0.0, old + new))
        distribution = restitution_distribution(plane)
        r = distribution.tables["right"]
        ahead = (inertia / self._mass + height**2) * (1.0 - r) / (r * new + old)  # Eq. 4
        k = np.clip((2.0 * ahead - (new - old)) / (new + old), 0.0, 1.0)  # Eq. 104
        ends = {"low": float(r[25]), "high": float(r[-26])}
        text = Message("{low:.3f} to {high:.3f} over the edge nearest to the centre of mass in 95 % of samples", ends)
        if (k == 1.0).any():
            text = Message(
                "{words}, of which {share} lose more energy than Housner's impact and are limited to it",
                {"words": text, "share": percent(float((k == 1.0).mean()))},
            )
        return k, as_measured(text, extrapolated=distribution.extrapolated)

    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> BodyOutcomes:
        """Return the outcomes of bodies under a motion times a factor."""
        sampled = {name: values[:, 0] for name, values in self.values(draws).items()}
        shapes = [self._shape(*pair) for pair in zip(sampled["base"].tolist(), sampled["centre"].tolist(), strict=True)]
        unique_shapes = list(dict.fromkeys(shapes))
        index_of_shape = {shape: k for k, shape in enumerate(unique_shapes)}
        body_index = np.array([index_of_shape[shape] for shape in shapes])
        ground = ground_of(*ground_components(self.motions[motion]))
        turned = zip(shapes, sampled["azimuth"].tolist(), strict=True)
        state = np.array([shape.state(azimuth) for shape, azimuth in turned])
        numbers = numbers_of_rows(sampled["restitution"], factor, sampled["friction"], state, self._gravity)
        initial_facet = np.array([shape.facet for shape in shapes])
        choices = np.column_stack(
            [body_index, np.zeros_like(body_index), np.full_like(body_index, self._law), initial_facet]
        )
        bodies = [shape.body for shape in unique_shapes]
        rows = HullRows(bodies, [ground], _SETTINGS, histories.chosen("auto"), {self._law})
        results = rows.run(numbers, choices, thread_count(threads))
        valid = results["status"] == Status.GOOD.code
        pairs = zip(shapes, results["pose"].tolist(), strict=True)
        overturned = np.array([shape.is_other_pose(pose) for shape, pose in pairs], dtype=np.float64)
        columns = (np.isfinite(results["first_uplift"]), results["sliding_distance"], overturned, results["peak_tilt"],
                   results["direction"])  # fmt: skip
        return BodyOutcomes(*(np.where(valid, column, np.nan) for column in columns))

    def _shape(self, base: float, centre: float) -> "_Shape":
        """Return the body with a base and a centre, in its initial pose."""
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
    """A body in its initial pose, and the test for other poses."""

    def __init__(self, body: HullBody) -> None:
        self.body = body
        facet = int(body.hull.rolls[body.under((0.0, 0.0, 1.0))])
        self.start, self.facet = standing(body, facet=facet), facet

    def state(self, azimuth: float) -> list[float]:
        """Return initial attitude, position and velocities."""
        attitude = product(turn([0.0, 0.0, 1.0], azimuth), np.array(self.start.attitude))
        return [*attitude.tolist(), *self.start.position, *self.start.velocity, *self.start.spin]

    def is_other_pose(self, pose: int) -> bool:
        """Return True if a pose, by index, differs from the initial pose."""
        if pose < 0:
            return False
        hull, numbers = self.body.hull, np.array(self.body.poses)
        facet = int(np.flatnonzero(hull.stable & (numbers == pose))[0])
        return float(hull.normals[facet] @ hull.normals[self.facet]) < ANOTHER
