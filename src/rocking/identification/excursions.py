"""Half cycles that stand out of the noise of a measured rotation, and which of them an impact joins."""

from dataclasses import dataclass, replace

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

_NOISES = 6.0  # least rotation over the noise
_FEWEST = 7  # samples
_STEEP = 0.6  # of the speed before: slower across zero it rested in between


@dataclass(frozen=True, eq=False)
class Excursions:
    """Where the rotation is beyond its noise."""

    first: IntArray  # sample
    last: IntArray
    sign: FloatArray  # 1 on the right foot, -1 on the left
    begin: FloatArray  # when the impact before it is [s], or its first sample
    end: FloatArray  # when the impact after it is [s], or its last sample
    joined: BoolArray  # to the one before, by an impact

    def kept(self, which: BoolArray) -> "Excursions":
        """Return some of them: what was joined to one that is not kept begins by itself."""
        joined = self.joined & np.concatenate([[False], which[:-1]])
        kept = {name: values[which] for name, values in vars(self).items()}
        return Excursions(**(kept | {"joined": joined[which]}))

    def parted(self, which: BoolArray, time: FloatArray) -> "Excursions":
        """Return them with some no longer joined to the one before."""
        begin, end = np.where(which, time[self.first], self.begin), self.end.copy()
        end[np.flatnonzero(which) - 1] = time[self.last[np.flatnonzero(which) - 1]]
        return replace(self, begin=begin, end=end, joined=self.joined & ~which)

    def alone(self) -> BoolArray:
        """Return which are joined to none."""
        return np.asarray(~(self.joined | np.append(self.joined[1:], False)))


def excursions_of(time: FloatArray, rotation: FloatArray, share: float) -> Excursions:
    """Return them of a rotation that is zero at rest; share: least rotation over the range."""
    noise = float(np.median(np.abs(np.diff(rotation, 2)))) / (0.6745 * np.sqrt(6.0))
    least = max(_NOISES * noise, share * float(np.ptp(rotation)))
    side = np.where(np.abs(rotation) > least, np.sign(rotation), 0.0)
    cuts = np.flatnonzero(np.diff(side) != 0.0) + 1
    first, last = np.concatenate([[0], cuts]), np.concatenate([cuts, [side.size]]) - 1
    long = (side[first] != 0.0) & (last - first + 1 >= _FEWEST)
    first, last = first[long], last[long]
    begin, end, joined = time[first].copy(), time[last].copy(), np.zeros(first.size, dtype=np.bool_)
    for n in range(1, first.size):
        a, b = last[n - 1], first[n]
        if side[a] * side[b] > 0.0 or np.any(side[a + 1 : b] != 0.0):
            continue
        slope = (rotation[b] - rotation[a]) / (time[b] - time[a])
        near = slice(max(a - max(3, b - a), int(first[n - 1])), a + 1)
        before = np.polyfit(time[near] - time[a], rotation[near], 1)[0]
        if slope * before > 0.0 and abs(slope) > _STEEP * abs(before):
            joined[n] = True
            begin[n] = end[n - 1] = time[a] - rotation[a] / slope
    return Excursions(first, last, side[first], begin, end, joined)
