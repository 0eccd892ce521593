"""Direction of overturning
========================

One record with two components is rotated to each azimuth at one hundred scale factors. The example shows the directions
of overturning of a bust. For conservators and researchers.
"""

import numpy as np

import rocking as rk
from rocking.bodies.solid import Part, Solid, box, ellipsoid, frustum, revolution
from rocking.plots import falling_picture, write

# %%
# A bust on a pedestal that is wider than deep.

pedestal = Part(box(0.42, 0.34, 1.20), 2400.0)
socle = Part(revolution([(0.15, 0.0), (0.10, 0.06), (0.08, 0.12), (0.10, 0.16)]), 2700.0).moved(0.0, 0.0, 1.20)
chest = Part(frustum(0.20, 0.40, 0.30), 2700.0).moved(0.02, 0.0, 1.36)
head = Part(ellipsoid(0.20, 0.18, 0.28, cut_below=0.02), 2700.0).moved(0.03, 0.0, 1.66)
statue = Solid([pedestal, socle, chest, head])

# %%
# Two horizontal components of one motion, the second with a factor of 0.7, rotated in steps of five degrees.

modulation = rk.synthetic.modulation_from_intensity(arias_intensity=1.5, significant_duration=8.0, middle=5.0)
strong, weak = (
    rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=s) for s in (3, 4)
)
step = strong.time_step
count = min(strong.acceleration.size, weak.acceleration.size)
first, second = strong.acceleration[:count], 0.7 * weak.acceleration[:count]
azimuths = np.radians(np.arange(0.0, 360.0, 5.0))
turned = [
    {"x": rk.GroundMotion(c * first - s * second, step), "y": rk.GroundMotion(s * first + c * second, step)}
    for c, s in zip(np.cos(azimuths), np.sin(azimuths), strict=True)
]

# %%
# Thousands of 3D simulations with two models.

scales = np.linspace(0.6, 4.0, 52)
results = rk.simulate_many(statue, turned, ["housner", "ked"], scale=scales)
over = results["overturned"].values[0, :, :, :, 0]
share = over.mean(axis=1)
for k, name in enumerate(results["restitution"].values):
    best, worst = (float(np.degrees(azimuths[f(share[:, k])])) for f in (np.argmin, np.argmax))
    print(f"{name}: {over[..., k].mean():.1%} overturn; fewest at {best:.0f} degrees, most at {worst:.0f} degrees")
differs = over[..., 0] != over[..., 1]
print(f"the verdict differs in {differs.mean():.1%} of {over.size // 2} pairs")
assert over.size == 72 * 52 * 2
assert (results["outcome"] != rk.Outcome.FAILED.code).all()
assert not over[:, 0].any()  # the weakest shaking overturns from no direction
# how often it falls depends on the direction of the shaking, and for single histories on the model
assert (share.max(axis=0) > 1.15 * share.min(axis=0)).all()
assert differs.mean() > 0.05

# %%
# The bust overturns over its long sides, along y, more often than over its short sides.

along_y = np.abs(np.sin(results["direction"].values[results["overturned"].values == 1.0])) > np.sqrt(0.5)
print(f"{along_y.mean():.1%} of the falls are over the long sides of the base")
assert along_y.mean() > 0.6

# %%
# Overturning fraction by the direction of the motion, direction of overturning, and differences between the models.

base = [(0.21, 0.17), (-0.21, 0.17), (-0.21, -0.17), (0.21, -0.17)]
write(falling_picture(results, azimuths, base), "falling_by_direction.png")
