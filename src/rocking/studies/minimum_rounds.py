"""Minimum overturning accelerations in rounds: a common search for all motions, restitutions and bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.plane.fast_engine import Arrays, empty_results
from rocking.motions.pulse import Pulse
from rocking.studies.minimum_acceleration import Cases, Effort, Transitions, searched
from rocking.studies.motion_sets import MotionList
from rocking.studies.question import modes_of, peak_ratio
from rocking.studies.sensitivity.restitutions import sampled
from rocking.studies.study_plan import AdaptiveResult, Compute, NumberedTable
from rocking.tables import Column, Table, prefixed, text_array

# ratio of histories of later rounds to histories of the first round, by kind of motion
_LATER = {"pulses": (2.0, 10.0), "records": (10.0, 100.0)}
_MODE = "no uplift -2, no overturning -1, n >= 0 overturned after n impacts"

_NUMBERS: dict[str, tuple[str, str]] = {
    "minimum": ("m/s2", "smallest sampled overturning PGA; NaN if none, or if the lowest overturns"),
    "certain": ("m/s2", "PGA above which all samples overturn; NaN if the highest does not"),
    "uplift_acceleration": ("m/s2", "ground acceleration of uplift"),
    "min_pga": ("m/s2", "smallest PGA that is computed"),
    "max_pga": ("m/s2", "largest PGA that is computed"),
    "resolution": ("1", "relative spacing of the first samples"),
    "resolution_below": ("1", "widest relative gap between samples below the minimum; NaN if there is none"),
}
_COUNTS = {
    "crossings": "number of changes of the verdict",
    "starts_overturned": "1 if the lowest acceleration overturns",
    "samples": "number of histories",
    "failed": "number of histories without a result",
}
_CROSSING = {
    "acceleration": ("m/s2", "peak ground acceleration at which the verdict changes"),
    "ratio": ("1", "PGA over the acceleration of uplift"),
    "scale": ("1", "scale factor of the motion"),
    "width": ("m/s2", "width of the bracket"),
}


@dataclass(frozen=True)
class MinimumSearch:
    """Rounds of a search for crossings."""

    cases: Cases  # every motion with every restitution and body; the body changes fastest
    effort: Effort  # samples, bisections and tolerance of the search
    motions: MotionList
    shape: tuple[int, int, int]  # numbers of motions, restitutions and bodies
    law: ImpactLaw  # law of the coefficient per impact
    options: dict[str, Any]  # settings and engine, as for `Histories`
    names: dict[str, list[str]]  # names of the motions and the restitutions
    kept: float = field(default=1.0, init=False)

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Return a tuple of `Transitions` (None for cases without a result), and their tables."""
        motion, _, body = np.unravel_index(np.arange(self.cases.uplift.size), self.shape)

        def run(values: dict[str, FloatArray], case: IntArray) -> Arrays:
            if case.size:
                # the random numbers of a body depend neither on the amplitude nor on other motions
                options: dict[str, Any] = {"law": self.law, **self.options}
                results = compute(sampled(NumberedTable(self.motions, motion[case], values, body[case], **options)))
            else:
                results = empty_results(0)
            ratio = peak_ratio(results["peak_rotation"], values["alpha_right"], values["alpha_left"])
            return {**results, "mode": modes_of(results), "peak_ratio": ratio}

        crossings = searched(self.cases, self.effort, run)
        return AdaptiveResult(crossings, tables_of(crossings, self.cases, self.effort, self.shape, self.names))

    def later(self, first: int) -> tuple[int, int]:
        """Return the usual range of the number of histories of later rounds."""
        low, high = _LATER["pulses" if type(self.motions[0]) is Pulse else "records"]
        return int(low * first), int(high * first)


def tables_of(
    crossings: Sequence[Transitions | None], cases: Cases, effort: Effort, shape: tuple[int, int, int],
    names: Mapping[str, list[str]],
) -> dict[str, Table]:  # fmt: skip
    """Return the tables ``minima``, one row per case, and ``crossings``, one row per crossing."""
    rows = [_row(transitions, cases, effort, k) for k, transitions in enumerate(crossings)]
    columns = _case_columns(np.arange(len(crossings)), shape, names)
    described = _NUMBERS | {name: ("1", meaning) for name, meaning in _COUNTS.items()}
    for name, (unit, meaning) in described.items():
        values = np.array([row[name] for row in rows], np.int64 if name in _COUNTS else np.float64)
        columns[name] = Column(values, unit, meaning)
    minima = Table("case", prefixed("case", columns))
    crossed = [
        (k, transitions) for k, transitions in enumerate(crossings) if transitions is not None and len(transitions)
    ]
    case = np.repeat(np.array([k for k, _ in crossed], np.int64), [len(transitions) for _, transitions in crossed])
    columns = _case_columns(case, shape, names)
    for name, (unit, meaning) in _CROSSING.items():
        columns[name] = Column(np.concatenate([np.empty(0), *(getattr(c, name) for _, c in crossed)]), unit, meaning)
    modes = np.concatenate([np.empty((0, 2), np.int64), *(c.modes for _, c in crossed)])
    for k, name in enumerate(("mode_below", "mode_above")):
        columns[name] = Column(modes[:, k], "1", f"just {name[5:]}: {_MODE}")
    return {"crossings": Table("crossing", prefixed("crossing", columns)), "minima": minima}


def _row(crossings: Transitions | None, cases: Cases, effort: Effort, k: int) -> dict[str, Any]:
    if crossings is None:  # only the first samples were computed, and all of them failed
        limits = {"uplift_acceleration": cases.uplift[k], "min_pga": cases.low[k], "max_pga": cases.high[k]}
        counts = {"crossings": 0, "starts_overturned": 0, "samples": effort.samples, "failed": effort.samples}
        return dict.fromkeys(_NUMBERS, np.nan) | limits | counts
    row = {name: getattr(crossings, name) for name in (*_NUMBERS, *_COUNTS) if name != "crossings"}
    return {name: np.nan if value is None else value for name, value in row.items()} | {"crossings": len(crossings)}


def _case_columns(case: np.ndarray, shape: tuple[int, int, int], names: Mapping[str, list[str]]) -> dict[str, Column]:
    motion, restitution, body = np.unravel_index(case, shape)
    return {
        "motion": Column(text_array([names["motion"][k] for k in motion]), "1", "name of the motion"),
        "restitution": Column(text_array([names["restitution"][k] for k in restitution]), "1", "restitution"),
        "body": Column(np.asarray(body, np.int64), "1", "number of the body in the job"),
    }
