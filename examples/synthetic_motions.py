"""Synthetic motions by seed: three models, and the same bits for the same seed."""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking.motions import intensity_measures, response_spectrum, significant_duration
from rocking.plots.style import new_figure, write

modulation = rk.synthetic.modulation_from_intensity(arias_intensity=1.0, significant_duration=12.0, middle=8.0)
motions = [
    rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1),
    rk.synthetic.point_source_motion(rk.synthetic.PointSource(magnitude=6.8, distance=12e3), seed=1),
    rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=1),
]
figure, axes = new_figure(7.0, 6.0, rows=4)
periods = np.geomspace(0.05, 4.0, 50)
for axis, motion in zip(axes, motions, strict=False):
    measures = intensity_measures(motion)
    print(f"{motion.name:40s} PGA {measures['pga'].value:.3g} m/s2, Arias {measures['arias'].value:.3g} m/s")
    axis.plot(motion.time, motion.acceleration, linewidth=0.5)
    axis.set_title(motion.name, loc="left", fontsize=7)
    axis.set_ylabel("m/s2")
    axes[3].plot(periods, response_spectrum(motion, periods).pseudo_acceleration, label=motion.name)
axes[2].set_xlabel("time [s]")
axes[3].set(xlabel="period [s]", ylabel="Sa [m/s2]")
axes[3].legend(fontsize=6)

again = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1)
assert (again.acceleration == motions[0].acceleration).all()
other = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=2)
assert not (again.acceleration == other.acceleration).all()
# one motion scatters about the duration asked for
assert 6.0 < significant_duration(motions[0]) < 24.0
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(figure, folder / "synthetic_motions.png")
