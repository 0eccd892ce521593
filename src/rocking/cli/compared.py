"""Comparison of the default restitution model with other models: the study repeated with each model."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rocking.answers import Answer, Display
from rocking.cli.page import Page
from rocking.dynamics.mechanics import restitution_label
from rocking.errors import RockingError
from rocking.quantities import Quantity
from rocking.restitution.headline import headline, label_of

if TYPE_CHECKING:
    import numpy as np

    from rocking.spec.study import StudyProblem

Facts = Callable[[Any], dict[str, Any]]
_OWN = {
    "overturned": Quantity("overturned", "1", "number of histories with overturning", label="overturned"),
}


def with_models(compute: Callable[["StudyProblem"], Any], problem: "StudyProblem") -> tuple[Any, dict[str, Any]]:
    """Return the result of a study, and the results or errors of the compared models by name."""
    others: dict[str, Any] = {}
    result = compute(problem)
    for name, other in problem.with_compared_models.items():
        try:
            others[name] = compute(other)
        except RockingError as error:
            others[name] = error
    return result, others


def model_facts(
    label: str, others: Mapping[str, Any], facts: Facts, body: Any = None, *, is_stated: bool | None = None
) -> dict[str, Any]:
    """Return the sentence on the restitution model of a result, and the values of the compared models by label.

    `is_stated` is True for a stated model; None means a stated model if there are no compared models.
    """
    values_of_models = {
        restitution_label(name, body): {"error": str(result)} if isinstance(result, RockingError) else facts(result)
        for name, result in others.items()
    }
    is_stated = not others if is_stated is None else is_stated
    return {"headline": headline(restitution_label(label, body), is_stated=is_stated), "other_models": values_of_models}


def show_models(page: Page, answer: Answer, display: Display, label: str, own: dict[str, Any]) -> None:
    """Write a table of all models, and the sentence on the model of the result; `own` contains its values."""
    page.line()
    other_models = answer["other_models"]
    if other_models:
        label = label_of(label, in_space=all(name.endswith("-3d") for name in other_models))
        rows = {label: own, **{name: values for name, values in other_models.items() if "error" not in values}}
        page.line("Compare restitution models", "bold")
        shown = replace(display, own={**display.own, **_OWN})
        page.rows([{"model": name, **values} for name, values in rows.items()], (), shown)
        page.warn(f"{name}: {values['error']}" for name, values in other_models.items() if "error" in values)
    page.line(answer["headline"])


def overturned(modes: "np.ndarray") -> dict[str, Any]:
    """Return the number and the fraction of the computed histories with overturning."""
    computed, overturned = int((modes > -3).sum()), int((modes >= 0).sum())
    return {"overturned": overturned, "fraction": overturned / computed if computed else None}


def grouped(outcomes: Mapping[str, str], shown: Collection[str]) -> list[list[str]]:
    """Return groups of models: single models in `shown`, then the other models by outcome."""
    others: dict[str, list[str]] = {}
    for label, outcome in outcomes.items():
        if label not in shown:
            others.setdefault(outcome, []).append(label)
    return [[label] for label in outcomes if label in shown] + list(others.values())


def spanned(display: Display, name: str, values: Iterable[float | None]) -> str:
    """Return the smallest and largest value of models, or one number if both have equal texts."""
    numbers = [value for value in values if value is not None and not math.isnan(value)]
    ends = (min(numbers), max(numbers)) if numbers else (None,)
    return "-".join(dict.fromkeys(display.cell(name, end) for end in ends))


def by_foot(display: Display, left: Iterable[float], right: Iterable[float]) -> str:
    """Return coefficients of restitution of the left and right foot, or one entry if both have equal texts."""
    return " / ".join(dict.fromkeys(spanned(display, "coefficient", foot) for foot in (left, right)))
