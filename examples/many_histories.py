"""Many histories
==============

Thousands of histories in one call: sizes, amplitudes and restitution models, as one labelled dataset.
"""

import numpy as np

import rocking as rk

blocks = [rk.Block(width=0.25 * size, height=size) for size in np.geomspace(0.5, 8.0, 40)]
pulse = rk.pulses.sine(amplitude=1.0, period=0.8)
result = rk.simulate_many(blocks, pulse, ["housner", "ked"], scale=np.linspace(2.5, 12.0, 60))
print(dict(result.sizes))

overturned = (result.outcome == rk.Outcome.OVERTURNED.code).isel(motion=0)
share = overturned.mean(("body", "scale"))
for model in result.restitution.values:
    print(f"{model:8s} overturns {float(share.sel(restitution=model)):.1%} of {overturned[..., 0].size} cases")
flips = int((overturned.sel(restitution="housner") != overturned.sel(restitution="ked")).sum())
print(f"the choice between them decides {flips} cases")
assert float(share.sel(restitution="ked")) >= float(share.sel(restitution="housner"))
assert (result.status == 0).all()

one = rk.simulate(blocks[7], pulse, "ked", scale=float(result.scale[30]))
batch = result.isel(body=7, motion=0, scale=30).sel(restitution="ked")
assert float(abs(batch.peak_rotation)) == one.peak_rotation  # the same bits, alone or in company
