"""What a study asks beside its axes: one body, one motion, its restitution and the settings, ready to be run."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking import quantities
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.batch import Batch, Rows
from rocking.dynamics.plane.fast_engine import Arrays, instruction_set
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.outcome import Outcome, flags
from rocking.studies.histories import part
from rocking.version import SOFTWARE

UNLIFTED, SURVIVED, FAILED = -2, -1, -3
"""Modes beside the number of impacts before overturning: never lifted; rocked and stayed standing; no result."""


@dataclass(frozen=True)
class Question:
    """One body under one motion, to be varied."""

    body: Body
    motion: Motion
    restitution: Any = "ked"  # as for `simulate`
    settings: Settings = field(default_factory=Settings)  # how to integrate
    threads: int | None = None  # threads of the fast engine; the results do not depend on them
    engine: str = "auto"  # which engine

    def __post_init__(self) -> None:
        if not isinstance(self.motion, (GroundMotion, Pulse)):
            raise InvalidValueError(f"motion must be a GroundMotion or a pulse, got {self.motion!r:.60}")
        _ = self.parameters

    @cached_property
    def parameters(self) -> RockingParameters:
        """The body as it is, before any axis changes it."""
        return self.parameters_of(self.body)

    @property
    def law(self) -> ImpactLaw:
        """How the coefficient changes from impact to impact."""
        return self.parameters.law

    @cached_property
    def batch(self) -> Batch:
        """The motion as the engine lays it out."""
        return Batch([self.motion.segments()], self.law, self.settings, self.threads, self.engine)

    def parameters_of(self, body: Body) -> RockingParameters:
        """Return another body with the same restitution, evaluated for it."""
        return RockingParameters.of_body(body, self.restitution, self.settings.gravity)

    def run(
        self,
        values: dict[str, FloatArray],
        stretch: FloatArray,
        stream: Any = None,
        progress: Callable[[int], None] | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results of many variations, their modes and relative peaks [-] with them.

        A motion stretched in time by s does to a body of frequency parameter p what the motion itself does to one of p
        s, all times multiplied by s: so one motion serves all stretches, and nothing is approximated. Values: sides and
        scale, by the names of `batch.ROWS`, one entry a history.
        """
        count = stretch.size
        if np.any(stretch != 1.0):
            self.check_stretching("an axis")
        quick = {n: v * stretch if n in {"p_right", "p_left"} else v for n, v in values.items()}  # Eq. 179
        rows = Rows.of(count, 0, stream, **quick)
        results, work = self.batch.run(count, lambda a, b: part(rows, a, b), progress)
        for name in quantities.TIMES:
            results[name] = results[name] * stretch
        results["peak_velocity"] = results["peak_velocity"] / stretch
        results |= {"mode": modes_of(results), **flags(results)}
        results["peak_ratio"] = peak_ratio(results["peak_rotation"], values["alpha_right"], values["alpha_left"])
        return results, work

    def check_stretching(self, name: str) -> None:
        """Refuse to stretch time where the restitution would notice."""
        if self.law.kind in {1, -1}:
            raise InvalidValueError(
                f"{name} stretches the time of the motion, which needs a restitution that does not depend on the speed "
                f"in rad/s, got {type(self.law).__name__}; vary scale and size instead"
            )

    def attributes(self, work: dict[str, int]) -> dict[str, Any]:
        """Return what was computed from what and how, as plain values."""
        motion = self.motion
        return {
            "software": SOFTWARE,
            "engine": f"fast ({instruction_set()})" if work else "reference",
            "body": repr(self.body),
            "motion": motion.name,
            "motion_provenance": "; ".join(getattr(motion, "provenance", ())) or repr(motion),
            "restitution": self.parameters.label,
            "seed": int(getattr(self.law, "seed", 0)),
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in self.settings.stated.items()},
            **{f"work_{k}": v for k, v in work.items()},
        }


def modes_of(results: Arrays) -> np.ndarray:
    """Return -3 failed, -2 not lifted, -1 rocked and stayed standing, n >= 0 overturned after n impacts.

    >>> modes_of({"outcome": np.array([0, 1, 2, 3]), "impacts": np.array([0, 3, 1, 0])}).tolist()
    [-2, -1, 1, -3]
    """
    outcome = np.asarray(results["outcome"])
    modes = {Outcome.OVERTURNED: results["impacts"], Outcome.NO_UPLIFT: UNLIFTED, Outcome.FAILED: FAILED}
    chosen = np.select([outcome == each.code for each in modes], list(modes.values()), SURVIVED)
    return np.asarray(chosen, dtype=np.int64)


def peak_ratio(peak: FloatArray, right: FloatArray, left: FloatArray) -> FloatArray:
    """Return the peak rotation over the slenderness angle of its side; beyond one is not overturning [-]."""
    return np.abs(peak) / np.where(np.asarray(peak) < 0.0, left, right)  # Eq. 181
