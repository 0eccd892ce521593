"""Many histories: arrays of bodies, motions, scales and coefficients, by the fast engine or one by one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, DrawnRestitution, ImpactLaw
from rocking.dynamics.parameters import RockingParameters, RockingSide
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.settings import Settings, check_progress, thread_count
from rocking.errors import InvalidValueError
from rocking.motions.components import Components
from rocking.outcome import Outcome, Status

PIECE = 1 << 16
"""Histories that are handed to the engine at a time: memory beside the results does not grow with their number."""

_CHUNK = 64
ROWS = (
    "alpha_right", "alpha_left", "p_right", "p_left", "r_right", "r_left", "q_right", "q_left",
    "share_right", "share_left", "scale", "rotation", "velocity", "friction", "azimuth",
)  # fmt: skip
"""Numbers that make a history, beside the number of its motion and its stream."""

SIDES_UNTOLD = {"q_right": np.nan, "q_left": np.nan, "share_right": 1.0, "share_left": 1.0}
"""What is taken where a side is not told whole: forces of the ground are not known, draws are from all of a law."""

_UNTOLD = {"scale": 1.0, "rotation": 0.0, "velocity": 0.0, "friction": np.nan, "azimuth": np.nan}


@dataclass(frozen=True)
class Rows:
    """Histories to compute, one entry each; a piece of a larger whole."""

    # the keys of `ROWS` [rad, rad/s, -, -, -, -, rad, rad/s, -]; q is m R^2 / I_o of a side, share the part of a
    # distribution that its coefficient is drawn from; the friction is that of the settings where it is NaN, and the
    # azimuth by which the motion of a body in space is turned [rad] is none
    values: dict[str, FloatArray]
    motion: np.ndarray  # number of the motion
    stream: np.ndarray  # number of the history, for random coefficients

    @classmethod
    def of(cls, count: int, motion: Any = 0, stream: Any = None, **values: Any) -> "Rows":
        """Return rows from numbers and arrays, which are repeated to the count."""
        given = _UNTOLD | SIDES_UNTOLD | values
        if set(given) != set(ROWS):
            odd = sorted(set(given) ^ set(ROWS))
            raise InvalidValueError(f"rows have {', '.join(ROWS)}; missing or unknown: {', '.join(odd)}")
        try:
            rows = {name: _repeated(given[name], count, np.float64) for name in ROWS}
            streams = np.arange(count) if stream is None else stream
            return cls(rows, _repeated(motion, count, np.int64), _repeated(streams, count, np.int64))
        except (TypeError, ValueError) as error:
            raise InvalidValueError(f"rows must be numbers, or arrays of {count}: {error}") from error

    def __len__(self) -> int:
        return int(self.motion.size)

    def part(self, first: int, last: int) -> "Rows":
        values = {name: self.values[name][first:last] for name in ROWS}
        return Rows(values, self.motion[first:last], self.stream[first:last])


@dataclass(frozen=True)
class Batch:
    """What to compute many times: the motions, the law of impact, the settings."""

    motions: Sequence[Any]  # `Segments`, all of records or all of pulses; in space `Components` too [m/s2]
    law: ImpactLaw = field(default_factory=ConstantRestitution)  # how the coefficient changes from impact to impact
    settings: Settings = field(default_factory=Settings)  # how to integrate
    threads: int | None = None  # threads of the fast engine; as many as the processor has, if not given
    engine: str = "auto"  # which engine

    def __post_init__(self) -> None:
        thread_count(self.threads)
        if any(isinstance(motion, Components) for motion in self.motions) and not hasattr(type(self.law), "on_hull"):
            raise InvalidValueError("a motion of several components is for bodies in space; a plane body takes one")

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[fast_engine.Arrays, dict[str, int]]:
        """Return arrays by the keys of `fast_engine.RESULTS`, and the steps taken (none by the reference engine)."""
        check_progress(progress)
        taken = thread_count(self.threads if threads is None else threads)
        if self.law.per_history:
            return self._constant.run(count, lambda a, b: drawn_rows(rows(a, b), self.law), progress, threads)
        rocks = self.settings.friction is None
        library = self._library if rocks and fast_engine.chosen(self.engine, self.law) == "fast" else None
        results = fast_engine.empty_results(count)
        total: dict[str, int] = {}
        for first in range(0, count, PIECE):
            piece = rows(first, min(first + PIECE, count))
            out = {name: values[first : first + len(piece)] for name, values in results.items()}
            done = self._rocking(piece, out, taken, library) if rocks else self._with_friction(piece, out, taken)
            total = {name: total.get(name, 0) + value for name, value in done.items()}
            if progress is not None:
                progress(len(piece))
        return results, total

    def _rocking(self, piece: Rows, out: fast_engine.Arrays, threads: int, library: Any) -> dict[str, int]:
        """Write the results of a piece, and return the steps taken."""
        if not np.isnan(piece.values["friction"]).all():
            raise InvalidValueError("rows with a friction are of bodies that slide: their settings need one too")
        if library is not None:
            done: dict[str, int] = fast_engine.module().run_batch(
                library, {**piece.values, "motion": piece.motion, "key": piece.stream}, out,
                order=self.settings.order, threads=threads, chunk=_CHUNK,
                **fast_engine.common(self.settings, self.law),
            )  # fmt: skip
            return done
        for k, (motion, stream) in enumerate(zip(piece.motion.tolist(), piece.stream.tolist(), strict=True)):
            row = {name: float(values[k]) for name, values in piece.values.items()}
            for name, value in self._one(row, motion, stream).items():
                out[name][k] = value
        return {}

    def _with_friction(self, piece: Rows, out: fast_engine.Arrays, threads: int) -> dict[str, int]:
        if not isinstance(self.law, ConstantRestitution):
            raise InvalidValueError(
                "with friction a history has one coefficient of restitution, or one that is drawn once for it, got "
                f"{type(self.law).__name__}"
            )
        found = self._with_contact.run(piece.values, piece.motion, threads)
        for name, values in out.items():
            values[:] = found[name]
        return {"steps": int(found["steps"].sum())}

    @cached_property
    def _with_contact(self) -> Any:
        from rocking.dynamics.contact.batch import RowsWithContact
        from rocking.dynamics.hull.batch import RowsOnHull
        from rocking.dynamics.hull.restitution import RestitutionOnHull

        if isinstance(self.law, RestitutionOnHull):
            return RowsOnHull(self.motions, self.law, self.settings, self.engine)
        return RowsWithContact(self.motions, self.settings, self.engine)

    @cached_property
    def _constant(self) -> "Batch":
        """The same with the coefficients of the rows, into which a draw for every history goes beforehand."""
        return replace(self, law=ConstantRestitution())

    @cached_property
    def _library(self) -> Any:
        order, linear = self.settings.order, self.settings.linear
        if order != 8 and (linear or any(motion.vertical is not None for motion in self.motions)):
            which = "the linear equations" if linear else "motions with a vertical part"
            raise InvalidValueError(
                f"order must be 8 for {which}, got {order}: "
                "orders 4 and 6 exist only for nonlinear equations and motions without a vertical part"
            )
        return fast_engine.library_of(self.motions)

    def _one(self, row: dict[str, float], motion: int, stream: int) -> dict[str, float]:
        """Results of one history by the reference engine."""
        if not valid_row(row) or not 0 <= motion < len(self.motions):
            bad = dict.fromkeys(fast_engine.RESULTS, np.nan) | {"outcome": Outcome.FAILED.code, "side": 0}
            return bad | {"status": Status.INVALID.code, "impacts": 0, "uplifts": 0, "still_rocking": 0}
        from rocking.dynamics.plane.reference import Reference

        right, left = (
            RockingSide(row[f"alpha_{s}"], row[f"p_{s}"], 1.0, row[f"r_{s}"], row[f"q_{s}"], row[f"share_{s}"])
            for s in ("right", "left")
        )
        reference = Reference(
            RockingParameters(right, left, self.law, ""), self.motions[motion], self.settings, scale=row["scale"],
            stream=stream, to_the_ground=False,
        )  # fmt: skip
        run = reference.run(row["rotation"], row["velocity"])
        codes = {"outcome": run.outcome.code, "status": run.status.code}
        return {name: getattr(run, name) for name in fast_engine.RESULTS} | codes


def valid_row(row: dict[str, float]) -> bool:
    """Return whether the numbers of a history are finite and within the ranges that the engines take."""

    def both(low: float, high: float, name: str) -> bool:
        return low < row[f"{name}_right"] < high and low < row[f"{name}_left"] < high

    return (
        both(0.0, 0.5 * np.pi, "alpha")
        and both(1e-9, 1e9, "p")
        and all(0.0 <= row[f"r_{foot}"] <= 100.0 for foot in FEET)
        and not any(row[f"q_{foot}"] <= 0.0 or row[f"q_{foot}"] > 1.000001 for foot in FEET)
        and all(0.0 < row[f"share_{foot}"] <= 1.0 for foot in FEET)
        and abs(row["scale"]) <= 1e9
        and abs(row["rotation"]) < 0.5 * np.pi
        and abs(row["velocity"]) < 1e9
    )


def drawn_rows(rows: Rows, law: ImpactLaw) -> Rows:
    """Return rows whose coefficients are multiplied by the draws of a law that draws once for every history."""
    draws: Any = law.draws
    drawn, cut = {}, isinstance(law, DrawnRestitution) and law.truncates
    for foot in FEET:
        where = (foot, rows.values[f"share_{foot}"]) if cut else ()
        drawn[f"r_{foot}"] = rows.values[f"r_{foot}"] * draws(rows.stream, *where)
    return replace(rows, values=rows.values | drawn)


def _repeated(values: Any, count: int, dtype: Any) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=dtype), (count,)))
