"""Own model
=========

A restitution model of your own is one class; here the base is a fan of n equal facets (multi-step impact).
"""

from dataclasses import dataclass
from itertools import pairwise

import rocking as rk


@dataclass(frozen=True)
class Facets(rk.restitution.RestitutionModel):
    """The body rolls over n equal facets: a product of n Housner impacts between neighbouring edges."""

    n: int = 2

    name = "facets"
    title = "rolling over n equal facets"
    reference = "product of Housner impacts, one an edge"
    domain = "symmetric bodies"
    inertia_only = True

    def raw_coefficient(self, body, onto):
        """Multiply (I_h + m x_i x_j) / (I_h + m x_j^2) over successive edges."""
        side = body.side(onto)
        gyration = side.moment_of_inertia / side.mass - side.half_width**2
        edges = [side.half_width * (2.0 * i / self.n - 1.0) for i in range(self.n + 1)]
        r = 1.0
        for before, after in pairwise(edges):
            r *= (gyration + before * after) / (gyration + after**2)
        return r


block = rk.Block(width=1.0, height=2.0)
for n in (1, 2, 3, 4):
    print(f"{n} facet(s): r = {rk.coefficient_of_restitution(block, Facets(n)):.10f}")

assert abs(rk.coefficient_of_restitution(block, Facets(1)) - rk.coefficient_of_restitution(block, "housner")) < 1e-14
# one midpoint: r = (4 l^2 + 1) / (4 l^2 + 4)
assert abs(rk.coefficient_of_restitution(block, Facets(2)) - 17.0 / 20.0) < 1e-14
