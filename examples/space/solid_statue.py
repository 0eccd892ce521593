"""Bust in three dimensions
========================

A 3D body rocks over each edge and over corners, and each has another energy loss. For engineers and conservators.
"""

import numpy as np

import rocking as rk
from rocking.bodies.solid import Part, Solid, box, ellipsoid, frustum, revolution
from rocking.plots import energy_picture, write
from rocking.restitution.space import edge_coefficient, impact_in_space, spatial_models, unit_energies

# %%
# A marble bust of three parts on a pedestal: shapes in metres with densities and positions.

pedestal = Part(box(0.60, 0.50, 1.00), 2400.0)
socle = Part(revolution([(0.15, 0.0), (0.10, 0.06), (0.08, 0.12), (0.10, 0.16)]), 2700.0).moved(0.0, 0.0, 1.00)
chest = Part(frustum(0.20, 0.42, 0.30), 2700.0).moved(0.02, 0.0, 1.16)
head = Part(ellipsoid(0.20, 0.18, 0.28, cut_below=0.02), 2700.0).moved(0.03, 0.0, 1.46)
statue = Solid([pedestal, socle, chest, head])

print(f"{statue!r}: centre {statue.centre.round(4)} m")
print(f"principal moments about the centre: {np.linalg.eigvalsh(statue.inertia).round(2)} kg m2")

# %%
# The coefficient from edge to edge with each 3D model, and from one corner to the opposite corner.

for name in spatial_models():
    over = [edge_coefficient(statue, name, start=i) for i in range(4)]
    corner = impact_in_space(statue, [-0.5, 0.6, 0.0], pivot=(-0.3, -0.25), onto=(0.3, 0.25), model=name)
    print(f"{name:24s} edges {', '.join(f'{r:.4f}' for r in over)}; over the diagonal {corner.coefficient:.4f}")
    assert all(0.0 < r < 1.0 for r in over)
    assert corner.energy_after < corner.energy_before

# %%
# The mirrored bust has the same coefficients on the mirrored edges.

here, there = (
    sorted(edge_coefficient(body, "ked-3d", start=i) for i in range(4)) for body in (statue, statue.mirrored())
)
assert np.allclose(here, there, rtol=1e-12, atol=0.0)

# %%
# The energy loss of an impact: by unit, in a vertical slice, and over the height.

edges = statue.base.edges
result = impact_in_space(statue, -edges[3].direction, pivot=edges[3], onto=statue.base.opposite(3), model="ked-3d")
energies = unit_energies(result, 12)
share = [energies.lost[energies.units.part == i].sum() / energies.lost.sum() for i in range(4)]
print("energy lost in pedestal, socle, chest, head:", ", ".join(f"{100.0 * s:.1f} %" for s in share))
exact = result.energy_before - result.energy_after
assert abs(energies.lost.sum() / exact - 1.0) < 0.02  # units of a twelfth of each part: order 2
write(energy_picture(result), "solid_statue.png")

# %%
# The bust under two perpendicular components: the path of its top, its tilt and direction, and its contact.

shaking = {"x": rk.pulses.sine(amplitude=5.4, period=0.7), "y": rk.pulses.cosine(amplitude=5.0, period=0.9)}
response = rk.simulate(statue, shaking, restitution="ked")
print(response.summary)
response.plot("bust_under_two_components.png")
