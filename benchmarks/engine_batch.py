"""The batch on which engines are timed: 10,000 blocks, each under a record of its own, of 8 to 40 s."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rocking.conventions import g
from rocking.dynamics.batch import Batch
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays, common, library_of, module
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rows import Rows
from rocking.motions import Segments

COUNT = 10_000
STEP = 0.01
CHUNK = 256


@dataclass(frozen=True, eq=False)
class Histories:
    """Records [m/s2] at steps of 0.01 s, and a block for each: alpha, p [rad/s], r (Housner's), R [m], factor."""

    records: list[np.ndarray]
    alpha: np.ndarray
    p: np.ndarray
    r: np.ndarray
    size: np.ndarray
    scale: np.ndarray

    def __len__(self) -> int:
        return len(self.records)

    @property
    def megabytes(self) -> float:
        """Size of the records."""
        return sum(record.nbytes for record in self.records) / 1e6

    def some(self, which: Any) -> "Histories":
        """Some of them."""
        numbers = np.arange(len(self))[which]
        arrays = (self.alpha[numbers], self.p[numbers], self.r[numbers], self.size[numbers], self.scale[numbers])
        return Histories([self.records[k] for k in numbers], *arrays)

    def rescaled(self, factor: float) -> "Histories":
        """The same with all records multiplied."""
        return replace(self, scale=self.scale * factor)

    def segments(self) -> list[Segments]:
        """The records as engines take them."""
        return [Segments.between_samples(STEP, record) for record in self.records]

    def rows(self, motion: np.ndarray | None = None) -> Rows:
        """The blocks as engines take them."""
        values = {f"{name}_{side}": getattr(self, name) for name in ("alpha", "p", "r") for side in ("right", "left")}
        values |= {"q_right": 0.75, "q_left": 0.75}  # rectangles
        return Rows.of(len(self), np.arange(len(self)) if motion is None else motion, scale=self.scale, **values)


def histories(count: int = COUNT, seed: int = 2024, highest: float = 8.0) -> Histories:
    """Blocks of R 0.2 to 10 m and slenderness 2 to 10; scaled so that about a third each rests, rocks, overturns.

    Records with frequencies above `highest` [Hz] make blocks chatter, with an impact every few samples.
    """
    rng = np.random.default_rng(seed)
    records = [record(rng, highest) for _ in range(count)]
    size = 10.0 ** rng.uniform(np.log10(0.2), 1.0, count)
    slenderness = rng.uniform(2.0, 10.0, count)
    alpha = np.arctan(1.0 / slenderness)
    # what a block needs to overturn grows with its size against the period of the shaking
    severity = np.exp(rng.normal(0.05, 0.75, count)) * (0.9 + 0.35 * size**0.6)
    peaks = np.array([np.abs(values).max() for values in records])
    scale = severity * g * np.tan(alpha) / peaks
    return Histories(records, alpha, np.sqrt(0.75 * g / size), 1.0 - 1.5 * np.sin(alpha) ** 2, size, scale)


def record(rng: np.random.Generator, highest: float) -> np.ndarray:
    """White noise through a soil layer (Kanai-Tajimi), a high-pass and a low-pass, under an envelope; peak 1 m/s2."""
    from scipy.signal import bilinear, lfilter

    duration = rng.uniform(8.0, 40.0)
    time = np.arange(0.0, duration, STEP)
    soil, low, high = 2.0 * np.pi * rng.uniform(0.6, 3.0), 2.0 * np.pi * 0.15, 2.0 * np.pi * highest
    noise = rng.standard_normal(time.size)
    for top, bottom in (
        ([1.2 * soil, soil**2], [1.0, 1.2 * soil, soil**2]),
        ([1.0, 0.0, 0.0], [1.0, 1.4 * low, low**2]),
        ([high**2], [1.0, 1.4 * high, high**2]),
    ):
        noise = lfilter(*bilinear(top, bottom, 1.0 / STEP), noise)
    rise, fall = 0.15 * duration, 0.5 * duration
    envelope = np.minimum(time / rise, 1.0) ** 2 * np.exp(-np.maximum(time - fall, 0.0) * 5.0 / duration)
    shaken = envelope * noise
    shaken[-1] = 0.0
    return np.ascontiguousarray(shaken / np.abs(shaken).max())


class Fast:
    """The fast engine on a batch: a call of the engine, with new result arrays each time."""

    def __init__(self, batch: Histories, threads: int = 1, **options: Any) -> None:
        self.library = library_of(batch.segments())
        self.rows = batch.rows()
        self.count, self.threads, self.settings = len(batch), threads, PlaneSettings(**options)

    def __call__(self) -> tuple[Arrays, dict[str, int]]:
        """Results and work."""
        out: Arrays = {name: np.empty(self.count, dtype) for name, dtype in RESULTS.items()}
        columns = {**self.rows.values, "motion": self.rows.motion, "key": self.rows.stream}
        work = module().run_batch(
            self.library, columns, out, order=self.settings.order, threads=self.threads, chunk=CHUNK,
            **common(self.settings, ConstantRestitution()),
        )  # fmt: skip
        return out, dict(work)


def reference(batch: Histories) -> Arrays:
    """Results of the reference engine."""
    return Batch(batch.segments(), engine="reference").run(len(batch), lambda *_: batch.rows())[0]


def overturned(results: Arrays) -> np.ndarray:
    """Which ones overturn."""
    return np.asarray(results["outcome"] == 2)
