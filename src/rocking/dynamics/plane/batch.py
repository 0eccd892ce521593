"""Many histories of plane bodies without friction, given as rows, by the fast or the reference engine."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.conventions import FEET
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters, RockingSide
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

_CHUNK = 64


class RowsInPlane:
    """Motions of a study. `run` computes histories given as rows."""

    def __init__(self, motions: Sequence[Segments], law: ImpactLaw, settings: PlaneSettings, engine: str) -> None:
        self.motions, self.law, self.settings = motions, law, settings
        self.library = self._library() if fast_engine.chosen(engine, law) == "fast" else None

    def run(self, piece: Rows, threads: int) -> tuple[fast_engine.Arrays, dict[str, int]]:
        """Return the results of a piece, and numbers of steps (empty for the reference engine)."""
        if not np.isnan(piece.values["friction"]).all():
            raise InvalidValueError("rows with friction need settings with friction")
        out = fast_engine.empty_results(len(piece))
        if self.library is not None:
            step_counts: dict[str, int] = fast_engine.module().run_batch(
                self.library, {**piece.values, "motion": piece.motion, "key": piece.stream}, out,
                order=self.settings.order, threads=threads, chunk=_CHUNK,
                **fast_engine.common(self.settings, self.law),
            )  # fmt: skip
            return out, step_counts
        for k, (motion, stream) in enumerate(zip(piece.motion.tolist(), piece.stream.tolist(), strict=True)):
            row = {name: float(values[k]) for name, values in piece.values.items()}
            for name, value in self._one(row, motion, stream).items():
                out[name][k] = value
        return out, {}

    def _library(self) -> Any:
        order, linear = self.settings.order, self.settings.linear
        if order != 8 and (linear or any(motion.vertical is not None for motion in self.motions)):
            subject = "the linear equations" if linear else "motions with a vertical component"
            raise InvalidValueError(
                "{parameter} must be {allowed} for {subject}, got {value}: orders 4 and 6 apply only to nonlinear "
                "equations and motions without a vertical component", parameter="order", allowed="8", value=order,
                subject=subject,
            )  # fmt: skip
        return fast_engine.library_of(self.motions)

    def _one(self, row: dict[str, float], motion: int, stream: int) -> dict[str, float]:
        """Return the results of one history by the reference engine."""
        if not valid_row(row) or not 0 <= motion < len(self.motions):
            failed = dict.fromkeys(fast_engine.RESULTS, np.nan) | {"outcome": Outcome.FAILED.code, "side": 0}
            return failed | {"status": Status.INVALID.code, "impacts": 0, "uplifts": 0, "still_rocking": 0}
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
    """Return True if the numbers of a history are finite and within the ranges of the engines."""

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
