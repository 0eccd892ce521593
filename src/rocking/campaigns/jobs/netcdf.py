"""Results as netCDF 4, written chunk by chunk: the file may be larger than the memory."""

import errno
import json
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns.jobs.results import Results
from rocking.campaigns.jobs.study import TYPES, Coordinate, blocks
from rocking.errors import extra
from rocking.quantities import attributes

# attributes, and what HDF5 needs for itself [bytes]
_MARGIN = 150_000


def to_netcdf(results: Results, path: Path) -> None:
    """Write results as netCDF, which xarray and MATLAB open."""
    h5py: Any = extra("h5py", "netCDF")
    study = results.study
    room = study.histories.count * sum(np.dtype(kind).itemsize for kind in TYPES.values())
    room += sum(room_of(each.values) for each in study.coordinates.values())
    with netcdf_file(path, "w", room) as file:
        file.dimensions = dict(study.dims)
        for name, value in results.attributes.items():
            file.attrs[name] = value
        for name, coordinate in study.coordinates.items():
            _coordinate(file, name, coordinate, h5py.string_dtype())
        also = " ".join(name for name in study.coordinates if name not in study.dims)
        for name, kind in TYPES.items():
            made = file.create_variable(name, tuple(study.dims), dtype=np.dtype(kind))
            made.attrs.update(attributes(name))
            if also:
                made.attrs["coordinates"] = also
        for first, last, arrays in results.pieces():
            for name, values in arrays.items():
                for place, part in blocks(first, last, study.shape):
                    shape = tuple(s.stop - s.start for s in place)
                    file.variables[name][place] = np.asarray(values)[part].reshape(shape)


@contextmanager
def netcdf_file(path: Path, mode: str, room: int) -> Iterator[Any]:
    """Open a netCDF file, if the disk has room for it, that is closed whatever happens.

    room: what will be written into it, at least [bytes].
    """
    h5netcdf: Any = extra("h5netcdf", "netCDF")
    # asked before: HDF5 that cannot write tries again when the process ends, and may crash it
    if shutil.disk_usage(path.parent).free < room + _MARGIN:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    file = h5netcdf.File(path, mode)
    try:
        yield file
        file.close()
    except BaseException as error:
        _dropped(file, path)
        told = re.search(r"errno = (\d+), error message = '([^']*)'", str(error))
        if told is None:
            raise
        raise OSError(int(told[1]), told[2]) from error


def room_of(values: np.ndarray) -> int:
    """Return the room that some values take in a file.

    Returns at least [bytes].
    """
    return int(values.nbytes if values.dtype.kind in "iufb" else 16 * values.size)


def _dropped(file: Any, path: Path) -> None:
    """Close a file that is of no use."""
    with suppress(OSError):
        os.truncate(path, 0)  # there is room again for the little that closing writes
    with suppress(Exception):
        file.close()


def _coordinate(file: Any, name: str, coordinate: Coordinate, words: Any) -> None:
    kind = words if coordinate.is_words else coordinate.values.dtype
    made = file.create_variable(name, coordinate.dims, dtype=kind)
    made[...] = coordinate.values
    made.attrs["units"], made.attrs["long_name"] = coordinate.unit, coordinate.words


def attributes_of(provenance: dict[str, Any], more: dict[str, Any]) -> dict[str, Any]:
    """Return provenance as attributes of a file: the main facts each by itself, and all of it as JSON."""
    main = {name: provenance[name] for name in ("software", "campaign", "kind", "engine", "histories_key")}
    plain = {name: int(v) if isinstance(v, bool) else v for name, v in more.items() if v is not None}
    return {**main, **plain, "provenance": json.dumps(provenance, sort_keys=True)}
