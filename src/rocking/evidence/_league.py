"""The league table: every model, as it is or fitted, against every measurement, by measures that tell them apart."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.evidence import comparison
from rocking.evidence.comparison import FEWEST, MEASURES, compare, drawn, resampled
from rocking.evidence.likelihood import rounding_bic
from rocking.evidence.measurements import BANDS, DataSet, all_measurements
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


def contact_bed(*, eta: bool) -> Contender:
    """Return the contact bed with points and hardness fitted, damping its default, and a factor on request."""

    def of(points: int) -> Contender:
        return family(
            "contact-bed", "hardness", lambda x: ContactBedModel(points=points, hardness=x), HARDNESS, eta=eta
        )

    def fit(data: DataSet) -> RestitutionModel:
        """Fit the hardness with every number of points; the one with the least squares takes part."""
        fitted = [of(points).fit(data) for points in POINTS]
        return min(
            fitted, key=lambda model: float(((model.of_slenderness(data.slenderness) - data.coefficient) ** 2).sum())
        )

    prefix, first = ("eta*", ("eta",)) if eta else ("", ())
    return Contender(f"{prefix}contact-bed(points, hardness)", (*first, "points", "hardness"), fit)


def contenders() -> list[Contender]:
    """Return everyone who takes part by default."""
    impulses = [ShiftedImpulse(k=2.0 / 3.0), *(DistributedImpulse(q=q) for q in (0.0, 1.0, 2.0))]
    whole = [Housner(), Ked(), HorizontalMomentum(), *impulses, PlasticWinkler(), ContactBedModel()]
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


def _best_eta(model: FloatArray, measured: FloatArray) -> float:
    return float(np.clip((model @ measured) / (model @ model), 1e-6, 1.0))


_UNRESOLVED, _SLENDER = 6.0, 6.0
_PUBLISHED = "Two sources, repeated tests of the same blocks and one tape-covered interface are little evidence: what"


@dataclass(frozen=True, slots=True)
class LeagueRow:
    """One contender's record on measurements."""

    name: str  # in the league
    model: RestitutionModel  # with fitted values where there are any
    parameters: tuple[str, ...]  # names of the fitted parameters
    rmse: float  # rmse, bias: of r, model minus experiment [-]
    bias: float
    rmse_low: float  # rmse_low, rmse_high: 95 % bootstrap interval, specimens resampled within their data sets [-]
    rmse_high: float
    correlation: float  # Pearson's [-]
    concordance: float  # Lin's [-]
    loss_rmse: float  # loss_rmse, log_loss_rmse: errors of the energy loss 1 - r^2, absolute and logarithmic [-]
    log_loss_rmse: float
    leave_one_out: float  # RMSE of predictions by fits that have not seen the row [-]
    leave_group_out: float  # the same without its whole data set [-]
    bic: float  # of the likelihood that knows the rounding, with a scatter that grows with the loss; lower is better
    by_group: dict[str, float]  # RMSE by data set [-]
    by_band: dict[str, float]  # RMSE by slenderness band [-]
    # 95 % paired bootstrap interval of RMSE minus that of KED [-]; not resolved where it includes zero
    ahead_of_ked: tuple[float, float]

    @property
    def fitted(self) -> str:
        """The fitted values, as words."""
        values = self.model.parameters
        return ", ".join(f"{name} = {values[name]:.4g}" for name in self.parameters)

    def as_dict(self) -> dict[str, Any]:
        """Return the row as plain values."""
        plain = {name: getattr(self, name) for name in self.__slots__ if name not in ("model", "parameters")}
        return {**plain, "fitted": {name: self.model.parameters[name] for name in self.parameters}}


def league(extra: Sequence[RestitutionModel] = (), measurements: DataSet | None = None) -> tuple[LeagueRow, ...]:
    """Return the league table, best RMSE of r first.

    Parameters
    ----------
    extra : sequence of RestitutionModel
        Your own models, to take part as they are.
    measurements : DataSet, optional
        What they are judged by; the 39 published coefficients if not given.

    Returns
    -------
    tuple of LeagueRow
        One row a contender.

    Raises
    ------
    InvalidValueError
        If the measurements are of fewer than five blocks.

    Examples
    --------
    >>> [row.name for row in league() if not row.parameters][0]
    'horizontal-momentum'
    """
    data = all_measurements() if measurements is None else measurements
    if (count := len(set(zip(data.group, data.labels, data.slenderness.tolist(), strict=True)))) < FEWEST:
        raise InvalidValueError(f"a league needs measurements of at least {FEWEST} blocks, got {count}")
    rows = [*_standing(data), *(_row(as_it_is(model), data) for model in extra)]
    return tuple(sorted(rows, key=lambda row: row.rmse))


@lru_cache(maxsize=4)
def _standing(data: DataSet) -> tuple[LeagueRow, ...]:
    return tuple(_row(contender, data) for contender in contenders())


def _row(contender: Contender, data: DataSet) -> LeagueRow:
    model = contender.fit(data)
    r, measured = model.of_slenderness(data.slenderness), data.coefficient
    low, high = np.quantile(resampled((r - measured) ** 2, drawn(data)), [0.025, 0.975]).tolist()
    against_ked = compare(data, r, Ked().of_slenderness(data.slenderness))
    count = len(contender.parameters)
    bands = {name: (data.slenderness > a) & (data.slenderness <= b) for name, a, b in BANDS}
    groups = {name: np.array([group == name for group in data.group]) for name in dict.fromkeys(data.group)}
    each = list(np.eye(len(data), dtype=bool)) if count else [np.ones(len(data), dtype=bool)]
    measures = ("rmse", "bias", "correlation", "concordance", "loss_rmse", "log_loss_rmse")
    return LeagueRow(
        name=contender.name,
        model=model,
        parameters=contender.parameters,
        rmse_low=low,
        rmse_high=high,
        **{name: getattr(comparison, name)(r, measured) for name in measures},
        leave_one_out=_left_out(contender, data, each),
        leave_group_out=_left_out(contender, data, list(groups.values())),
        bic=rounding_bic(data, r, count),
        by_group={name: comparison.rmse(r[rows], measured[rows]) for name, rows in groups.items()},
        by_band={
            name: comparison.rmse(r[rows], measured[rows]) if rows.any() else math.nan for name, rows in bands.items()
        },
        ahead_of_ked=(against_ked.low, against_ked.high),
    )


def _left_out(contender: Contender, data: DataSet, subsets: list[Any]) -> float:
    if contender.parameters and any(left.all() for left in subsets):
        return math.nan  # nothing is left to fit
    predicted = np.empty(len(data))
    for left in subsets:
        # nothing is fitted where nothing is free, so the whole may be left out at once
        model = contender.fit(data.rows(~left)) if contender.parameters else contender.fit(data)
        predicted[left] = model.of_slenderness(data.slenderness[left])
    return comparison.rmse(predicted, data.coefficient)


def verdict(rows: Sequence[LeagueRow], measurements: DataSet | None = None) -> tuple[str, ...]:
    """Put the league table into words, also where the paper's own model loses.

    Parameters
    ----------
    rows : sequence of LeagueRow
        The league, which must hold ``ked`` and ``housner``.
    measurements : DataSet, optional
        What it is of; the 39 published coefficients if not given.

    Returns
    -------
    tuple of str
        One sentence or two each.
    """
    data = all_measurements() if measurements is None else measurements
    by_name = {row.name: row for row in rows}
    ked, housner = by_name["ked"], by_name["housner"]
    best = min(rows, key=lambda row: row.bic)
    close = [row.name for row in rows if row.bic - best.bic < _UNRESOLVED]
    return (
        f"Error of r: {_between(data, ked, housner, 'r')}.",
        _against_free(data, ked, [row for row in rows if not row.parameters]),
        *(f"{name.capitalize()}: {_between(data, ked, housner, name)}." for name in list(MEASURES)[1:]),
        f"{_slender(data, ked, housner)}The bias of KED over all rows is {ked.bias:+.4f} (model minus measurement).",
        f"With fitted parameters the lowest BIC is that of {best.name} ({best.fitted or 'nothing fitted'}): RMSE "
        f"{best.rmse:.4f}, leave-one-out {best.leave_one_out:.4f}, leave-one-data-set-out {best.leave_group_out:.4f}.",
        f"What these data cannot resolve: {', '.join(close)} lie within {_UNRESOLVED:g} in BIC of each other. "
        f"{_PUBLISHED if data is all_measurements() else 'What'} a model does outside slenderness "
        f"{data.slenderness.min():g} to {data.slenderness.max():g}, or for other shapes, is theory.",
    )


def _slender(data: DataSet, ked: LeagueRow, housner: LeagueRow) -> str:
    rows = data.rows(np.flatnonzero(data.slenderness > _SLENDER).tolist())
    return f"Above slenderness {_SLENDER:g}: {_between(rows, ked, housner, 'r')}. " if len(rows) else ""


def _between(data: DataSet, one: LeagueRow, other: LeagueRow, measure: str) -> str:
    first, second = (row.model.of_slenderness(data.slenderness) for row in (one, other))
    return compare(data, first, second, measure).sentence(one.name, other.name)


def _against_free(data: DataSet, ked: LeagueRow, free: Sequence[LeagueRow]) -> str:
    mine = ked.model.of_slenderness(data.slenderness)
    better = [row for row in free if compare(data, row.model.of_slenderness(data.slenderness), mine).sign < 0]
    best = min(free, key=lambda row: row.rmse)
    names = ", ".join(row.name for row in better) or "none"
    if best is ked:
        return "Among the models without a fitted parameter, KED has the smallest error."
    return (
        f"Models without a fitted parameter that are closer than KED: {names}. The smallest error is that of "
        f"{best.name}: {_between(data, best, ked, 'r')}."
    )
