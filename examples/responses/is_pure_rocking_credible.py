"""Check of pure rocking
=====================

A rocking model excludes sliding and flight, and the response contains a check of this assumption. For engineers who
decide whether a result is valid.
"""

import warnings

import numpy as np

import rocking as rk
from rocking.errors import PureRockingWarning
from rocking.plots import regime_map_picture, write

# %%
# Rocking has a friction demand, which is larger for a squat body. With a friction coefficient of 0.4 the squat body
# slides, and `rk.simulate(..., friction=0.4)` simulates this.

squat, slender = rk.Block(width=1.0, height=1.6), rk.Block(width=0.4, height=1.6)
for body, amplitude in ((squat, 9.0), (slender, 4.0)):
    response = rk.simulate(body, rk.pulses.sine(amplitude, period=0.5), restitution="housner")
    print(f"h/b = {body.slenderness_ratio:g}: {response.outcome.value}, {len(response.impacts)} impacts")
    contact = response.contact
    print(f"  friction: motion {contact.friction_of_motion:.2f}, impacts {contact.friction_of_impacts:.2f}")
    for warning in contact.warnings(friction=0.4):
        print("  but", warning)
    assert bool(contact.warnings(friction=0.4)) is (body is squat)

# %%
# The regime of a squat body at rest under a sudden acceleration, as a function of friction: complementarity problem
# (cells) and the closed forms of Shenton (lines).

write(regime_map_picture(squat), "is_pure_rocking_credible.png")

# %%
# A strong vertical motion can cause flight, which pure rocking excludes. The result contains this message.

time = np.arange(0.0, 4.0, 0.005)
envelope = np.sin(np.pi * time / 4.0) ** 2
level = 4.5 * envelope * np.sin(2.0 * np.pi * 1.2 * time)
for share in (0.0, 0.5, 1.3):
    upward = share * 9.0 * envelope * np.sin(2.0 * np.pi * 5.0 * time)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PureRockingWarning)  # what it says is printed below
        response = rk.simulate(slender, rk.GroundMotion(level, 0.005, vertical=upward), restitution="housner")
    lifts_off = response.contact.loses_contact
    print(f"vertical peak {np.abs(upward).max():5.2f} m/s2: {response.outcome.value}; lifts off: {lifts_off}")
    for doubt in response.doubts():
        print("  but", doubt)
    assert response.lost_contact is lifts_off
    assert response.energy.closure < 1e-10
assert lifts_off

# %%
# The last response. Below: the contact force becomes tensile.

response.plot("response_with_vertical_motion.png")
