"""Who takes part in the league: every model as it is, and families with fitted parameters."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.measurements import DataSet
from rocking.restitution import (
    DistributedImpulse,
    HorizontalMomentum,
    Housner,
    Interface,
    Ked,
    PlasticWinkler,
    RestitutionModel,
    ShiftedImpulse,
)
from rocking.restitution.bed_table import HARDNESS, POINTS
from rocking.restitution.contact_bed import ContactBedModel


@dataclass(frozen=True, slots=True)
class Contender:
    """A model, or a family of models with the rule that fits it."""

    name: str  # name in the league
    parameters: tuple[str, ...]  # names of the fitted parameters; none for a model as it is
    # takes a `DataSet` and returns the model that fits it best in least squares of r
    fit: Callable[[DataSet], RestitutionModel]


def as_it_is(model: RestitutionModel) -> Contender:
    """Return a contender without anything fitted."""
    return Contender(model.label, (), lambda data: model)


def with_interface(model: RestitutionModel) -> Contender:
    """Return a contender with a fitted interface factor."""

    def fit(data: DataSet) -> RestitutionModel:
        """Fit the factor by least squares."""
        return Interface(model, eta=_best_eta(model.of_slenderness(data.slenderness), data.coefficient))

    return Contender(f"eta*{model.name}", ("eta",), fit)


def family(
    name: str, parameter: str, make: Callable[[float], RestitutionModel], ends: tuple[float, float], *, eta: bool
) -> Contender:
    """Return a contender with one fitted parameter, and an interface factor on request."""

    def fitted(value: float, data: DataSet) -> tuple[RestitutionModel, float]:
        """Return the model at a value of its parameter, and its misfit."""
        model = make(value)
        r = model.of_slenderness(data.slenderness)
        factor = _best_eta(r, data.coefficient) if eta else 1.0
        misfit = float(((factor * r - data.coefficient) ** 2).sum())
        return (Interface(model, eta=factor) if eta else model), misfit

    def fit(data: DataSet) -> RestitutionModel:
        """Find the parameter by bounded least squares."""
        from scipy.optimize import minimize_scalar

        least = minimize_scalar(
            lambda value: fitted(float(value), data)[1], bounds=ends, method="bounded", options={"xatol": 1e-7}
        )
        return fitted(float(least.x), data)[0]

    prefix = "eta*" if eta else ""
    return Contender(f"{prefix}{name}({parameter})", (("eta", parameter) if eta else (parameter,)), fit)


def best_of(name: str, parameters: tuple[str, ...], members: Sequence[Contender]) -> Contender:
    """Return a contender that is fitted as several families; the one with the least squares takes part."""

    def fit(data: DataSet) -> RestitutionModel:
        """Fit every family."""
        fitted = [member.fit(data) for member in members]
        return min(
            fitted, key=lambda model: float(((model.of_slenderness(data.slenderness) - data.coefficient) ** 2).sum())
        )

    return Contender(name, parameters, fit)


def contact_bed(*, eta: bool) -> Contender:
    """Return the contact bed with points and hardness fitted, damping its default, and a factor on request."""
    members = [
        family(ContactBedModel.name, "hardness", partial(_bed_of, points), HARDNESS, eta=eta) for points in POINTS
    ]
    prefix, first = ("eta*", ("eta",)) if eta else ("", ())
    return best_of(f"{prefix}contact-bed(points, hardness)", (*first, "points", "hardness"), members)


def contenders() -> list[Contender]:
    """Return everyone who takes part by default."""
    whole = [
        Housner(),
        Ked(),
        HorizontalMomentum(),
        ShiftedImpulse(k=2.0 / 3.0),
        DistributedImpulse(q=0.0),
        DistributedImpulse(q=1.0),
        DistributedImpulse(q=2.0),
        PlasticWinkler(),
        ContactBedModel(),
    ]
    factored = [Housner(), Ked(), HorizontalMomentum(), PlasticWinkler()]
    shifted = ("shifted-impulse", "k", ShiftedImpulse, (0.0, 1.0))
    distributed = ("distributed-impulse", "q", DistributedImpulse, (0.0, 20.0))
    return [
        *(as_it_is(model) for model in whole),
        family(*shifted, eta=False),
        family(*distributed, eta=False),
        *(with_interface(model) for model in factored),
        family(*shifted, eta=True),
        family(*distributed, eta=True),
        contact_bed(eta=False),
        contact_bed(eta=True),
    ]


def _bed_of(points: int, hardness: float) -> RestitutionModel:
    return ContactBedModel(points=points, hardness=hardness)


def _best_eta(model: FloatArray, measured: FloatArray) -> float:
    return float(np.clip((model @ measured) / (model @ model), 1e-6, 1.0))
