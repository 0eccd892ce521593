"""What `rocking fragility` prints.

Keys of the JSON
----------------
- ``body``, ``assumed`` (sentences),
  ``motions`` (kind, count, and family and seed, or names), ``gravity_m_s2``, ``linear``, ``analysis``,
  ``measure``, ``unit``, ``states``, ``uplift_threshold`` (null if no level decides), ``levels``.
- ``results``: one for every restitution, each with restitution, definition, uplift, failed, trials, reached (by state),
  curves (by state: those of `LognormalFit.summary`); of a cloud regression; of an incremental analysis
  first_crossing, first_crossings, overturning_intervals (motion, start, end; end is null if it overturns to the
  highest level), resurrected_motions, resurrected_motions_over_1_percent.
- ``comparison``: null for one restitution, else choices, a row each, and verdict.
"""

import json
import math
from typing import TYPE_CHECKING, Any

from rocking.cli import study_output as shared
from rocking.cli.fragility_question import FragilityAnswer
from rocking.errors import InvalidValueError
from rocking.studies.fragility._incremental import IncrementalAnalysis
from rocking.studies.fragility.separation import Separation

if TYPE_CHECKING:
    from rocking.studies.fragility.lognormal import LognormalFit

WIDE = 0.01
"""Survivals of less width over their level are named apart: in them the body balances on its corner [-]."""


def as_json(answer: FragilityAnswer) -> str:
    """Return everything as JSON."""
    asked, found = answer.question, answer.found
    compared = answer.compared
    facts = {
        "body": repr(asked.body),
        "assumed": list(asked.body.assumed),
        "motions": answer.motions,
        "gravity_m_s2": asked.settings["gravity"],
        "linear": asked.settings["linear"],
        "analysis": asked.analysis,
        "measure": asked.measure.name,
        "unit": asked.measure.unit,
        "states": list(asked.states),
        "uplift_threshold": found.subject.uplift_threshold,
        "levels": found.levels.tolist(),
        "results": [_result(one) for one in answer.results.values()],
        "comparison": None if compared is None else {"choices": compared.summary(), "verdict": compared.verdict},
    }
    return json.dumps(_plain(facts), indent=1, allow_nan=False)


def _result(found: Any) -> dict[str, Any]:
    told = found.summary()
    made = {
        "restitution": found.subject.rocker.label,
        "definition": found.definition,
        "uplift": told["uplift"],
        "failed": told["failed"],
        "contact": _stripes(found).responses.contact,
        "trials": found.trials.tolist(),
        "reached": {name: counts.tolist() for name, counts in found.counts.items()},
        "curves": {name: fit.summary() for name, fit in found.fits.items()},
    }
    if "regression" in told:
        made["regression"] = told["regression"]
    if isinstance(found, IncrementalAnalysis):
        made |= {
            "first_crossing": told["first crossing"],
            "first_crossings": found.first_crossings.tolist(),
            "overturning_intervals": [{"motion": i.motion, "start": i.start, "end": i.end} for i in found.intervals],
            "resurrected_motions": found.resurrected(),
            "resurrected_motions_over_1_percent": found.resurrected(WIDE),
        }
    return made


def _plain(value: Any) -> Any:
    """Return a value with null where there is no finite number."""
    if isinstance(value, dict):
        return {str(name): _plain(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def show(answer: FragilityAnswer, length: str = "m") -> None:
    """Print the curves, and what is to be known of them."""
    from rich.console import Console

    console, found = Console(highlight=False, soft_wrap=True), answer.found
    labels = dict.fromkeys(one.subject.rocker.label for one in answer.results.values())
    head = {
        **dict(shared.body_lines(answer.question.body, answer.question.settings["gravity"], length)),
        "motions": _motions(answer.motions),
        "restitution": ", ".join(labels),
        "measure": f"{found.subject.measure.name}, {found.subject.measure.words}",
        "rocking": _uplift(answer),
    }
    for name, words in head.items():
        console.print(f"{name + ':':13} {words}", markup=False)
    console.print(f"{found.definition[:1].upper()}{found.definition[1:]}.", markup=False)
    console.print()
    for label, result in answer.results.items():
        console.print(shared.table(*_curves(answer, label if answer.compared is not None else "state", result)))
        console.print()
    for sentence in _sentences(answer):
        console.print(sentence, markup=False)


def _uplift(answer: FragilityAnswer) -> str:
    check = _stripes(answer.found).uplift
    if check.threshold is None:
        return str(check.verdict)
    unit, factor = answer.question.unit
    return (
        f"certain above {check.threshold / factor:.4g} {unit}, impossible below; "
        f"{check.contradictions} of {check.checked} histories contradict it"
    )


def _stripes(result: Any) -> Any:
    return result.stripes if isinstance(result, IncrementalAnalysis) else result


def _motions(facts: dict[str, Any]) -> str:
    if facts["kind"] == "synthetic":
        return f"{facts['count']} synthetic motions of the family {facts['family']}, seed {facts['seed']}"
    kind = facts["kind"] if facts["count"] > 1 else facts["kind"][:-1]
    return f"{facts['count']} {kind}: {', '.join(' '.join(name.split()) for name in facts['names'][:4])}" + (
        ", ..." if facts["count"] > 4 else ""
    )


def _curves(answer: FragilityAnswer, first: str, result: Any) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    unit, factor = answer.question.unit
    head = (first, f"median [{unit}]", "95 %", "dispersion", "95 %")
    rows: list[tuple[str, ...]] = []
    for name, fit in result.fits.items():
        told = fit.summary()
        median = "none" if fit.median is None else f"{fit.median / factor:.4g}"
        spread = "none" if fit.dispersion is None else f"{fit.dispersion:.3g}"
        known = fit.exists and not _too_few(fit)
        middle = _interval(told["median_95"], factor) if known else ""
        rows.append((name, median, middle, spread, _interval(told["dispersion_95"], 1.0) if known else ""))
    return head, rows


def _interval(ends: list[float | None], factor: float) -> str:
    low, high = ("open" if end is None else f"{end / factor:.3g}" for end in ends)
    return f"{low} to {high}"


def _too_few(fit: "LognormalFit") -> str:
    """Return why motions that serve at several levels are too few for an interval; empty if they are not."""
    return fit.counts.scarcity if fit.counts.is_clustered else ""


def _sentences(answer: FragilityAnswer) -> list[str]:
    told: list[str] = []
    for label, result in answer.results.items():
        before = f"{label}, " if answer.compared is not None else ""
        told += [f"{before}{words}" for words in _verdicts(answer, result)]
        failed = _stripes(result).failed
        if failed:
            told.append(f"! {before}{failed} histories could not be computed; they count at no level")
        if contact := _stripes(result).responses.contact:
            told.append(f"! {before}{contact}")
    found = answer.found
    if answer.question.analysis == "cloud":
        told.append(_line(found))
    else:
        told += _intervals(answer)
    if isinstance(found, IncrementalAnalysis):
        told += _crossings(answer, found)
    if answer.compared is not None:
        told.append(answer.compared.told(answer.question.unit))
    return told


def _intervals(answer: FragilityAnswer) -> list[str]:
    """Return what the intervals are, and why there are none."""
    fits = [(name, fit) for result in answer.results.values() for name, fit in result.fits.items() if fit.exists]
    whys = {_too_few(fit): name for name, fit in fits}
    told = [
        f"No interval of {name}: motions serve at every level, and there are too few of them ({why})."
        for why, name in whys.items()
        if why
    ]
    if "" not in whys:
        return told
    how = (
        "the values of the parameter under which so few, or so many, failures as these are no rarity, each motion with "
        "one capacity"
        if any(fit.counts.draws_capacities for _, fit in fits)
        else "whole motions drawn anew"
    )
    return [*told, f"Intervals: {how}, since a motion serves at every level."]


def _verdicts(answer: FragilityAnswer, result: Any) -> list[str]:
    """Return what is to be known of curves that are not likeliest, the same words once; intervals are told apart."""
    states: dict[str, list[str]] = {}
    for name, fit in result.fits.items():
        if fit.separation is not Separation.OVERLAP or not fit.exists:
            words = fit.verdict.split(" Outcomes of one cluster")[0].split(" Intervals are")[0]
            states.setdefault(words, []).append(name)
    where = "" if (unit := answer.question.measure.unit) == "-" else f" (levels in {unit})"
    return [f"{', '.join(names)}: {words}{where}" for words, names in states.items()]


def _line(found: Any) -> str:
    try:
        line = found.regression
    except InvalidValueError as error:
        return f"No line of the rotation over the measure: {error}"
    return (
        f"Of {line.count} histories that rocked and stayed standing, ln(theta/alpha) grows with slope {line.slope:.3g} "
        f"over ln({found.subject.measure.name}), scatter {line.scatter:.3g}, R squared {line.determination:.3g}."
    )


def _crossings(answer: FragilityAnswer, found: IncrementalAnalysis) -> list[str]:
    unit, factor = answer.question.unit
    first, whole = found.first_crossing_fit, int(found.complete.sum())
    curve = (
        "too few motions overturn it for a curve"
        if first is None
        else f"median {first.median / factor:.4g} {unit}, dispersion {first.dispersion:.3g}"
    )
    words = found.definitions["first crossing"]
    return [
        f"{words[:1].upper()}{words[1:]}: {curve}.",
        f"{len(found.resurrected())} of {whole} motion{'s' * (whole != 1)} left it standing at levels above one "
        f"that overturns it, {len(found.resurrected(WIDE))} of them over more than 1 % of the level.",
    ]
