"""Bases that are not flat: convex, concave, uneven, rough."""

from typing import Any, Literal

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.studies.impact_laboratory.beds import Laboratory
from rocking.studies.impact_laboratory.dependence import study, whole
from rocking.studies.impact_laboratory.result import LaboratoryStudy

Shape = Literal["convex", "concave", "tilted", "random"]
SHAPES: tuple[Shape, ...] = ("convex", "concave", "tilted", "random")


def profile(shape: Shape, amplitude: float, points: int, *, seed: int = 0) -> tuple[float, ...]:
    """Return heights of contact points over the base line.

    shape: A parabola that bulges down in the middle, one that is hollow there, a slope with the new foot up, or
    independent uniform heights in [0, amplitude] from the seed; amplitude: difference between the highest and the
    lowest point, or its bound [m]. Returns heights [m].

    >>> profile("concave", 0.001, 3)
    (0.0, 0.001, 0.0)
    """
    amplitude = checks.within("amplitude", amplitude, 0.0, 10.0, unit="m")
    count, start = whole("points", points, 2), whole("seed", seed, 0)
    s = np.linspace(-1.0, 1.0, count)
    if shape == "concave":
        heights = amplitude * (1.0 - s**2)
    elif shape == "convex":
        heights = amplitude * s**2
    elif shape == "tilted":
        heights = 0.5 * amplitude * (1.0 + s)
    elif shape == "random":
        heights = np.random.default_rng(start).uniform(0.0, amplitude, count)
    else:
        raise InvalidValueError(f"shape must be one of {', '.join(SHAPES)}, got {shape!r}")
    return tuple(heights.tolist())


def profile_study(
    shape: Shape, amplitudes: Any, laboratory: Laboratory | None = None, *, seed: int = 0
) -> LaboratoryStudy:
    """Return r against the unevenness of the base.

    amplitudes: heights of the unevenness [m].
    """

    def uneven(start: Laboratory, amplitude: float) -> Laboratory:
        """Return the laboratory with a base of that unevenness."""
        return start.but(profile=profile(shape, amplitude, start.points, seed=seed))

    return study("amplitude", "m", amplitudes, uneven, laboratory)


def random_profiles(amplitude: float, seeds: Any, laboratory: Laboratory | None = None) -> LaboratoryStudy:
    """Return r of bases with random unevenness.

    amplitude: bound of the heights [m].
    """

    def rough(start: Laboratory, seed: float) -> Laboratory:
        """Return the laboratory with the base of a seed."""
        return start.but(profile=profile("random", amplitude, start.points, seed=whole("seed", seed, 0)))

    return study("seed", "1", seeds, rough, laboratory)
