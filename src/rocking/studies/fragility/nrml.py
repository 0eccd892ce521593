"""Fragility as OpenQuake reads it: NRML 0.5, continuous lognormal functions."""

import math
import re
from pathlib import Path
from xml.etree import ElementTree as ET

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions.intensity import MEASURES, spectral_measure, spectral_period
from rocking.studies.fragility.curves import Crossing, FragilityModel, nested
from rocking.studies.fragility.export import Destination
from rocking.tables import target_of

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
    crossing: Crossing = "refuse",
) -> Path:
    """Write a model as an OpenQuake fragility model (NRML 0.5).

    The parameters there are mean and standard deviation of the lognormal variable itself, not of its logarithm.

    Parameters
    ----------
    model : FragilityModel
        The curves, against a measure that OpenQuake knows: pga, pgv, pgd, sa(period) with 5 % damping, arias or cav.
    path : str or path
        The file.
    asset_category : str
        What the assets are.
    loss_category : {"structural", "nonstructural", "contents", "business_interruption", "occupants"}
        What kind of loss.
    description : str
        Words for the reader; the source of the model, if not given. How each curve was fitted, and what can be claimed
        of it, stands after them.
    highest : float, optional
        OpenQuake takes the measure for no larger than this; four dispersions above all medians and all levels, if
        not given [unit of the measure].
    crossing : {"refuse", "common-dispersion"}
        What to do with curves that cross between the ends of the file: no worse state may be likelier than a lesser
        one, or the file gives states negative probabilities.

    Returns
    -------
    Path
        The file. Below the level where nothing rocks, if there is one, OpenQuake takes all probabilities for zero.

    Raises
    ------
    InvalidValueError
        If OpenQuake does not know the measure or the loss category, a name cannot stand in XML, or curves cross.
    """
    target = target_of(path)
    if loss_category not in LOSS_CATEGORIES:
        raise InvalidValueError(f"loss_category must be one of {', '.join(LOSS_CATEGORIES)}, got {loss_category!r:.60}")
    imt, unit = intensity_type(model.measure)
    model = nested(model, crossing, None if highest is None else checks.positive("highest", highest, model.unit))
    top = model.highest if highest is None else highest
    states = _identifiers([curve.state for curve in model.curves])
    root = ET.Element("nrml", xmlns=NAMESPACE)
    about = {"id": _identifier(model.name), "assetCategory": asset_category, "lossCategory": loss_category}
    node = ET.SubElement(root, "fragilityModel", {k: _word(v) for k, v in about.items()})
    ET.SubElement(node, "description").text = _word(_description(model, description))
    ET.SubElement(node, "limitStates").text = " ".join(states)
    function = ET.SubElement(
        node, "fragilityFunction", {"id": _word(model.name), "format": "continuous", "shape": "logncdf"}
    )
    levels = {
        "noDamageLimit": (model.uplift_threshold or 0.0) * unit,
        "minIML": 0.0,
        "maxIML": checks.positive("highest", top, model.unit) * unit,
    }
    ET.SubElement(function, "imls", {"imt": imt} | {name: repr(value) for name, value in levels.items()})
    for state, curve in zip(states, model.curves, strict=True):
        mean, deviation = moments_of_lognormal(curve.median * unit, curve.dispersion)
        ET.SubElement(function, "params", {"ls": state, "mean": repr(mean), "stddev": repr(deviation)})
    ET.indent(root)
    ET.ElementTree(root).write(target, encoding="utf-8", xml_declaration=True)
    return target


def intensity_type(measure: str) -> tuple[str, float]:
    """Return what OpenQuake calls a measure, and the factor from SI to its unit.

    Returns factor: one SI unit in the unit there: g, cm/s, cm, m/s or g s.

    >>> intensity_type("pgv")
    ('PGV', 100.0)
    """
    period = spectral_period(measure)
    one = MEASURES.get(measure) if period is None else spectral_measure(*period)
    if one is None or one.openquake is None:
        known = ", ".join(name for name, each in MEASURES.items() if each.openquake)
        raise InvalidValueError(
            f"OpenQuake knows {known} and sa(period) with 5 % damping, got {measure!r:.60}; "
            "fit the curves against one of these"
        )
    return one.openquake


def moments_of_lognormal(median: float, dispersion: float) -> tuple[float, float]:
    """Return mean and standard deviation of a lognormal variable.

    median: its median [any unit]; dispersion: standard deviation of its natural logarithm [-]. Returns of the variable
    [the same unit].

    >>> mean, deviation = moments_of_lognormal(1.0, 0.5)
    >>> round(mean, 6), round(deviation, 6)
    (1.133148, 0.603901)
    """
    if dispersion > 25.0:
        raise InvalidValueError(f"dispersion must be at most 25 for a finite standard deviation, got {dispersion:g}")
    mean = median * math.exp(0.5 * dispersion**2)  # Eq. 228
    return mean, mean * math.sqrt(math.expm1(dispersion**2))  # Eq. 228


def _description(model: FragilityModel, given: str) -> str:
    claims = [f"{c.state}: {'; '.join(filter(None, (c.method, c.verdict)))}" for c in model.curves if c.method]
    return " | ".join([given or model.source or "fragility of a rocking body", *claims])


def _identifier(name: str) -> str:
    made = re.sub(r"[^A-Za-z0-9_-]+", "_", name).strip("_")[:60]
    return made or "fragility"


def _identifiers(names: list[str]) -> list[str]:
    """Names of limit states stand in a list separated by blanks: they hold letters, digits and underscores only."""
    made = [re.sub(r"[^A-Za-z0-9]+", "_", name.replace(">", "above")).strip("_") or "state" for name in names]
    made = [name if name[0].isalpha() else f"state_{name}" for name in made]
    return [name if made.count(name) == 1 else f"{name}_{k}" for k, name in enumerate(made, 1)]


def _word(text: str) -> str:
    """Refuse what no XML file can hold, escaped or not."""
    if not _XML.fullmatch(text):
        raise InvalidValueError(f"words in XML must be printable and not empty, got {text!r:.60}")
    return text
