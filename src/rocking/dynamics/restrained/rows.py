"""Histories of one body with restraints, given as rows of a study."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.dynamics.restrained.devices import blocked, devices_of, parameters_of
from rocking.dynamics.restrained.engines import FAST, RestrainedHistory, run_rows
from rocking.dynamics.restrained.many import AFTER
from rocking.dynamics.restrained.pushover import pushover
from rocking.dynamics.restrained.settings import RestrainedStudySettings
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

COLUMNS: Mapping[str, Any] = {
    **RESULTS, "residual_rotation": np.float64, "yielded_restraints": np.int64, "broken_restraints": np.int64,
}  # fmt: skip
"""Results of a history with their types. The last two are sums of 2^k over the indices k of restraints."""

MOST_RESTRAINTS = 62  # in a study, because of these sums
_UPRIGHT = 1e-12  # a rotation that only selects the foot [rad]


class RowsWithRestraints:
    """Motions and one body with restraints. `run` computes histories given as rows of a study."""

    def __init__(
        self, motions: Sequence[Segments], law: ImpactLaw, settings: RestrainedStudySettings, engine: str
    ) -> None:
        if not isinstance(law, ConstantRestitution):
            raise InvalidValueError(
                "with restraints the coefficient of restitution must be constant within a history, got {law}",
                parameter="restitution", law=type(law).__name__,
            )  # fmt: skip
        if len(settings.body.restraints) > MOST_RESTRAINTS:
            raise InvalidValueError(
                "a study accepts at most {limit} restraints, got {count}", parameter="restraints",
                limit=MOST_RESTRAINTS, count=len(settings.body.restraints),
            )  # fmt: skip
        self.motions, self.settings, self.engine = motions, settings, engine
        self.parameters = parameters_of(settings.body, None, settings.gravity, may_be_none=True)

    def run(self, piece: Rows, threads: int) -> tuple[dict[str, np.ndarray], dict[str, int]]:
        """Return the results of a piece by name, and the number of rows of the compiled engine."""
        values = piece.values
        self._check_sides(values)
        slow = min(self.parameters.right.frequency_parameter, self.parameters.left.frequency_parameter)
        lengths = [motion.duration + AFTER / slow for motion in self.motions]
        names = ("r_right", "r_left", "rotation", "velocity", "scale")
        histories = [
            RestrainedHistory(
                self.settings.body, self._with(right, left), motion, (rotation, velocity), scale, lengths[motion]
            )
            for motion, right, left, rotation, velocity, scale in zip(
                piece.motion.tolist(), *(values[name].tolist() for name in names), strict=True
            )
        ]
        engine, results, restraints = run_rows(
            histories, self.motions, self.settings, engine=self.engine, threads=threads
        )
        results["residual_rotation"][results["still_rocking"] == 1] = np.nan
        bits = 2 ** np.arange(len(self.settings.body.restraints))
        results["yielded_restraints"] = (restraints["yield_count"] > 0.0) @ bits
        results["broken_restraints"] = (restraints["is_broken"] > 0.0) @ bits
        return results, {"rows": len(piece)} if engine == FAST else {}

    def _with(self, right: float, left: float) -> RockingParameters:
        parameters = self.parameters
        sides = replace(parameters.right, coefficient=right), replace(parameters.left, coefficient=left)
        return RockingParameters(*sides, parameters.law, parameters.label)

    def _check_sides(self, values: Mapping[str, FloatArray]) -> None:
        """Raise an error for rows of another body or of a faster motion, for which the restraints are unknown."""
        for foot in FEET:
            side = getattr(self.parameters, foot)
            same = np.isclose(values[f"alpha_{foot}"], side.slenderness_angle, rtol=1e-12, atol=0.0)
            if not np.all(same & np.isclose(values[f"p_{foot}"], side.frequency_parameter, rtol=1e-12, atol=0.0)):
                raise InvalidValueError("dimensions and time do not vary for a body with restraints")


def uplift_accelerations(settings: RestrainedStudySettings, count: int) -> FloatArray:
    """Return the ground accelerations of uplift about the right and the left foot [m/s2], shape (2, count).

    Prestress and slip forces act before uplift. Stiffness and viscous forces act only after uplift.
    """
    accelerations = np.full(2, np.inf)  # a rigid wall prevents the uplift of one side
    for k, side in enumerate((1, -1)):
        if side not in blocked(devices_of(settings.body, linear=settings.linear)):
            curve = pushover(settings.body, [0.0, side * _UPRIGHT], gravity=settings.gravity, linear=settings.linear)
            accelerations[k] = -side * curve.balancing_acceleration[0]
    if not np.all(accelerations > 0.0):
        raise InvalidValueError(
            "the body must stand without motion; the restraints lift it", parameter="restraints",
            value=[restraint.name for restraint in settings.body.restraints],
        )  # fmt: skip
    return np.repeat(accelerations[:, None], count, axis=1)
