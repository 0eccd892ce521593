"""From a record file to a response
================================

A record file gives a response and a table for Excel or MATLAB. The program recognises fourteen formats by content.
For engineers with records from a database.
"""

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.motions import intensity_measures, response_spectrum, scaled_to
from rocking.motions.formats import write_motion
from rocking.plots import ground_motion_picture, write

# %%
# The package contains no real record. Therefore a synthetic motion is first written in the PEER format.

made = rk.synthetic.point_source_motion(rk.synthetic.PointSource(magnitude=6.5, distance=15e3), seed=4)
write_motion(made, "synthetic.AT2", format="peer", units="g")

# %%
# The reader needs the file name only. It recognises the format, and the unit is in the file.

motion = rk.read_motion("synthetic.AT2")
print(motion.name, f"{motion.duration:.2f} s at {motion.time_step} s, {motion.metadata['unit']}")
assert np.allclose(motion.acceleration, made.acceleration, rtol=1e-6, atol=1e-7 * motion.peak)  # 7 digits in the file

# %%
# The intensity measures and the response spectrum.

for measure in intensity_measures(motion).values():
    print(f"  {measure.name:30s} {measure.value:9.4g} {measure.unit}")
spectrum = response_spectrum(motion, np.geomspace(0.05, 4.0, 60))
print(f"  largest Sa {spectrum.pseudo_acceleration.max():.3g} m/s2")
write(ground_motion_picture(motion), "record_from_a_file.png")

# %%
# Scaled to a peak of 0.4 g, the motion acts on a stele from a body file. The table has one row per sample, with units
# in its header.

stele = rk.examples.body("stele")
response = rk.simulate(stele, scaled_to(motion, "pga", 0.4 * conventions.g), restitution="ked")
print(response.summary)
table = response.to_csv("response.csv")
assert len(table.read_text(encoding="utf-8").splitlines()) > response.time.size

# %%
# The response: ground motion, rotation, velocity, energy, and friction demand.

response.plot("response_of_the_stele.png")
