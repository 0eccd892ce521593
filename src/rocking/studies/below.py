"""Below the least amplitude that overturns: sampled again and again, for under a record thin stretches hide there."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.scan import Samples, Scan

# where the points of a round lie between those of the others, and how many rounds without news are enough
_SHIFTS, _ENOUGH = (0.25, 0.75, 0.5, 0.125), 2


@dataclass(frozen=True)
class Below:
    """Samples of one body up to the first that overturns."""

    scales: FloatArray  # factors on the motion, increasing; all but the last survive [-]

    @property
    def gap(self) -> float:
        """Relative width of the widest gap between them [-]."""
        return float(np.max(self.scales[1:] / self.scales[:-1])) - 1.0


def below(samples: Samples) -> dict[int, Below]:
    """Return the samples of each body up to the first that overturns.

    Returns by the number of the body; without those that never overturn, or do so at the lowest sample.

    >>> n, x = np.array([0, 0, 0, 1, 1]), np.array([1.0, 2.0, 3.0, 1.0, 2.0])
    >>> found = below(Samples(n, x, np.array([-1, -1, 2, -1, -1]), n, x, x, x))
    >>> {k: each.scales.tolist() for k, each in found.items()}
    {0: [1.0, 2.0, 3.0]}
    """
    bodies, start = np.unique(samples.body, return_index=True)
    made = {}
    for body, first, last in zip(bodies.tolist(), start, np.append(start, samples.body.size)[1:], strict=True):
        falls = np.flatnonzero(samples.falls[first:last])
        if falls.size and falls[0] > 0:
            made[body] = Below(samples.scale[first : first + falls[0] + 1])
    return made


def search_below(scan: Scan, points: int) -> None:
    """Sample below the least amplitude that overturns until it holds.

    A round spreads points over the range up to the first sample that overturns. A body is done when two rounds in a row
    have found nothing that overturns below the survivors next to that sample, or after four.
    """
    held: dict[int, int] = {}
    for shift in _SHIFTS:
        known = {k: each.scales for k, each in below(scan.samples.good).items() if held.get(k, 0) < _ENOUGH}
        if not known:
            return
        share = (np.arange(points) + shift) / points
        scales = np.concatenate([s[0] * (s[-1] / s[0]) ** share for s in known.values()])
        found = scan.compute(np.repeat(np.array(list(known)), points), scales)
        scan.samples = scan.samples.joined(found)
        least = np.full(1 + max(known), -np.inf)
        least[list(known)] = [s[-2] for s in known.values()]
        news = set(np.unique(found.body[found.falls & (found.scale < least[found.body])]).tolist())
        held |= {k: 0 if k in news else held.get(k, 0) + 1 for k in known}
