"""Synthetic motions
=================

Synthetic motions by seed: three models, and the same bits for the same seed.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking.motions import intensity_measures, response_spectrum, significant_duration
from rocking.plots import write
from rocking.plots.style import COLORS, SINGLE, in_journal_style, look, new_figure

modulation = rk.synthetic.modulation_from_intensity(arias_intensity=1.0, significant_duration=12.0, middle=8.0)
motions = [
    rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1),
    rk.synthetic.point_source_motion(rk.synthetic.PointSource(magnitude=6.8, distance=12e3), seed=1),
    rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=1),
]
periods = np.geomspace(0.05, 4.0, 50)


@in_journal_style
def draw():
    """Draw every motion, and the spectra of all."""
    figure, axes = new_figure(SINGLE, 4.6, rows=4, height_ratios=[1.0, 1.0, 1.0, 1.6])
    for place, motion in enumerate(motions):
        axes[place].plot(motion.time, motion.acceleration, linewidth=0.4, color=COLORS[place])
        axes[place].set_title(motion.name, loc="left", fontsize=7)
        axes[place].set_xlim(0.0, max(each.duration for each in motions))
        axes[place].tick_params(labelbottom=place == 2)
        spectrum = response_spectrum(motion, periods).pseudo_acceleration
        axes[3].plot(periods, spectrum, label=motion.name.removeprefix("synthetic, "), **look(place))
    axes[1].set_ylabel("ground acceleration [m/s$^2$]")
    axes[2].set_xlabel("time [s]")
    axes[3].set_xlabel("period [s]")
    axes[3].set_ylabel("Sa, 5 % [m/s$^2$]")
    axes[3].set_ylim(bottom=0.0)
    axes[3].legend()
    return figure


for motion in motions:
    measures = intensity_measures(motion)
    print(f"{motion.name:40s} PGA {measures['pga'].value:.3g} m/s2, Arias {measures['arias'].value:.3g} m/s")

again = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=1)
assert (again.acceleration == motions[0].acceleration).all()
other = rk.synthetic.nonstationary_motion(modulation, rk.synthetic.NonstationaryFilter(), seed=2)
assert not (again.acceleration == other.acceleration).all()
# one motion scatters about the duration asked for
assert 6.0 < significant_duration(motions[0]) < 24.0
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(draw(), folder / "synthetic_motions.png")
