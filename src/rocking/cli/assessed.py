"""First lines, values and measures of `rocking assess` and `rocking predict` on one screen."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.answers import Display
from rocking.bodies import Body
from rocking.cli.compared import by_foot, spanned
from rocking.cli.numbers import body_line
from rocking.cli.page import Page
from rocking.conventions import Assumed, g, percent
from rocking.decision.prediction.forecast import Chance
from rocking.decision.remedies import millimetres, rounded_up
from rocking.motions.summary import peak_name, support_of
from rocking.quantities import closely

if TYPE_CHECKING:
    from rocking.decision.assessment import BodyAssessment
    from rocking.decision.prediction import Prediction

R = Display(own=closely(coefficient=".3f"))
_OUTCOMES = {False: "NO OVERTURNING", True: "OVERTURNING"}


def show_subject(page: Page, result: "Prediction", more: str = "") -> None:
    """Write the body in one line and the motions in another."""
    body = result.body
    answer = body.answer(result.gravity) if isinstance(body, Body) else body.answer()
    page.line(body_line(body, answer, Display(), ("slenderness_angle", "semi_diagonal", "frequency_parameter")))
    count, facts = len(result.motions), result.condition.facts
    motions = f"Ground motion: {result.motions[0].name}" if count == 1 else f"Ground motions: {count}"
    ranges = ": medians and ranges" * (count > 1)
    page.line(f"{motions}, {facts['peak']}; {facts['velocity']}{ranges}{more}\n")


def show_assumed(page: Page, result: "Prediction") -> None:
    """Write the assumptions that matter most in one line, and the repairs of a mesh."""
    values = ((name, getattr(result.body, name, None), unit) for name, unit in (("density", "kg/m3"), ("depth", "m")))
    assumed = [f"{name} {value:g} {unit}" for name, value, unit in values if isinstance(value, Assumed)]
    inputs = [name for name in result.assumptions if name in result.inputs]
    assumed += [f"{name} {result.inputs[name]}" for name in inputs if name == "friction"]
    if others := len(set(inputs) - {"friction"}):
        assumed.append(f"{others} other inputs")
    page.line(f"Assumed: {'; '.join(assumed)} (all inputs: --details)")
    page.warn(result.repairs)


def chance_text(chance: Chance) -> str:
    """Return a probability with its intervals."""
    text = f"{_percent(chance.value)} (95 % interval {_between(chance.low, chance.high)}"
    if not np.isnan(chance.wide_low):
        text += f"; for other motions like these {_between(chance.wide_low, chance.wide_high)}"
    return f"{text})"


def _percent(fraction: float) -> str:
    return percent(round(fraction, 3))


def _between(low: float, high: float) -> str:
    return f"{100.0 * round(low, 3):.3g} to {_percent(high)}"


def prediction_values(result: "Prediction") -> list[tuple[str, str]]:
    """Return label and text of the probabilities."""
    values = [
        ("Overturning", chance_text(result.chances["overturning"])),
        ("Rocking", chance_text(result.chances["uplift"])),
        (f"Sliding by {1000.0 * result.sliding_beyond:g} mm or more", chance_text(result.chances["sliding"])),
    ]
    samples = f"{result.count // 4} of {result.count} samples"
    others = [(f"Overturning with {name} ({samples})", chance_text(chance)) for name, chance in result.beside.items()]
    return values + others


def headline_of(result: "BodyAssessment") -> str:
    """Return the outcome in capitals, with the number of motions and of restitution models."""
    fraction = result.overturning_fraction
    count, all_models, some_models = fraction.size, int((fraction == 1.0).sum()), int((fraction > 0.0).sum())
    if np.isnan(result.lowest.factor):
        return "NO RESULT (0 histories)"
    motions = f"of {count} motion{'s' * (count != 1)}"
    if all_models == some_models:
        outcome = "NO UPLIFT" if (result.uplift_factors > 1.0).all() else _OUTCOMES[some_models > 0]
        return f"{outcome} ({some_models} {motions}, {_of_models(result, all_cases=True)}, both polarities)"
    if count == 1:
        return f"RESULT DEPENDS ON THE RESTITUTION MODEL (overturning with {_of_models(result)})"
    return f"RESULT DEPENDS ON THE RESTITUTION MODEL (overturning under {all_models} to {some_models} {motions})"


def _of_models(result: "BodyAssessment", *, all_cases: bool = False) -> str:
    """Return the number of models with overturning and of interval ends; or of all with `all_cases`."""
    from rocking.decision.assessment.answer import cases_by_kind

    texts = []
    for kind, names in cases_by_kind(result.models).items():
        overturned = sum(result.count_overturned(result.models[name]) > 0 for name in names)
        numbers = f"{len(names)} {kind}{'s' * (len(names) != 1)}" + " of the 95 % interval" * (kind == "end")
        texts += [numbers if all_cases else f"{overturned} of {numbers}"] if names else []
    return ", ".join(texts)


def assessment_values(result: "BodyAssessment") -> list[tuple[str, str]]:
    """Return label and text of margin, uplift, probability and main uncertain input."""
    k, chance = int(np.argmin(result.uplift_factors)), result.prediction.chances["overturning"]
    motion, factor = result.motions[k], float(result.uplift_factors[k])
    peak = f"{peak_name(support_of(motion))} of {factor * motion.peak / g:.3g} g"
    name = "this record" if len(result.motions) == 1 else motion.name
    values = [
        ("Margin", result.margin_value),
        ("Uplift", f"{factor:.3g} times {name}, a {peak}."),
        ("Overturning probability", f"{chance_text(chance)}."),
    ]
    if len(result.prediction.motions) > 1:
        worst = int(np.nanargmax(chance.per_motion))
        largest = f"{_percent(float(chance.per_motion[worst]))}, under {result.prediction.motions[worst].name}."
        values.append(("Largest of all motions", largest))
    main = result.main_uncertainty
    return [*values, *([("Main uncertainty", main)] if main else [])]


def model_cells(rows: list[dict[str, Any]]) -> tuple[str, ...]:
    """Return name, coefficients, number of motions with overturning and margin of a group of restitution cases."""
    label = rows[0]["restitution"] if len(rows) == 1 else f"{len(rows)} other models"
    r = by_foot(R, *([row[f"coefficient_{foot}"] for row in rows] for foot in ("left", "right")))
    return label, r, rows[0]["overturned"], spanned(R, "min_factor", [row["min_factor"] for row in rows])


def measures_of(result: "BodyAssessment") -> Iterable[str]:
    """Return two lines of retrofit measures, or sentences (3D body, required margin, or measures not computed)."""
    remedy = result.remedies
    wider, lower = remedy.wider, remedy.lower
    is_short = remedy.needed and remedy.isolation and wider.length_no_overturning > 0.0
    is_short = is_short and lower.length_no_overturning > 0.0 and np.isfinite(lower.length_no_uplift)
    if not is_short or wider.reason or lower.reason or result.standing is not None or remedy.margin != 1.0:
        return result.measures
    period, displacement = remedy.isolation or (0.0, 0.0)
    forces = {edge: f"{rounded_up(force / 1e3):.3g} kN" for edge, force in remedy.tension.items()}
    edges = [f"{force} on the {edge} edge" for edge, force in forces.items()]
    if len(forces) == 2 and len(set(forces.values())) == 1:
        edges = [f"{forces['left']} on each edge"]
    return (
        f"Prevent overturning: base +{millimetres(wider.length_no_overturning)} mm on each side, or centre of mass "
        f"-{millimetres(lower.length_no_overturning)} mm",
        f"Prevent uplift:      anchors {', '.join(edges)}, shear {rounded_up(remedy.shear / 1e3):.3g} kN; "
        f"base +{millimetres(wider.length_no_uplift)} mm; centre of mass -{millimetres(lower.length_no_uplift)} mm; "
        f"isolation period >= {period:.3g} s, {millimetres(displacement)} mm",
    )
