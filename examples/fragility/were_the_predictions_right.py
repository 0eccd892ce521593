"""Comparison of predictions with outcomes
=======================================

The outcomes of 180 trials of one body are known. Were the predicted probabilities calibrated, and were they better than
a curve in PGA and PGV? For users with shaking-table tests or observations after an earthquake.

The trials of this example are simulations with friction, feet and restitution that the prediction does not use.
"""

# %%
# Each trial has its own motion. The outcomes are computed with one hidden friction, chipped feet, and one coefficient
# per trial.

import numpy as np

import rocking as rk
from rocking.decision.prediction import score
from rocking.motions.integrals import peak_ground_velocity
from rocking.plots import reliability_picture, write

random = np.random.default_rng(4)
body = rk.Block(width=0.4, height=1.6)
shapes = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.ricker)
motions = [shapes[k % 3](random.uniform(1.5, 7.0), random.uniform(0.3, 1.4)).sampled(0.01) for k in range(180)]


def tried(motion):
    """Return whether a body with what is hidden of it overturned."""
    left, right = random.uniform(0.0, 0.02, 2)
    truly = body.with_feet(body.feet[0] + left, body.feet[1] - right)
    friction, restitution = random.uniform(0.1, 0.8), random.uniform(0.85, 0.93)
    found = rk.simulate_many(truly, motion, restitution, friction=friction, scale=random.choice([-1.0, 1.0]))
    return float(found.overturned.item())


fell = np.array([tried(motion) for motion in motions])
print(f"{fell.sum():.0f} of {fell.size} overturned")

# %%
# The prediction uses ranges only. `score` compares it with a logistic curve in PGA and PGV and with the base rate.
# Both are fitted to the outcomes under all other motions. The prediction is not fitted.

known = {"friction": (0.1, 0.8), "base": (0.0, 0.02), "restitution": (0.85, 0.93), "centre": 1.0}
known |= {"offset": 0.0, "level": 0.0, "model_error": "off"}
foreseen = rk.predict(body, motions, **known, count=32, contributions=False)
pga, pgv = [motion.peak for motion in motions], [peak_ground_velocity(motion) for motion in motions]
said = foreseen.chances["overturning"].per_motion
found = score(said, fell, range(180), pga=pga, pgv=pgv, count=foreseen.count)
print(found)

# %%
# Points on the dashed line are calibrated. The prediction is better to the right of zero. A bar across zero is not
# distinguishable.

write(reliability_picture(found), "were_the_predictions_right.png")
assert found.finding == "better"

# %%
# With the first twenty trials only, the prediction and the curve are not distinguishable.

few = slice(20)
first = score(said[few], fell[few], range(20), pga=pga[few], pgv=pgv[few], count=foreseen.count)
print(first)
assert first.finding == "not resolved"

# %%
# Negative control: the same probabilities with the outcomes of other trials. The verdict states that the prediction
# is not better.

shuffled = score(said, random.permutation(fell), range(180), pga=pga, pgv=pgv, count=foreseen.count)
print(shuffled.verdict)
assert shuffled.finding == "worse"
