"""Comparison of an own model with all models
==========================================

All models and an own model are compared with the 39 published measurements. The result states the differences that the
data distinguish. For researchers with a new model.
"""

from dataclasses import dataclass

import rocking as rk
from rocking.plots import journal_style, new_figure, write

# %%
# A model with one fitted parameter, as a class.


@dataclass(frozen=True)
class SineFit(rk.restitution.RestitutionModel):
    """The free fit r = 1 - c sin(alpha)^2."""

    c: float = 0.994

    name = "sine-fit"
    title = "1 - c sin(alpha)^2"
    reference = "a one-parameter fit"

    def raw_coefficient(self, body, foot):
        """Return the fit for the body's slenderness."""
        return 1.0 - self.c / (1.0 + body.side(foot).slenderness_ratio ** 2)


# %%
# The comparison: the error of `r`, the error of the logarithm of the energy loss, and the 95 % interval of the
# difference from KED. An interval with zero is not distinguishable. Models with `(...)` have parameters fitted to
# these data.

rows = rk.evidence.league([SineFit()])
for row in rows:
    low, high = row.ahead_of_ked
    print(f"{row.name:28s} RMSE {row.rmse:.4f}  log loss {row.log_loss_rmse:.3f}  minus KED {low:+.4f} to {high:+.4f}")

by_name = {row.name: row for row in rows}
# c = 0.994 is nearly cos^2 alpha, and both are closer to the measurements than KED
assert abs(by_name["sine-fit:c=0.994"].rmse - by_name["horizontal-momentum"].rmse) < 5e-4
assert by_name["sine-fit:c=0.994"].rmse < by_name["ked"].rmse < by_name["housner"].rmse

# %%
# The same as a picture: errors with their intervals, the closest model on top.

with journal_style():
    figure, (axes,) = new_figure(6.0, 3.8)
    for place, row in enumerate(rows):
        color = "#D55E00" if row.name.startswith("sine-fit") else "#222222"
        axes.plot([row.rmse_low, row.rmse_high], [place, place], color=color)
        axes.plot(row.rmse, place, "o", color=color)
    axes.set_yticks(range(len(rows)), [row.name for row in rows])
    axes.invert_yaxis()
    axes.set(xlabel="error of r over 39 measurements (RMSE) [-]", xlim=(0.0, None))
write(figure, "league_with_own_model.png")

# %%
# The comparison in sentences, with its limits.

print(*rk.evidence.verdict(rows), sep="\n")
