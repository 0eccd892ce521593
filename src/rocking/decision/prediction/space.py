"""Sampled 3D bodies with contact at the vertices of the hull, and their outcomes by the compiled engine."""

import math
from collections.abc import Mapping
from types import MappingProxyType
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
from rocking.decision.prediction.model_error import Similarity
from rocking.decision.prediction.placement import OFFSET, OFFSET_REASON
from rocking.decision.prediction.shapes import SampledShapes
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.histories import HullRows, numbers_of_rows
from rocking.dynamics.frictional.restitution import FixedPosition
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.rolling.ground import ground_of
from rocking.dynamics.settings import thread_count
from rocking.errors import InvalidValueError
from rocking.evidence import restitution_distribution
from rocking.messages import Message
from rocking.outcome import Status

INSIDE, STEPS = 0.02, 32
"""Default of the largest inset of the contact points / width of the base, and number of sampled bases."""

_UPRIGHT = -1.0 + 1e-12
_SETTINGS = HullSettings(tolerance=1e-6, rest_speed=3e-4)
"""Settings with larger tolerances than for single histories; the effect is that of a change of the motion by 1e-6."""

NOT_SAMPLED = {
    "placement": Message("the body is free-standing"),
    "density": DENSITY_REASON,
}

_REASONS = {
    "friction": FRICTION_REASON,
    "base": Message(
        "inset of the contact points from the outline, for rounded or crushed edges and error of the scan: up to 2 % "
        "of the base width, in 32 equal steps"
    ),
    "centre": CENTRE_REASON,
    "offset": OFFSET_REASON,
    "azimuth": AZIMUTH_REASON,
}
_LAWS = {
    "housner": histories.HOUSNER, "housner-3d": histories.HOUSNER,
    "ked": histories.KED, "ked-3d": histories.KED,
}  # fmt: skip


class SampledInSpace(SampledBodies):
    """A 3D body that may slide, hop, fly and overturn onto another side."""

    reasons, never_sampled = _REASONS, NOT_SAMPLED
    widths_of: Mapping[str, int] = MappingProxyType({"offset": 2, "level": 2, "model_error": 2})

    def __init__(self, solid: Solid, motions: Any, inputs: Mapping[str, Any], gravity: float) -> None:
        super().__init__(motions, inputs)
        if inputs.get("polarity") is not None:
            raise InvalidValueError("polarity applies to plane bodies only; use azimuth for a 3D body")
        if solid.equilibria().settling((0.0, 0.0, -1.0)).down[2] > _UPRIGHT:
            solid = solid.settled()
        self._gravity, self.solid, equilibria = gravity, solid, solid.equilibria()
        self.pose, self._mass = equilibria.settling((0.0, 0.0, -1.0)), equilibria.mass
        rotation = self.pose.rotation
        self.inertia = rotation @ solid.local_moments.inertia @ rotation.T
        self.shapes = SampledShapes(solid, self.pose, self.inertia)
        width = 2.0 * float(np.linalg.norm(self.pose.support, axis=1).mean())
        half_sizes = 0.5 * np.ptp(self.shapes.corners[:, :2], axis=0)
        offset = OFFSET * float(half_sizes.mean())
        height, farthest = self.pose.height, float(half_sizes.max())
        full_turn = 2.0 * math.pi
        self.assumed |= dict.fromkeys(solid.assumed, "")
        self._set_inputs({
            "friction": FRICTION,
            "base": ((-INSIDE * width, 0.0), -0.25 * width, 0.5 * height, "m"),
            "centre": CENTRE,
            "offset": ((-offset, offset), -farthest, farthest, "m"),
            "level": self._level(width),
            "azimuth": ((0.0, full_turn), -full_turn, full_turn, "rad"),
        })  # fmt: skip
        self._set_restitution(inputs.get("restitution"))
        self._set_model_error()

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
        reach = support @ np.array([edge[1], -edge[0]])  # extent normal to the edge, positive outward
        new, old, height = float(reach.max()), float(-reach.min()), self.pose.height
        inertia = float(edge @ self.inertia @ edge)
        # two equal masses with the moments of the body; no block has these moments if the body overhangs its base
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
                "{words}, {share} of the samples are limited to the energy loss of Housner's impact",
                {"words": text, "share": percent(float((k == 1.0).mean()))},
            )
        return k, as_measured(text, extrapolated=distribution.extrapolated)

    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> BodyOutcomes:
        """Return the outcomes of bodies under a motion times a factor."""
        values = self.values(draws)
        sampled = {name: column[:, 0] for name, column in values.items()}
        similar = Similarity.of_factors(values["model_error"])
        offset, slope = values["offset"], values["level"]
        factor_of_shift = self.shapes.standing(sampled["base"], offset + self.pose.height * np.tan(slope))[:, None]
        offset, slope = factor_of_shift * offset, factor_of_shift * slope
        placed = zip(sampled["base"].tolist(), sampled["centre"].tolist(), map(tuple, offset.tolist()), strict=True)
        shapes = [self.shapes.of(*numbers) for numbers in placed]
        unique_shapes = list(dict.fromkeys(shapes))
        index_of_shape = {shape: k for k, shape in enumerate(unique_shapes)}
        body_index = np.array([index_of_shape[shape] for shape in shapes])
        ground = ground_of(*ground_components(self.motions[motion]))
        turned = zip(shapes, sampled["azimuth"].tolist(), strict=True)
        state = np.array([shape.state(azimuth) for shape, azimuth in turned])
        numbers = numbers_of_rows(
            sampled["restitution"], factor * similar.motion, sampled["friction"] * similar.friction, state,
            self._gravity * similar.gravity, sloping(_rotated(slope, sampled["azimuth"])),
        )  # fmt: skip
        initial_facet = np.array([shape.facet for shape in shapes])
        choices = np.column_stack(
            [body_index, np.zeros_like(body_index), np.full_like(body_index, self._law), initial_facet]
        )
        bodies = [shape.body for shape in unique_shapes]
        rows = HullRows(bodies, [ground], _SETTINGS, histories.chosen("auto"), {self._law})
        results = rows.run(numbers, choices, thread_count(threads))
        valid = results["status"] == Status.GOOD.code
        overturned = np.asarray(results["pose"] == 1, dtype=np.float64)
        columns = (np.isfinite(results["first_uplift"]), results["sliding_distance"] * similar.length, overturned,
                   results["peak_tilt"], results["direction"])  # fmt: skip
        return BodyOutcomes(*(np.where(valid, column, np.nan) for column in columns))

    def values(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return the values of samples from the unit cube, by input; the base has 32 values."""
        levels = self.probabilities(draws)
        levels["base"] = (np.floor(levels["base"] * STEPS) + 0.5) / STEPS
        return {name: uncertain.quantile(levels[name]) for name, uncertain in self.inputs.items()}


def _rotated(vectors: FloatArray, angle: FloatArray) -> FloatArray:
    """Return horizontal vectors rotated by angles about the vertical: from axes of the body to axes of the ground."""
    c, s, (x, y) = np.cos(angle), np.sin(angle), vectors.T
    return np.column_stack([c * x - s * y, s * x + c * y])


def sloping(slope: FloatArray) -> FloatArray:
    """Return infinite planes that descend by angles towards x and y, as for `numbers_of_rows`; shape (n, 11)."""
    steepest = np.hypot(*slope.T)
    x, y = (slope / np.maximum(steepest, 1e-300)[:, None]).T
    c, s = np.cos(steepest), np.sin(steepest)
    axes = (1.0 + x * x * (c - 1.0), x * y * (c - 1.0), -x * s, x * y * (c - 1.0), 1.0 + y * y * (c - 1.0), -y * s,
            x * s, y * s, c)  # fmt: skip
    return np.column_stack([*axes, *np.full((2, len(slope)), math.inf)])
