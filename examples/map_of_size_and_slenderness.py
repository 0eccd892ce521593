"""Map of size and slenderness
===========================

Which blocks a pulse overturns: size against slenderness, with the restitution of every block evaluated anew.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.plots import overturning_map_picture, write
from rocking.studies import boundary, map_sensitivity

block = rk.Block(width=0.5, height=2.0)
pulse = rk.pulses.sine(amplitude=0.5 * conventions.g, period=0.8)
axes = ("semi_diagonal", np.geomspace(0.2, 10.0, 120)), ("slenderness_ratio", np.linspace(1.5, 9.0, 121))
compared = map_sensitivity(block, pulse, *axes, ["ked", "housner"])
found = compared.datasets["ked"]  # what overturning_map returns

falls = found["mode"] >= 0
largest = float(found["semi_diagonal"].where(falls.any("slenderness_ratio")).max())
print(f"{float(falls.mean()):.1%} of these blocks overturn, none of more than R = {largest:.2f} m")
# a block is lifted where the pulse exceeds g b / h: here h/b > 2
lifted = (found["mode"] != -2).any("semi_diagonal")
assert bool((lifted == (found["slenderness_ratio"] > 2.0)).all())
assert float(found["semi_diagonal"].max()) > largest

print(compared.verdict)
assert compared.flips_between("ked", "housner").count > 0

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
lines = boundary(block, pulse, *axes, restitution="ked", by="mode", tolerance=1e-5)
write(overturning_map_picture(found, lines), folder / "map_of_size_and_slenderness.png")
