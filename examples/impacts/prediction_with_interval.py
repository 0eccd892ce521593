"""Calibrated coefficient with its interval
========================================

The default model is calibrated with the published measurements and has a 95 % interval. A warning states the limits of
the measurements. For engineers who need a coefficient and its uncertainty.
"""

import rocking as rk
from rocking.evidence._coefficient_table import outside_evidence
from rocking.plots import coefficient_picture, write

# %%
# A body from a file: a marble figure on a brick pedestal.

statue = rk.examples.body("statue")
prediction = rk.evidence.calibrate().predict(statue)
print(f"r = {prediction.coefficient:.3f}, 95 % interval {prediction.low:.3f} to {prediction.high:.3f}")
assert prediction.low < prediction.coefficient < prediction.high

# %%
# No block wider than high was measured. Its interval is an extrapolation.

flat = rk.Block(width=2.0, height=1.0)
print(outside_evidence(flat))
assert "extrapolation" in outside_evidence(flat)

# %%
# All models for both feet, each with the interval from its errors at the measurements, and the slenderness of this
# body in the range of the measurements. `rocking restitution statue.toml --output statue.png` writes the same
# picture.

tables = {foot: rk.evidence.coefficient_table(statue, foot=foot) for foot in ("left", "right")}
write(coefficient_picture(statue, tables), "prediction_with_interval.png")
