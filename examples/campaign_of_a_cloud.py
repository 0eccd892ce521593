"""Campaign of a cloud
===================

Motions as they are, as a campaign: the rotations over a measure, and which measure says most, as a file.
"""

import csv
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking.campaigns.jobs import Job, JobFolder, analyses, export, measure_comparison
from rocking.plots import cloud_picture, write

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
measure = "pgv"
factor = 3.0
states = [0.3]
[export]
measures = ["pga", "pgv", "p pgv/(g tan alpha)", "pgv/pga", "sa(1.0)", "arias", "cav"]
columns = ["magnitude", "ln distance_km"]
""")

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
with TemporaryDirectory() as home:
    campaign = JobFolder.create(Path(home, "campaign"), job)
    campaign.run()
    (found,) = analyses(campaign).values()
    line, fit = found.regression, found.fits["overturned"]
    print(f"{line.count} rocked and stayed standing, {int((found.responses.overturned == 1.0).sum())} overturned")
    print(f"ln(theta/alpha) = {line.intercept:.2f} + {line.slope:.2f} ln(PGV), scatter {line.scatter:.2f}")
    print(f"overturning: median PGV {fit.median:.2f} m/s, dispersion {fit.dispersion:.2f}")
    parts = found.parts(fit.median, 0.3)
    assert abs(sum(float(part) for part in parts.values()) - 1.0) < 1e-12
    assert abs(float(parts["overturned"]) - 0.5) < 1e-9

    ranked = measure_comparison(campaign)
    for score in ranked.scores:
        print(f"  {score.measure:20s} efficiency {score.efficiency:.2f}")
    # the same from the shell: rocking campaign export CAMPAIGN --out measures=cabinet_measures.csv
    table = export(campaign, folder / "cabinet_measures.csv", "measures")
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["efficiency"]) for row in rows] == [score.efficiency for score in ranked.scores]
    write(cloud_picture(found), folder / "campaign_of_a_cloud.png")
