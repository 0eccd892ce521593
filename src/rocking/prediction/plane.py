"""What is drawn for a plane body on a floor with friction, and what becomes of it by the compiled engine."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, BoolArray, FloatArray, IntArray
from rocking.dynamics.contact.batch import RowsWithContact
from rocking.dynamics.contact.settings import ContactSettings
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.parameters import coefficients_of
from rocking.dynamics.rows import Rows
from rocking.dynamics.settings import thread_count
from rocking.errors import InvalidValueError
from rocking.evidence import calibrate_hierarchy, restitution_distribution
from rocking.messages import Message
from rocking.motions.components import rotated, with_vertical
from rocking.outcome import Outcome, overturned
from rocking.prediction.mechanics import (
    AZIMUTH_WHY,
    CENTRE,
    CENTRE_WHY,
    COMPLEMENTARITY,
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
from rocking.restitution import ImpactGeometry, RestitutionModel
from rocking.restitution.shifted_impulse import shifted

BASE = 0.02  # share of the base within which feet lie where nobody says otherwise

DIRECTIONS = 36
"""Over half a turn, to which azimuths are rounded: a motion of two components is turned into each that was drawn."""

NOT_SAMPLED = {
    "placement": Message("the ground is level and the body stands flat on both feet"),
    "density": DENSITY_WHY,
}

_WHY = {
    "friction": FRICTION_WHY,
    "base": Message(
        "how far each foot lies inside of the drawn base, for chipped or rounded edges: up to 2 % of its width"
    ),
    "centre": CENTRE_WHY,
    "polarity": Message("as recorded or mirrored: which way round the body will stand is not known"),
    "azimuth": AZIMUTH_WHY,
}


_FOLLOWS = Message("restitution follows base and centre as the shifted impulse of the calibrated model does")


class SampledInPlane(SampledBodies):
    """A plane body that may slide, hop and fly."""

    widths_of, why, never_sampled = {"base": 2}, _WHY, NOT_SAMPLED

    def __init__(self, body: Body, motions: Any, given: Mapping[str, Any], settings: ContactSettings) -> None:
        super().__init__(motions, given)
        self.body, self._settings = body, settings
        if not self._turns and given.get("azimuth") is not None:
            raise InvalidValueError('azimuth goes with motions of two components, {"x": ..., "y": ...}')
        left, right = (body.side(foot, settings.gravity) for foot in FEET)
        self._levers, self._height = np.array([left.half_width, right.half_width]), right.centre_height
        self._spread = body.moment_of_inertia / body.mass
        most, turn = 0.9 * float(self._levers.min()), 2.0 * math.pi
        self.assumed |= dict.fromkeys(body.assumed, "")
        self._take({
            "friction": FRICTION,
            "base": ((0.0, min(BASE * float(self._levers.sum()), most)), 0.0, most, "m"),
            "centre": CENTRE,
            "polarity": ({"values": [-1.0, 1.0]}, -1.0, 1.0, "-"),
            **({"azimuth": ((0.0, turn), -turn, turn, "rad")} if self._turns else {}),
        })  # fmt: skip
        if not np.isin(self.inputs["polarity"].quantile(np.linspace(0.0, 1.0, 33)), (-1.0, 1.0)).all():
            raise InvalidValueError(parameter="polarity", allowed="1, -1 or both as a sample", value=given["polarity"])
        self._set_restitution(given.get("restitution"))

    def _set_restitution(self, told: Any) -> None:
        """Take coefficients onto both feet for probabilities, and whether they follow the base."""
        word = told if isinstance(told, str) else MEASURED[0] if told is None else ""
        if word in MEASURED:
            found = restitution_distribution(self.body)
            self._tables = [found.tables[foot] for foot in FEET]
            ends = {"low": float(self._tables[1][25]), "high": float(self._tables[1][-26])}
            onto = Message("{low:.3f} to {high:.3f} onto the right foot in 95 % of draws", ends)
            words = as_measured(onto, extrapolated=found.extrapolated)
            self._follows, fixed = True, False
            self.assumed["restitution"] = because(words, MEASURED_WHY)
        elif word == COMPLEMENTARITY:
            words, self._follows, fixed = Message("by complementarity alone"), False, True
            self._tables = [np.full(2, np.nan)] * 2
        elif word or isinstance(told, RestitutionModel) or (isinstance(told, Mapping) and set(told) == set(FEET)):
            pair, words = coefficients_of(told, self.body)
            self._tables, self._follows, fixed = (
                [np.full(2, pair[foot]) for foot in FEET],
                not isinstance(told, Mapping),
                True,
            )
        else:
            one = Uncertain.of("restitution", told, 0.0, 10.0)
            levels = np.linspace(0.0, 1.0, 1025)
            levels[[0, -1]] = 0.25 / 1025, 1.0 - 0.25 / 1025
            self._tables, self._follows, fixed, words = [one.quantile(levels)] * 2, False, one.fixed, one.words
        if self._follows:
            self.assumed[_FOLLOWS] = ""
        at = np.linspace(0.0, 1.0, self._tables[1].size)
        right = self._tables[1]
        self.inputs = {"restitution": Uncertain(words, lambda u: np.interp(u, at, right), fixed), **self.inputs}

    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> Endings:
        """Return what becomes of bodies under a motion times a factor."""
        levels, drawn = self.probabilities(draws), self.values(draws)
        segments, number, mirrored = self._ground(motion, drawn)
        levers = self._levers - drawn["base"]
        height = self._height * drawn["centre"][:, 0]
        coefficients = self._coefficients(levels["restitution"][:, 0], levers, height)
        levers, coefficients = _turned(levers, mirrored), _turned(coefficients, mirrored)
        rows: dict[str, FloatArray] = {
            "friction": drawn["friction"][:, 0], "scale": factor,
            "rotation": np.zeros(len(draws)), "velocity": np.zeros(len(draws)),
        }  # fmt: skip
        for k, foot in enumerate(FEET):
            square = levers[:, k] ** 2 + height**2
            inertia = self._spread + square
            rows[f"alpha_{foot}"] = np.arctan2(levers[:, k], height)
            rows[f"p_{foot}"] = np.sqrt(self._settings.gravity * np.sqrt(square) / inertia)  # Eq. 26
            rows[f"q_{foot}"] = square / inertia  # Eq. 27
            rows[f"r_{foot}"] = coefficients[:, k]
        runner = RowsWithContact(segments, ConstantRestitution(), self._settings, "auto")
        found, _ = runner.run(Rows.of(len(draws), number, **rows), thread_count(threads))
        failed = np.asarray(found["outcome"]) == Outcome.FAILED.code
        rose = np.isfinite(found["first_uplift"]) | (found["peak_rotation"] != 0.0)
        return Endings(
            np.where(failed, np.nan, rose), np.where(failed, np.nan, found["sliding_distance"]),
            overturned(found["outcome"]), np.abs(found["peak_rotation"]),
        )  # fmt: skip

    def _ground(self, motion: int, drawn: Mapping[str, FloatArray]) -> tuple[list[Any], IntArray, BoolArray]:
        """Return the motion in all directions that were drawn, which of them each body has, and whom it mirrors."""
        first, second, upright = parts(self.motions[motion])
        mirrored = drawn["polarity"][:, 0] < 0.0
        if second is None:
            return [_whole(first, upright).segments()], np.zeros(mirrored.size, np.int64), mirrored
        step = np.rint(drawn["azimuth"][:, 0] * DIRECTIONS / math.pi).astype(np.int64)
        wanted, number = np.unique(step % DIRECTIONS, return_inverse=True)
        turned = [rotated(first, second, math.pi * k / DIRECTIONS)[0] for k in wanted.tolist()]
        half_a_turn = (step // DIRECTIONS) % 2 == 1
        return [_whole(each, upright).segments() for each in turned], number, mirrored ^ half_a_turn

    def _coefficients(self, level: FloatArray, levers: FloatArray, height: FloatArray) -> FloatArray:
        """Return the coefficients landing left and right, within what energy allows."""
        found = np.empty_like(levers)
        for new, table in enumerate(self._tables):
            old = 1 - new
            r = np.interp(level, np.linspace(0.0, 1.0, table.size), table)
            if self._follows:
                k = np.asarray(calibrate_hierarchy().summary["k"]["mean"])
                now = shifted(self._impact(levers[:, old], levers[:, new], height), k)
                before = shifted(self._impact(self._levers[old], self._levers[new], self._height), k)
                r = r * np.maximum(now, 0.0) / np.maximum(before, 1e-3)
            inertia = self._spread + height[:, None] ** 2 + levers**2
            found[:, new] = np.clip(r, 0.0, np.sqrt(inertia[:, old] / inertia[:, new]))  # Eq. 29
        return found

    def _impact(self, old: Any, new: Any, height: Any) -> ImpactGeometry:
        half = np.asarray(0.5 * self._spread)
        return ImpactGeometry(height, old, new, half, half)


def _turned(pairs: FloatArray, mirrored: BoolArray) -> FloatArray:
    return np.where(mirrored[:, None], pairs[:, ::-1], pairs)


def _whole(along: Any, upright: Any) -> Any:
    return along if upright is None else with_vertical(along, upright)


def whole_settings(gravity: float, bounce: float, bounce_law: str) -> ContactSettings:
    """Return how to integrate with friction, which every body has its own of."""
    return ContactSettings(gravity=gravity, friction=0.5, bounce=bounce, bounce_law=bounce_law)
