"""Export of fragility curves: parameters, points and FEMA P-58 as CSV, Excel, MATLAB or netCDF, and NRML."""

import json
import math
import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.messages import listed
from rocking.motions.intensity import MEASURES, exchange_unit, spectral_measure, spectral_period
from rocking.motions.summary import GROUND, words_on
from rocking.statistics.goodness import STATISTICS
from rocking.studies.fragility.curves import (
    CLAIMS,
    Crossing,
    FragilityModel,
    check_crossing,
    nested,
    uplift_words,
    variables_of,
)
from rocking.tables import Cell, Table, target_of
from rocking.tables import to_csv as table_to_csv
from rocking.tables import to_excel as tables_to_excel
from rocking.tables import to_mat as structure_to_mat
from rocking.tables import to_netcdf as dataset_to_netcdf

TABLES = ("parameters", "points", "fema-p58")  # exported tables
Destination = str | os.PathLike[str]


def table(model: FragilityModel, which: str = "parameters", *, crossing_curves: Crossing = "refuse") -> Table:
    """Return one of the tables of a model."""
    match checks.one_of("table", which, (*TABLES, "pelicun")):
        case "parameters":
            return _parameters(model)
        case "points":
            return _points(model)
        case "pelicun":
            return _pelicun(model, crossing_curves)
    return fema_p58_table(model, crossing_curves=crossing_curves)


def _parameters(model: FragilityModel) -> Table:
    unit, ends = f"[{model.unit}]", ("from", "to")
    entries = [(c.state, c) for c in model.curves]
    entries += [(f"{c.state}, alone", c.alone) for c in model.curves if c.alone is not None]
    curves = [replace(curve, alone=None) for _, curve in entries]
    evidence = {name: variable[1].tolist() for name, variable in variables_of(curves, model.levels.size, "").items()}
    intervals = {"median 95 %": ("median_95", unit), "dispersion 95 %": ("dispersion_95", "[-]")}
    repeated = {
        "median bootstrap 95 %": ("median_bootstrap_95", unit),
        "dispersion bootstrap 95 %": ("dispersion_bootstrap_95", "[-]"),
    }
    header = (
        "component", "state", "im", f"median {unit}", "dispersion [-]", "method", f"lowest level {unit}",
        f"highest level {unit}", "histories", "source",
        *(f"{label} {end} {units}" for label, (_, units) in intervals.items() for end in ends),
        "intervals by", "verdict", *(f"{name}{suffix} [-]" for name in STATISTICS for suffix in ("", " p-value")),
        "agreement",
    )  # fmt: skip
    if "bootstrap" in evidence:
        header += (*(f"{label} {end} {units}" for label, (_, units) in repeated.items() for end in ends), "bootstrap")
        intervals |= repeated
    common: dict[str, Cell] = {
        "component": model.name, "im": model.im, "method": "none", header[6]: float(model.levels[0]),
        header[7]: float(model.levels[-1]), "histories": int(np.sum(model.trials)), "source": model.source,
    }  # fmt: skip
    rows = []
    for k, (state, c) in enumerate(entries):
        cells = common | {
            "state": state, header[3]: c.median, header[4]: c.dispersion, "method": c.method,
            "intervals by": c.interval_method, "verdict": c.verdict,
        }  # fmt: skip
        numbers = {
            f"{label} {end} {units}": value
            for label, (name, units) in intervals.items()
            for end, value in zip(ends, evidence[name][k], strict=True)
        }
        for name in STATISTICS:
            numbers |= {f"{name} [-]": evidence[name][k], f"{name} p-value [-]": evidence[f"{name}_p_value"][k]}
        cells |= {name: value for name, value in numbers.items() if not math.isnan(value)}
        rows.append(cells | {name: evidence[name][k] for name in ("agreement", "bootstrap") if name in evidence})
    rows += [{**common, "state": state, "verdict": reason} for state, reason in model.without.items()]
    return Table.of_rows("parameters", header, [tuple(cells.get(name, "") for name in header) for cells in rows])


def _points(model: FragilityModel) -> Table:
    fitted = {c.state: c.probability(model.levels) for c in model.curves}
    observed = {f"observed {name} [histories]": np.asarray(values) for name, values in model.reached.items()}
    columns = {
        f"{model.im} [{model.unit}]": model.levels,
        "histories": np.asarray(model.trials),
        **observed,
        **{f"fitted {name} [-]": values for name, values in fitted.items()},
    }
    for curve in model.curves:
        fitted_alone, name = curve.alone or curve, f"{curve.state}{', alone' if curve.alone else ''}"
        if fitted_alone.repeated is not None and fitted_alone.repeated.band is not None:
            for end, values in zip(("from", "to"), fitted_alone.repeated.band, strict=True):
                columns[f"bootstrap 95 % {end} {name} [-]"] = values
    rows = tuple(zip(*(values.tolist() for values in columns.values()), strict=True))
    return Table.of_rows("points", tuple(columns), rows)


def fema_p58_table(
    model: FragilityModel,
    description: str = "",
    demand_parameter: str = "",
    quality: str = "Analytical",
    *,
    crossing_curves: Crossing = "refuse",
) -> Table:
    """Return the table of a component for FEMA P-58, one row per damage state.

    Parameters
    ----------
    model : FragilityModel
        The curves. The name of the model is the id of the component.
    description : str
        Description of the component.
    demand_parameter : str
        Name of the demand in FEMA P-58. Default: the measure.
    quality : str
        Quality of the data. Default: derived by analysis. The text continues with method and verdict of the curves.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}
        Treatment of curves that cross, as in `model_of`. A worse state must not be more probable than a lesser state.

    Returns
    -------
    Table
        Sequential damage states DS1, DS2, ... from the mildest to the worst state. Medians of accelerations are in g,
        as in files for PELICUN and OpenQuake. The table contains the unit.

    Raises
    ------
    InvalidValueError
        If curves cross and `crossing_curves` is "refuse".

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
    model = nested(model, crossing_curves)
    demand, count = demand_parameter or words_on(_support(model), model.im), int(np.sum(model.trials))
    unit, size = exchange_unit(model.im, model.unit)
    unit = "dimensionless" if unit == "-" else unit
    about = (model.adjusted, "" if model.uplift_threshold is None else uplift_words(model))
    rows = tuple(
        (
            model.name, description, f"DS{k}", curve.state, curve.median * size, curve.dispersion, demand, unit,
            "sequential", listed((quality, curve.method, curve.verdict, *about)), model.source, count,
        )
        for k, curve in enumerate(model.curves, 1)
    )  # fmt: skip
    return Table.of_rows("fema-p58", header, rows)


_PELICUN = "ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"
_LIMIT_STATE = "Family", "Theta_0", "Theta_1", "DamageStateWeights"


def pelicun_demand(measure: str, support: str = GROUND) -> str:
    """Return the demand of a measure in PELICUN 3, for motions of a support."""
    # layout, names of demands, and spectral|period are as in NHERI-SimCenter/DamageAndLossModelLibrary, fragility.csv
    # of seismic/power_network (Hazus v5.1), vocabularies.py, and fragility.csv of California RC Bridges 2025
    spectral = spectral_period(measure)
    if measure != "pga" and (spectral is None or spectral[1] != 0.05):
        raise InvalidValueError(
            "PELICUN requires curves over pga or sa(period) with 5 % damping, got {measure!r:.60}",
            measure=measure, hint="for other measures, export to FEMA P-58 or OpenQuake (NRML)",
        )  # fmt: skip
    on_floor = support != GROUND
    if on_floor and spectral is not None:
        raise InvalidValueError(
            "PELICUN requires curves over pga (Peak Floor Acceleration) for motions of {support}, got "
            "{measure!r:.60}", support=support, measure=measure,
        )  # fmt: skip
    peak = f"Peak {'Floor' if on_floor else 'Ground'} Acceleration"
    return peak if spectral is None else f"Spectral Acceleration|{spectral[0]!r}"


def _pelicun(model: FragilityModel, crossing_curves: Crossing) -> Table:
    """Return the damage model of a component for PELICUN 3: one row, accelerations in g."""
    demand = pelicun_demand(model.im, _support(model))
    unit, size = exchange_unit(model.im, model.unit)
    # Demand-Directional is 1, because the curve is for a motion in one direction; with 0, PELICUN uses the larger of
    # two directions times NonDirectionalMultipliers, default 1.2 (pelicun/model/demand_model.py)
    row: list[Cell] = [model.name, 0, demand, unit, 0, 1]
    curves = nested(model, crossing_curves).curves
    for curve in curves:
        row += ["lognormal", curve.median * size, curve.dispersion, ""]
    head = (*_PELICUN, *(f"LS{k}-{name}" for k in range(1, len(curves) + 1) for name in _LIMIT_STATE))
    return Table.of_rows("pelicun", head, [tuple(row)])


def to_csv(
    model: FragilityModel,
    path: Destination,
    which: str | Table = "parameters",
    *,
    crossing_curves: Crossing = "refuse",
) -> Path:
    """Write a table of a model as comma-separated values with all digits.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.
    which : {"parameters", "points", "fema-p58", "pelicun"} or Table
        The table. For PELICUN 3, a damage model of one component over pga or sa(period), in g.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}
        Treatment of curves that cross, as in `model_of`, in the tables of FEMA P-58 and PELICUN.

    Returns
    -------
    Path
        The file. Text that a spreadsheet would read as a formula starts with an apostrophe.
    """
    content = which if isinstance(which, Table) else table(model, which, crossing_curves=crossing_curves)
    return table_to_csv(content, target_of(path))


def to_excel(model: FragilityModel, path: Destination, *, crossing_curves: Crossing = "refuse") -> Path:
    """Write all tables of a model as a workbook, one sheet per table. Text is never stored as a formula.

    Parameters
    ----------
    model, path, crossing_curves
        As for `to_csv`. If curves cross and `crossing_curves` is "refuse", the sheet of FEMA P-58 contains the reason.

    Returns
    -------
    Path
        The file.
    """
    target = target_of(path)
    tables_to_excel([(name, _sheet(model, name, crossing_curves)) for name in TABLES], target, model.about)
    return target


def _sheet(model: FragilityModel, name: str, crossing_curves: Crossing) -> Table:
    """Return a table. If it cannot be exported, return a table with the reason."""
    check_crossing(crossing_curves)
    try:
        return table(model, name, crossing_curves=crossing_curves)
    except InvalidValueError as error:
        return Table.of_rows(name, (str(error),), ())


def to_mat(model: FragilityModel, path: Destination) -> Path:
    """Write a model as a MATLAB file (version 5) with one structure ``fragility``.

    Parameters
    ----------
    model, path
        As for `to_csv`.

    Returns
    -------
    Path
        The file. It contains states, median and dispersion with intervals (NaN for open ends), goodness of fit (NaN if
        missing), requested bootstrap, levels, trials, exceeded, probability, texts and provenance.
    """
    structure = {
        "component": model.name,
        "im": model.im,
        "unit": model.unit,
        "source": model.source,
        "limit_states": np.array([c.state for c in model.curves], dtype=object),
        **{claim: np.array([getattr(c, claim) for c in model.curves], dtype=object) for claim in CLAIMS},
        "median": np.array([c.median for c in model.curves]),
        "dispersion": np.array([c.dispersion for c in model.curves]),
        **_evidence(model),
        "levels": model.levels,
        "trials": np.asarray(model.trials, dtype=np.float64),
        "counted_states": np.array(list(model.reached), dtype=object),
        "exceeded": np.array([np.asarray(v, dtype=np.float64) for v in model.reached.values()]),
        "probability": np.array([c.probability(model.levels) for c in model.curves]),
        "adjusted": model.adjusted,
        "provenance": json.dumps(dict(model.about)),
    }
    return structure_to_mat(structure, target_of(path), "fragility")


def _evidence(model: FragilityModel) -> dict[str, Any]:
    """Return intervals, goodness of fit and bootstrap, one row per state, and reasons for missing curves."""
    evidence = {
        name: np.asarray(values)
        for name, (_, values, *_) in variables_of(model.curves, model.levels.size, model.unit).items()
    }
    texts = {name: values.astype(object) for name, values in evidence.items() if values.dtype.kind == "U"}
    without = {"state": list(model.without), "reason": list(model.without.values())}
    return evidence | texts | {"without_curve": {name: np.array(v, dtype=object) for name, v in without.items()}}


def to_netcdf(model: FragilityModel, path: Destination) -> Path:
    """Write a model as netCDF 4, which xarray and MATLAB open.

    Parameters
    ----------
    model, path
        As for `to_csv`.

    Returns
    -------
    Path
        The file.
    """
    return dataset_to_netcdf(model.dataset, target_of(path))


NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"
LOSS_CATEGORIES = ("structural", "nonstructural", "contents", "business_interruption", "occupants")

_XML = re.compile("[\\t\\n\\r\\x20-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]+")


def to_nrml(
    model: FragilityModel,
    path: Destination,
    *,
    asset_category: str = "contents",
    loss_category: str = "contents",
    description: str = "",
    highest: float | None = None,
    crossing_curves: Crossing = "refuse",
) -> Path:
    """Write a model as an OpenQuake fragility model (NRML 0.5).

    The parameters in NRML are mean and standard deviation of the lognormal variable, not of its logarithm.

    Parameters
    ----------
    model : FragilityModel
        The curves, over a measure of OpenQuake: pga, pgv, pgd, sa(period) with 5 % damping, arias or cav.
    path : str or path
        The file.
    asset_category : str
        Category of the assets.
    loss_category : {"structural", "nonstructural", "contents", "business_interruption", "occupants"}
        Category of the loss.
    description : str
        Description. Default: the source of the model. The text continues with method and verdict of the curves.
    highest : float, optional
        Largest value of the measure in OpenQuake [unit of the measure]. Default: 4 dispersions above all medians and
        levels.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}
        Treatment of curves that cross within the range of the file, as in `model_of`. Curves that cross would give
        negative probabilities of states.

    Returns
    -------
    Path
        The file. If there is a threshold of uplift, OpenQuake uses zero probability below it.

    Raises
    ------
    InvalidValueError
        If OpenQuake does not have the measure or loss category, if a name is not allowed in XML, or if curves cross.
    """
    target = target_of(path)
    loss_category = checks.one_of("loss_category", loss_category, LOSS_CATEGORIES)
    if _support(model) != GROUND:
        raise InvalidValueError(
            "OpenQuake requires the {measure} of the ground; these motions are of {support}. Fit curves to ground "
            "motions, or export to PELICUN or FEMA P-58.", measure=model.im, support=_support(model),
        )  # fmt: skip
    imt, unit, size = intensity_type(model.im)
    model = nested(model, crossing_curves, None if highest is None else checks.positive("highest", highest, model.unit))
    top = model.highest if highest is None else highest
    limit_states = _identifiers([curve.state for curve in model.curves])
    root = ET.Element("nrml", xmlns=NAMESPACE)
    about = {"id": _identifier(model.name), "assetCategory": asset_category, "lossCategory": loss_category}
    node = ET.SubElement(root, "fragilityModel", {k: _word(v) for k, v in about.items()})
    ET.SubElement(node, "description").text = _word(_description(model, description, unit))
    ET.SubElement(node, "limitStates").text = " ".join(limit_states)
    function = ET.SubElement(
        node, "fragilityFunction", {"id": _word(model.name), "format": "continuous", "shape": "logncdf"}
    )
    levels = {
        "noDamageLimit": (model.uplift_threshold or 0.0) * size,
        "minIML": 0.0,
        "maxIML": checks.positive("highest", top, model.unit) * size,
    }
    ET.SubElement(function, "imls", {"imt": imt} | {name: repr(value) for name, value in levels.items()})
    for state, curve in zip(limit_states, model.curves, strict=True):
        mean, deviation = moments_of_lognormal(curve.median * size, curve.dispersion)
        ET.SubElement(function, "params", {"ls": state, "mean": repr(mean), "stddev": repr(deviation)})
    ET.indent(root)
    ET.ElementTree(root).write(target, encoding="utf-8", xml_declaration=True)
    return target


def intensity_type(measure: str) -> tuple[str, str, float]:
    """Return name and unit of a measure in OpenQuake, and the size of one SI unit in this unit."""
    period = spectral_period(measure)
    im = MEASURES.get(measure) if period is None else spectral_measure(*period)
    if im is None or im.openquake is None:
        supported = ", ".join(name for name, candidate in MEASURES.items() if candidate.openquake)
        raise InvalidValueError(
            "OpenQuake supports {names} and sa(period) with 5 % damping, got {measure!r:.60}", names=supported,
            measure=measure, hint="Fit the curves to one of these measures.",
        )  # fmt: skip
    return im.openquake


def _support(model: FragilityModel) -> str:
    return str(model.about.get("support", GROUND))


def moments_of_lognormal(median: float, dispersion: float) -> tuple[float, float]:
    """Return mean and standard deviation of a lognormal variable, in the unit of its median."""
    if dispersion > 25.0:
        raise InvalidValueError(
            parameter="dispersion", allowed="at most 25 for a finite standard deviation", value=float(dispersion)
        )
    mean = median * math.exp(0.5 * dispersion**2)  # Eq. 228
    return mean, mean * math.sqrt(math.expm1(dispersion**2))  # Eq. 228


def _description(model: FragilityModel, description: str, unit: str) -> str:
    claims = [f"{c.state}: {'; '.join(filter(None, (c.method, c.verdict)))}" for c in model.curves if c.method]
    about = [f"{model.im} in {unit}", *([model.adjusted] if model.adjusted else [])]
    return " | ".join([description or model.source or "fragility of a rocking body", *about, *claims])


def _identifier(name: str) -> str:
    plain = re.sub(r"[^A-Za-z0-9_-]+", "_", name).strip("_")[:60]
    return plain or "fragility"


def _identifiers(names: list[str]) -> list[str]:
    """Return names of limit states for a list separated by blanks, with only letters, digits and underscores."""
    plain = [re.sub(r"[^A-Za-z0-9]+", "_", name.replace(">", "above")).strip("_") or "state" for name in names]
    plain = [name if name[0].isalpha() else f"state_{name}" for name in plain]
    return [name if plain.count(name) == 1 else f"{name}_{k}" for k, name in enumerate(plain, 1)]


def _word(text: str) -> str:
    """Return a text. Raise an error if XML does not allow one of its characters."""
    if not _XML.fullmatch(text):
        raise InvalidValueError("A text in XML must be printable and not empty, got {word!r:.60}.", word=text)
    return text
