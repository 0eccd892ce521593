"""Energy of the three stages
==========================

Where the paper's model loses energy: the three stages of an impact of a pedestal with a hollow.
"""

from pathlib import Path

import rocking as rk
from rocking.plots import energy_stages_picture

outline = rk.bodies.shapes.trapezoid(base=1.0, top=0.5, height=2.5)
hollow = [(0.4, 0.4), (0.6, 0.4), (0.6, 1.6), (0.4, 1.6)]
pedestal = rk.Section.from_points(outline, density=2700.0, holes=[hollow])

balance = rk.restitution.energy_balance(pedestal, onto="right", angular_velocity=0.5)
for stage, share in balance.shares.items():
    print(f"{stage:8s} {balance.totals[stage]:9.2f} J  {share:7.2%}")

shares = list(balance.shares.values())
assert shares[0] == 1.0
assert shares[0] > shares[1] > shares[2]
assert abs(shares[2] - shares[3]) < 1e-12

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
energy_stages_picture(pedestal).savefig(folder / "energy_of_the_three_stages.png")
