"""The default restitution model compared with others: the same study with each of them, as a table."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rocking.answers import Answer, Display
from rocking.cli.page import Page
from rocking.dynamics.mechanics_base import in_space
from rocking.errors import RockingError
from rocking.quantities import Quantity
from rocking.restitution.headline import headline

if TYPE_CHECKING:
    import numpy as np

    from rocking.spec.study import StudyProblem

Facts = Callable[[Any], dict[str, Any]]
_OWN = {
    "overturned": Quantity("overturned", "1", "number of histories with overturning", label="overturned"),
    "share": Quantity("share", "1", "fraction of the histories with overturning", label="fraction", digits=".2%"),
}


def with_models(compute: Callable[["StudyProblem"], Any], problem: "StudyProblem") -> tuple[Any, dict[str, Any]]:
    """Return a result, and the results of the models that the default is compared with, or their errors, by model."""
    others: dict[str, Any] = {}
    result = compute(problem)
    for name, other in problem.with_compared_models.items():
        try:
            others[name] = compute(other)
        except RockingError as error:
            others[name] = error
    return result, others


def model_facts(label: str, others: Mapping[str, Any], facts: Facts, body: Any = None) -> dict[str, Any]:
    """Return the model of the result of a body with the reason for it, and the values that other models give."""
    given = {name: {"error": str(one)} if isinstance(one, RockingError) else facts(one) for name, one in others.items()}
    return {"headline": headline(label, in_space=in_space(body)), "other_models": given}


def show_models(page: Page, answer: Answer, display: Display, label: str, own: dict[str, Any]) -> None:
    """Write the results of all models as a table, and the model of the result; own: the values of that model."""
    page.line()
    given = answer["other_models"]
    if given:
        rows = {label: own, **{name: values for name, values in given.items() if "error" not in values}}
        page.line("Compare restitution models", "bold")
        shown = replace(display, own={**display.own, **_OWN})
        page.rows([{"model": name, **values} for name, values in rows.items()], (), shown)
        page.warn(f"{name}: {values['error']}" for name, values in given.items() if "error" in values)
    page.line(answer["headline"])


def overturned(modes: "np.ndarray") -> dict[str, Any]:
    """Return the number and the fraction of histories with overturning, of those that could be computed."""
    computed, overturned = int((modes > -3).sum()), int((modes >= 0).sum())
    return {"overturned": overturned, "share": overturned / computed if computed else None}


def grouped(outcomes: Mapping[str, str], shown: Collection[str]) -> list[list[str]]:
    """Return groups of models: those shown alone, then the others by outcome."""
    others: dict[str, list[str]] = {}
    for label, outcome in outcomes.items():
        if label not in shown:
            others.setdefault(outcome, []).append(label)
    return [[label] for label in outcomes if label in shown] + list(others.values())


def spanned(display: Display, name: str, values: Iterable[float | None]) -> str:
    """Return the smallest and largest value of models; one number if both print the same."""
    numbers = [value for value in values if value is not None and not math.isnan(value)]
    ends = (min(numbers), max(numbers)) if numbers else (None,)
    return "-".join(dict.fromkeys(display.cell(name, end) for end in ends))


def by_foot(display: Display, left: Iterable[float], right: Iterable[float]) -> str:
    """Return coefficients of restitution at the left and right foot; one entry if both print the same."""
    return " / ".join(dict.fromkeys(spanned(display, "coefficient", foot) for foot in (left, right)))
