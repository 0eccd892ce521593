"""Assessment of an inventory, as a labelled dataset."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import g
from rocking.decision.inventory.assessment import Assessment, assess
from rocking.decision.inventory.hazard import COUNT, FAMILY, SEED, Hazard, IntensityLevel
from rocking.decision.inventory.lights import Light, Thresholds
from rocking.decision.inventory.lists.reader import Inventory, read_inventory
from rocking.decision.inventory.objects import DIRECTIONS, InventoryObject
from rocking.decision.inventory.ranking import advice, plan_words, remarks, sentence, words_of
from rocking.errors import InvalidValueError, extra
from rocking.messages import plain_texts
from rocking.motions.motion import GroundMotion

if TYPE_CHECKING:
    import xarray as xr

# variables over restitution, object and direction: type and description
_OF_DIRECTIONS = {
    "count": (np.int64, "number of computed motions"),
    "lifted": (np.int64, "number of motions with uplift"),
    "overturned": (np.int64, "number of motions with overturning"),
    "slid": (np.int64, "number of motions with sliding, of objects in three dimensions"),
    "failed": (np.int64, "number of motions that could not be computed"),
    "lost_contact": (np.int64, "number of motions with a tensile contact force"),
    "median_rotation": (
        np.float64,
        "median of the peak rotation over the slenderness angle; infinite if overturned",
    ),
    "high_rotation": (
        np.float64,
        "84 % quantile of the peak rotation over the slenderness angle; infinite if overturned",
    ),
}


def inventory(  # noqa: PLR0913 - users set every one of them
    objects: str | Path | Inventory | Sequence[InventoryObject],
    motions: str | Hazard | GroundMotion | Mapping[str, GroundMotion] | Sequence[Any] = FAMILY,
    restitution: Any = None,
    *,
    pga: str | float | None = None,
    pgv: str | float | None = None,
    count: int | None = None,
    seed: int | None = None,
    thresholds: Thresholds | None = None,
    gravity: float = g,
    friction: float | None = None,
    map_columns: str | Mapping[str, str] | None = None,
    **options: Any,
) -> "xr.Dataset":
    """Assess the objects of a list at an intensity level; return them with the worst first.

    Parameters
    ----------
    objects : str, Path, Inventory or sequence of InventoryObject
        A list as .xlsx, .ods or CSV with the columns ``name``, ``width_cm``, ``depth_cm``, ``height_cm`` and more, in
        English, German, Italian, French, Spanish, Greek, Chinese or Turkish; or the objects. A column ``body_file``
        names scans and other 3D bodies in the folder of the list, with ``units`` of a mesh.
    motions : str, Hazard, GroundMotion, mapping, or a sequence of them
        The family of synthetic motions, or records; each acts in each direction separately. Of records by axis, as for
        `simulate`, the component with the largest peak acts; in three dimensions the other horizontal component acts
        at right angles.
    restitution : str, RestitutionModel, float or mapping
        Restitution model, compared with Housner's (KED if Housner's is selected). Default: the calibrated model with a
        sampled coefficient per motion, compared with both.
    pga, pgv : str or float, optional
        Peak ground acceleration or velocity of every scaled motion, such as ``"0.3g"`` or ``"25cm/s"``, or a number in
        SI. Synthetic motions need one of the two; records are unscaled by default [m/s2 or m/s].
    count, seed : int, optional
        Number of synthetic motions (default 200) and their random seed (default 1) [-].
    thresholds : Thresholds, optional
        Thresholds of the lights.
    gravity : float
        Acceleration of gravity [m/s2].
    friction : float, optional
        Coefficient of friction of rows without one: objects slide, rock and overturn in three dimensions, under every
        motion along the width and along the depth. Without friction a box rocks in a plane, and a body of a file does
        not slide [-].
    map_columns : str or mapping of str to str, optional
        Meaning of columns with unknown titles: ``"Objekt=name, Maß B=width_cm"``.
    **options
        ``threads`` of the fast engine, and ``progress``, called with the number of histories computed since the last
        call.

    Returns
    -------
    xarray.Dataset
        Over ``object``, the worst first: rating, worse direction, uplift acceleration, interval of the overturning
        fraction, and sentences, with the measures that make it green. Over ``restitution``, ``object`` and
        ``direction``: numbers of motions with uplift and with overturning, and rotations. Over ``not_assessed``: rows
        without a verdict, with reasons. Over ``not_object``: other lines. The dataset also contains the units, and the
        numbers and notes of the list.

    Raises
    ------
    InvalidValueError
        If there is no object, synthetic motions have no level, or a value is outside its range.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import rocking as rk
    >>> ranking = rk.inventory(rk.examples.path("objects"), "point-source", pga="0.3g", count=5)
    >>> ranking["object"].values[[0, -1]].tolist(), ranking["rating"].values[[0, -1]].tolist()
    (['tall clock', 'low stone chest'], ['red', 'green'])
    """
    if map_columns is not None and not isinstance(objects, (str, Path)):
        raise InvalidValueError("map_columns applies to files only. Remove map_columns.")
    objects = read_inventory(objects, map_columns=map_columns) if isinstance(objects, (str, Path)) else objects
    hazard = _hazard(motions, pga, pgv, count, seed)
    settings = {"restitution": restitution, "thresholds": thresholds, "gravity": gravity, "friction": friction}
    return dataset_of(assess(objects, hazard, **settings, **options))


def _hazard(motions: Any, pga: Any, pgv: Any, count: int | None, seed: int | None) -> Hazard:
    levels = {kind: value for kind, value in (("PGA", pga), ("PGV", pgv)) if value is not None}
    if len(levels) > 1:
        raise InvalidValueError("Use pga or pgv, not both.")
    level = None
    for kind, value in levels.items():
        in_si = isinstance(value, (int, float)) and not isinstance(value, bool)
        level = IntensityLevel(kind, value) if in_si else IntensityLevel.of(kind, value)
    if isinstance(motions, str):
        if level is None:
            raise InvalidValueError('The intensity level is missing. Add pga="0.3g" or pgv="25cm/s", or use records.')
        number, start = COUNT if count is None else count, SEED if seed is None else seed
        return Hazard.of_family(motions, level, count=number, seed=start)
    odd = [name for name, value in (("count", count), ("seed", seed)) if value is not None]
    if odd:
        raise InvalidValueError(
            "{names} applies to synthetic motions only. Remove it, or remove the records.", names=", ".join(odd)
        )
    if isinstance(motions, Hazard):
        if level is not None:
            raise InvalidValueError("The hazard is already scaled. Remove pga and pgv.")
        return motions
    return Hazard.of_records([motions] if isinstance(motions, (GroundMotion, Mapping)) else motions, level)


def dataset_of(assessment: Assessment) -> "xr.Dataset":
    """Return an assessment as a labelled dataset."""
    xarray = extra("xarray", "inventory")
    verdicts, sentences = assessment.verdicts, assessment.thresholds.sentences(assessment.language)
    names = [assessment.restitution, *assessment.comparisons]
    plan, say = {id(entry.item): entry for entry in assessment.plan}, words_of(assessment)
    by_model = [
        [verdict.results for verdict in verdicts],
        *zip(*(verdict.compared for verdict in verdicts), strict=True),
    ]
    results = [result for of_model in by_model for pair in of_model for result in pair]
    shape = (len(names), len(verdicts), len(DIRECTIONS))

    def table(name: str, kind: type, long_name: str) -> tuple[Any, np.ndarray, dict[str, str]]:
        values = [np.inf if (value := getattr(result, name)) is None else value for result in results]
        about = {"units": "1", "long_name": long_name}
        return ("restitution", "object", "direction"), np.array(values, dtype=kind).reshape(shape), about

    meanings = " ".join(f"{light.word}: {sentences[light]}" for light in reversed(Light))
    data: dict[str, Any] = {
        "rating": ("object", [verdict.light.word for verdict in verdicts], {"long_name": meanings}),
        "worse_direction": ("object", [verdict.worse.direction for verdict in verdicts]),
        "uplift_acceleration": (
            "object", [verdict.uplift_acceleration for verdict in verdicts],
            {"units": "m/s2", "long_name": "ground acceleration of uplift, the smaller of both directions"},
        ),
        "overturned_fraction_95": (
            ("object", "end"), np.array([verdict.interval for verdict in verdicts]).reshape(len(verdicts), 2),
            {"units": "1", "long_name": "interval of the overturning fraction in the worse direction"},
        ),
        "text": ("object", [sentence(verdict, assessment) for verdict in verdicts]),
        "plan": (
            "object", [plan_words(plan[k], say) if (k := id(verdict.item)) in plan else "" for verdict in verdicts]
        ),
        "measures": ("object", [advice(verdict, assessment) for verdict in verdicts]),
        **{name: table(name, *about) for name, about in _OF_DIRECTIONS.items()},
        "reason": ("not_assessed", [say(row.reason) for row in assessment.not_assessed]),
        "not_object_reason": ("not_object", [say(row.reason) for row in assessment.not_objects]),
    }  # fmt: skip
    coordinates = {
        "object": [verdict.item.name for verdict in verdicts],
        "row": ("object", [verdict.item.row for verdict in verdicts], {"units": "1", "long_name": "line of its file"}),
        "number": ("object", [verdict.item.number for verdict in verdicts], {"long_name": "inventory number"}),
        "pieces": ("object", [verdict.item.count for verdict in verdicts], {"units": "1", "long_name": "equal pieces"}),
        "note": ("object", [verdict.item.note for verdict in verdicts], {"long_name": "note of the list"}),
        "remarks": ("object", [remarks(verdict, assessment) for verdict in verdicts], {"long_name": "assumptions"}),
        "direction": list(DIRECTIONS),
        "restitution": names,
        "end": ["low", "high"],
        "not_assessed": [row.name for row in assessment.not_assessed],
        "not_assessed_row": ("not_assessed", [row.row for row in assessment.not_assessed]),
        "not_assessed_number": ("not_assessed", [row.number for row in assessment.not_assessed]),
        "not_assessed_note": ("not_assessed", [row.note for row in assessment.not_assessed]),
        "not_object": [row.row for row in assessment.not_objects],
    }
    hazard = assessment.hazard
    about = {"inventory": assessment.source, "shaking": hazard.words(say.code), "motions": say(hazard.source)}
    labelled: xr.Dataset = xarray.Dataset(data, coords=coordinates, attrs=plain_texts(about))
    return labelled
