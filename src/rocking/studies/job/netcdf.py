"""Results as netCDF 4, written chunk by chunk: the file may be larger than the memory."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from rocking.dynamics.export import extra
from rocking.studies.job.results import Results
from rocking.studies.job.study import VARIABLES, Coordinate, blocks


def to_netcdf(results: Results, path: Path) -> None:
    """Write results as netCDF, which xarray and MATLAB open.

    Parameters
    ----------
    results : Results
        What to write.
    path : Path
        The file.
    """
    h5py: Any = extra("h5py", "netCDF")
    h5netcdf: Any = extra("h5netcdf", "netCDF")
    study = results.study
    with h5netcdf.File(path, "w") as file:
        file.dimensions = dict(study.dims)
        for name, value in results.attributes.items():
            file.attrs[name] = value
        for name, coordinate in study.coordinates.items():
            _coordinate(file, name, coordinate, h5py.string_dtype())
        also = " ".join(name for name in study.coordinates if name not in study.dims)
        for name, (kind, unit, words) in VARIABLES.items():
            made = file.create_variable(name, tuple(study.dims), dtype=np.dtype(kind))
            made.attrs["units"], made.attrs["long_name"] = unit, words
            if also:
                made.attrs["coordinates"] = also
        for first, last, arrays in results.pieces():
            for name, values in arrays.items():
                for place, part in blocks(first, last, study.shape):
                    shape = tuple(s.stop - s.start for s in place)
                    file.variables[name][place] = np.asarray(values)[part].reshape(shape)


def _coordinate(file: Any, name: str, coordinate: Coordinate, words: Any) -> None:
    kind = words if coordinate.is_words else coordinate.values.dtype
    made = file.create_variable(name, coordinate.dims, dtype=kind)
    made[...] = coordinate.values
    made.attrs["units"], made.attrs["long_name"] = coordinate.unit, coordinate.words


def attributes_of(provenance: dict[str, Any], more: dict[str, Any]) -> dict[str, Any]:
    """Return provenance as attributes of a file: the main facts each by itself, and all of it as JSON.

    Parameters
    ----------
    provenance : dict
        Plain values.
    more : dict
        What the study says of itself.

    Returns
    -------
    dict
        Numbers and words.
    """
    main = {name: provenance[name] for name in ("software", "campaign", "kind", "engine", "histories_key")}
    plain = {name: int(v) if isinstance(v, bool) else v for name, v in more.items() if v is not None}
    return {**main, **plain, "provenance": json.dumps(provenance, sort_keys=True)}
