"""A cabinet under one sine pulse: does the choice of the restitution model change the verdict?"""

from pathlib import Path

import rocking as rk
from rocking.plots import response_picture, write

cabinet = rk.Block(width=0.6, height=2.0, depth=0.5, density=300.0)
pulse = rk.pulses.sine(amplitude=7.6, period=0.5)

folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
verdicts = {}
for model in ("housner", "ked", "horizontal-momentum"):
    response = rk.simulate(cabinet, pulse, restitution=model)
    verdicts[model] = response.outcome
    print(f"{model:20s} r = {response.rocker.right.coefficient:.3f}: {response.summary}")
assert response.energy.closure < 1e-10

write(response_picture(rk.simulate(cabinet, pulse, restitution="ked")), folder / "response_to_a_pulse.png")
assert verdicts["housner"] is rk.Outcome.ROCKED
assert verdicts["ked"] is rk.Outcome.OVERTURNED
