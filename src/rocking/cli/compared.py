"""The default restitution model compared with others: the same study with each of them, as a table."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rocking.answers import Answer, Display
from rocking.cli.page import Page
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


def model_facts(label: str, others: Mapping[str, Any], facts: Facts) -> dict[str, Any]:
    """Return the model of a result with the reason for it, and the values that other models give."""
    given = {name: {"error": str(one)} if isinstance(one, RockingError) else facts(one) for name, one in others.items()}
    return {"headline": headline(label), "other_models": given}


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
    known, fell = int((modes > -3).sum()), int((modes >= 0).sum())
    return {"overturned": fell, "share": fell / known if known else None}


def grouped(rows: dict[str, tuple[str, ...]], shown: set[str]) -> dict[str, tuple[str, ...]]:
    """Return rows in which models that are not shown have one row per outcome, the third cell, with ranges."""
    kept = {label: row for label, row in rows.items() if label in shown}
    groups: dict[str, list[tuple[str, ...]]] = {}
    for label, row in rows.items():
        if label not in shown:
            groups.setdefault(row[2], []).append(row)
    for outcome, group in groups.items():
        if len(group) == 1:
            kept[group[0][0]] = group[0]
            continue
        label = f"{len(group)} other models"
        others = [outcome if k == 2 else _range([row[k] for row in group]) for k in range(1, len(group[0]))]
        kept[f"{label}: {outcome}"] = (label, *others)
    return kept


def _range(cells: Sequence[str]) -> str:
    ordered = sorted(set(cells), key=lambda cell: (cell == "-", len(cell.partition(".")[0]), cell))
    return ordered[0] if len(ordered) == 1 else f"{ordered[0]}-{ordered[-1]}"
