"""Free rocking decay
==================

Let a block go at half its slenderness angle: Housner's closed form, and r found again from two peaks.
"""

import math

import rocking as rk

block = rk.Block(width=0.4, height=1.6)
alpha, p = block.slenderness_angle, block.frequency_parameter
response = rk.free_rocking(block, rotation=0.5 * alpha, restitution=0.92)
quarter = response.impacts["time"][0]

linear = math.acosh(2.0) / p  # slender bodies: cosh(p T / 4) = 1 / (1 - theta0 / alpha)
print(f"first impact after {quarter:.4f} s; for slender bodies {linear:.4f} s; rest after {response.time[-1]:.2f} s")
assert abs(quarter / linear - 1.0) < 0.03  # what linearising costs at h/b = 4

speeds = abs(response.impacts["velocity_before"])
found = speeds[1:11] / speeds[:10]
print(f"r from successive impacts: {found.min():.12f} to {found.max():.12f}")
assert abs(found - 0.92).max() < 1e-12

for engine in ("fast", "reference"):
    told = rk.free_rocking(block, rotation=0.5 * alpha, restitution=0.92, engine=engine)
    print(f"{told.engine}: first impact {told.impacts['time'][0]:.15f} s, error estimate {told.error_estimate:.1e} rad")
