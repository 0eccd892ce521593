"""Calibrated coefficient with its interval
========================================

The default model is calibrated with the published measurements and has a 95 % interval. A warning states the limits of
the measurements. For engineers who need a coefficient and its uncertainty.
"""

import rocking as rk
from rocking.evidence._coefficient_table import outside_evidence
from rocking.plots import coefficient_picture, write

# %%
# A body from a file: a marble figure on a pedestal of brick.

statue = rk.examples.body("statue")
prediction = rk.evidence.calibrate().predict(statue)
print(f"r = {prediction.coefficient:.3f}, 95 % interval {prediction.low:.3f} to {prediction.high:.3f}")
assert prediction.low < prediction.coefficient < prediction.high

# %%
# Nobody has measured a block that is wider than high: its interval is an extrapolation.

flat = rk.Block(width=2.0, height=1.0)
print(outside_evidence(flat))
assert "extrapolation" in outside_evidence(flat)

# %%
# All models for both feet, each with the interval that its errors at the measurements give it, and where this body
# lies among them. The command `rocking restitution statue.toml --output statue.png` draws the same.

tables = {foot: rk.evidence.coefficient_table(statue, onto=foot) for foot in ("left", "right")}
write(coefficient_picture(statue, tables), "prediction_with_interval.png")
