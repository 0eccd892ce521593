"""The front door: an inventory assessed, as a labelled dataset."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import g
from rocking.errors import InvalidValueError, extra
from rocking.messages import plain_texts
from rocking.motions.motion import GroundMotion
from rocking.studies.inventory.assessment import Assessment, assess
from rocking.studies.inventory.hazard import COUNT, FAMILY, SEED, Hazard, IntensityLevel
from rocking.studies.inventory.lights import Light, Thresholds
from rocking.studies.inventory.objects import DIRECTIONS, InventoryObject
from rocking.studies.inventory.reading import Inventory, read_inventory
from rocking.studies.inventory.table import advice, plan_words, remarks, sentence, words_of

if TYPE_CHECKING:
    import xarray as xr

# of each restitution, object and direction: kind and meaning
_OF_DIRECTIONS = {
    "count": (np.int64, "motions that were computed"),
    "lifted": (np.int64, "motions that lift it"),
    "overturned": (np.int64, "motions that overturn it"),
    "slid": (np.int64, "motions that make it slide, of objects in three dimensions"),
    "failed": (np.int64, "motions that could not be computed"),
    "lost_contact": (np.int64, "motions in which the ground would have to pull"),
    "median_rotation": (
        np.float64,
        "median of the peak rotation over the slenderness angle; infinite if it overturns there",
    ),
    "high_rotation": (
        np.float64,
        "84 % quantile of the peak rotation over the slenderness angle; infinite if it overturns",
    ),
}


def inventory(  # noqa: PLR0913 - every one of them is a question that users ask
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
    """Return which objects of a list stay standing at a level of shaking, the worst first.

    Parameters
    ----------
    objects : str, Path, Inventory or sequence of InventoryObject
        A list as .xlsx, .ods or CSV with the columns ``name``, ``width_cm``, ``depth_cm``, ``height_cm`` and more, in
        English, German, Italian, French, Spanish, Greek, Chinese or Turkish; or the objects. Scans and other bodies in
        space are named in a column ``body_file``, beside the list, with ``units`` of a mesh.
    motions : str, Hazard, GroundMotion, mapping, or a sequence of them
        The family of synthetic motions, or records; each acts in either direction by itself. Of records by axis, as for
        `simulate`, the one with the largest peak does, and in three dimensions the other horizontal one across it.
    restitution : str, RestitutionModel, float or mapping
        Restitution model, compared with Housner's (KED if Housner's is selected). Default: the calibrated model with a
        sampled coefficient per motion, compared with both.
    pga, pgv : str or float, optional
        Peak ground acceleration or velocity to which every motion is scaled, such as ``"0.3g"`` or ``"25cm/s"``, a
        number in SI; synthetic motions need one of the two, records are taken as they are without [m/s2 or m/s].
    count, seed : int, optional
        How many synthetic motions, 200 if not given, and their seed, 1 if not given [-].
    thresholds : Thresholds, optional
        What the lights mean.
    gravity : float
        Acceleration of gravity [m/s2].
    friction : float, optional
        Coefficient of friction where a row has none of its own: objects slide, rock and fall in three dimensions, each
        under every motion along its width and along its depth. Without one a box rocks in a plane, and a body of a file
        does not slide [-].
    map_columns : str or mapping of str to str, optional
        What columns of a list are that are not understood, by their titles: ``"Objekt=name, Maß B=width_cm"``.
    **options
        ``threads`` of the fast engine, and ``progress``, told how many histories have been computed since it was last
        called.

    Returns
    -------
    xarray.Dataset
        Over ``object``, the worst first: light, worse direction, acceleration of uplift, interval of the share that
        overturns, and sentences, one of them with what would make it green; over ``restitution``, ``object`` and
        ``direction``: motions that lift it and overturn it, and rotations; over ``not_assessed`` the rows without a
        verdict and why, over ``not_object`` the lines that are no objects; with units, numbers and notes of the list.

    Raises
    ------
    InvalidValueError
        If there is no object, the motions are not said to be of any strength, or a value is outside its range.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import rocking as rk
    >>> ranking = rk.inventory(rk.examples.path("objects"), "point-source", pga="0.3g", count=5)
    >>> ranking["object"].values[[0, -1]].tolist(), ranking["light"].values[[0, -1]].tolist()
    (['tall clock', 'low stone chest'], ['red', 'green'])
    """
    if map_columns is not None and not isinstance(objects, (str, Path)):
        raise InvalidValueError("map_columns applies to files only. Remove map_columns.")
    everything = read_inventory(objects, map_columns=map_columns) if isinstance(objects, (str, Path)) else objects
    hazard = _hazard(motions, pga, pgv, count, seed)
    how = {"restitution": restitution, "thresholds": thresholds, "gravity": gravity, "friction": friction}
    assessment = assess(everything, hazard, **how, **options)
    return dataset_of(assessment)


def _hazard(motions: Any, pga: Any, pgv: Any, count: int | None, seed: int | None) -> Hazard:
    levels = {kind: value for kind, value in (("PGA", pga), ("PGV", pgv)) if value is not None}
    if len(levels) > 1:
        raise InvalidValueError("give pga or pgv, not both: motions are scaled to one of them")
    level = None
    for kind, value in levels.items():
        in_si = isinstance(value, (int, float)) and not isinstance(value, bool)
        level = IntensityLevel(kind, value) if in_si else IntensityLevel.of(kind, value)
    if isinstance(motions, str):
        if level is None:
            raise InvalidValueError('how strong is the shaking? Give pga="0.3g" or pgv="25cm/s", or records')
        number, start = COUNT if count is None else count, SEED if seed is None else seed
        return Hazard.of_family(motions, level, count=number, seed=start)
    odd = [name for name, value in (("count", count), ("seed", seed)) if value is not None]
    if odd:
        raise InvalidValueError("{names} is for synthetic motions: leave it out beside records", names=", ".join(odd))
    if isinstance(motions, Hazard):
        if level is not None:
            raise InvalidValueError("a hazard is scaled already: leave pga and pgv out")
        return motions
    return Hazard.of_records([motions] if isinstance(motions, (GroundMotion, Mapping)) else motions, level)


def dataset_of(assessment: Assessment) -> "xr.Dataset":
    """Return an assessment as a labelled dataset."""
    xarray = extra("xarray", "inventory")
    verdicts, sentences = assessment.verdicts, assessment.thresholds.sentences(assessment.language)
    names = [assessment.restitution, *assessment.comparisons]
    plan, say = {id(each.item): each for each in assessment.plan}, words_of(assessment)
    by_model = [[each.results for each in verdicts], *zip(*(each.compared for each in verdicts), strict=True)]
    results = [one for of_model in by_model for results in of_model for one in results]
    shape = (len(names), len(verdicts), len(DIRECTIONS))

    def table(name: str, kind: type, words: str) -> tuple[Any, np.ndarray, dict[str, str]]:
        values = [np.inf if (value := getattr(one, name)) is None else value for one in results]
        about = {"units": "1", "long_name": words}
        return ("restitution", "object", "direction"), np.array(values, dtype=kind).reshape(shape), about

    meanings = " ".join(f"{light.word}: {sentences[light]}" for light in reversed(Light))
    data: dict[str, Any] = {
        "light": ("object", [each.light.word for each in verdicts], {"long_name": meanings}),
        "worse_direction": ("object", [each.worse.direction for each in verdicts]),
        "uplift_acceleration": (
            "object", [each.uplift_acceleration for each in verdicts],
            {"units": "m/s2", "long_name": "ground acceleration below which it stays still in both directions"},
        ),
        "overturned_share_95": (
            ("object", "end"), np.array([each.interval for each in verdicts]).reshape(len(verdicts), 2),
            {"units": "1", "long_name": "interval of the share that overturns in the worse direction"},
        ),
        "in_words": ("object", [sentence(each, assessment) for each in verdicts]),
        "measures": ("object", [plan_words(plan[k], say) if (k := id(each.item)) in plan else "" for each in verdicts]),
        "what_to_do": ("object", [advice(each, assessment) for each in verdicts]),
        **{name: table(name, *about) for name, about in _OF_DIRECTIONS.items()},
        "reason": ("not_assessed", [say(each.reason) for each in assessment.not_assessed]),
        "not_object_reason": ("not_object", [say(each.reason) for each in assessment.not_objects]),
    }  # fmt: skip
    coordinates = {
        "object": [each.item.name for each in verdicts],
        "row": ("object", [each.item.row for each in verdicts], {"units": "1", "long_name": "line of its file"}),
        "number": ("object", [each.item.number for each in verdicts], {"long_name": "inventory number"}),
        "pieces": ("object", [each.item.count for each in verdicts], {"units": "1", "long_name": "pieces alike"}),
        "note": ("object", [each.item.note for each in verdicts], {"long_name": "what the list notes"}),
        "remarks": ("object", [remarks(each, assessment) for each in verdicts], {"long_name": "what was assumed"}),
        "direction": list(DIRECTIONS),
        "restitution": names,
        "end": ["low", "high"],
        "not_assessed": [each.name for each in assessment.not_assessed],
        "not_assessed_row": ("not_assessed", [each.row for each in assessment.not_assessed]),
        "not_assessed_number": ("not_assessed", [each.number for each in assessment.not_assessed]),
        "not_assessed_note": ("not_assessed", [each.note for each in assessment.not_assessed]),
        "not_object": [each.row for each in assessment.not_objects],
    }
    hazard = assessment.hazard
    about = {"inventory": assessment.source, "shaking": hazard.words(say.code), "motions": say(hazard.source)}
    labelled: xr.Dataset = xarray.Dataset(data, coords=coordinates, attrs=plain_texts(about))
    return labelled
