"""Sampled plane bodies on a floor with friction, and their outcomes by the compiled engine."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking.bodies import Block, Body
from rocking.conventions import FEET, BoolArray, FloatArray, IntArray
from rocking.decision.prediction.mechanics import (
    AZIMUTH_REASON,
    CENTRE,
    CENTRE_REASON,
    COMPLEMENTARITY,
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
from rocking.decision.prediction.placement import FARTHEST, OFFSET, OFFSET_REASON
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.parameters import UNIMPOSED, coefficients_of
from rocking.dynamics.plane_frictional.batch import RowsWithContact
from rocking.dynamics.plane_frictional.settings import ContactSettings
from rocking.dynamics.rows import Rows
from rocking.dynamics.settings import thread_count
from rocking.errors import InvalidValueError
from rocking.evidence import calibrate_hierarchy, restitution_distribution
from rocking.messages import Message
from rocking.motions.components import rotated, with_vertical
from rocking.outcome import Outcome, overturned
from rocking.restitution import ImpactGeometry, RestitutionModel
from rocking.restitution.shifted_impulse import shifted

BASE = 0.02  # default of the largest inset of a foot / base width

DIRECTIONS = 36
"""Number of directions over half a turn, to which sampled azimuths are rounded."""

NOT_SAMPLED = {
    "placement": Message("the body is free-standing and has contact at both feet"),
    "density": DENSITY_REASON,
}

_REASONS = {
    "friction": FRICTION_REASON,
    "base": Message(
        "inset of each foot from the nominal base, for chipped or rounded edges: up to 2 % of the base width"
    ),
    "centre": CENTRE_REASON,
    "offset": OFFSET_REASON,
    "polarity": Message("as recorded or reversed: the orientation of the body is unknown"),
    "azimuth": AZIMUTH_REASON,
}


_FOLLOWS = Message("restitution depends on base and centre as in the shifted impulse of the calibrated model")


class SampledInPlane(SampledBodies):
    """A plane body that may slide, hop and fly."""

    widths_of, reasons, never_sampled = {"base": 2, "model_error": 2}, _REASONS, NOT_SAMPLED

    def __init__(self, body: Body, motions: Any, inputs: Mapping[str, Any], settings: ContactSettings) -> None:
        super().__init__(motions, inputs)
        self.body, self._settings = body, settings
        self.kind = "machined" if isinstance(body, Block) else "object"
        if not self._turns and inputs.get("azimuth") is not None:
            raise InvalidValueError('azimuth requires motions of two components, {"x": ..., "y": ...}')
        left, right = (body.side(foot, settings.gravity) for foot in FEET)
        self._levers, self._height = np.array([left.half_width, right.half_width]), right.centre_height
        self._spread = body.moment_of_inertia / body.mass
        max_inset, full_turn = 0.9 * float(self._levers.min()), 2.0 * math.pi
        offset = OFFSET * 0.5 * float(self._levers.sum())
        self.assumed |= dict.fromkeys(body.assumed, "")
        self._set_inputs({
            "friction": FRICTION,
            "base": ((0.0, min(BASE * float(self._levers.sum()), max_inset)), 0.0, max_inset, "m"),
            "centre": CENTRE,
            "offset": ((-offset, offset), -max_inset, max_inset, "m"),
            "level": self._level(float(self._levers.sum())),
            "polarity": ({"values": [-1.0, 1.0]}, -1.0, 1.0, "-"),
            **({"azimuth": ((0.0, full_turn), -full_turn, full_turn, "rad")} if self._turns else {}),
        })  # fmt: skip
        if not np.isin(self.inputs["polarity"].quantile(np.linspace(0.0, 1.0, 33)), (-1.0, 1.0)).all():
            raise InvalidValueError(
                parameter="polarity", allowed="1, -1, or a sample of these two values", value=inputs["polarity"]
            )
        self._set_restitution(inputs.get("restitution"))
        self._set_model_error()

    def _set_restitution(self, stated: Any) -> None:
        """Set the quantiles of the coefficients of both feet, and their dependence on the base."""
        name = stated if isinstance(stated, str) else MEASURED[0] if stated is None else ""
        if name in MEASURED:
            distribution = restitution_distribution(self.body)
            self._tables = [distribution.tables[foot] for foot in FEET]
            ends = {"low": float(self._tables[1][25]), "high": float(self._tables[1][-26])}
            interval = Message("{low:.3f} to {high:.3f} on the right foot in 95 % of samples", ends)
            text = as_measured(interval, extrapolated=distribution.extrapolated)
            self._follows, fixed = True, False
            self.assumed["restitution"] = with_reason(text, MEASURED_REASON)
        elif name == COMPLEMENTARITY:
            text, self._follows, fixed = Message("complementarity only"), False, True
            self._tables = [np.full(2, UNIMPOSED)] * 2
        elif name or isinstance(stated, RestitutionModel) or (isinstance(stated, Mapping) and set(stated) == set(FEET)):
            pair, text = coefficients_of(stated, self.body)
            self._tables, self._follows, fixed = (
                [np.full(2, pair[foot]) for foot in FEET],
                not isinstance(stated, Mapping),
                True,
            )
        else:
            uncertain = Uncertain.of("restitution", stated, 0.0, 10.0)
            levels = np.linspace(0.0, 1.0, 1025)
            levels[[0, -1]] = 0.25 / 1025, 1.0 - 0.25 / 1025
            self._tables, self._follows, fixed, text = (
                [uncertain.quantile(levels)] * 2,
                False,
                uncertain.fixed,
                uncertain.text,
            )
        if self._follows:
            self.assumed[_FOLLOWS] = ""
        table_levels = np.linspace(0.0, 1.0, self._tables[1].size)
        right = self._tables[1]
        self.inputs = {
            "restitution": Uncertain(text, lambda u: np.interp(u, table_levels, right), fixed),
            **self.inputs,
        }

    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> BodyOutcomes:
        """Return the outcomes of bodies under a motion times a factor."""
        levels, values = self.probabilities(draws), self.values(draws)
        segments, motion_index, mirrored = self._ground(motion, values)
        height = self._height * values["centre"][:, 0]
        levers = _moved(self._levers - values["base"], values["offset"][:, 0], height, values["level"][:, 0])
        coefficients = self._coefficients(levels["restitution"][:, 0], levers, height)
        levers, coefficients = _turned(levers, mirrored), _turned(coefficients, mirrored)
        similar = Similarity.of_factors(values["model_error"])
        rows: dict[str, FloatArray] = {
            "friction": values["friction"][:, 0] * similar.friction, "scale": factor * similar.friction,
            "rotation": np.zeros(len(draws)), "velocity": np.zeros(len(draws)),
        }  # fmt: skip
        for k, foot in enumerate(FEET):
            square = levers[:, k] ** 2 + height**2
            inertia = self._spread + square
            rows[f"alpha_{foot}"] = np.arctan2(levers[:, k], height)
            # the size of the similar body changes its frequency parameter, Eq. 26
            rows[f"p_{foot}"] = np.sqrt(self._settings.gravity * similar.gravity * np.sqrt(square) / inertia)
            rows[f"q_{foot}"] = square / inertia  # Eq. 27
            rows[f"r_{foot}"] = coefficients[:, k]
        runner = RowsWithContact(segments, ConstantRestitution(), self._settings, "auto")
        results, _ = runner.run(Rows.of(len(draws), motion_index, **rows), thread_count(threads))
        failed = np.asarray(results["outcome"]) == Outcome.FAILED.code
        uplift = np.isfinite(results["first_uplift"]) | (results["peak_rotation"] != 0.0)
        return BodyOutcomes(
            np.where(failed, np.nan, uplift), np.where(failed, np.nan, results["sliding_distance"] / similar.friction),
            overturned(results["outcome"]), np.abs(results["peak_rotation"]),
        )  # fmt: skip

    def _ground(self, motion: int, values: Mapping[str, FloatArray]) -> tuple[list[Any], IntArray, BoolArray]:
        """Return the motion in all sampled directions, the direction index of each body, and flags of reversal."""
        first, second, upright = ground_components(self.motions[motion])
        mirrored = values["polarity"][:, 0] < 0.0
        if second is None:
            return [_whole(first, upright).segments()], np.zeros(mirrored.size, np.int64), mirrored
        step = np.rint(values["azimuth"][:, 0] * DIRECTIONS / math.pi).astype(np.int64)
        directions, direction_index = np.unique(step % DIRECTIONS, return_inverse=True)
        rotated_records = [rotated(first, second, math.pi * k / DIRECTIONS)[0] for k in directions.tolist()]
        half_a_turn = (step // DIRECTIONS) % 2 == 1
        return (
            [_whole(record, upright).segments() for record in rotated_records],
            direction_index,
            mirrored ^ half_a_turn,
        )

    def _coefficients(self, level: FloatArray, levers: FloatArray, height: FloatArray) -> FloatArray:
        """Return the coefficients for landing on the left and on the right foot, limited by energy."""
        coefficients = np.empty_like(levers)
        for new, table in enumerate(self._tables):
            old = 1 - new
            r = np.interp(level, np.linspace(0.0, 1.0, table.size), table)
            if self._follows:
                k = np.asarray(calibrate_hierarchy().summary["k"]["mean"])
                now = shifted(self._impact(levers[:, old], levers[:, new], height), k)
                before = shifted(self._impact(self._levers[old], self._levers[new], self._height), k)
                r = r * np.maximum(now, 0.0) / np.maximum(before, 1e-3)
            inertia = self._spread + height[:, None] ** 2 + levers**2
            limited = np.clip(r, 0.0, np.sqrt(inertia[:, old] / inertia[:, new]))  # Eq. 29
            coefficients[:, new] = np.where(r == UNIMPOSED, r, limited)
        return coefficients

    def _impact(self, old: Any, new: Any, height: Any) -> ImpactGeometry:
        half = np.asarray(0.5 * self._spread)
        return ImpactGeometry(height, old, new, half, half)


def _moved(levers: FloatArray, offset: FloatArray, height: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the levers of both feet [m] for a centre of mass offset to the right [m] on a descent to the right [rad].

    The slenderness angles from the vertical are exact. The distance between the feet is exact to first order. The
    plumb line stays within 90 % of the nearer lever.
    """
    limit = FARTHEST * levers.min(axis=1)
    sign = np.array([1.0, -1.0])
    moved = levers + sign * np.clip(offset, -limit, limit)[:, None]
    sloped = height[:, None] * np.tan(np.arctan2(moved, height[:, None]) + sign * slope[:, None])
    return np.maximum(sloped, (1.0 - FARTHEST) * levers)


def _turned(pairs: FloatArray, mirrored: BoolArray) -> FloatArray:
    return np.where(mirrored[:, None], pairs[:, ::-1], pairs)


def _whole(along: Any, upright: Any) -> Any:
    return along if upright is None else with_vertical(along, upright)


def contact_settings(gravity: float, normal_restitution: float, normal_restitution_law: str) -> ContactSettings:
    """Return the settings of contact; each body has its own friction."""
    return ContactSettings(
        gravity=gravity, friction=0.5, normal_restitution=normal_restitution,
        normal_restitution_law=normal_restitution_law,
    )  # fmt: skip
