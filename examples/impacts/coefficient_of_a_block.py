"""Coefficient of restitution of a concrete block
==============================================

Each restitution model gives another coefficient for the impact of a block. For engineers who need one coefficient and
the range of the models.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write
from rocking.plots.style import model_styles

# %%
# A block has full sizes [m] and a density [kg/m3]. The slenderness ratio `h/b` determines the energy loss, and the
# frequency parameter `p` the rate of rocking.

block = rk.Block(width=1.0, height=4.0, depth=1.0, density=2400.0)
print(f"h/b = {block.slenderness_ratio:g}, p = {block.frequency_parameter:.4f} rad/s")

# %%
# The coefficient `r` is the angular velocity after the impact / before the impact. Each value implies a position of
# the impulse, from `k = 0` at the centre of the base to `k = 1` at the new edge, and an energy loss.

for name in ("housner", "ked", "horizontal-momentum", "shifted-impulse", "distributed-impulse", "plastic-winkler"):
    r = rk.coefficient_of_restitution(block, name)
    meaning = rk.restitution.implied(block, r)
    print(f"{name:20s} r = {r:.6f}  impulse at k = {meaning.impulse_ratio:.3f}  loss = {meaning.energy_loss:.2%}")

# Mao et al. 2024, Table 2, h/b = 4; Housner 1963 gives 1 - 1.5 sin(alpha)^2 = 31/34
assert abs(rk.coefficient_of_restitution(block, "ked") - 0.94736684) < 5e-9
assert abs(rk.coefficient_of_restitution(block, "housner") - 31.0 / 34.0) < 1e-12

# %%
# Other blocks, from squat to slender. Near `h/b = 2` the classical model has a much larger energy loss than the other
# models.

ratio = np.linspace(1.5, 8.0, 200)
with journal_style():
    figure, (axes,) = new_figure(5.0, 3.2)
    for name, style in model_styles().items():
        axes.plot(ratio, rk.restitution.model(name).of_slenderness(ratio), **style)
    axes.axvline(block.slenderness_ratio, color="grey", linewidth=0.7)
    axes.set(xlabel="slenderness ratio h/b [-]", ylabel="coefficient of restitution r [-]")
    axes.legend(loc="lower right")
write(figure, "coefficient_of_a_block.png")
