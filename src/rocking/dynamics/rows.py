"""Rows of a study: arrays of bodies, motions, scales and coefficients, computed in pieces."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, DrawnRestitution, ImpactLaw
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays, empty_results
from rocking.dynamics.settings import check_progress
from rocking.errors import InvalidValueError

PIECE = 1 << 16
"""Histories per call of the engine. With pieces, only the memory for results increases with the number of histories."""

ROWS = (
    "alpha_right", "alpha_left", "p_right", "p_left", "r_right", "r_left", "q_right", "q_left",
    "share_right", "share_left", "scale", "rotation", "velocity", "friction", "azimuth",
)  # fmt: skip
"""Columns that, together with motion and stream, define a history."""

SIDE_DEFAULTS = {"q_right": np.nan, "q_left": np.nan, "share_right": 1.0, "share_left": 1.0}
"""Default values of columns of a side: unknown ground forces, full distribution."""

_DEFAULTS = {"scale": 1.0, "rotation": 0.0, "velocity": 0.0, "friction": np.nan, "azimuth": np.nan}


@dataclass(frozen=True)
class Rows:
    """Histories to compute, one entry per history."""

    # columns of `ROWS` [rad, rad/s, -, -, -, -, rad, rad/s, -, rad]; q is m R^2 / I_o of a side; share is the fraction
    # of the distribution that is sampled; friction is that of the settings if NaN; the azimuth turns the motion of a 3D
    # body (no turn if NaN)
    values: dict[str, FloatArray]
    motion: np.ndarray  # index of the motion
    stream: np.ndarray  # number of the history, for random coefficients

    @classmethod
    def of(cls, count: int, motion: Any = 0, stream: Any = None, **values: Any) -> "Rows":
        """Return rows from numbers and arrays. Single values are repeated."""
        columns = _DEFAULTS | SIDE_DEFAULTS | values
        if set(columns) != set(ROWS):
            unexpected = sorted(set(columns) ^ set(ROWS))
            raise InvalidValueError(
                "rows have {names}; missing or unknown: {others}", names=", ".join(ROWS), others=", ".join(unexpected)
            )
        try:
            rows = {name: _repeated(columns[name], count, np.float64) for name in ROWS}
            streams = np.arange(count) if stream is None else stream
            return cls(rows, _repeated(motion, count, np.int64), _repeated(streams, count, np.int64))
        except (TypeError, ValueError) as error:
            raise InvalidValueError(
                "rows must be numbers, or arrays of {count}: {reason}", count=count, reason=str(error)
            ) from error

    def __len__(self) -> int:
        return int(self.motion.size)

    def part(self, first: int, last: int) -> "Rows":
        values = {name: self.values[name][first:last] for name in ROWS}
        return Rows(values, self.motion[first:last], self.stream[first:last])


class RowRunner(Protocol):
    """Motions in the form of an engine. `run` computes histories given as rows."""

    def run(self, piece: Rows, threads: int) -> tuple[Arrays, dict[str, int]]:
        """Return columns of results (those of `study_columns` that the mechanics has), and numbers of steps."""


def run_rows(
    runner: RowRunner,
    law: ImpactLaw,
    count: int,
    rows: Callable[[int, int], Rows],
    threads: int,
    progress: Callable[[int], None] | None = None,
    *,
    columns: Mapping[str, Any] = RESULTS,
) -> tuple[Arrays, dict[str, int]]:
    """Return the results of rows, computed in pieces, and numbers of steps. `law` gives random coefficients."""
    check_progress(progress)
    results, total = empty_results(count, columns), dict[str, int]()
    for first in range(0, count, PIECE):
        piece = rows(first, min(first + PIECE, count))
        done, work = runner.run(drawn_rows(piece, law) if law.per_history else piece, threads)
        for name in results.keys() & done.keys():
            results[name][first : first + len(piece)] = done[name]
        total = {name: total.get(name, 0) + value for name, value in work.items()}
        if progress is not None:
            progress(len(piece))
    return results, total


def law_of_rows(law: ImpactLaw) -> ImpactLaw:
    """Return the law for the engine. The law is constant if the rows already contain the random coefficients."""
    return ConstantRestitution() if law.per_history else law


def drawn_rows(rows: Rows, law: ImpactLaw) -> Rows:
    """Return rows with coefficients multiplied by the random factors of a law with one factor per history."""
    draws: Any = law.draws
    coefficients, cut = {}, isinstance(law, DrawnRestitution) and law.truncates
    for foot in FEET:
        options = (foot, rows.values[f"share_{foot}"]) if cut else ()
        coefficients[f"r_{foot}"] = rows.values[f"r_{foot}"] * draws(rows.stream, *options)
    return replace(rows, values=rows.values | coefficients)


def _repeated(values: Any, count: int, dtype: Any) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=dtype), (count,)))
