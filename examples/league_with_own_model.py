"""League with own model
=====================

A model of your own among all the others, against the 39 published measurements.
"""

from dataclasses import dataclass

import rocking as rk


@dataclass(frozen=True)
class SineFit(rk.restitution.RestitutionModel):
    """The free fit r = 1 - c sin(alpha)^2."""

    c: float = 0.994

    name = "sine-fit"
    title = "1 - c sin(alpha)^2"
    reference = "a one-parameter fit"

    def raw_coefficient(self, body, onto):
        """Return the fit for the body's slenderness."""
        return 1.0 - self.c / (1.0 + body.side(onto).slenderness_ratio ** 2)


rows = rk.evidence.league([SineFit()])
for row in rows:
    low, high = row.ahead_of_ked
    print(f"{row.name:28s} RMSE {row.rmse:.4f}  log loss {row.log_loss_rmse:.3f}  minus KED {low:+.4f} to {high:+.4f}")

by_name = {row.name: row for row in rows}
# c = 0.994 is nearly cos^2 alpha, and both are closer to the measurements than KED
assert abs(by_name["sine-fit:c=0.994"].rmse - by_name["horizontal-momentum"].rmse) < 5e-4
assert by_name["sine-fit:c=0.994"].rmse < by_name["ked"].rmse < by_name["housner"].rmse

print(*rk.evidence.verdict(rows), sep="\n")
