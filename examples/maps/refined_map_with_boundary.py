"""Refined map with boundaries
===========================

A map is refined along its boundaries only, and the boundaries are polylines. A uniform grid with the same resolution
needs 250,000 simulations. For researchers who publish maps or fit formulas.
"""

import numpy as np

import rocking as rk
from rocking.plots import refined_map_picture, write
from rocking.studies import boundary, overturning_map, refined_map

# %%
# Three levels, each with half of the spacing, only between different neighbours.

block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.8)
axes = ("frequency_ratio", np.linspace(0.5, 8.0, 61)), ("amplitude_ratio", np.linspace(1.0, 10.0, 61))
levels = 3
points = refined_map(block, pulse, *axes, restitution=0.9, levels=levels)
lines = boundary(block, pulse, *axes, restitution=0.9, levels=levels, by="mode", tolerance=1e-6)

base, total = int(points.base.sum()), points.modes.size
whole = (60 * 2**levels + 1) ** 2
print(f"{base} points of the map, {total - base} along its boundaries; as fine everywhere: {whole}")
assert total < 0.2 * whole

# %%
# A point of the refined map equals the result of the usual map.

place = int(np.flatnonzero(~points.base)[100])
alone = overturning_map(
    block, pulse, ("frequency_ratio", points.x[[place]]), ("amplitude_ratio", points.y[[place]]), 0.9
)
assert int(alone["mode"].item()) == int(points.modes[place])

# %%
# A vertex of a polyline is between two modes, with an error below 1e-4.

print(f"{len(lines)} polylines, {sum(len(line.points) for line in lines)} vertices")
longest = max(lines, key=lambda line: len(line.points))
x, y = longest.points[len(longest.points) // 2]
sides = [
    overturning_map(block, pulse, ("frequency_ratio", [x * a]), ("amplitude_ratio", [y * b]), 0.9)["mode"].item()
    for a, b in ((1.0 - 1e-4, 1.0 + 1e-4), (1.0 + 1e-4, 1.0 - 1e-4))
]
assert sides[0] != sides[1]

# %%
# Left: the map. Right: the computed points in the marked region.

picture = refined_map_picture(
    points, lines, window=((1.6, 3.2), (1.8, 4.2)), title="sine pulse scaled; restitution 0.9"
)
write(picture, "refined_map_with_boundary.png")
