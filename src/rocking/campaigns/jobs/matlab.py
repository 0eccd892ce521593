"""Results as a MATLAB file (version 5)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import Sheet
from rocking.campaigns.jobs.results import Results
from rocking.campaigns.jobs.study import TYPES, blocks
from rocking.errors import InvalidValueError
from rocking.quantities import QUANTITIES

MOST_BYTES = 2**31 - 1
"""Largest variable of a MATLAB file of version 5 [bytes]."""

_WORD = 80


def to_matlab(results: Results, path: Path) -> None:
    """Write results as a structure ``campaign``; the last dimension of the study is the last one there."""
    from scipy.io import savemat

    study = results.study
    if 8 * study.histories.count > MOST_BYTES:
        raise InvalidValueError(
            f"MATLAB files take arrays up to 2 GiB, these are {study.histories.count} histories; take .nc, "
            "which MATLAB reads"
        )
    whole = {name: np.empty(study.shape, kind) for name, kind in TYPES.items()}
    for first, last, arrays in results.pieces():
        for name, values in arrays.items():
            for place, part in blocks(first, last, study.shape):
                whole[name][place] = values[part].reshape(whole[name][place].shape)
    told: dict[str, Any] = {
        "dimensions": np.array(list(study.dims), dtype=object),
        "coordinates": {name: coordinate.values for name, coordinate in study.coordinates.items()},
        "results": whole,
        "units": {name: QUANTITIES[name].unit for name in TYPES},
        "provenance": results.attributes["provenance"],
    }
    savemat(path, {"campaign": told}, oned_as="column", appendmat=False, long_field_names=True)


def sheet_to_matlab(sheet: Sheet, path: Path, attributes: Mapping[str, Any]) -> None:
    """Write a table as a structure ``table`` of columns, with their units and meanings."""
    from scipy.io import savemat

    # a word is a matrix of its own there
    room = sum(_WORD * each.values.size if each.is_words else each.values.nbytes for each in sheet.columns.values())
    if room > MOST_BYTES:
        raise InvalidValueError(
            f"MATLAB files take tables up to 2 GiB, this one has {sheet.rows} rows; take .nc, which MATLAB reads"
        )
    columns = {each.variable or name: each for name, each in sheet.columns.items()}
    told = {
        "columns": {n: each.values.astype(object) if each.is_words else each.values for n, each in columns.items()},
        "names": dict(zip(columns, sheet.columns, strict=True)),
        "units": {name: each.unit for name, each in columns.items()},
        "words": {name: each.words for name, each in columns.items()},
        "provenance": attributes["provenance"],
    }
    savemat(path, {"table": told}, oned_as="column", appendmat=False, long_field_names=True)
