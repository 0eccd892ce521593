"""Impact laboratory
=================

An impact that takes time: what the coefficient of restitution of a contact bed depends on.
"""

import numpy as np

import rocking as rk
from rocking.studies.impact_laboratory import Laboratory, bed_speed_law, study

by_points = study("points", [2, 3, 5, 11, 41])
print("r by contact points   ", by_points.coefficient.round(3).values)

by_speed = study("release", [0.1, 0.3, 0.6], Laboratory(slenderness=3.0))
print("r by landing velocity ", by_speed.coefficient.round(3).values)

# a tenth of a millimetre under a base of 0.2 m
hollow = study("amplitude", [0.0, 1e-4, 1e-3], shape="concave")
print("r by hollow of a base ", hollow.coefficient.round(3).values)

block = rk.Block(width=0.2, height=0.4)
bed = rk.restitution.model("contact-bed", points=41)
print("the same as a model   ", round(bed.coefficient(block), 3))

response = rk.free_rocking(block, 0.2, restitution=bed_speed_law(block, 400.0))
print("impacts of free rocking", len(response.impacts))

# two points are the classical impact, and more points lose less
assert abs(by_points.coefficient.values[0] - 0.7) < 2e-3
assert np.all(np.diff(by_points.coefficient.values[:5]) > 0.0)
assert abs(bed.coefficient(block) - by_points.coefficient.values[-1]) < 0.01
