"""Restitutions that a job describes: models, coefficients, and laws that draw them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rocking.bodies import Body
from rocking.conventions import FEET
from rocking.dynamics.impact_law import RandomRestitution
from rocking.dynamics.rocker import cut_of, cut_words
from rocking.errors import InvalidValueError
from rocking.restitution import RestitutionModel, model
from rocking.restitution.from_file import file_of, model_in_file
from rocking.studies.job.inputs import Inputs
from rocking.studies.job.reading import located
from rocking.studies.sensitivity.posterior import posterior
from rocking.studies.sensitivity.sampled import SampledRestitution

if TYPE_CHECKING:
    from rocking.studies.job.restitution_tables import RandomTable, RestitutionTable


def choices_of(
    table: "RestitutionTable", seed: int, bodies: Sequence[Body] = (), inputs: Inputs | None = None
) -> dict[str, Any]:
    """Return the restitutions that a table describes.

    Returns Models, coefficients, pairs by side or laws, as `simulate` takes them, by label.
    """
    with located("restitution"):
        words = [*([table.model] if table.model else []), *(table.models or [])]
        models = [_model(word, inputs) for word in words]
        pairs: list[tuple[str, Any]] = [(each.label, each) for each in models]
        numbers = [*([] if table.value is None else [table.value]), *(table.values or [])]
        pairs += [(f"{value!r}", value) for value in numbers]
        if table.left is not None:
            pairs.append((f"left {table.left!r}, right {table.right!r}", {"left": table.left, "right": table.right}))
        if table.distribution is not None:
            pairs.append(_drawn(table.distribution, seed, bodies, inputs))
        labels = [label for label, _ in pairs]
        twice = [label for label in labels if labels.count(label) > 1]
        if twice:
            raise InvalidValueError(f"{twice[0]} is given twice")
        return dict(pairs)


def _model(word: str, inputs: Inputs | None) -> RestitutionModel:
    """Return a model by name, or one of the user's own, whose file is then an input of the job."""
    name = file_of(word) if inputs is not None else None
    return model(word) if inputs is None or name is None else model_in_file(word, inputs.file(name))


def _drawn(
    table: "RandomTable", seed: int, bodies: Sequence[Body], inputs: Inputs | None
) -> tuple[str, Any]:  # fmt: skip
    times = _model(table.times, inputs) if isinstance(table.times, str) else table.times
    law = SampledRestitution if table.each == "history" else RandomRestitution
    seed = seed if table.seed is None else table.seed
    how: dict[str, Any] = {"seed": seed, "times": times}
    if table.posterior:
        drawn, words = _posterior(table, seed, bodies)
    elif table.values is not None:
        drawn, words = law.of_sample(table.values, **how), f"{len(table.values)} values"
        words += f" from {min(table.values):g} to {max(table.values):g}"
    else:
        mean, deviation = table.mean or 0.0, table.deviation or 0.0  # both are there: checked by the table
        drawn, words = law.normal(mean, deviation, **how), f"{mean:g} +- {deviation:g}"
    # of many bodies, the one of which most is cut off
    cuts = [cut_of(drawn, body) for body in bodies]
    most = {foot: max((cut[foot] for cut in cuts), default=0.0) for foot in FEET}
    return f"drawn per {table.each}: {words}, seed {seed}{cut_words(most)}", drawn


def _posterior(table: "RandomTable", seed: int, bodies: Sequence[Body]) -> tuple[Any, str]:
    """Return the law that the measurements make of the body: all quantiles, or a sample of so many values."""
    if len(bodies) != 1:
        told = f"{len(bodies)} bodies: make a job of each" if bodies else "no [body]; give values instead"
        raise InvalidValueError(f"distribution.posterior is of one body, and the job has {told}")
    found = posterior(bodies[0])
    words = "posterior of the measurements"
    if found.extrapolated:
        words += " (extrapolated in slenderness)"
    law = found.per_history(seed) if table.each == "history" else found.per_impact(seed)
    if table.count is None:
        return law, words
    values = {foot: found.sample(table.count, seed, foot) for foot in FEET}
    return replace(type(law).of_sample(values, seed=seed), cut=law.cut), f"{table.count} values of the {words}"
