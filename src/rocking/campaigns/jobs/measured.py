"""What a cloud job says of measures of intensity: which are compared, and against what else is known of the motions."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.intensity import measure
from rocking.studies.fragility.measure_comparison import DEFAULT_MEASURES
from rocking.studies.motion_sets import MotionList, MotionSet

if TYPE_CHECKING:
    from rocking.spec.document import CampaignDocument

USUAL_COLUMNS = ("magnitude", "ln distance_km")
"""Metadata that the sufficiency is tested against, where all motions have them and the job names none."""

_LOGARITHM = "ln "


def check_told(document: "CampaignDocument", motions: MotionSet) -> None:
    """Refuse measures and columns that there are not; of the motions only the first is asked."""
    measures_of(document)
    if document.export is not None and document.export.columns:
        columns_of(document, MotionList(motions[0]))


def measures_of(document: "CampaignDocument") -> list[str]:
    """Return the measures that a job compares.

    Returns those of ``[export] measures``; else the usual ones, and that of the job.
    """
    told = None if document.export is None else document.export.measures
    own = "pga" if document.fragility is None else document.fragility.measure
    names = [*DEFAULT_MEASURES, own] if told is None else told
    known = [measure(name).name for name in names]
    twice = [name for name in known if known.count(name) > 1]
    if told is not None and twice:
        raise InvalidValueError(f"measures: {twice[0]} is named twice")
    return list(dict.fromkeys(known))


def columns_of(document: "CampaignDocument", motions: MotionSet) -> dict[str, FloatArray]:
    """Return what is known of the motions beside their measures.

    Returns numbers in the metadata of the motions, by ``[export] columns``, or those of `USUAL_COLUMNS` that there are;
    a name that begins with ``ln`` is the logarithm of what follows.
    """
    told = None if document.export is None else document.export.columns
    wanted = USUAL_COLUMNS if told is None else told
    found: dict[str, list[float]] = {name: [] for name in wanted}
    if len(found) < len(wanted):
        raise InvalidValueError(f"columns: one of {', '.join(wanted)} is named twice")
    for k in range(len(motions)):
        motion = motions[k]
        metadata = getattr(motion, "metadata", {})
        for name in list(found):
            try:
                found[name].append(_number(name, metadata))
            except ValueError as error:
                if told is not None:
                    raise InvalidValueError(
                        f"columns: {name!r:.60} must be a number of every motion, {error} of motion {k}, "
                        f"{motion.name!r:.60}, which knows {', '.join(metadata) or 'nothing'}"
                    ) from error
                del found[name]
        if not found:
            break
    return {name: np.array(values) for name, values in found.items()}


def _number(name: str, metadata: Any) -> float:
    """Return a number of the metadata, or its logarithm; a ValueError says why there is none."""
    key = name.removeprefix(_LOGARITHM)
    if key not in metadata:
        raise ValueError("there is none")
    try:
        value = float(metadata[key])
    except ValueError as error:
        raise ValueError(f"got {metadata[key]!r:.40}") from error
    if not math.isfinite(value) or (name != key and value <= 0.0):
        raise ValueError(f"got {value:g}")
    return math.log(value) if name != key else value
