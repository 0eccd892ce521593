"""From a scan to a 3D response
============================

A mesh in millimetres with wrong face orientations is repaired, and a text file adds a plinth. For conservators and
heritage engineers with scans.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking.bodies.formats import read_body
from rocking.bodies.solid import box, revolution
from rocking.plots import solid_picture, write
from rocking.restitution.space import edge_coefficient, spatial_models

# %%
# A scan file: triangles in millimetres, some with the wrong orientation.

profile = np.array([(0.07, 0.0), (0.06, 0.05), (0.16, 0.30), (0.12, 0.50), (0.14, 0.60)])
vase = revolution(profile)
triangles = np.concatenate([surface.triangles(12) for surface in vase.surfaces()]) * 1000.0
triangles[::50] = triangles[::50, ::-1]


def stl(corners):
    """Text of an STL file."""
    facets = ["vertex {:.9g} {:.9g} {:.9g}".format(*point) for point in corners.reshape(-1, 3).tolist()]
    loops = ["\n".join(facets[i : i + 3]) for i in range(0, len(facets), 3)]
    body = "\n".join(f"facet normal 0 0 0\nouter loop\n{loop}\nendloop\nendfacet" for loop in loops)
    return f"solid vase\n{body}\nendsolid vase\n"


Path("vase.stl").write_text(stl(triangles), encoding="utf-8")

# %%
# The body file: a plinth, and the vase on it, rotated by 30 degrees and 1 cm off the centre.

TOML = """
units = "cm"
name = "vase on a plinth"

[[solid.part]]                # kg/m3, whatever the units
box = { width = 30, depth = 26, height = 90 }
density = 2700

[[solid.part]]
mesh = { file = "vase.stl", units = "mm" }
density = 1900
turned = [{ axis = [0, 0, 1], degrees = 30 }]
at = [1, 0, 90]
"""
Path("vase.toml").write_text(TOML, encoding="utf-8")
found = read_body("vase.toml")
print(f"{found.name}: {found.mass:.2f} kg, centre {found.centre.round(4)} m")
for sentence in found.repairs:
    print("repaired:", sentence)
assert any("reversed" in sentence for sentence in found.repairs)
write(solid_picture(found), "solid_from_a_file.png")

# %%
# Its mass compared with the mass of the profile of the triangles.

alone = read_body("vase.stl", units="mm", density=1900.0)
exact = 1900.0 * vase.moments().mass
print(f"vase alone: {alone.mass:.3f} kg from its triangles, {exact:.3f} kg from its profile")
assert abs(alone.mass / exact - 1.0) < 0.01
assert np.isclose(found.mass, alone.mass + 2700.0 * box(0.30, 0.26, 0.90).moments().mass, rtol=1e-12)

# %%
# Coefficients over the four edges of the plinth.

for name in spatial_models():
    over = [edge_coefficient(found, name, start=i) for i in range(4)]
    print(f"{name:24s} edges {', '.join(f'{r:.4f}' for r in over)}")
    assert all(0.0 < r < 1.0 for r in over)

# %%
# The response under two components.

x, y = rk.pulses.sine(amplitude=3.5, period=0.5), rk.pulses.ricker(amplitude=3.0, period=0.6)
response = rk.simulate(found, {"x": x, "y": y}, "housner")
print(response.summary)
assert response.outcome is not rk.Outcome.FAILED
frame = response.to_dataframe()
assert np.array_equal(frame["tilt [rad]"], response.tilt)
response.plot("vase_under_two_components.png")
