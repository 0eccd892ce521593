"""Thousands of simulations in one call
====================================

`rk.simulate_many` varies size, amplitude and model together and returns one labelled dataset. For researchers.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write

# %%
# Forty blocks of one slenderness ratio, from 0.5 m to 8 m high, under one pulse at sixty scale factors, with two
# models.

blocks = [rk.Block(width=0.25 * size, height=size) for size in np.geomspace(0.5, 8.0, 40)]
pulse = rk.pulses.sine(amplitude=1.0, period=0.8)
result = rk.simulate_many(blocks, pulse, ["housner", "ked"], scale=np.linspace(2.5, 12.0, 60))
print(dict(result.sizes))
assert (result.status == 0).all()

# %%
# The dataset is an xarray dataset: select, compare, count.

overturned = (result.outcome == rk.Outcome.OVERTURNED.code).isel(motion=0)
share = overturned.mean(("body", "scale"))
for model in result.restitution.values:
    print(f"{model:8s} overturns {float(share.sel(restitution=model)):.1%} of {overturned[..., 0].size} cases")
flips = overturned.sel(restitution="housner") != overturned.sel(restitution="ked")
print(f"the choice between them decides {int(flips.sum())} cases")
assert float(share.sel(restitution="ked")) >= float(share.sel(restitution="housner"))

# %%
# Each result equals the result of a single simulation, in all bits.

one = rk.simulate(blocks[7], pulse, "ked", scale=float(result.scale[30]))
batch = result.isel(body=7, motion=0, scale=30).sel(restitution="ked")
assert float(abs(batch.peak_rotation)) == one.peak_rotation

# %%
# Large blocks overturn at larger amplitudes. Near the boundary the outcome depends on the model.

with journal_style():
    figure, (axes,) = new_figure(5.0, 3.2)
    height = [block.height for block in blocks]
    shade = overturned.sel(restitution="ked").where(~flips, 2)
    axes.pcolormesh(height, result.scale, shade.T, cmap="OrRd", vmin=0, vmax=3, shading="nearest")
    axes.text(1.0, 9.0, "overturns")
    axes.text(5.0, 3.0, "stands")
    axes.set(xscale="log", xlabel="height [m]", ylabel="peak of the pulse [m/s$^2$]")
    axes.set_xticks([0.5, 1.0, 2.0, 4.0, 8.0], ["0.5", "1", "2", "4", "8"], minor=False)
    axes.minorticks_off()
    axes.set_title("dark: overturns with one of the two models only", loc="left")
write(figure, "many_histories.png")
