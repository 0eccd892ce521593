"""Random bodies, motions, histories and observations for tests: ``from random_cases import sections, smooth_noise``.

Bodies are asymmetric, since symmetric ones hide which side is meant; ``symmetric=True`` asks for the others.

Strategies of hypothesis, which shrink what fails:

- `polygons`: the ring of a star-shaped polygon with a base on y = 0, its centre above the base;
- `sections`: such a `rocking.Section` on feet inside its base, at unequal distances from the centre;
- `blocks`: a `rocking.Block` on unequal feet;
- `accelerations`: lists of accelerations [m/s2], zeros, runs and jumps among them.

From a seed or a `numpy.random.Generator`, the same at every call with the same seed:

- `section`, `block`, `solid`: one body of each kind, for loops over many;
- `rows`: the values of both sides of many bodies, as batches and history tables take them;
- `smooth_noise`: samples of a given peak; `noise_motion`: a `rocking.GroundMotion` of them, with a vertical one if
  wanted; `components`: three motions of 40 sines each, x, y and z;
- `record`: what a file of records holds, for writers of formats;
- `lognormal_failures`: failures of `trials` at levels, of a lognormal fragility curve.
"""

from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from scipy.special import ndtr

import rocking as rk
from rocking.dynamics.rolling import SpatialBody
from rocking.motions.formats import Component, Record

Random = int | list[int] | np.random.Generator


def _centre(ring: Any) -> float:
    x, y = np.asarray(ring).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    return float((cross * (x + np.roll(x, -1))).sum() / (3.0 * cross.sum()))


@st.composite
def polygons(draw: Any, most: int = 6, margin: float = 0.05) -> list[tuple[float, float]]:
    """A base from -a to c and one to `most` other vertices above it; the centre at least `margin` inside the base."""
    count = draw(st.integers(1, most))
    angles = [(i + draw(st.floats(0.1, 0.9))) * np.pi / count for i in range(count)]
    radii = [draw(st.floats(0.3, 3.0)) for _ in range(count)]
    left, right = -draw(st.floats(0.5, 2.0)), draw(st.floats(0.5, 2.0))
    above = [(float(r * np.cos(t)), float(r * np.sin(t))) for r, t in zip(radii, angles, strict=True)]
    ring = [(left, 0.0), (right, 0.0), *above]
    assume(left + margin < _centre(ring) < right - margin)
    return ring


@st.composite
def sections(draw: Any, most: int = 5, margin: float = 0.1) -> rk.Section:
    """A polygon of one of two densities on feet at 0.3 to 1 of the ways from below its centre to its corners."""
    ring = draw(polygons(most, margin))
    centre, (left, _), (right, _) = _centre(ring), *ring[:2]
    feet = tuple(centre + draw(st.floats(0.3, 1.0)) * (end - centre) for end in (left, right))
    return rk.Section.from_points(ring, draw(st.sampled_from([1.0, 2400.0])), feet=feet)


@st.composite
def blocks(draw: Any, symmetric: bool = False) -> rk.Block:
    """A block of 0.1 to 10 m and h/b of 1.5 to 10, its feet up to 0.4 of its width inside its corners."""
    height, ratio = draw(st.floats(0.1, 10.0)), draw(st.floats(1.5, 10.0))
    block = rk.Block(width=height / ratio, height=height)
    inside = st.just(0.0) if symmetric else st.floats(0.0, 0.4)
    return block.with_feet(draw(inside) * block.width, (1.0 - draw(inside)) * block.width)


def accelerations(least: int = 2, most: int = 30, peak: float = 9.0) -> st.SearchStrategy[list[float]]:
    """Accelerations of up to `peak` [m/s2]."""
    return st.lists(st.floats(-peak, peak), min_size=least, max_size=most)


def section(random: Random) -> rk.Section:
    """A leaning quadrilateral of 0.3 to 0.9 m by 1.2 to 3 m; the top stands anywhere above the base."""
    random = np.random.default_rng(random)
    width, height = random.uniform(0.3, 0.9), random.uniform(1.2, 3.0)
    left, right = np.sort(random.uniform(0.0, width, 2)).tolist()
    return rk.Section([rk.Region([(0.0, 0.0), (width, 0.0), (right, height), (left, height)], 2400.0)])


def block(random: Random, symmetric: bool = False) -> rk.Block:
    """A block of 0.1 to 10 m (equally likely in the logarithm) and h/b of 1.5 to 10 on unequal feet."""
    random = np.random.default_rng(random)
    height = np.exp(random.uniform(np.log(0.1), np.log(10.0)))
    made = rk.Block(width=height / random.uniform(1.5, 10.0), height=height)
    if symmetric:
        return made
    return made.with_feet(random.uniform(0.0, 0.4) * made.width, random.uniform(0.6, 1.0) * made.width)


def solid(random: Random) -> SpatialBody:
    """An off-centre, inhomogeneous body over a convex base of 3 to 8 vertices on a circle; no axis is a symmetry."""
    random = np.random.default_rng(random)
    count = int(random.integers(3, 9))
    angle = np.sort((np.arange(count) + random.uniform(-0.3, 0.3, count)) * 2.0 * np.pi / count)
    radius, height = random.uniform(0.2, 0.7), random.uniform(0.8, 2.5)
    base = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    centre = np.array([*(base.mean(axis=0) + 0.02 * radius * random.uniform(-1.0, 1.0, 2)), height])
    arms = random.normal(size=(30, 3)) * np.array([radius, 0.8 * radius, 0.6 * height])
    arms -= arms.mean(axis=0)
    inertia = 50.0 * (np.square(arms).sum() * np.eye(3) - arms.T @ arms)
    return SpatialBody(1500.0, centre, inertia, base)


RANGES = {"alpha": (0.08, 0.6), "p": (0.8, 6.0), "r": (0.0, 1.0)}
"""What `rows` draws: slenderness angles [rad], frequency parameters [rad/s] and coefficients of restitution [-]."""


def rows(count: int, random: Random, symmetric: bool = False, **ranges: tuple[float, float]) -> dict[str, np.ndarray]:
    """Columns such as ``alpha_right`` and ``alpha_left``, each drawn by itself; `ranges` change `RANGES` or add."""
    random, made = np.random.default_rng(random), {}
    for name, (low, high) in (RANGES | ranges).items():
        right = random.uniform(low, high, count)
        made |= {f"{name}_right": right, f"{name}_left": right if symmetric else random.uniform(low, high, count)}
    return made


def smooth_noise(random: Random, count: int, peak: float = 1.0, width: int = 5) -> np.ndarray:
    """Normal numbers through a running mean of `width` samples, the largest of them `peak` without its sign."""
    x = np.random.default_rng(random).normal(size=count + width - 1)
    x = np.convolve(x, np.ones(width) / width, mode="valid")
    return np.asarray(x / np.abs(x).max() * peak)


def noise_motion(
    random: Random, count: int = 400, time_step: float = 0.02, peak: float = 4.0, vertical: float = 0.0, width: int = 5
) -> rk.GroundMotion:
    """Smooth noise of that peak [m/s2] that rises and fades away; `vertical` is the peak of the vertical one [m/s2]."""
    random, fade = np.random.default_rng(random), np.sin(np.linspace(0.0, np.pi, count))
    rows = [fade * smooth_noise(random, count, width=width) for _ in range(2)]
    across, up = (size * row / np.abs(row).max() for size, row in zip((peak, vertical), rows, strict=True))
    up = up if vertical else None
    return rk.GroundMotion(across, time_step, vertical=up, name="noise")


def components(random: Random, duration: float, time_step: float) -> tuple[rk.GroundMotion, ...]:
    """Three components: noise of 40 sines under an envelope, the vertical one half as strong [m/s2]."""
    random, time = np.random.default_rng(random), np.arange(round(duration / time_step) + 1) * time_step
    rise_and_fall = np.minimum(1.0, time) * np.exp(-np.maximum(0.0, time - 0.6 * duration))
    frequency = random.uniform(0.3, 6.0, 40)
    made = []
    for strength in (1.0, 1.0, 0.5):
        waves = np.sin(2.0 * np.pi * frequency[:, None] * time + random.uniform(0.0, 2.0 * np.pi, (40, 1)))
        sway = (waves / (1.0 + frequency)[:, None]).sum(axis=0)
        made.append(rk.GroundMotion(strength * rise_and_fall * sway, time_step))
    return tuple(made)


def record(names: str, count: int, random: Random, unit: str = "cm/s2", time_step: float = 0.01) -> Record:
    """A record with a component of faded noise for every word of `names`, of about 120 in its unit, without a mean."""
    random = np.random.default_rng(random)
    parts = []
    for name in names.split():
        values = random.normal(scale=120.0, size=count) * np.hanning(count)
        parts.append(Component(name, values - values.mean(), unit, time_step))
    return Record("synthetic", tuple(parts), "", {"station": "nowhere", "event": "synthetic"})


def lognormal_failures(
    levels: Any, trials: int, random: Random, median: float = 1.0, dispersion: float = 0.5, studies: int | None = None
) -> np.ndarray:
    """How many of `trials` fail at each level of intensity; with `studies`, a row for each of so many studies."""
    levels = np.asarray(levels)
    shape = levels.shape if studies is None else (studies, *levels.shape)
    return np.random.default_rng(random).binomial(trials, ndtr(np.log(levels / median) / dispersion), shape)


def smooth_noises(count, seed, samples):
    """Yield samples of noise in a window, smoothed."""
    random, window = np.random.default_rng(seed), np.sin(np.linspace(0.0, np.pi, samples)) ** 2
    for _ in range(count):
        yield np.convolve(random.normal(size=samples), np.ones(15) / 15.0, mode="same") * window
