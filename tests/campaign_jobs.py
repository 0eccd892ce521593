"""Texts of small jobs, and their campaigns: ``from campaign_jobs import BODY, PULSE, axes, finished, job``."""

from pathlib import Path
from typing import Any

from rocking.campaigns import ledger
from rocking.campaigns.identity import Identity
from rocking.campaigns.jobs import Job, JobFolder

BODY = '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n'
BODIES = """[[body]]
units = "cm"
width = 50
height = 200
[[body]]
units = "m"
width = 0.3
height = 1.0
"""
TWO_BODIES = BODIES.replace('"cm"\nwidth = 50\nheight = 200', '"m"\nwidth = 0.5\nheight = 2.0').replace("1.0", "1.5")
PULSE = '[motions]\npulse = "sine:amplitude=3,period=0.6"\n'
PULSES = """[motions]
pulse = ["sine:amplitude=1,period=0.5", "sine:amplitude=1,period=0.7", "ricker:amplitude=1,period=0.9"]
"""
SYNTHETIC = '[motions]\nsynthetic = "pulse-like"\ncount = 12\nseed = 4\n'
TWO_MODELS = '[restitution]\nmodels = ["housner", "ked"]\n'


def axes(x: tuple[float, float, int] = (1, 7, 9), y: tuple[float, float, int] = (1, 9, 7)) -> str:
    """Table of a map: from, to and count of the frequency and the amplitude ratio."""
    ends = [f"from = {low}, to = {high}, count = {count}" for low, high, count in (x, y)]
    return f'[map]\nx = {{ axis = "frequency_ratio", {ends[0]} }}\ny = {{ axis = "amplitude_ratio", {ends[1]} }}\n'


def map_tables(
    count: int, name: str = "a small map", x: tuple[float, float] = (1, 6), y: tuple[float, float] = (1, 8), **more: Any
) -> dict[str, Any]:
    """Tables of a square map of a block under a pulse with two models, some of them replaced, as a page sends them."""
    ends = {"frequency_ratio": x, "amplitude_ratio": y}
    lines = [{"axis": axis, "from": low, "to": high, "count": count} for axis, (low, high) in ends.items()]
    return {
        "campaign": {"name": name, "kind": "overturning-map"},
        "body": {"units": "m", "width": 0.5, "height": 2.0},
        "motions": {"pulse": "sine:amplitude=3,period=0.6"},
        "restitution": {"models": ["ked", "housner"]},
        "map": dict(zip("xy", lines, strict=True)),
    } | more


def search(samples: int, tolerance: float) -> str:
    """Tables of minimum accelerations of two bodies under two motions with two restitutions."""
    motions = '[motions]\nsynthetic = "pulse-like"\ncount = 2\nseed = 3\n'
    how = f"max_pga = 25.0\nsamples = {samples}\nbisections = 1\ntolerance = {tolerance}\n"
    return f"{TWO_BODIES}{motions}[restitution]\nvalues = [0.85, 0.93]\n[minimum]\n{how}"


def job(kind: str, *tables: str, name: str = "a job", **campaign: Any) -> str:
    """Text of a job of some tables; chunk and seed where they are given."""
    more = "".join(f"{key} = {value}\n" for key, value in campaign.items() if value is not None)
    return f'[campaign]\nname = "{name}"\nkind = "{kind}"\n{more}' + "".join(tables)


def finished(path: Path, text: str, **how: Any) -> JobFolder:
    """A campaign that is through, by one thread unless said otherwise."""
    folder = JobFolder.create(path, Job.of_text(text))
    folder.run(**({"workers": 1} | how))
    return folder


def digests(folder: JobFolder) -> dict[str, tuple[str, str]]:
    """Keys and hashes of the results of all rounds."""
    plans = {path: Identity.read(path).plan for path in sorted(folder.path.glob("round-*"))}
    return {path.name: (plan.key, ledger.digest(ledger.pieces(path, plan))) for path, plan in plans.items()}


def flip(path: Path, bit: int) -> None:
    """Change a bit of a file; a negative number counts from its end."""
    data = bytearray(path.read_bytes())
    data[bit // 8] ^= 1 << bit % 8
    path.write_bytes(data)
