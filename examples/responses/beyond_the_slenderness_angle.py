"""Rotation beyond the slenderness angle
=====================================

A rotation above alpha is not always overturning. This block reaches one and a half times alpha, and the ground motion
returns it. For users who define overturning by a threshold.
"""

import rocking as rk
from rocking.plots import animate_comparison

# %%
# Between an amplitude that overturns and one that does not lies the least that does; bisection finds it to nine
# digits.

block = rk.Block(width=0.5, height=1.5)
overturned, standing = 12.0, 10.6  # m/s2
assert rk.simulate(block, rk.pulses.sine(overturned, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
while overturned - standing > 1e-9:
    middle = 0.5 * (overturned + standing)
    falls = rk.simulate(block, rk.pulses.sine(middle, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
    overturned, standing = (middle, standing) if falls else (overturned, middle)

# %%
# Two amplitudes that differ by at most a billionth of a m/s2: one overturns, the other comes back from 1.56
# alpha, without a single impact.

response, fallen = (rk.simulate(block, rk.pulses.sine(amplitude, 0.75), 0.85) for amplitude in (standing, overturned))
print(f"{standing:.6f} m/s2: {response.summary}")
print(f"{overturned:.6f} m/s2: {fallen.summary}")
assert response.peak_rotation / block.slenderness_angle > 1.0
response.plot("beyond_the_slenderness_angle.png")

# %%
# A little below and a little above it, side by side as a film; and the one that comes back as a web page of one
# file, in which one can stop, slow down and drag.

both = {
    f"{amplitude:.2f} m/s2": rk.simulate(block, rk.pulses.sine(amplitude, 0.75), 0.85)
    for amplitude in (standing - 0.1, overturned + 0.1)
}
animate_comparison(both, "beyond_the_slenderness_angle.gif", until=3.0)
page = both[f"{standing - 0.1:.2f} m/s2"].animate("beyond_the_slenderness_angle.html")
assert "https://" not in page.read_text(encoding="utf-8")
