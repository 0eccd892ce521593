"""The league table: all models, unfitted or fitted, compared with all measurements by several error measures."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.answers import Answer
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.evidence import comparison
from rocking.evidence.comparison import FEWEST, MEASURES, compare, drawn, resampled
from rocking.evidence.likelihood import rounding_bic
from rocking.evidence.measurements import BANDS, DataSet, all_measurements
from rocking.evidence.searches import minimise_between
from rocking.restitution import (
    DistributedImpulse,
    HorizontalMomentum,
    Housner,
    ImpactGeometry,
    Interface,
    Ked,
    PlasticWinkler,
    RestitutionModel,
    ShiftedImpulse,
)
from rocking.restitution.bed_table import HARDNESS, POINTS
from rocking.restitution.contact_bed import ContactBedModel, tabulated
from rocking.restitution.distributed_impulse import distributed
from rocking.restitution.registry import model as resolved
from rocking.restitution.shifted_impulse import shifted


@dataclass(frozen=True, slots=True)
class Contender:
    """A model, or a family of models with its fit."""

    name: str  # name in the league
    parameters: tuple[str, ...]  # names of the fitted parameters; empty for an unfitted model
    # function of a `DataSet` and row selections; the result is one least-squares model of r per selection
    fit: Callable[[DataSet, Sequence[BoolArray]], list[RestitutionModel]]


def as_it_is(model: RestitutionModel) -> Contender:
    """Return an unfitted contender."""
    return Contender(model.label, (), lambda data, rows: [model] * len(rows))


def with_interface(model: RestitutionModel) -> Contender:
    """Return a contender with a fitted interface factor."""

    def fit(data: DataSet, rows: Sequence[BoolArray]) -> list[RestitutionModel]:
        """Fit the factor by least squares."""
        r = model.of_slenderness(data.slenderness)
        return [Interface(model, eta=_best_eta(r[subset], data.coefficient[subset])) for subset in rows]

    return Contender(f"eta*{model.name}", ("eta",), fit)


def family(
    name: str,
    parameter: str,
    make: Callable[[float], RestitutionModel],
    coefficients: Callable[[ImpactGeometry, FloatArray], FloatArray],
    ends: tuple[float, float],
    *,
    eta: bool,
) -> Contender:
    """Return a contender with one fitted parameter, and optionally an interface factor.

    `make` gives the model for a parameter value. `coefficients` gives the coefficients of impacts for a column of
    values, one row per value.
    """

    def fit(data: DataSet, rows: Sequence[BoolArray]) -> list[RestitutionModel]:
        """Fit the parameter by bounded least squares."""
        geometry = ImpactGeometry.of_slenderness(data.slenderness)

        def factors(values: FloatArray, which: IntArray) -> tuple[list[float], list[float]]:
            """Return the interface factors and the misfits at values of the parameter, each value for its own rows."""
            every = np.maximum(coefficients(geometry, values[:, None]), 0.0)
            pairs = [(r[rows[i]], data.coefficient[rows[i]]) for r, i in zip(every, which.tolist(), strict=True)]
            best = [_best_eta(r, measured) if eta else 1.0 for r, measured in pairs]
            misfits = [
                float(((factor * r - measured) ** 2).sum()) for factor, (r, measured) in zip(best, pairs, strict=True)
            ]
            return best, misfits

        every = np.arange(len(rows))
        values = minimise_between(
            lambda values, which: np.array(factors(values, which)[1]), ends, len(rows), tolerance=1e-7
        )
        models = [make(value) for value in values.tolist()]
        if not eta:
            return models
        return [Interface(model, eta=factor) for model, factor in zip(models, factors(values, every)[0], strict=True)]

    prefix = "eta*" if eta else ""
    return Contender(f"{prefix}{name}({parameter})", (("eta", parameter) if eta else (parameter,)), fit)


def contact_bed(*, eta: bool) -> Contender:
    """Return the contact bed with fitted number of points and hardness, default damping, and optionally a factor."""
    default_damping = ContactBedModel().damping

    def family_with(points: int) -> Contender:
        return family(
            "contact-bed",
            "hardness",
            lambda x: ContactBedModel(points=points, hardness=x),
            lambda geometry, x: tabulated(geometry, points, default_damping, x),
            HARDNESS,
            eta=eta,
        )

    def fit(data: DataSet, rows: Sequence[BoolArray]) -> list[RestitutionModel]:
        """Fit the hardness with all numbers of points; return the least-squares model."""

        def closest(models: Sequence[RestitutionModel], subset: BoolArray) -> RestitutionModel:
            ratios, measured = data.slenderness[subset], data.coefficient[subset]
            return min(models, key=lambda model: float(((model.of_slenderness(ratios) - measured) ** 2).sum()))

        by_rows = zip(*(family_with(points).fit(data, rows) for points in POINTS), strict=True)
        return [closest(models, subset) for models, subset in zip(by_rows, rows, strict=True)]

    prefix, first = ("eta*", ("eta",)) if eta else ("", ())
    return Contender(f"{prefix}contact-bed(points, hardness)", (*first, "points", "hardness"), fit)


def contenders() -> list[Contender]:
    """Return the default contenders."""
    impulses = [ShiftedImpulse(k=2.0 / 3.0), *(DistributedImpulse(q=q) for q in (0.0, 1.0, 2.0))]
    unfitted = [Housner(), Ked(), HorizontalMomentum(), *impulses, PlasticWinkler(), ContactBedModel()]
    factored = [Housner(), Ked(), HorizontalMomentum(), PlasticWinkler()]
    by_position = ("shifted-impulse", "k", ShiftedImpulse, shifted, (0.0, 1.0))
    by_exponent = ("distributed-impulse", "q", DistributedImpulse, distributed, (0.0, 20.0))
    return [
        *(as_it_is(model) for model in unfitted),
        family(*by_position, eta=False),
        family(*by_exponent, eta=False),
        *(with_interface(model) for model in factored),
        family(*by_position, eta=True),
        family(*by_exponent, eta=True),
        contact_bed(eta=False),
        contact_bed(eta=True),
    ]


def _best_eta(model: FloatArray, measured: FloatArray) -> float:
    return float(np.clip((model @ measured) / (model @ model), 1e-6, 1.0))


_UNRESOLVED, _SLENDER = 6.0, 6.0
_PUBLISHED = (
    "Two sources, repeated tests of the same blocks and one tape-covered interface are little evidence. The behaviour "
    "of"
)


@dataclass(frozen=True, slots=True)
class LeagueRow:
    """Errors of one model in the comparison with the measurements."""

    name: str  # name in the league
    model: RestitutionModel  # model with fitted values
    parameters: tuple[str, ...]  # names of the fitted parameters
    rmse: float  # rmse, bias: of r, model minus experiment [-]
    bias: float
    rmse_low: float  # rmse_low, rmse_high: 95 % bootstrap interval, specimens resampled within their data sets [-]
    rmse_high: float
    correlation: float  # Pearson's correlation [-]
    concordance: float  # Lin's concordance [-]
    loss_rmse: float  # loss_rmse, log_loss_rmse: errors of the energy loss 1 - r^2, absolute and logarithmic [-]
    log_loss_rmse: float
    leave_one_out: float  # RMSE of predictions for rows that are omitted from the fit [-]
    leave_group_out: float  # RMSE of predictions for data sets that are omitted from the fit [-]
    bic: float  # BIC of the likelihood with rounding and a scatter that grows with the energy loss; lower is better
    by_group: dict[str, float]  # RMSE by data set [-]
    by_band: dict[str, float]  # RMSE by slenderness band [-]
    # 95 % paired bootstrap interval of the RMSE minus the RMSE of KED [-]; not resolved if zero is inside
    ahead_of_ked: tuple[float, float]

    @property
    def fitted(self) -> str:
        """Fitted values as text."""
        values = self.model.parameters
        return ", ".join(f"{name} = {values[name]:.4g}" for name in self.parameters)

    def answer(self) -> Answer:
        """Return the results of the model."""
        plain = {name: getattr(self, name) for name in self.__slots__ if name not in ("model", "parameters")}
        return Answer({**plain, "fitted": {name: self.model.parameters[name] for name in self.parameters}})


def league(extra: Sequence[RestitutionModel] = (), measurements: DataSet | None = None) -> tuple[LeagueRow, ...]:
    """Return the league table, sorted by the RMSE of r.

    Parameters
    ----------
    extra : sequence of RestitutionModel
        User models, compared without a fit.
    measurements : DataSet, optional
        Measurements; default: the 39 published coefficients.

    Returns
    -------
    tuple of LeagueRow
        One row per contender.

    Raises
    ------
    InvalidValueError
        If the measurements have fewer than five blocks.
    UnknownModelError
        If an element of `extra` is not a restitution model.

    Examples
    --------
    >>> [row.name for row in league() if not row.parameters][0]
    'horizontal-momentum'
    """
    data = all_measurements() if measurements is None else measurements
    if (count := len(set(zip(data.group, data.labels, data.slenderness.tolist(), strict=True)))) < FEWEST:
        raise InvalidValueError(
            "measurements of at least {fewest} blocks are required, got {count}", fewest=FEWEST, count=count
        )
    rows = [*_standing(data), *(_row(as_it_is(resolved(model)), data) for model in extra)]
    return tuple(sorted(rows, key=lambda row: row.rmse))


@lru_cache(maxsize=4)
def _standing(data: DataSet) -> tuple[LeagueRow, ...]:
    return tuple(_row(contender, data) for contender in contenders())


def _row(contender: Contender, data: DataSet) -> LeagueRow:
    measured = data.coefficient
    groups = {name: np.array([group == name for group in data.group]) for name in dict.fromkeys(data.group)}
    all_rows, without_row = np.ones(len(data), dtype=bool), list(~np.eye(len(data), dtype=bool))
    without_group = [~rows for rows in groups.values()]
    if contender.parameters and len(groups) == 1:
        without_group = []  # no result, because no rows remain for the fit
    model, *partial_fits = contender.fit(data, [all_rows, *without_row, *without_group])
    r = model.of_slenderness(data.slenderness)
    low, high = np.quantile(resampled((r - measured) ** 2, drawn(data)), [0.025, 0.975]).tolist()
    against_ked = compare(data, r, Ked().of_slenderness(data.slenderness))
    count = len(contender.parameters)
    bands = {name: (data.slenderness > a) & (data.slenderness <= b) for name, a, b in BANDS}
    measures = ("rmse", "bias", "correlation", "concordance", "loss_rmse", "log_loss_rmse")
    return LeagueRow(
        name=contender.name,
        model=model,
        parameters=contender.parameters,
        rmse_low=low,
        rmse_high=high,
        **{name: getattr(comparison, name)(r, measured) for name in measures},
        leave_one_out=_left_out(partial_fits[: len(without_row)], without_row, data),
        leave_group_out=_left_out(partial_fits[len(without_row) :], without_group, data) if without_group else math.nan,
        bic=rounding_bic(data, r, count),
        by_group={name: comparison.rmse(r[rows], measured[rows]) for name, rows in groups.items()},
        by_band={
            name: comparison.rmse(r[rows], measured[rows]) if rows.any() else math.nan for name, rows in bands.items()
        },
        ahead_of_ked=(against_ked.low, against_ked.high),
    )


def _left_out(models: Sequence[RestitutionModel], seen: Sequence[BoolArray], data: DataSet) -> float:
    """Return the RMSE of predictions of rows by models fitted to the other rows [-]."""
    predicted = np.empty(len(data))
    for model, rows in zip(models, seen, strict=True):
        predicted[~rows] = model.of_slenderness(data.slenderness[~rows])
    return comparison.rmse(predicted, data.coefficient)


def verdict(rows: Sequence[LeagueRow], measurements: DataSet | None = None) -> tuple[str, ...]:
    """Return the conclusions of the league table as sentences.

    Parameters
    ----------
    rows : sequence of LeagueRow
        The league, with the rows ``ked`` and ``housner``.
    measurements : DataSet, optional
        Measurements of the league; default: the 39 published coefficients.

    Returns
    -------
    tuple of str
        One or two sentences per conclusion.
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
        f"Models that these data do not distinguish (BIC within {_UNRESOLVED:g}): {', '.join(close)}. "
        f"{_PUBLISHED if data is all_measurements() else 'The behaviour of'} a model outside slenderness "
        f"{data.slenderness.min():g} to {data.slenderness.max():g}, or for other shapes, is not tested.",
    )


def _slender(data: DataSet, ked: LeagueRow, housner: LeagueRow) -> str:
    rows = data.rows(np.flatnonzero(data.slenderness > _SLENDER).tolist())
    return f"Above slenderness {_SLENDER:g}: {_between(rows, ked, housner, 'r')}. " if len(rows) else ""


def _between(data: DataSet, first_row: LeagueRow, second_row: LeagueRow, measure: str) -> str:
    first, second = (row.model.of_slenderness(data.slenderness) for row in (first_row, second_row))
    return compare(data, first, second, measure).sentence(first_row.name, second_row.name)


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
