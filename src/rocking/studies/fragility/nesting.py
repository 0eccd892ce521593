"""Whether a worse state is anywhere likelier than a lesser one, which curves of unlike dispersion always claim."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from rocking.errors import InvalidValueError
from rocking.studies.fragility.curves import FragilityModel, with_common_dispersion
from rocking.studies.fragility.ordered import difference_extremes

Crossing = Literal["refuse", "common-dispersion"]
CROSSING: tuple[Crossing, ...] = ("refuse", "common-dispersion")

TOLERANCE = 1e-6
"""Largest probability by which a worse state may be likelier than a lesser one in a file [-]."""


@dataclass(frozen=True)
class Excess:
    """Where the curve of a worse state lies highest above that of a lesser one."""

    lesser: str  # lesser, worse: names of the states
    worse: str
    level: float  # where [unit of the measure]
    size: float  # by how much [-]


def largest_excess(model: FragilityModel, lowest: float, highest: float) -> Excess | None:
    """Return where neighbouring curves are most out of order.

    lowest, highest: levels between which they are compared, >= 0 [unit of the measure]. Returns none if no curve is
    above the one before it.
    """
    found = None
    for lesser, worse in zip(model.curves[:-1], model.curves[1:], strict=True):
        with np.errstate(over="ignore", under="ignore"):
            extremes = np.exp(difference_extremes(*((c.median, c.dispersion) for c in (lesser, worse))))
        places = np.array([lowest, highest, *extremes[(extremes > lowest) & (extremes < highest)]])
        apart = worse.probability(places) - lesser.probability(places)
        k = int(np.argmax(apart))
        if apart[k] > (0.0 if found is None else found.size):
            found = Excess(lesser.state, worse.state, float(places[k]), float(apart[k]))
    return found


def nested(model: FragilityModel, crossing: Crossing = "refuse", highest: float | None = None) -> FragilityModel:
    """Return curves that may be written: no worse state is likelier than a lesser one.

    highest: largest level that readers of the file take; `FragilityModel.highest`, if not given [unit of the measure].
    Returns the model itself if its curves do not cross, or the one with common dispersion if that was asked for.
    """
    check_crossing(crossing)
    if crossing == "common-dispersion":
        return with_common_dispersion(model)
    worst = largest_excess(model, model.uplift_threshold or 0.0, model.highest if highest is None else highest)
    if worst is None or worst.size <= TOLERANCE:
        return model
    raise InvalidValueError(
        f"curves must not cross, but at {worst.level:.4g} {model.unit} {worst.worse!r} would be likelier than"
        f" {worst.lesser!r} by {worst.size:.2g}, at most {TOLERANCE:g} is allowed; their dispersions differ:"
        ' crossing="common-dispersion" fits one for all states'
    )


def check_crossing(crossing: Any) -> None:
    """Refuse what is no way to treat curves that cross."""
    if crossing not in CROSSING:
        raise InvalidValueError(f"crossing must be one of {', '.join(CROSSING)}, got {crossing!r:.60}")
