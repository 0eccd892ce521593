"""Assessment of a collection
==========================

A list of objects in centimetres and kilograms and an earthquake of 0.3 g give a list of ratings, the highest risk
first. For conservators and facility managers. Knowledge of rocking is not necessary.
"""

from pathlib import Path

import rocking as rk
from rocking.decision.inventory import assess, read_inventory
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.ranking import advice, model_note, sentence
from rocking.plots import inventory_picture, write
from rocking.reports.inventory_folder import write_inventory

# %%
# The list is a table with one row per object. Excel files are read too. The earthquake has a peak acceleration and
# two hundred synthetic motions.

inventory = read_inventory(rk.examples.path("objects"))
hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=200, seed=1)
assessment = assess(inventory, hazard)
print(f"{len(assessment.verdicts)} objects at {hazard.words()}")

# %%
# Overturning fraction of each object with its rating. Right: the PGA at uplift, compared with 0.3 g.

write(inventory_picture(assessment), "inventory_of_objects.png")

# %%
# One sentence per object. An unreadable row is listed and not guessed.

for rank, verdict in enumerate(assessment.verdicts, start=1):
    print(f"{rank:2}. [{verdict.light.word.upper():5}] {verdict.item.name}: {sentence(verdict, assessment)}")
    print(f"    {advice(verdict, assessment)} {model_note(verdict, assessment)}")
for row in assessment.not_assessed:
    print(f"    {row.name} (line {row.row}) not assessed: {row.reason}")

severities = [verdict.light.severity for verdict in assessment.verdicts]
assert severities == sorted(severities, reverse=True)
assert [row.name for row in assessment.not_assessed] == ["framed mirror on a stand"]

# %%
# The same result as a folder: a web page, a PDF, a workbook, and tables.

written, left_out = write_inventory(assessment, Path("inventory"))
print("wrote", ", ".join(path.name for path in written), *left_out)
assert {path.suffix for path in written} >= {".html", ".csv"}
