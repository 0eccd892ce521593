"""Synthetic motions
=================

Three stochastic models create ground motions from a random seed. The same seed gives the same motion on each computer.
For teachers, developers, and studies with many motions.
"""

import numpy as np

import rocking as rk
from rocking.motions import intensity_measures, response_spectrum, significant_duration
from rocking.plots import journal_style, new_figure, write
from rocking.plots.style import COLORS, look

# %%
# One model has intensity and duration as input, one magnitude and distance, and one the soil.

modulation = rk.synthetic.modulation_from_intensity(arias_intensity=1.0, significant_duration=12.0, middle=8.0)
motions = [
    rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1),
    rk.synthetic.point_source_motion(rk.synthetic.PointSource(magnitude=6.8, distance=12e3), seed=1),
    rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=1),
]
for motion in motions:
    measures = intensity_measures(motion)
    print(f"{motion.name:40s} PGA {measures['pga'].value:.3g} m/s2, Arias {measures['arias'].value:.3g} m/s")

# %%
# The seed determines the motion.

again = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1)
assert (again.acceleration == motions[0].acceleration).all()
other = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=2)
assert not (again.acceleration == other.acceleration).all()
# one motion scatters about the duration asked for
assert 6.0 < significant_duration(motions[0]) < 24.0

# %%
# The motions and their spectra.

periods = np.geomspace(0.05, 4.0, 50)
with journal_style():
    figure, axes = new_figure(5.0, 4.8, rows=4, height_ratios=[1.0, 1.0, 1.0, 1.8])
    for place, motion in enumerate(motions):
        axes[place].plot(motion.time, motion.acceleration, linewidth=0.5, color=COLORS[place])
        axes[place].set_title(motion.name, loc="left")
        axes[place].set_xlim(0.0, max(each.duration for each in motions))
        axes[place].tick_params(labelbottom=place == 2)
        spectrum = response_spectrum(motion, periods).pseudo_acceleration
        axes[3].plot(periods, spectrum, label=motion.name.removeprefix("synthetic, "), **look(place))
    axes[1].set_ylabel("ground acceleration [m/s$^2$]")
    axes[2].set_xlabel("time [s]")
    axes[3].set(xlabel="period [s]", ylabel="Sa, 5 % [m/s$^2$]", ylim=(0.0, None))
    axes[3].legend()
write(figure, "synthetic_motions.png")
