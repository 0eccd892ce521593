"""StationXML files for the conversion of counts to accelerations: one file, several files, or folders."""

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache
from os import PathLike
from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats.record import Source

_ROOT = b"FDSNStationXML"
_TOP = 4096  # largest number of bytes before the root element of a StationXML file
BETWEEN = "|"
"""Separator of several files or folders in one text."""

Places = str | PathLike[str] | Sequence[str | PathLike[str]]

# names of acceleration units in StationXML, without blanks and in upper case, and their values in m/s2
_SPELT = re.compile(r"([NUMC]?)M/(?:S\*\*2|\(S\*\*2\)|S\^2|S\^\{2\}|S2|S/S|SEC\*\*2|SEC\^2|SEC2|SEC/SEC)")
_FACTORS = {"": 1.0, "C": 1e-2, "M": 1e-3, "U": 1e-6, "N": 1e-9}
_COUNTS = {"COUNTS", "COUNT", "DIGITALCOUNTS", "CT", "CTS"}
_DESCRIBED = ("rate", "sensitivity", "azimuth", "dip", "from")  # keys with equal values in equal descriptions
_UNNAMED = {"NONE", "", "UNKNOWN", "UNDEFINED"}


def is_station_file(path: Path) -> bool:
    """Return True if a file is a StationXML file by its extension and its first bytes."""
    if path.suffix.lower() != ".xml" or not path.is_file():
        return False
    try:
        with path.open("rb") as stream:
            return _ROOT in stream.read(_TOP)
    except OSError:
        return False


def station_files(places: Places) -> list[Path]:
    """Return the StationXML files of paths. Folders are searched with their subfolders.

    >>> station_files("a.xml|b.xml")
    [PosixPath('a.xml'), PosixPath('b.xml')]
    """
    if isinstance(places, str):
        places = [name.strip() for name in places.split(BETWEEN) if name.strip()]
    files: list[Path] = []
    for root in map(Path, [places] if isinstance(places, PathLike) else places):
        inside = [path for path in sorted(root.rglob("*.xml")) if is_station_file(path)] if root.is_dir() else [root]
        if not inside:
            raise RecordError("the folder contains no StationXML file").at(str(root))
        files += inside
    return list(dict.fromkeys(files))


def station_sources(places: Places, codes: Iterable[str]) -> list[Source]:
    """Return the StationXML files that contain one of the station codes, or all files if no file does."""
    sources = [_kept(path, path.stat().st_mtime_ns if path.is_file() else 0) for path in station_files(places)]
    form = re.compile(rb"\bcode\s*=\s*[\"'](?:" + b"|".join(re.escape(code.encode()) for code in codes) + rb")[\"']")
    return [source for source in sources if form.search(source.content)] or sources


@lru_cache(maxsize=64)
def _kept(path: Path, _changed: int) -> Source:
    return Source.of_path(path)


def sensitivity_of(source: Source, channel: dict[str, Any], name: str) -> float:
    """Return the overall sensitivity of a channel [counts/(m/s2)]. A missing output unit gives a warning."""
    total = channel["sensitivity"]
    if not total:
        raise source.error(
            None,
            "{station}: the StationXML contains no overall sensitivity; request the file with level=response",
            station=name,
        )
    before, after = ("".join(str(unit).upper().split()) for unit in total[1:])
    spelt = _SPELT.fullmatch(before)
    if spelt is None or not (after in _COUNTS or after in _UNNAMED):
        raise source.error(
            None, "{station}: sensitivity from M/S**2 to counts required, found {input} to {output}", station=name,
            input=before, output=after,
        )  # fmt: skip
    if after in _UNNAMED:
        source.doubt(
            None,
            f"{name}: the output unit of the sensitivity is {after or 'missing'} in the StationXML; counts are assumed",
        )
    value = float(total[0]) / _FACTORS[spelt[1]]
    if not 1e-12 < abs(value) < 1e15:
        raise InvalidValueError(
            "{station}: sensitivity must be within 1e-12 to 1e15 counts/(m/s2), got {sensitivity:g}", station=name,
            sensitivity=value,
        )  # fmt: skip
    return value


def channel_at(
    source: Source, descriptions: Sequence[dict[str, Any]], stations: Sequence[Source], name: str, when: str
) -> tuple[dict[str, Any], Source]:
    """Return the description of a channel at a time, and its StationXML file. Equal descriptions count as one."""
    exact = [description for description in descriptions if description["matches"]]
    distinct = {repr([description[key] for key in _DESCRIBED]): description for description in exact}
    if len(distinct) == 1:
        (channel,) = distinct.values()
        return channel, stations[channel["file_index"]]
    if not exact:
        others = sorted(
            {
                f"location {description['location'] or 'blank'}, {description['from']} to {description['to']}"
                for description in descriptions
            }
        )
        other_channels = f", only {'; '.join(others[:4])}" if others else ""
        raise source.error(
            None, "{station} at {time}: the StationXML files do not describe this channel{others}", station=name,
            time=when, others=other_channels,
        )  # fmt: skip
    files = ", ".join(sorted({stations[description["file_index"]].name for description in exact}))
    raise source.error(
        None, "{station} at {time}: {count} different descriptions in {files}; select one file", station=name,
        time=when, count=len(distinct), files=files,
    )  # fmt: skip
