"""Small jobs of every kind, and the folders of their campaigns."""

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from campaign_jobs import BODIES, BODY, PULSE, PULSES, SYNTHETIC, TWO_MODELS, axes, job

from rocking.campaigns.jobs import Job, JobFolder

SPECTRUM = """[spectrum]
slenderness_angles = [0.15, 0.3]
periods = { from = 1.5, to = 9, count = 6, spacing = "log" }
"""
STRIPES = """[fragility]
im = "pga"
levels = { from = 2, to = 10, count = 5 }
limit_states = [0.3]
"""
INCREMENTAL = "[restitution]\nvalue = 0.9\n[fragility]\nlevels = [2.0, 4.0, 6.0, 9.0]\nlimit_states = []\n"
JOBS = {
    "overturning-map": BODY + PULSE + axes(),
    "rocking-spectrum": PULSES.replace("amplitude=1", "amplitude=4") + SPECTRUM,
    "stripes": BODY + SYNTHETIC + STRIPES,
    "incremental": BODY + PULSES + INCREMENTAL,
    "cloud": BODY + SYNTHETIC + '[fragility]\nim = "pgv"\nscale = 2.0\n',
    "histories": BODIES + PULSES + TWO_MODELS + "[histories]\nscales = [2.5, 5.0, 8.0, 11.0]\n",
}


def text_of(kind: str, chunk: int | None = None) -> str:
    """Text of a small job."""
    return job(kind, JOBS[kind], name=f"a small {kind}", chunk=chunk)


@pytest.fixture
def text() -> Callable[..., str]:
    """Text of a small job of a kind, with a size of chunks."""
    return text_of


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., JobFolder]:
    """Campaign of a small job that is through; computed once, not to be changed."""

    @cache
    def make(kind: str, chunk: int | None = None, words: str | None = None) -> JobFolder:
        folder = JobFolder.create(tmp_path_factory.mktemp(kind) / "c", Job.of_text(words or text_of(kind, chunk)))
        folder.campaign.run(workers=1)
        return folder

    return make


@pytest.fixture
def records(tmp_path: Path) -> Path:
    """Folder with two records of columns, as a job names them."""
    for name, period in (("one", 0.5), ("two", 0.8)):
        lines = [f"{0.01 * k:.2f} {4.0 * math.sin(2 * math.pi * 0.01 * k / period):.6f}" for k in range(101)]
        (tmp_path / f"{name}.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return tmp_path
