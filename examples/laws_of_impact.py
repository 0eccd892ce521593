"""Laws of impact
==============

Coefficients by side, by velocity, and drawn anew for every impact: what they do to one response.
"""

import numpy as np

import rocking as rk

block = rk.Block(width=0.5, height=2.0)
shaking = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=7)
shaking = rk.motions.bandpassed(rk.motions.scaled_to(shaking, "pga", 5.0), 0.2, 8.0)

by_side = rk.simulate(block, shaking, restitution={"left": 0.80, "right": 0.95})
print("by side:    ", by_side.summary)
onto = by_side.impacts["onto"]
assert set(by_side.impacts["coefficient"][onto == "left"]) == {0.80}

harder = rk.dynamics.SpeedRestitution(at=[0.0, 0.2, 1.0], factors=[1.0, 0.97, 0.90], times="housner")
by_speed = rk.simulate(block, shaking, restitution=harder)
print("by velocity:", by_speed.summary)
fast = np.abs(by_speed.impacts["velocity_before"])
assert (np.diff(by_speed.impacts["coefficient"][np.argsort(fast)]) <= 0.0).all()

drawn = rk.dynamics.RandomRestitution.normal(0.9, 0.03, seed=11)
drawn_responses = [rk.simulate(block, shaking, restitution=drawn, stream=stream) for stream in range(100)]
falls = sum(response.outcome is rk.Outcome.OVERTURNED for response in drawn_responses)
print(f"drawn:       overturned in {falls} of 100 draws of the same distribution")
assert 0 < falls < 100
again = rk.simulate(block, shaking, restitution=drawn, stream=5)
assert (again.rotation == drawn_responses[5].rotation).all()  # the same seed and key, the same draws
