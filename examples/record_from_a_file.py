"""Record from a file
==================

From a record file to a response: read, look, scale, compute, write for MATLAB and spreadsheets.

The file is a synthetic motion written in PEER's format, since no real record comes with the package.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking import conventions
from rocking.motions import intensity_measures, response_spectrum, scaled_to
from rocking.motions.formats import write_motion
from rocking.plots import ground_motion_picture, write

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
made = rk.synthetic.point_source_motion(rk.synthetic.PointSource(magnitude=6.5, distance=15e3), seed=4)
write_motion(made, folder / "synthetic.AT2", format="peer", units="g")

motion = rk.read_motion(folder / "synthetic.AT2")  # the format is recognised, the unit is what the file states
print(motion.name, f"{motion.duration:.2f} s at {motion.time_step} s, {motion.metadata['unit']}")
assert np.allclose(motion.acceleration, made.acceleration, rtol=1e-6, atol=1e-7 * motion.peak)  # 7 digits in the file

for measure in intensity_measures(motion).values():
    print(f"  {measure.name:30s} {measure.value:9.4g} {measure.unit}")
spectrum = response_spectrum(motion, np.geomspace(0.05, 4.0, 60))
print(f"  largest Sa {spectrum.pseudo_acceleration.max():.3g} m/s2")
write(ground_motion_picture(motion), folder / "record.png")

stele = rk.examples.body("stele")
response = rk.simulate(stele, scaled_to(motion, "pga", 0.4 * conventions.g), restitution="ked")
print(response.summary)
response.to_csv(folder / "response.csv")
assert len((folder / "response.csv").read_text(encoding="utf-8").splitlines()) > response.time.size
