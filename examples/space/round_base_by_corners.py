"""Round base as a polygon
=======================

A round base is modelled as a polygon. The error relative to the rolling rim is inversely proportional to the number of
corners. For researchers who model columns and drums.
"""

import numpy as np

import rocking as rk
from rocking.bodies.solid import Part, RoundBase, Solid, box, revolution
from rocking.dynamics import SpatialStart
from rocking.plots import journal_style, new_figure, write
from rocking.restitution.space import edge_coefficient

# %%
# A round statue with an eccentric mass, with an initial tilt and rotation.

profile = [(0.30, 0.0), (0.30, 0.15), (0.18, 0.25), (0.15, 1.2), (0.22, 1.5), (0.10, 1.75)]
parts = [Part(revolution(profile), 2600.0), Part(box(0.25, 0.2, 0.3), 2600.0).moved(0.35, 0.05, 1.1)]
time = np.arange(101) * 0.01
along = rk.GroundMotion(0.30 * np.sin(2.0 * np.pi * time / 0.9), 0.01)
across = rk.GroundMotion(0.225 * np.sin(2.0 * np.pi * time / 0.7 + 0.8), 0.01)
shaking = {"x": along, "y": across}
start = SpatialStart(tilt=0.04, azimuth=0.4, angular_velocity=(0.15, 0.1, 0.1))


def on_corners(count: int) -> Solid:
    """Return the statue on a polygon in its round foot, one edge across the motion."""
    angle = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    return Solid(parts, base=0.3 * np.column_stack([np.cos(angle), np.sin(angle)]))


# %%
# On its rim the statue rolls without an impact. On corners it has repeated impacts with a small energy loss.

drum = Solid(parts, base=RoundBase(np.zeros(2), 0.3))
rim = rk.simulate(drum, shaking, start=start, duration=1.2)
assert rim.still_rocking
energy = rim.energy.kinetic[-1] + rim.energy.potential[-1]
counts = np.array([8, 16, 32, 64])
lacking = {}
for law in ("housner-3d", "ked-3d"):
    rows = []
    for count in counts:
        solid = on_corners(count)
        edge = int(np.argmin([abs(e.direction[0]) - e.point[0] for e in solid.base.edges]))
        run = rk.simulate(solid, shaking, law, start=start, duration=1.2)
        landing = edge_coefficient(solid, law, start=edge) - edge_coefficient(drum, law, start=0.0)
        rows.append((abs(landing), 1.0 - run.peak_tilt / rim.peak_tilt, run.energy.lost[-1] / energy))
    lacking[law] = np.array(rows)
    for n, (_, peak, lost) in zip(counts, rows, strict=True):
        print(f"{law:10s} {n:3d} corners: peak tilt lower by {peak:6.2%}, energy lost {lost:6.2%}")
    assert (np.diff(lacking[law], axis=0) < 0.0).all()  # ever nearer to the rim
    assert lacking[law][-1, 1:].max() < 0.04

# %%
# The error of one landing decreases with the square of the number of corners. The error of a complete rotation
# decreases with the number.

with journal_style():
    figure, axes = new_figure(7.0, 2.4, columns=3)
    for panel, k, name in zip(axes, range(3), ("coefficient of a landing", "peak tilt", "energy lost"), strict=True):
        for law, marker in (("housner-3d", "s"), ("ked-3d", "o")):
            panel.loglog(counts, lacking[law][:, k], marker=marker, label=law)
        panel.set_xticks(counts, [str(n) for n in counts])
        panel.minorticks_off()
        panel.set(xlabel="corners of the base [-]", title=name)
    axes[0].set_ylabel("distance from the rim [-]")
    axes[0].legend()
write(figure, "round_base_by_corners.png")
