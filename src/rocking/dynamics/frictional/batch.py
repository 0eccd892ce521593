"""All combinations of bodies on their hulls, motions, scales, restitutions, frictions and starts."""

import json
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rocking import plausibility
from rocking.conventions import FEET
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import HullGround
from rocking.dynamics.frictional.histories import HullRows, hull_histories, numbers_of
from rocking.dynamics.frictional.restitution import RestitutionOnHull, law_on_hull
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.mechanics_base import Combinations, listed, row_of
from rocking.dynamics.parameters import UNIMPOSED
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.batch import SpatialBatch, converted_or_refused, motions_in_space, provenance_of
from rocking.dynamics.rolling.ground import SpatialGround, ground_of
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions.components import Components
from rocking.motions.segments import Segments
from rocking.outcome import UNCOUNTED, Outcome

RENAMED = {"held": "contacts_held", "replaced": "landings_replaced"}
"""New names of results whose name in the engine has another meaning in `rocking.quantities`."""


def many_on_hulls(cases: Combinations, settings: HullSettings) -> SpatialBatch:
    """Return the outcome of all combinations."""
    bodies, motions, scales = listed(cases.bodies), motions_in_space(cases.motions), row_of("scale", cases.scales)
    frictions, duration = cases.frictions, cases.duration
    starts = [None] if cases.start is None else listed(cases.start)
    hull_bodies, refused = converted_or_refused(HullBody.of, bodies)
    if not hull_bodies or not motions or not cases.restitutions or not starts:
        raise InvalidValueError("bodies, motions, restitution and start must be at least one each, got none")
    if (frictions < 0.0).any():
        raise InvalidValueError("friction must be in [0, 1e+06], got {smallest:g}", smallest=frictions.min())
    until = math.inf if duration is None else duration
    components = [tuple(component for component in motion or () if component is not None) for motion in motions]
    for group in components:
        plausibility.warn(plausibility.of_scaled(group, scales))
    laws = [law_on_hull(restitution) for restitution in cases.restitutions]
    grounds = [
        HullGround.placed(ground_of(*motion or (), until=until), np.eye(3), (math.inf, math.inf), settings.gravity)
        for motion in motions
    ]
    initial_states = [start or SpatialStart() for start in starts]
    batch = hull_histories(
        hull_bodies, grounds, laws, frictions, scales, initial_states, horizon=duration or 0.0,
        settings=settings, engine=cases.engine, threads=cases.threads, progress=cases.progress,
    )  # fmt: skip
    # hull_histories has its own order: body, motion, scale, restitution, friction, start
    values = {RENAMED.get(name, name): array for name, array in batch.values.items()}
    labels: dict[str, list[object]] = {
        "motion": [", ".join(component.name for component in group) or "none" for group in components],
        "scale": scales.tolist(), "restitution": [str(law) for law in laws], "friction": frictions.tolist(),
    }  # fmt: skip
    stated = {name: value for name, value in settings.stated.items() if name != "friction"}
    summaries = [None if b is None else [b.mass, b.centre.tolist(), len(b.points)] for b in hull_bodies]
    component_lists = [motion or () for motion in motions]
    source = provenance_of(stated, component_lists, initial_states, duration, "until it rests after the motion")
    source |= {"bodies": json.dumps(summaries)}
    return replace(batch, values=values, labels=labels, refused=refused, provenance=source)


class RowsOnHull:
    """Motions of a study of solids. `run` computes the histories of one body, given as rows."""

    def __init__(
        self, motions: Sequence[Segments | Components], law: RestitutionOnHull, settings: HullSettings, engine: str
    ) -> None:
        self.law, self.gravity, self.friction = law, settings.gravity, settings.friction
        grounds = [_ground(motion) for motion in motions]
        engine_name = histories.chosen(engine)
        laws = {histories.CODES[law.model]} if isinstance(law.model, str) else set()
        self.rows = HullRows([law.on_hull], grounds, settings, engine_name, laws)

    def run(self, piece: Rows, threads: int) -> tuple[dict[str, np.ndarray], dict[str, int]]:
        """Return the results of a piece by their names in studies, and counts of steps.

        A body that is c times larger moves like the given body under gravity / c and ground accelerations / c, in the
        same time. The frequency parameter p of a row determines c.
        """
        law, values, motion, count = self.law, piece.values, piece.motion, len(piece)
        if values["rotation"].any() or values["velocity"].any():
            raise InvalidValueError("rows of a body in space must start upright and at rest")
        with np.errstate(all="ignore"):  # an invalid row gets an error status
            size = (law.frequency / values["p_right"]) ** 2 * (self.gravity / law.gravity)
            size = np.where(np.all([values[f"alpha_{foot}"] > 0.0 for foot in FEET], axis=0), size, np.nan)
            pull, scale = self.gravity / size, values["scale"] / size
        friction = np.where(np.isnan(values["friction"]), self.friction, values["friction"])
        r = values["r_right"]
        is_modelled = r == UNIMPOSED
        code = histories.CODES.get(str(law.model), 0)
        azimuth, plane = np.nan_to_num(values["azimuth"]), np.tile(histories.LEVEL, (count, 1))
        plane[:, [0, 4]], plane[:, 1], plane[:, 3] = np.cos(azimuth)[:, None], -np.sin(azimuth), np.sin(azimuth)
        state = np.tile(numbers_of(law.on_hull, SpatialStart()), (count, 1))
        numbers = histories.numbers_of_rows(np.where(is_modelled, 0.0, r), scale, friction, state, pull, plane)
        codes = np.where(is_modelled, code, histories.COEFFICIENT)
        base = np.full(count, law.on_hull.base)
        choices = np.column_stack([np.zeros(count, np.int64), motion, codes, base]).astype(np.int64)
        results = self.rows.run(numbers, choices, threads)
        overturns = results["outcome"] == Outcome.OVERTURNED.code
        names = ("outcome", "status", "uplifts", "still_rocking", "overturning_time", "peak_time", "first_uplift")
        return {name: results[name] for name in names} | {
            "peak_rotation": np.where(overturns, 0.5 * math.pi, results["peak_tilt"]),
            "peak_velocity": results["peak_spin"], "impacts": np.where(overturns, UNCOUNTED, results["impacts"]),
            "side": np.where(overturns, np.where(np.cos(results["direction"]) < 0.0, -1, 1), 0),
        }, {"steps": int(results["steps"].sum())}  # fmt: skip


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
