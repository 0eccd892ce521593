"""Plain words: one sentence for what an object does, one for what to do about it."""

import math

from rocking.conventions import g
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.verdict import Assessment, DirectionResult, Verdict

SLIDING = (
    "Sliding is not assessed: an object on a smooth floor or shelf may slide before it rocks, "
    "and slide off its support."
)
"""What no verdict covers."""

LIMITS = (
    SLIDING,
    "Objects are rigid and stand freely on a rigid, level floor, at the shaking given: what a building, a pedestal or "
    "a shelf adds to the motion of the ground must be in that shaking.",
    "Each motion acts once along the width and once along the depth; the worse direction counts. Rocking in both "
    "directions at once, twisting and rolling on the rim of a round base are not computed.",
    "Each direction is a rectangle of the outer size, on the base that is given; where no height of the centre of mass "
    "is given it is half the height.",
    "Blows from neighbours, shaking loose, and damage without falling are not assessed.",
)
"""What every report says about the assumptions."""


def sentence(verdict: Verdict, assessment: Assessment) -> str:
    """Return what an object does."""
    hazard = assessment.hazard
    still = f"Stays still up to {_in_g(verdict.uplift_acceleration)}"
    if hazard.vertical:
        still += " of level shaking alone"
    worse = verdict.worse
    at = f"at {hazard.words()}"
    if worse.failed:
        at += f" ({worse.failed} of {worse.count + worse.failed} motions could not be computed)"
    words = f"{still}; {at} {_fate(worse, hazard.synthetic)}"
    if worse.lost_contact:
        words += f"; in {worse.lost_contact} the ground would have to pull, and the verdict assumes contact"
    return f"{words}."


def advice(verdict: Verdict, assessment: Assessment) -> str:
    """Return what to do about an object."""
    if verdict.light is Light.GREEN:
        return "Nothing to do for rocking; check that it cannot slide off."
    how = f"Secure it, lower its centre of mass, or widen its base: {_base(verdict, assessment)}."
    if verdict.light is Light.AMBER:
        return f"{how} Give it room to rock without touching its neighbours."
    return f"{how} Until then keep people and other objects out of its reach."


def model_note(verdict: Verdict, assessment: Assessment) -> str:
    """Return whether the model of impact decides.

    Returns one sentence, empty if both models show the same light.
    """
    if not verdict.model_decides:
        return ""
    other = verdict.worse_compared
    share = f"{other.overturned} of {other.count}"
    return f"The model of impact decides: {assessment.comparison} shows {other.light.word} ({share} overturn)."


def rotation_words(value: float | None) -> str:
    """Return a peak rotation in words.

    value: over the slenderness angle, None if the object overturns [-].
    """
    return "overturns" if value is None else f"{value:.2f}"


def rounded_down(value: float, digits: int) -> str:
    """Return a limit that stays true in print.

    digits: decimals [-]. Returns the largest number of so many decimals that is not above it, but for rounding.

    >>> rounded_down(0.1299, 2), rounded_down(0.3, 2)
    ('0.12', '0.30')
    """
    return f"{math.floor(value * 10**digits + 1e-9) / 10**digits:.{digits}f}"


def _in_g(acceleration: float) -> str:
    return f"{rounded_down(acceleration / g, 2 if acceleration >= 0.1 * g else 3)} g"


def _base(verdict: Verdict, assessment: Assessment) -> str:
    """Return the base that no motion would lift, as ``g b / h`` has it, at the same height of the centre."""
    way, peak = verdict.worse.direction, assessment.hazard.peak()
    now = verdict.item.base(way)
    needed = math.ceil(100.0 * now * peak / verdict.worse.uplift_acceleration - 1e-9)
    own = verdict.item.width if way == "width" else verdict.item.depth
    size = f"{100.0 * now:.3g} cm"
    words = f"its {way} is {size}" if now == own else f"its base is {size} along the {way}"
    return words if assessment.hazard.vertical else f"{words}, and {needed} cm would not be lifted"


def _fate(result: DirectionResult, synthetic: bool) -> str:
    motions = "simulated earthquakes" if synthetic else "records"
    of = f"{result.count} {motions}" if result.count > 1 else f"the one {motions.removesuffix('s')}"
    if result.lifted == 0:
        return f"it stood still in all of {result.count} {motions}" if result.count > 1 else f"it stood still in {of}"
    if result.overturned:
        fell = f"fell over in {result.overturned} of {of}" if result.count > 1 else f"fell over in {of}"
        return f"it rocks, and {fell}"
    high = result.high_rotation or 0.0
    how = "barely rocks" if high < 0.05 else "rocks a little" if high < 0.2 else "rocks"
    none = f"fell over in none of {of}" if result.count > 1 else f"did not fall over in {of}"
    return f"it {how}, and {none}"
