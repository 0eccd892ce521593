"""Fragility curves as tables of plain cells: parameters, points, and the style of FEMA P-58."""

import math

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.studies.fragility.agreement import STATISTICS, Ends, Repeated
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel
from rocking.studies.fragility.nesting import Crossing, nested
from rocking.tables import Cell, Table

TABLES = ("parameters", "points", "fema-p58")
"""Tables that can be written."""


def table(model: FragilityModel, which: str = "parameters", *, crossing: Crossing = "refuse") -> Table:
    """Return one of the tables of a model."""
    made = {"parameters": _parameters, "points": _points}
    given: object = which
    if not isinstance(given, str) or which not in TABLES:
        raise InvalidValueError(f"table must be one of {', '.join(TABLES)}, got {which!r:.60}")
    return made[which](model) if which in made else fema_p58_table(model, crossing=crossing)


def _bracket(model: FragilityModel) -> str:
    return f"[{model.unit}]"


def _parameters(model: FragilityModel) -> Table:
    header = (
        "component", "state", "measure", f"median {_bracket(model)}", "dispersion [-]", "method",
        f"lowest level {_bracket(model)}", f"highest level {_bracket(model)}", "histories", "source",
        f"median 95 % from {_bracket(model)}", f"median 95 % to {_bracket(model)}", "dispersion 95 % from [-]",
        "dispersion 95 % to [-]", "intervals by", "verdict", *_AGREEMENT,
    )  # fmt: skip
    repeated = any(c.repeated for c in model.curves)
    if repeated:
        words = (f"median bootstrap 95 % {{}} {_bracket(model)}", "dispersion bootstrap 95 % {} [-]")
        header += (*(word.format(end) for word in words for end in ("from", "to")), "bootstrap")
    ends = float(model.levels[0]), float(model.levels[-1])
    count = int(np.sum(model.trials))
    rows = tuple(
        (
            model.name, c.state, model.measure, c.median, c.dispersion, c.method, *ends, count, model.source,
            *_cells(c.median_95), *_cells(c.dispersion_95), c.interval_method, c.verdict,
            *_agreement(c), *(_repeated(c.repeated) if repeated else ()),
        )
        for c in model.curves
    )  # fmt: skip
    known: dict[str, Cell] = {"component": model.name, "measure": model.measure, "method": "none"}
    known |= {"source": model.source, "histories": count, header[6]: ends[0], header[7]: ends[1]}
    for state, why in model.without.items():
        cells = {**known, "state": state, "verdict": why}
        rows += (tuple(cells.get(name, "") for name in header),)
    return Table.of_rows("parameters", header, rows)


_AGREEMENT = (*(f"{name}{what} [-]" for name in STATISTICS for what in ("", " p-value")), "agreement")


def _agreement(curve: FragilityCurve) -> tuple[Cell, ...]:
    if curve.agreement is None:
        return ("",) * len(_AGREEMENT)
    numbers = [number for name in STATISTICS for number in curve.agreement.numbers[name]]
    return (*("" if math.isnan(number) else number for number in numbers), curve.agreement.words)


def _repeated(found: Repeated | None) -> tuple[Cell, ...]:
    told = found or Repeated()
    return (*_cells(told.median_95), *_cells(told.dispersion_95), told.words)


def _cells(interval: Ends | None) -> tuple[Cell, Cell]:
    low, high = ("" if end is None else end for end in interval or (None, None))
    return low, high


def _points(model: FragilityModel) -> Table:
    fitted = {c.state: c.probability(model.levels) for c in model.curves}
    observed = {f"observed {name} [histories]": np.asarray(values) for name, values in model.reached.items()}
    columns = {
        f"{model.measure} {_bracket(model)}": model.levels,
        "histories": np.asarray(model.trials),
        **observed,
        **{f"fitted {name} [-]": values for name, values in fitted.items()},
    }
    for curve in model.curves:
        if curve.repeated is not None and curve.repeated.band is not None:
            for end, values in zip(("from", "to"), curve.repeated.band, strict=True):
                columns[f"bootstrap 95 % {end} {curve.state} [-]"] = values
    rows = tuple(zip(*(values.tolist() for values in columns.values()), strict=True))
    return Table.of_rows("points", tuple(columns), rows)


def fema_p58_table(
    model: FragilityModel,
    description: str = "",
    demand_parameter: str = "",
    quality: str = "Analytical",
    *,
    crossing: Crossing = "refuse",
) -> Table:
    """Return the table of a component as FEMA P-58 asks for it, one row a damage state.

    Parameters
    ----------
    model : FragilityModel
        The curves; its name is the component's id.
    description : str
        What the component is.
    demand_parameter : str
        The demand in the words of the method; the measure, if not given.
    quality : str
        What the data are: a derivation by analysis, unless said otherwise. How each curve was fitted, and what can be
        claimed of it, stands after it.
    crossing : {"refuse", "common-dispersion"}
        What to do with curves that cross: no worse damage state may be likelier than a lesser one.

    Returns
    -------
    Table
        Damage states DS1, DS2, ... from the least to the worst, sequential.

    Raises
    ------
    InvalidValueError
        If curves cross and `crossing` is "refuse".

    Examples
    --------
    >>> from rocking.studies.fragility.curves import FragilityCurve
    >>> curve = FragilityCurve("overturned", 3.0, 0.4)
    >>> model = FragilityModel("E2022.001", "pga", "m/s2", (curve,), [1.0, 5.0], [9, 9], {}, "a study")
    >>> fema_p58_table(model).rows[0][:4]
    ('E2022.001', '', 'DS1', 'overturned')
    """
    header = (
        "Component ID", "Component Description", "Damage State", "Damage State Description", "Median Demand",
        "Total Dispersion (Beta)", "Demand Parameter", "Demand Unit", "Damage State Relation",
        "Data Quality and Relevance", "Source of Data", "Number of Histories",
    )  # fmt: skip
    model = nested(model, crossing)
    demand, count = demand_parameter or model.measure, int(np.sum(model.trials))
    unit = "dimensionless" if model.unit == "-" else model.unit
    rows = tuple(
        (
            model.name, description, f"DS{k}", curve.state, curve.median, curve.dispersion, demand, unit,
            "sequential", "; ".join(part for part in (quality, curve.method, curve.verdict) if part), model.source,
            count,
        )
        for k, curve in enumerate(model.curves, 1)
    )  # fmt: skip
    return Table.of_rows("fema-p58", header, rows)


def with_added_dispersion(dispersion: float, *others: float) -> float:
    """Return the dispersion with others added, as the root of the sum of squares.

    dispersion: dispersion from record to record [-]; *others: of modelling, of construction, and so on [-]. Returns
    total dispersion [-].

    >>> round(with_added_dispersion(0.3, 0.4), 12)
    0.5
    """
    parts = [checks.positive("dispersion", dispersion)]
    parts += [checks.within("dispersion", other, 0.0, 10.0) for other in others]
    return math.hypot(*parts)
