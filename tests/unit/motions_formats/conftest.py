"""A made-up record for round trips."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rocking.motions.formats import Component, Record


@pytest.fixture(scope="session")
def made_up() -> Callable[..., Record]:
    """Make records of decaying sines: names of the components, their unit, step and largest amplitude."""

    def make(*names: str, unit: str = "m/s2", step: float = 0.02, scale: float = 1.0, samples: int = 61) -> Record:
        time = np.arange(samples) * step
        rows = [scale * np.sin((7.0 + 2.0 * k) * time) * np.exp(-time) for k in range(len(names))]
        parts = tuple(Component(name, row, unit, step) for name, row in zip(names, rows, strict=True))
        return Record("made up", parts, metadata={"event": "Somewhere", "station": "Cellar"})

    return make


@pytest.fixture(scope="session")
def case_records() -> Path:
    """Folder with small synthetic inputs that were once misread; its tests are skipped where it is absent."""
    folder = Path(__file__).parents[4] / "shared" / "data" / "cases" / "records"
    if not folder.is_dir():
        pytest.skip("shared cases of records are absent")
    return folder
