"""All overturning intervals under twelve motions
==============================================

For each motion, all PGA intervals with overturning of a cabinet. The minimum overturning PGA is seldom the only limit.
For researchers who derive fragility curves from such searches.
"""

from tempfile import TemporaryDirectory

import rocking as rk
from rocking import conventions
from rocking.campaigns.jobs import Job, JobFolder, answer
from rocking.plots import transitions_of_many_picture, write
from rocking.studies import SyntheticSet, minimum_overturning_acceleration

# %%
# The study as a job, as in a job file.

COUNT = 12
job = Job.of_text(f"""
[campaign]
name = "cabinet under motions that grow"
kind = "minimum-acceleration"
[body]
units = "m"
width = 0.4
height = 1.6
[motions]
synthetic = "pulse-like"
count = {COUNT}
seed = 2
[restitution]
models = ["housner", "ked"]
[minimum]
samples = 120
bisections = 2
""")

with TemporaryDirectory() as home:
    campaign = JobFolder.create(f"{home}/campaign", job)
    campaign.run()
    crossings = answer(campaign).value  # motion by motion, of each first Housner's
found = {"housner": crossings[0::2], "ked": crossings[1::2]}

# %%
# One of the results, computed by the search function alone.

motions, block = SyntheticSet("pulse-like", COUNT, seed=2), rk.Block(width=0.4, height=1.6)
alone = minimum_overturning_acceleration(block, motions[7], "ked", samples=120, bisections=2)
assert alone.acceleration.tolist() == found["ked"][7].acceleration.tolist()

# %%
# Under most motions there are intervals without overturning above the minimum.

for label, each in found.items():
    again = sum(any(high > 1.01 * low for low, high in one.safe_intervals[1:]) for one in each)
    least = sorted(one.minimum / conventions.g for one in each)
    print(f"{label}: overturns from {least[0]:.2f} g to {least[-1]:.2f} g on, median {least[COUNT // 2]:.2f} g;")
    print(f"    under {again} of {COUNT} motions it stands again over more than 1 % of a level beyond the least")
    assert again > 0
    assert all((one.acceleration[1:] > one.acceleration[:-1]).all() for one in each)

names = [str(k + 1) for k in range(COUNT)]
picture = transitions_of_many_picture(found, names, lane_title="motion, sorted by housner", until=3.0 * conventions.g)
write(picture, "crossings_under_many_motions.png")
