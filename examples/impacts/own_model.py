"""Own restitution model
=====================

A restitution model is a class with one method. In this example the base has `n` equal facets, and the body lands on one
after the other. For researchers.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write
from rocking.plots.style import look

# %%
# The class contains title, reference and domain. Its method returns the coefficient of a body for a landing on a
# foot. Parameters are fields of a dataclass.


@dataclass(frozen=True)
class Facets(rk.restitution.RestitutionModel):
    """The body rolls over n equal facets: a product of n Housner impacts between neighbouring edges."""

    n: int = 2

    name = "facets"
    title = "rolling over n equal facets"
    reference = "product of Housner impacts, one an edge"
    domain = "symmetric bodies"
    inertia_only = True

    def raw_coefficient(self, body, foot):
        """Multiply (I_h + m x_i x_j) / (I_h + m x_j^2) over successive edges."""
        side = body.side(foot)
        gyration = side.moment_of_inertia / side.mass - side.half_width**2
        edges = [side.half_width * (2.0 * i / self.n - 1.0) for i in range(self.n + 1)]
        r = 1.0
        for before, after in pairwise(edges):
            r *= (gyration + before * after) / (gyration + after**2)
        return r


# %%
# The object replaces a model name: here, in `rk.simulate`, in maps and in fragility curves.

block = rk.Block(width=1.0, height=2.0)
for n in (1, 2, 3, 4):
    print(f"{n} facet(s): r = {rk.coefficient_of_restitution(block, Facets(n)):.10f}")

assert abs(rk.coefficient_of_restitution(block, Facets(1)) - rk.coefficient_of_restitution(block, "housner")) < 1e-14
# one midpoint: r = (4 l^2 + 1) / (4 l^2 + 4)
assert abs(rk.coefficient_of_restitution(block, Facets(2)) - 17.0 / 20.0) < 1e-14

# %%
# One facet is Housner's impact. The energy loss decreases with the number of facets: the limit is a rolling base.

ratio = np.linspace(1.5, 6.0, 40)
with journal_style():
    figure, (axes,) = new_figure(5.0, 3.0)
    for k, n in enumerate((1, 2, 4, 8)):
        r = [rk.coefficient_of_restitution(rk.Block(width=1.0, height=one), Facets(n)) for one in ratio]
        axes.plot(ratio, r, label=f"{n} facet{'s' * (n > 1)}", **look(k))
    axes.set(xlabel="slenderness ratio h/b [-]", ylabel="coefficient of restitution r [-]")
    axes.legend(loc="lower right")
write(figure, "own_model.png")
