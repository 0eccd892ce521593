"""Inventory of objects
====================

An inventory of ten objects at PGA 0.3 g: which of them fall over, the worst first, in plain words.
"""

from pathlib import Path

from rocking import examples
from rocking.plots import inventory_picture, write
from rocking.reports.inventory_folder import write_inventory
from rocking.studies.inventory import assess, read_inventory
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.table import advice, model_note, sentence

inventory = read_inventory(examples.path("objects"))
hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=200, seed=1)
assessment = assess(inventory, hazard)

print(f"{len(assessment.verdicts)} objects at {hazard.words()}, {hazard.source}\n")
for rank, verdict in enumerate(assessment.verdicts, start=1):
    print(f"{rank:2}. [{verdict.light.word.upper():5}] {verdict.item.name}: {sentence(verdict, assessment)}")
    print(f"    {advice(verdict, assessment)} {model_note(verdict, assessment)}")
for row in assessment.not_assessed:
    print(f"    {row.name} (line {row.row}) not assessed: {row.reason}")

severities = [verdict.light.severity for verdict in assessment.verdicts]
assert severities == sorted(severities, reverse=True)
assert [row.name for row in assessment.not_assessed] == ["framed mirror on a stand"]

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(inventory_picture(assessment), folder / "inventory_of_objects.png")
written, left_out = write_inventory(assessment, folder / "inventory")  # HTML, PDF, Excel, CSV, JSON
print("wrote", ", ".join(path.name for path in written), *left_out)
assert {path.suffix for path in written} >= {".html", ".csv"}
