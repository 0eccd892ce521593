"""Many histories as rows. The settings determine the mechanics."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.mechanics_base import Mechanics
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import RowRunner, Rows, law_of_rows, run_rows
from rocking.dynamics.settings import Settings, thread_count


@dataclass(frozen=True)
class Batch:
    """Motions, law of impact and settings of many histories."""

    motions: Sequence[Any]  # `Segments`, either all of records or all of pulses; for 3D bodies also `Components` [m/s2]
    law: ImpactLaw = field(default_factory=ConstantRestitution)  # law of the coefficient of restitution
    settings: Settings = field(default_factory=PlaneSettings)  # settings of the integration
    threads: int | None = None  # threads of the fast engine; default: number of processors
    engine: str = "auto"  # "auto", "fast" or "reference"

    def __post_init__(self) -> None:
        thread_count(self.threads)
        self._mechanics.check_motions(self.motions)

    def run(
        self,
        count: int,
        rows: Callable[[int, int], Rows],
        progress: Callable[[int], None] | None = None,
        threads: int | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return arrays by the keys of `study_columns`, and numbers of steps (empty for the reference engine)."""
        worker_count = thread_count(self.threads if threads is None else threads)
        columns = self._mechanics.study_columns
        return run_rows(self._runner, self.law, count, rows, worker_count, progress, columns=columns)

    @property
    def _mechanics(self) -> Mechanics:
        return mechanics_of(self.settings)

    @cached_property
    def _runner(self) -> RowRunner:
        return self._mechanics.rows(self.motions, law_of_rows(self.law), self.settings, self.engine)
