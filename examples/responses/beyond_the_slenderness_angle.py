"""Rotation beyond the slenderness angle
=====================================

A rotation above alpha is not always overturning. This block reaches one and a half times alpha, and the ground motion
returns it. For users who define overturning by a threshold.
"""

import rocking as rk
from rocking.plots import animate_comparison

# %%
# Bisection finds the minimum overturning amplitude between an amplitude with and an amplitude without overturning, to
# nine digits.

block = rk.Block(width=0.5, height=1.5)
overturned, standing = 12.0, 10.6  # m/s2
assert rk.simulate(block, rk.pulses.sine(overturned, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
while overturned - standing > 1e-9:
    middle = 0.5 * (overturned + standing)
    falls = rk.simulate(block, rk.pulses.sine(middle, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
    overturned, standing = (middle, standing) if falls else (overturned, middle)

# %%
# Two amplitudes differ by at most 1e-9 m/s2. The body overturns with one of them. With the other one it returns from
# 1.56 alpha without an impact.

response, fallen = (rk.simulate(block, rk.pulses.sine(amplitude, 0.75), 0.85) for amplitude in (standing, overturned))
print(f"{standing:.6f} m/s2: {response.summary}")
print(f"{overturned:.6f} m/s2: {fallen.summary}")
assert response.peak_rotation / block.slenderness_angle > 1.0
response.plot("beyond_the_slenderness_angle.png")

# %%
# Both responses as an animation; and the second one as an interactive web page.

both = {
    f"{amplitude:.2f} m/s2": rk.simulate(block, rk.pulses.sine(amplitude, 0.75), 0.85)
    for amplitude in (standing - 0.1, overturned + 0.1)
}
animate_comparison(both, "beyond_the_slenderness_angle.gif", until=3.0)
page = both[f"{standing - 0.1:.2f} m/s2"].animate("beyond_the_slenderness_angle.html")
assert "https://" not in page.read_text(encoding="utf-8")
