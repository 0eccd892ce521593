"""Many histories as rows, by the mechanics of their settings."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import RowRunner, Rows, law_of_rows, run_rows
from rocking.dynamics.settings import Settings, thread_count


@dataclass(frozen=True)
class Batch:
    """What to compute many times: the motions, the law of impact, the settings."""

    motions: Sequence[Any]  # `Segments`, all of records or all of pulses; in space `Components` too [m/s2]
    law: ImpactLaw = field(default_factory=ConstantRestitution)  # how the coefficient changes from impact to impact
    settings: Settings = field(default_factory=PlaneSettings)  # how to integrate
    threads: int | None = None  # threads of the fast engine; as many as the processor has, if not given
    engine: str = "auto"  # which engine

    def __post_init__(self) -> None:
        thread_count(self.threads)
        mechanics_of(self.settings).check_laid_out(self.motions)

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return arrays by the keys of `fast_engine.RESULTS`, and the steps taken (none by the reference engine)."""
        taken = thread_count(self.threads if threads is None else threads)
        return run_rows(self._runner, self.law, count, rows, taken, progress)

    @cached_property
    def _runner(self) -> RowRunner:
        return mechanics_of(self.settings).rows(self.motions, law_of_rows(self.law), self.settings, self.engine)
