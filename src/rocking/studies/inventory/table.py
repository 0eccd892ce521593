"""The ranked table: as plain values for JSON, as text for CSV and spreadsheets."""

import csv
import io
import math
from typing import Any

from rocking.conventions import g
from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.lights import Light
from rocking.tables import escaped

HEADER = (
    "rank", "light", "name", "count", "row", "worse direction", "uplift acceleration [g]", "motions", "lifted",
    "overturned", "overturned, low [%]", "overturned, high [%]", "median rotation / angle", "84 % rotation / angle",
    "light by other models", "in words", "what to do", "note",
)  # fmt: skip
"""Columns of the table in files."""


def rows(assessment: Assessment) -> list[list[str | float | int]]:
    """Return one row an object, by `HEADER`, the worst first, those without a verdict last; formulas are escaped."""
    lines: list[list[str | float | int]] = []
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        worse, item, (low, high) = verdict.worse, verdict.item, verdict.interval
        others = "; ".join(f"{name}: {word}" for name, word in _lights(verdict, assessment).items())
        rotations = (
            rotation_words(each) if each is None else round(each, 3)
            for each in (worse.median_rotation, worse.high_rotation)
        )
        lines.append([
            rank, f"{verdict.light.value} {verdict.light.word}", escaped(item.name), item.count, item.row,
            worse.direction, round(verdict.uplift_acceleration / g, 4), worse.count, worse.lifted, worse.overturned,
            round(100.0 * low, 2), round(100.0 * high, 2), *rotations, others,
            sentence(verdict, assessment),
            f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip(), escaped(item.note),
        ])  # fmt: skip
    for refused in assessment.not_assessed:
        line: list[str | float | int] = [""] * len(HEADER)
        line[1], line[2], line[4] = "not assessed", escaped(refused.name), refused.row
        line[HEADER.index("in words")] = f"not assessed: {refused.reason}"
        lines.append(line)
    return lines


def as_csv(assessment: Assessment) -> str:
    """Return the table as CSV; its last line names the columns of the list that were not read, if any."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(HEADER)
    writer.writerows(rows(assessment))
    if assessment.ignored:
        note = f"columns of the list that were not read: {', '.join(assessment.ignored)}"
        writer.writerow([note if title == "in words" else "" for title in HEADER])
    return text.getvalue()


def as_plain(assessment: Assessment) -> dict[str, Any]:
    """Return everything as plain values, for JSON: SI units, named in the keys; text as it was typed."""
    hazard, limits = assessment.hazard, assessment.thresholds
    low, high = hazard.velocity()
    return {
        "inventory": assessment.source,
        "hazard": {
            # the description comes first: its pgv_m_s is the level asked for, not the range that came out
            **hazard.description,
            "level": hazard.words(),
            "motions": hazard.source,
            "number_of_motions": len(hazard.motions),
            "pgv_range_m_s": [low, high],
        },
        "restitution": assessment.restitution,
        "comparisons": list(assessment.comparisons),
        "thresholds": dict(vars(limits)) | {light.word: words for light, words in limits.sentences().items()},
        "counts": {light.word: count for light, count in assessment.counts().items()}
        | {"not_assessed": len(assessment.not_assessed)},
        "objects": [_plain(rank, each, assessment) for rank, each in enumerate(assessment.verdicts, start=1)],
        "not_assessed": [
            {"row": each.row, "name": each.name, "reason": each.reason} for each in assessment.not_assessed
        ],
        "columns_not_read": list(assessment.ignored),
        "assumptions": list(LIMITS),
    }


def _plain(rank: int, verdict: Verdict, assessment: Assessment) -> dict[str, Any]:
    item = verdict.item
    return {
        "rank": rank,
        "name": item.name,
        "row": item.row,
        "count": item.count,
        "note": item.note,
        "light": verdict.light.word,
        "worse_direction": verdict.worse.direction,
        "uplift_acceleration_m_s2": verdict.uplift_acceleration,
        "overturned_interval": list(verdict.interval),
        "friction": verdict.friction,
        "directions": [_direction(each) for each in verdict.results],
        "directions_by_comparison": {
            name: [_direction(each) for each in results]
            for name, results in zip(assessment.comparisons, verdict.compared, strict=True)
        },
        "light_by_comparison": _lights(verdict, assessment),
        "model_decides": verdict.model_decides,
        "in_words": sentence(verdict, assessment),
        "what_to_do": advice(verdict, assessment),
        "model_note": model_note(verdict, assessment),
    }


# names of a direction's results in JSON where they are not their own
_PLAIN = {
    "uplift_acceleration": "uplift_acceleration_m_s2", "count": "motions",
    "median_rotation": "median_rotation_over_angle", "high_rotation": "high_rotation_over_angle",
}  # fmt: skip


def _direction(result: DirectionResult) -> dict[str, Any]:
    names = (
        "direction", "light", "uplift_acceleration", "count", "lifted", "overturned", "slid", "failed", "lost_contact",
        "overturned_share", "median_rotation", "high_rotation",
    )  # fmt: skip
    plain = {_PLAIN.get(name, name): getattr(result, name) for name in names}
    return plain | {"light": result.light.word}


SLIDING = (
    "Sliding is not assessed without a friction: an object on a smooth floor or shelf may slide before it rocks, "
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
    "is given it is half the height. With a friction or a body file the object moves in three dimensions instead, by "
    "KED where no model was asked for, as nothing was measured there.",
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
    if worse.slid:
        words += f"; it slides in {worse.slid}"
    if worse.lost_contact:
        words += f"; in {worse.lost_contact} the ground would have to pull, and the verdict assumes contact"
    return f"{words}."


def advice(verdict: Verdict, assessment: Assessment) -> str:
    """Return what to do about an object."""
    if verdict.light is Light.GREEN:
        return "Nothing to do for rocking; check that it cannot slide off."
    base = f": {_base(verdict, assessment)}" if verdict.friction is None else ""
    how = f"Secure it, lower its centre of mass, or widen its base{base}."
    if verdict.light is Light.AMBER:
        return f"{how} Give it room to rock without touching its neighbours."
    return f"{how} Until then keep people and other objects out of its reach."


def _lights(verdict: Verdict, assessment: Assessment) -> dict[str, str]:
    pairs = zip(assessment.comparisons, verdict.worse_compared, strict=True)
    return {name: each.light.word for name, each in pairs}


def model_note(verdict: Verdict, assessment: Assessment) -> str:
    """Return whether the model of impact decides, as a sentence; empty if all models show the same light."""
    pairs = zip(assessment.comparisons, verdict.worse_compared, strict=True)
    others = [
        f"{name} shows {each.light.word} ({each.overturned} of {each.count} overturn)"
        for name, each in pairs if each.light is not verdict.light
    ]  # fmt: skip
    return f"The model of impact decides: {', '.join(others)}." if others else ""


def rotation_words(value: float | None) -> str:
    """Return a peak rotation over the slenderness angle in words; None overturns."""
    return "overturns" if value is None else f"{value:.2f}"


def rounded_down(value: float, digits: int) -> str:
    """Return a limit with so many decimals that stays true in print: not above it, but for rounding.

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
    if result.lifted == 0 and result.slid:
        return f"it does not rock in any of {of}"
    if result.lifted == 0:
        return f"it stood still in all of {result.count} {motions}" if result.count > 1 else f"it stood still in {of}"
    if result.overturned:
        fell = f"fell over in {result.overturned} of {of}" if result.count > 1 else f"fell over in {of}"
        return f"it rocks, and {fell}"
    high = result.high_rotation or 0.0
    how = "barely rocks" if high < 0.05 else "rocks a little" if high < 0.2 else "rocks"
    none = f"fell over in none of {of}" if result.count > 1 else f"did not fall over in {of}"
    return f"it {how}, and {none}"
