"""Coefficient of a block
======================

The coefficient of restitution of a concrete block under every model, and what each value implies.
"""

import rocking as rk

block = rk.Block(width=1.0, height=4.0, depth=1.0, density=2400.0)
print(f"h/b = {block.slenderness_ratio:g}, p = {block.frequency_parameter:.4f} rad/s")

for name in ("housner", "ked", "horizontal-momentum", "shifted-impulse", "distributed-impulse", "plastic-winkler"):
    r = rk.coefficient_of_restitution(block, name)
    meaning = rk.restitution.implied(block, r)
    print(f"{name:20s} r = {r:.6f}  impulse at k = {meaning.impulse_ratio:.3f}  loss = {meaning.energy_loss:.2%}")

# Mao et al. 2024, Table 2, h/b = 4; Housner 1963 gives 1 - 1.5 sin(alpha)^2 = 31/34
assert abs(rk.coefficient_of_restitution(block, "ked") - 0.94736684) < 5e-9
assert abs(rk.coefficient_of_restitution(block, "housner") - 31.0 / 34.0) < 1e-12
