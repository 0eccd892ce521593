"""Beyond the slenderness angle
============================

A rotation beyond alpha alone is not overturning: a block that leans out to 1.5 alpha and comes back.
"""

from pathlib import Path

import rocking as rk
from rocking.plots import animate_html, response_picture, write

block = rk.Block(width=0.5, height=1.5)
overturned, standing = 12.0, 10.6  # m/s2; a bracket of the least amplitude that overturns
assert rk.simulate(block, rk.pulses.sine(overturned, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
while overturned - standing > 1e-9:
    middle = 0.5 * (overturned + standing)
    falls = rk.simulate(block, rk.pulses.sine(middle, 0.75), 0.85).outcome is rk.Outcome.OVERTURNED
    overturned, standing = (middle, standing) if falls else (overturned, middle)

response = rk.simulate(block, rk.pulses.sine(standing, 0.75), 0.85)
ratio = response.peak_rotation / block.slenderness_angle
print(f"{standing:.6f} m/s2: {response.summary}")
print(f"{overturned:.6f} m/s2: {rk.simulate(block, rk.pulses.sine(overturned, 0.75), 0.85).summary}")
assert ratio > 1.0

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(response_picture(response), folder / "beyond_the_slenderness_angle.png")
page = animate_html(response, folder / "beyond_the_slenderness_angle.html")
assert "https://" not in page.read_text(encoding="utf-8")
