"""Impact laws
===========

The coefficient of restitution can differ between the sides, depend on the speed, or be random. For researchers who
measured such effects.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write
from rocking.plots.style import look

# %%
# A block under one synthetic motion, filtered and scaled to 5 m/s2.

block = rk.Block(width=0.5, height=2.0)
shaking = rk.synthetic.kanai_tajimi_motion(rk.synthetic.KanaiTajimi(density=0.01), seed=7)
shaking = rk.motions.bandpassed(rk.motions.scaled_to(shaking, "pga", 5.0), 0.2, 8.0)

# %%
# Dependence on the side: the left foot has a larger energy loss.

by_side = rk.simulate(block, shaking, restitution={"left": 0.80, "right": 0.95})
print("by side:    ", by_side.summary)
foot = by_side.impacts["foot"]
assert set(by_side.impacts["coefficient"][foot == "left"]) == {0.80}

# %%
# Dependence on the speed: a faster impact has a larger energy loss.

harder = rk.dynamics.SpeedRestitution(at=[0.0, 0.2, 1.0], factors=[1.0, 0.97, 0.90], times="housner")
by_speed = rk.simulate(block, shaking, restitution=harder)
print("by velocity:", by_speed.summary)
fast = np.abs(by_speed.impacts["velocity_before"])
assert (np.diff(by_speed.impacts["coefficient"][np.argsort(fast)]) <= 0.0).all()

# %%
# Random coefficients: one hundred simulations with samples of the same distribution. The same seed and stream give
# the same samples.

drawn = rk.dynamics.RandomRestitution.normal(0.9, 0.03, seed=11)
drawn_responses = [rk.simulate(block, shaking, restitution=drawn, stream=stream) for stream in range(100)]
falls = sum(response.outcome is rk.Outcome.OVERTURNED for response in drawn_responses)
print(f"drawn:       overturned in {falls} of 100 draws of the same distribution")
assert 0 < falls < 100
again = rk.simulate(block, shaking, restitution=drawn, stream=5)
assert (again.rotation == drawn_responses[5].rotation).all()

# %%
# Above: all samples. Below: the two other laws. With a scatter of 3 % per impact the outcome of one motion is random.

with journal_style():
    figure, (above, below) = new_figure(6.0, 3.8, rows=2, sharex=True)
    for response in drawn_responses:
        fell = response.outcome is rk.Outcome.OVERTURNED
        above.plot(response.time, response.rotation, color="#D55E00" if fell else "#0072B2", linewidth=0.4, alpha=0.5)
    for k, (response, words) in enumerate(((by_side, "by side"), (by_speed, "by speed"))):
        below.plot(response.time, response.rotation, label=words, **look(k))
    above.set_title(f"drawn anew at every impact: {falls} overturn, {100 - falls} stand", loc="left")
    for axes in (above, below):
        axes.axhline(block.slenderness_angle, color="grey", linewidth=0.7)
        axes.axhline(-block.slenderness_angle, color="grey", linewidth=0.7)
        axes.set(ylim=(-0.4, 0.4), xlim=(0.0, shaking.duration), ylabel="rotation [rad]")
    below.legend(ncols=2)
    below.set_xlabel("time [s]")
write(figure, "laws_of_impact.png")
