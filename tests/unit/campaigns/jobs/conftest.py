"""Small jobs of every kind, and the folders of their campaigns."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from rocking.campaigns.jobs import Job, JobFolder

BLOCK = '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n'
PULSE = '[motions]\npulse = "sine:amplitude=3,period=0.6"\n'
PULSES = """[motions]
pulse = ["sine:amplitude=1,period=0.5", "sine:amplitude=1,period=0.7", "ricker:amplitude=1,period=0.9"]
"""
FEW = '[motions]\nsynthetic = "pulse-like"\ncount = 12\nseed = 4\n'
MAP = """[map]
x = { axis = "frequency_ratio", from = 1, to = 7, count = 9 }
y = { axis = "amplitude_ratio", from = 1, to = 9, count = 7 }
"""
SPECTRUM = """[spectrum]
slenderness_angles = [0.15, 0.3]
periods = { from = 1.5, to = 9, count = 6, spacing = "log" }
"""
STRIPES = """[fragility]
measure = "pga"
levels = { from = 2, to = 10, count = 5 }
states = [0.3]
"""
INCREMENTAL = """[restitution]
value = 0.9
[fragility]
levels = [2.0, 4.0, 6.0, 9.0]
states = []
"""
CLOUD = '[fragility]\nmeasure = "pgv"\nfactor = 2.0\n'
BODIES = """[[body]]
units = "cm"
width = 50
height = 200
[[body]]
units = "m"
width = 0.3
height = 1.0
"""
SCALES = """[restitution]
models = ["housner", "ked"]
[histories]
scales = [2.5, 5.0, 8.0, 11.0]
"""
JOBS = {
    "overturning-map": BLOCK + PULSE + MAP,
    "rocking-spectrum": PULSES.replace("amplitude=1", "amplitude=4") + SPECTRUM,
    "stripes": BLOCK + FEW + STRIPES,
    "incremental": BLOCK + PULSES + INCREMENTAL,
    "cloud": BLOCK + FEW + CLOUD,
    "histories": BODIES + PULSES + SCALES,
}


def text_of(kind: str, chunk: int | None = None) -> str:
    """Text of a small job."""
    cut = "" if chunk is None else f"chunk = {chunk}\n"
    return f'[campaign]\nname = "a small {kind}"\nkind = "{kind}"\n{cut}{JOBS[kind]}'


@pytest.fixture
def text() -> Callable[..., str]:
    """Text of a small job of a kind, with a size of chunks."""
    return text_of


@pytest.fixture
def finished(tmp_path: Path) -> Callable[..., JobFolder]:
    """Campaign of a small job that is through."""

    def make(kind: str, chunk: int | None = None, words: str | None = None) -> JobFolder:
        folder = JobFolder.create(tmp_path / f"{kind}-{chunk}", Job.of_text(words or text_of(kind, chunk)))
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
