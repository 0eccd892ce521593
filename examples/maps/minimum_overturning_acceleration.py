"""Minimum overturning acceleration
================================

A block has a minimum overturning acceleration. Above this value there can be intervals without overturning. For
engineers who use the minimum and need the other limits.
"""

import math

import rocking as rk
from rocking import conventions
from rocking.plots import transitions_picture, write
from rocking.studies import minimum_overturning_acceleration

# %%
# All amplitudes of one sine pulse at which the outcome changes.

block = rk.Block(width=0.5, height=2.0)
pulse = rk.pulses.sine(amplitude=3.0, period=0.8)
found = minimum_overturning_acceleration(block, pulse, 0.85)
for low, high in found.overturning_intervals:
    print(f"overturns from {low / conventions.g:.4f} g to {high / conventions.g:.4f} g")
for low, high in found.safe_intervals:
    print(f"stays standing from {low / conventions.g:.4f} g to {high / conventions.g:.4f} g")
assert len(found) == 3  # after one impact, safe again, without impact
assert found.modes[:, 1].tolist() == [1, -1, 0]

# %%
# The peak rotation over the amplitude, and the number of impacts before overturning.

write(transitions_picture(found, block, pulse, 0.85), "minimum_overturning_acceleration.png")

# %%
# For a rectangular pulse and the slender-linear equations the minimum has a closed form: `g alpha / (1 - exp(-p T))`.

duration = 0.5
one = minimum_overturning_acceleration(block, rk.pulses.rectangular(1.0, duration), 0.85, linear=True)
exact = conventions.g * block.slenderness_angle / (1.0 - math.exp(-block.frequency_parameter * duration))
print(f"rectangular pulse: {one.minimum:.9f} m/s2, closed form {exact:.9f} m/s2")
assert one.minimum is not None
assert abs(one.minimum / exact - 1.0) < 1e-10
