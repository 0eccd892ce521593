"""Prediction with interval
========================

A coefficient with its interval: the calibrated default for a cabinet, and a warning where evidence ends.
"""

from pathlib import Path

import rocking as rk
from rocking.evidence._coefficient_table import outside_evidence
from rocking.plots import coefficient_picture, write

statue = rk.examples.body("statue")
prediction = rk.evidence.calibrate().predict(statue)
print(f"r = {prediction.coefficient:.3f}, 95 % interval {prediction.low:.3f} to {prediction.high:.3f}")
assert prediction.low < prediction.coefficient < prediction.high

flat = rk.Block(width=2.0, height=1.0)
print(outside_evidence(flat))
assert "extrapolation" in outside_evidence(flat)

tables = {foot: rk.evidence.coefficient_table(statue, onto=foot) for foot in ("left", "right")}
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(coefficient_picture(statue, tables), folder / "statue.png")
