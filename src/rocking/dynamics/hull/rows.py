"""Rows of studies of bodies in space with friction, as histories of one body on its hull."""

import math
from collections.abc import Sequence

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.hull import fast_engine
from rocking.dynamics.hull.histories import HullRows, numbers_of
from rocking.dynamics.hull.law import RestitutionOnHull
from rocking.dynamics.hull.response import settings_on_hull
from rocking.dynamics.parameters import UNIMPOSED
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.ground import SpatialGround, ground_of
from rocking.errors import InvalidValueError
from rocking.motions.components import Components
from rocking.motions.segments import Segments
from rocking.outcome import UNCOUNTED, Outcome


class RowsOnHull:
    """Motions of a study, and histories of one body under them as rows: the runner behind every study of solids."""

    def __init__(
        self, motions: Sequence[Segments | Components], law: RestitutionOnHull, settings: Settings, engine: str
    ) -> None:
        self.law, self.gravity = law, settings.gravity
        assert settings.friction is not None
        self.friction = settings.friction
        grounds = [_ground(motion) for motion in motions]
        which = fast_engine.chosen(engine)
        ked = law.model == "ked-3d"
        self.rows = HullRows([law.on_hull], grounds, settings_on_hull(settings), which, ked=ked)
        if ked and law.on_hull.solid is None:
            raise InvalidValueError(
                "restitution 'ked-3d' needs the distribution of mass, of this body moments are known"
            )

    def run(self, values: dict[str, FloatArray], motion: np.ndarray, threads: int) -> dict[str, np.ndarray]:
        """Return the results of some rows by the names that studies know; NaN for what this mechanics has not.

        A body of c times the size moves as the one at hand does under gravity and ground accelerations over c, in the
        same time; p says c.
        """
        law, count = self.law, motion.size
        if values["rotation"].any() or values["velocity"].any():
            raise InvalidValueError("rows of a body in space start upright and at rest")
        with np.errstate(all="ignore"):  # a row that is no body is refused by itself
            size = (law.frequency / values["p_right"]) ** 2 * (self.gravity / law.gravity)
            size = np.where(np.all([values[f"alpha_{foot}"] > 0.0 for foot in FEET], axis=0), size, np.nan)
            pull, scale = self.gravity / size, values["scale"] / size
        friction = np.where(np.isnan(values["friction"]), self.friction, values["friction"])
        r = values["r_right"]
        modelled = r == UNIMPOSED
        code = {"housner-3d": fast_engine.HOUSNER, "ked-3d": fast_engine.KED}.get(str(law.model), 0)
        numbers = np.zeros((count, 29))
        numbers[:, 0], numbers[:, 1], numbers[:, 3] = np.where(modelled, 0.0, r), scale, friction
        turned = np.nan_to_num(values["azimuth"])
        numbers[:, 4:13], numbers[:, 13:15] = np.eye(3).ravel(), math.inf
        numbers[:, 4], numbers[:, 8] = np.cos(turned), np.cos(turned)
        numbers[:, 5], numbers[:, 7] = -np.sin(turned), np.sin(turned)
        numbers[:, 15:28], numbers[:, 28] = numbers_of(law.on_hull, SpatialStart()), pull
        codes = np.where(modelled, code, fast_engine.COEFFICIENT)
        choices = np.column_stack([np.zeros(count, np.int64), motion, codes]).astype(np.int64)
        found = self.rows.run(numbers, choices, threads)
        fell, unknown = found["outcome"] == Outcome.OVERTURNED.code, np.full(count, np.nan)
        names = ("outcome", "status", "uplifts", "still_rocking", "steps", "overturning_time", "peak_time",
                 "first_uplift")  # fmt: skip
        return {name: found[name] for name in names} | {
            "peak_rotation": np.where(fell, 0.5 * math.pi, found["peak_tilt"]), "peak_velocity": found["peak_spin"],
            "impacts": np.where(fell, UNCOUNTED, found["impacts"]),
            "side": np.where(fell, np.where(np.cos(found["direction"]) < 0.0, -1, 1), 0),
            "truncation": unknown, "least_force": unknown, "friction_demand": unknown,
        }  # fmt: skip


def _ground(motion: Segments | Components) -> SpatialGround:
    if isinstance(motion, Components):
        return ground_of(*motion.parts)
    times = np.asarray(np.arange(motion.count + 1) * motion.step, dtype=np.float64)
    degree = motion.horizontal.shape[1]
    rows = np.zeros((motion.count, 3, degree))
    rows[:, 0] = motion.horizontal
    if motion.vertical is not None:
        rows[:, 2, : motion.vertical.shape[1]] = motion.vertical
    return SpatialGround(times, rows)
