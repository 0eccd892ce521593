"""Stable poses of a body
======================

The stable poses of a bust and the rise of the centre of mass to leave its pose in each direction. For conservators and
engineers with small or uncertain bases.
"""

import numpy as np

import rocking as rk
from rocking.bodies.equilibria import base_tolerances
from rocking.plots import equilibria_picture, write

# %%
# A bust on its pedestal. Stable poses are facets of its convex hull, saddles are edges, summits are corners. Their
# numbers satisfy stable - saddles + summits = 2.

bust = rk.examples.body("bust")
found = bust.equilibria()
print(f"{len(found.stable)} stable poses, {len(found.saddles)} saddles, {len(found.summits)} summits")
assert len(found.stable) - len(found.saddles) + len(found.summits) == 2

# %%
# The current pose and its lowest passes: rise of the centre of mass, and the energy.

standing = found.settling([0.0, 0.0, -1.0])
for way in found.neighbours(standing):
    print(f"into pose {way.end}: {1e3 * way.rise:.1f} mm, {way.energy:.0f} J, at {np.rad2deg(way.tilt):.1f} degrees")
    assert way.rise >= standing.barrier

# %%
# In a straight tilt to one side the centre of mass rises more than on the lowest path into the same pose.

azimuths = np.deg2rad(np.arange(0.0, 360.0, 45.0))
straight = found.barrier(standing, azimuths)
lowest = found.barrier(standing, azimuths, path="lowest")
print("straight [mm]:", (1e3 * straight).round(1), "lowest [mm]:", (1e3 * lowest).round(1))
print("lifts at [m/s2]:", standing.uplift_acceleration(azimuths).round(2))
assert (straight >= lowest - 1e-12).all()

# %%
# The effect of points close to the ground, which is often the largest uncertainty.

for row in base_tolerances(found, standing):
    print(f"within {1e3 * row.tolerance:3.1f} mm: {row.points} points, lifts at {row.uplift_acceleration:.2f} m/s2")
    assert row.edge_distance >= standing.edge_distances.min() - 1e-12

# %%
# The height of the centre of mass around this pose, the support polygon, and the bust on it.

write(equilibria_picture(bust, standing, equilibria=found), "ways_a_body_can_stand.png")

# %%
# In its lowest pose the bust is a usual body for a simulation.

lying = bust.settled(found.stable[0])
print(f"lying: centre {lying.centre[2]:.3f} m high instead of {bust.centre[2]:.3f} m")
assert lying.centre[2] < bust.centre[2]
