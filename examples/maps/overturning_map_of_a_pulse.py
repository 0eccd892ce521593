"""Overturning map of a pulse
==========================

A map over frequency and amplitude has two overturning modes. Between them is a region in which a stronger pulse does
not overturn the block. For researchers.
"""

import numpy as np

import rocking as rk
from rocking.plots import overturning_map_picture, write
from rocking.studies import boundary, overturning_map, safe_beyond_overturning

# %%
# 160 x 160 sine pulses, as ratios: frequency / frequency parameter `p` of the block, amplitude / uplift acceleration.

block = rk.Block(width=0.5, height=2.0)
pulse = rk.pulses.sine(amplitude=3.0, period=0.8)
axes = ("frequency_ratio", np.linspace(0.5, 10.0, 160)), ("amplitude_ratio", np.linspace(1.0, 12.0, 160))
found = overturning_map(block, pulse, *axes, restitution=0.85)

share = {mode: float((found["mode"] == mode).mean()) for mode in (0, 1)}
beyond = safe_beyond_overturning(found)
print(f"{share[0]:.1%} overturns without impact, {share[1]:.1%} after one impact")
print(f"{float(beyond.mean()):.1%} stays standing although a weaker pulse of the same frequency overturns it")
assert min(share.values()) > 0.05
assert beyond.any()
# a pulse of at most g tan(alpha) lifts nothing
assert (found["mode"].sel(amplitude_ratio=1.0) == -2).all()

# %%
# Bisection gives the boundary as polylines. The outcome changes at the boundary.

lines = boundary(block, pulse, *axes, restitution=0.85, tolerance=1e-5)
longest = max(lines, key=lambda line: len(line.points))
print(f"boundary: {len(lines)} lines, the longest has {len(longest.points)} vertices")
x, y = longest.points[len(longest.points) // 2]
around = [
    overturning_map(block, pulse, ("frequency_ratio", [x * a, x * a * 1.01]), ("amplitude_ratio", [y * b]), 0.85)
    for a, b in ((0.98, 1.02), (1.02, 0.98))
]
assert {bool((one["mode"] >= 0).any()) for one in around} == {True, False}

# %%
# Brown: overturning without an impact. Orange: overturning after one impact. Blue lines: peak rotation / alpha
# without overturning.

write(overturning_map_picture(found, lines), "overturning_map_of_a_pulse.png")
