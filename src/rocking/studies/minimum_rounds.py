"""Minimum overturning accelerations in rounds: every motion with every restitution and body, searched together."""

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

# histories of later rounds over those of the first, by what the motions are
_LATER = {"pulses": (2.0, 10.0), "records": (10.0, 100.0)}
_MODE = "not lifted -2, survived -1, n >= 0 overturned after n impacts"

_NUMBERS: dict[str, tuple[str, str]] = {
    "minimum": ("m/s2", "least peak acceleration that overturns, of those sampled; NaN if none, or the lowest does"),
    "certain": ("m/s2", "peak acceleration above which all that were sampled overturn; NaN if the highest survives"),
    "uplift_acceleration": ("m/s2", "ground acceleration that lifts the body"),
    "min_pga": ("m/s2", "smallest PGA that is computed"),
    "max_pga": ("m/s2", "largest PGA that is computed"),
    "resolution": ("1", "relative spacing of the first samples"),
    "resolution_below": ("1", "widest relative gap between samples below the minimum; NaN if there is none"),
}
_COUNTS = {
    "crossings": "changes of verdict that were found",
    "starts_overturned": "1 if the lowest acceleration overturns already",
    "samples": "histories of the scan",
    "failed": "histories without a result; if all failed, nothing is known",
}
_CROSSING = {
    "acceleration": ("m/s2", "peak ground acceleration at which the verdict changes"),
    "ratio": ("1", "the same over the acceleration that lifts the body"),
    "scale": ("1", "the same as factor on the motion"),
    "width": ("m/s2", "width of the bracket"),
}


@dataclass(frozen=True)
class MinimumSearch:
    """A search for crossings that somebody else computes, round by round."""

    cases: Cases  # every motion with every restitution and body; the body changes fastest
    effort: Effort  # how closely to look
    motions: MotionList
    shape: tuple[int, int, int]  # numbers of motions, restitutions and bodies
    law: ImpactLaw  # how the coefficient changes from impact to impact
    options: dict[str, Any]  # settings and engine, as `Histories` takes them
    names: dict[str, list[str]]  # what the motions and the restitutions are called
    kept: float = field(default=1.0, init=False)

    def __call__(self, compute: Compute) -> AdaptiveResult:
        """Return a tuple of `Transitions`, None where no history could be computed, and tables of them."""
        motion, _, body = np.unravel_index(np.arange(self.cases.uplift.size), self.shape)

        def run(values: dict[str, FloatArray], case: IntArray) -> Arrays:
            if case.size:
                # the draws of a body are the same at every amplitude, and those of a call with this motion alone
                options: dict[str, Any] = {"law": self.law, **self.options}
                results = compute(sampled(NumberedTable(self.motions, motion[case], values, body[case], **options)))
            else:
                results = empty_results(0)
            ratio = peak_ratio(results["peak_rotation"], values["alpha_right"], values["alpha_left"])
            return {**results, "mode": modes_of(results), "peak_ratio": ratio}

        crossings = searched(self.cases, self.effort, run)
        return AdaptiveResult(crossings, tables_of(crossings, self.cases, self.effort, self.shape, self.names))

    def later(self, first: int) -> tuple[int, int]:
        """Return how many histories later rounds usually have."""
        low, high = _LATER["pulses" if type(self.motions[0]) is Pulse else "records"]
        return int(low * first), int(high * first)


def tables_of(
    crossings: Sequence[Transitions | None], cases: Cases, effort: Effort, shape: tuple[int, int, int],
    names: Mapping[str, list[str]],
) -> dict[str, Table]:  # fmt: skip
    """Return ``minima``, a table with a row for each case, and ``crossings``, with a row for each crossing."""
    rows = [_row(each, cases, effort, k) for k, each in enumerate(crossings)]
    columns = _places(np.arange(len(crossings)), shape, names)
    described = _NUMBERS | {name: ("1", meaning) for name, meaning in _COUNTS.items()}
    for name, (unit, meaning) in described.items():
        values = np.array([row[name] for row in rows], np.int64 if name in _COUNTS else np.float64)
        columns[name] = Column(values, unit, meaning)
    minima = Table("case", prefixed("case", columns))
    known = [(k, each) for k, each in enumerate(crossings) if each is not None and len(each)]
    case = np.repeat(np.array([k for k, _ in known], np.int64), [len(each) for _, each in known])
    columns = _places(case, shape, names)
    for name, (unit, meaning) in _CROSSING.items():
        columns[name] = Column(np.concatenate([np.empty(0), *(getattr(c, name) for _, c in known)]), unit, meaning)
    modes = np.concatenate([np.empty((0, 2), np.int64), *(c.modes for _, c in known)])
    for place, name in enumerate(("mode_below", "mode_above")):
        columns[name] = Column(modes[:, place], "1", f"just {name[5:]}: {_MODE}")
    return {"crossings": Table("crossing", prefixed("crossing", columns)), "minima": minima}


def _row(crossings: Transitions | None, cases: Cases, effort: Effort, k: int) -> dict[str, Any]:
    if crossings is None:  # nothing but the first samples was tried, and all of them failed
        limits = {"uplift_acceleration": cases.uplift[k], "min_pga": cases.low[k], "max_pga": cases.high[k]}
        counts = {"crossings": 0, "starts_overturned": 0, "samples": effort.samples, "failed": effort.samples}
        return dict.fromkeys(_NUMBERS, np.nan) | limits | counts
    row = {name: getattr(crossings, name) for name in (*_NUMBERS, *_COUNTS) if name != "crossings"}
    return {name: np.nan if value is None else value for name, value in row.items()} | {"crossings": len(crossings)}


def _places(case: np.ndarray, shape: tuple[int, int, int], names: Mapping[str, list[str]]) -> dict[str, Column]:
    motion, restitution, body = np.unravel_index(case, shape)
    return {
        "motion": Column(text_array([names["motion"][k] for k in motion]), "1", "name of the motion"),
        "restitution": Column(text_array([names["restitution"][k] for k in restitution]), "1", "restitution"),
        "body": Column(np.asarray(body, np.int64), "1", "number of the body in the job"),
    }
