"""Coefficients by side, by velocity, and drawn anew for every impact: what they do to one response."""

import numpy as np

import rocking as rk

block = rk.Block(width=0.5, height=2.0)
shaking = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=7)
shaking = rk.motions.bandpassed(rk.motions.scaled_to_pga(shaking, 5.0), 0.2, 8.0)

by_side = rk.simulate(block, shaking, restitution={"left": 0.80, "right": 0.95})
print("by side:    ", by_side.summary)
onto = by_side.impacts["onto"]
assert set(by_side.impacts["coefficient"][onto == "left"]) == {0.80}

harder = rk.SpeedRestitution(at=[0.0, 0.2, 1.0], factors=[1.0, 0.97, 0.90], times="housner")
by_speed = rk.simulate(block, shaking, restitution=harder)
print("by velocity:", by_speed.summary)
fast = np.abs(by_speed.impacts["velocity_before"])
assert (np.diff(by_speed.impacts["coefficient"][np.argsort(fast)]) <= 0.0).all()

drawn = rk.RandomRestitution.normal(0.9, 0.03, seed=11)
peaks = [rk.simulate(block, shaking, restitution=drawn, key=key).peak_rotation for key in range(100)]
spread = np.quantile(np.degrees(peaks), [0.05, 0.5, 0.95])
print(f"drawn:       peak rotation {spread[1]:.3f} degrees, 90 % between {spread[0]:.3f} and {spread[2]:.3f}")
assert spread[0] < spread[1] < spread[2]
again = rk.simulate(block, shaking, restitution=drawn, key=5).peak_rotation
assert again == peaks[5]  # the same seed and key, the same draws
