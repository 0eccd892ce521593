"""Cloud analysis as a campaign
============================

A cloud analysis uses motions as recorded, without scaling. The campaign stores each simulation, fits the peak rotations
over an intensity measure, and ranks the measures. For researchers with many records.
"""

import csv
from tempfile import TemporaryDirectory

from rocking.campaigns.jobs import Job, JobFolder, analyses, export, measure_comparison
from rocking.plots import cloud_picture, write

# %%
# The job is the same as in a job file: `rocking campaign run cabinet.toml --output CAMPAIGN` runs it.

job = Job.of_text("""
[campaign]
name = "cabinet under far earthquakes"
kind = "cloud"
[body]
units = "m"
width = 0.3
height = 1.5
[motions]
synthetic = "point-source"
count = 250
seed = 1
[restitution]
model = "ked"
[fragility]
im = "pgv"
scale = 3.0
limit_states = [0.3]
[export]
ims = ["pga", "pgv", "p pgv/(g tan alpha)", "pgv/pga", "sa(1.0)", "arias", "cav"]
columns = ["magnitude", "ln distance_km"]
""")

with TemporaryDirectory() as home:
    campaign = JobFolder.create(f"{home}/campaign", job)
    campaign.run()
    (found,) = analyses(campaign).values()
    ranked = measure_comparison(campaign)
    # from the shell: rocking campaign export CAMPAIGN --output ims=cabinet_measures.csv
    table = export(campaign, "cabinet_measures.csv", "ims")

# %%
# The regression, and the outcomes of the cabinet at the median. The probabilities add up to one.

line, fit = found.regression, found.fits["overturned"]
print(f"{line.count} rocked but did not overturn, {int((found.responses.overturned == 1.0).sum())} overturned")
print(f"ln(theta/alpha) = {line.intercept:.2f} + {line.slope:.2f} ln(PGV), scatter {line.scatter:.2f}")
print(f"overturning: median PGV {fit.median:.2f} m/s, dispersion {fit.dispersion:.2f}")
parts = found.parts(fit.median, 0.3)
assert abs(sum(float(part) for part in parts.values()) - 1.0) < 1e-12
assert abs(float(parts["overturned"]) - 0.5) < 1e-9
write(cloud_picture(found), "campaign_of_a_cloud.png")

# %%
# The best measure has the smallest scatter. The exported file contains the same values.

for score in ranked.scores:
    print(f"  {score.im:20s} efficiency {score.efficiency:.2f}")
with table.open(encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
assert [float(row["efficiency"]) for row in rows] == [score.efficiency for score in ranked.scores]
