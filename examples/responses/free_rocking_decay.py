"""Free rocking
============

A tilted block is released. The example computes the duration of rocking and identifies the coefficient from the
response. For experimenters: free rocking is the test for the coefficient of restitution.
"""

import math

import rocking as rk

# %%
# Initial rotation of half the slenderness angle, with `r = 0.92`. For slender bodies the time of the first impact has
# a closed form. At `h/b = 4` the error of the linear equations is less than 1 %.

block = rk.Block(width=0.4, height=1.6)
alpha, p = block.slenderness_angle, block.frequency_parameter
response = rk.free_rocking(block, rotation=0.5 * alpha, restitution=0.92)
quarter = response.impacts["time"][0]

linear = math.acosh(2.0) / p  # slender bodies: cosh(p T / 4) = 1 / (1 - theta0 / alpha)
print(f"first impact after {quarter:.4f} s; for slender bodies {linear:.4f} s; rest after {response.time[-1]:.2f} s")
assert abs(quarter / linear - 1.0) < 0.03

# %%
# The impact times give the coefficient.

speeds = abs(response.impacts["velocity_before"])
found = speeds[1:11] / speeds[:10]
print(f"r from successive impacts: {found.min():.12f} to {found.max():.12f}")
assert abs(found - 0.92).max() < 1e-12

# %%
# Two independent engines agree, and each contains an error estimate.

for engine in ("fast", "reference"):
    other = rk.free_rocking(block, rotation=0.5 * alpha, restitution=0.92, engine=engine)
    print(f"{engine}: first impact {other.impacts['time'][0]:.15f} s, error estimate {other.error_estimate:.1e} rad")

# %%
# The rotations become smaller and faster until rest.

response.plot("free_rocking_decay.png")
