"""Files of measured coefficients of restitution, in TOML or CSV: what may stand in them, read and written.

Imported only when one is read or written: it loads pydantic.
"""

import csv
import io
import math
import tomllib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import ConfigDict, Field, ValidationError, model_validator

from rocking import plausibility
from rocking.bodies.block import Block
from rocking.bodies.formats.schema import BlockSides, Positive
from rocking.bodies.formats.words import from_pydantic
from rocking.conventions import NORMAL_95
from rocking.errors import InvalidValueError, MeasurementError, located
from rocking.evidence.measurements import DataSet, interface_of, joined
from rocking.messages import Range

_LARGEST, _MOST = 16 * 2**20, 100_000  # bytes of a file, measurements in it
_RATIOS, _USUAL_RATIOS = (0.5, 200.0), (1.0, 30.0)
"""h/b that is refused outside, and doubted: below 0.71 a block that keeps to Housner's model does not rock on [-]."""

_DEVIATIONS, _USUAL_DEVIATIONS = (1e-6, 0.29), (1e-4, 0.1)
"""Standard deviations of r likewise: all of 0 to 1, each as likely, has 0.29; times are hardly known to 1e-4 [-]."""

Word = Annotated[str, Field(min_length=1, max_length=300)]
Coefficient = Annotated[float, Field(gt=0.0, le=2.0)]


class Measurement(BlockSides):  # type: ignore[misc]  # made of the fields of a block
    """One measured coefficient of restitution, or a series of them, of one homogeneous rectangle.

    Parameters
    ----------
    width, height : float, optional
        Full sizes of the block [m].
    source, licence : str
        Publication, or whoever measured it; under what others may use it.
    interface : str
        Materials that touch, with a stroke between them: ``granite/granite``.
    method : str
        How it was measured: sound, video, laser, ...
    block : str
        Name of the block; rows of one block and slenderness deviate together.
    laboratory, group, material, doi, note : str, optional
        Who measured; the set of the row, if not the laboratory; of what the block is; DOI of the source; anything else.
    slenderness_ratio : float, optional
        h/b; or `width` and `height` [-].
    mass : float, optional
        Its mass [kg].
    r : float, optional
        Ratio of velocities, not of energies; or `series` [-].
    series : list of float, optional
        Coefficients of single impacts or trials, at least two: their mean counts, and its standard error [-].
    uncertainty : float, optional
        Standard deviation of r; or `low` and `high` [-].
    low, high : float, optional
        Interval that printed digits leave open [-].

    Examples
    --------
    >>> row = Measurement(
    ...     source="mine",
    ...     licence="CC0",
    ...     interface="oak/steel",
    ...     method="sound",
    ...     block="A",
    ...     width=0.1,
    ...     height=0.4,
    ...     series=[0.93, 0.95, 0.94],
    ... )
    >>> row.ratio, [round(value, 4) for value in row.interval]
    (4.0, [0.93, 0.94, 0.95])
    """

    model_config = ConfigDict(defer_build=False)  # users read its signature

    source: Word = Field(description="publication, or whoever measured it")
    licence: Word = Field(description="under what others may use it, such as CC BY 4.0")
    interface: Word = Field(description="materials that touch, such as granite/granite")
    method: Word = Field(description="how it was measured: sound, video, laser, ...")
    block: Word = Field(description="name of the block; rows of one block deviate together")
    laboratory: Word | None = Field(None, description="who measured")
    group: Word | None = Field(None, description="set of the measurement; the laboratory, or the source, if left out")
    material: Word | None = Field(None, description="what the block is of")
    doi: Annotated[str, Field(pattern=r"^10\.\d{4,9}/\S+$", max_length=300)] | None = Field(
        None, description="DOI of the source, such as 10.3390/buildings14072119"
    )
    note: Word | None = Field(None, description="anything else")
    slenderness_ratio: Positive | None = Field(None, description="h/b [-]; or width and height")
    mass: Positive | None = Field(None, description="mass [kg]")
    r: Coefficient | None = Field(None, description="coefficient, a ratio of velocities [-]; or series")
    series: Annotated[list[Coefficient], Field(min_length=2, max_length=_MOST)] | None = Field(
        None, description="coefficients of single impacts or trials [-]"
    )
    uncertainty: Positive | None = Field(None, description="standard deviation of r [-]; or low and high")
    low: Annotated[float, Field(ge=0.0)] | None = Field(None, description="low end of what printed digits leave open")
    high: Positive | None = Field(None, description="high end of it [-]")

    @model_validator(mode="after")
    def _whole(self) -> "Measurement":
        sizes, ends = (self.width is not None) + (self.height is not None), (self.low, self.high)
        if sizes != (2 if self.slenderness_ratio is None else 0):
            raise InvalidValueError("give slenderness_ratio, or width and height")
        if (self.r is None) == (self.series is None):
            raise InvalidValueError("give r or series, one of them")
        open_ = [self.uncertainty is not None, None not in ends, self.series is not None]
        if sum(open_) != 1 or (not open_[1] and ends != (None, None)):
            raise InvalidValueError("say how far r is open: give uncertainty, or low and high, or a series alone")
        low, r, high = self.interval
        if not low <= r <= high or low == high:
            raise InvalidValueError(
                "{parameter} must lie in an interval that is open, got {low:g} <= {r:g} <= {high:g}", parameter="r",
                value=r, low=low, r=r, high=high,
            )  # fmt: skip
        if r > 1.0:
            raise InvalidValueError(
                "{parameter} must be {allowed}: a rectangle that gains energy was not measured, got {value}",
                parameter="r", allowed=Range(-math.inf, 1.0), value=r,
            )  # fmt: skip
        if not _RATIOS[0] <= self.ratio <= _RATIOS[1]:
            raise InvalidValueError(
                "h/b must be in {low:g} to {high:g}, got {ratio:g}", low=_RATIOS[0], high=_RATIOS[1], ratio=self.ratio,
                hint="is it b/h, or is one length in another unit?",
            )  # fmt: skip
        if not _DEVIATIONS[0] <= self.deviation <= _DEVIATIONS[1]:
            raise InvalidValueError(
                "{parameter} must be known to a standard deviation of {low:g} to {high:g}, got {deviation:.3g}",
                parameter="r", low=_DEVIATIONS[0], high=_DEVIATIONS[1], deviation=self.deviation,
                hint="is it in percent, or that of something else?",
            )  # fmt: skip
        return self

    @property
    def deviation(self) -> float:
        """Standard deviation of r [-]."""
        low, _, high = self.interval
        return (high - low) / math.sqrt(12.0)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What was hardly meant."""
        found = []
        if not _USUAL_RATIOS[0] <= self.ratio <= _USUAL_RATIOS[1]:
            found.append(f"h/b = {self.ratio:.4g} is outside {_USUAL_RATIOS[0]:g} to {_USUAL_RATIOS[1]:g}; is it b/h?")
        if not _USUAL_DEVIATIONS[0] <= self.deviation <= _USUAL_DEVIATIONS[1]:
            low, high = _USUAL_DEVIATIONS
            found.append(f"a standard deviation of r of {self.deviation:.3g} is outside {low:g} to {high:g}")
        size = () if self.height is None else plausibility.of_body(0.5 * self.height, self.ratio, ())
        return (*found, *size, *plausibility.of_coefficient(self.interval[1]))

    @property
    def ratio(self) -> float:
        """Slenderness ratio h/b [-]."""
        if self.width is not None and self.height is not None:
            return float(self.height / self.width)
        return self.slenderness_ratio or math.nan

    @property
    def interval(self) -> tuple[float, float, float]:
        """Low end, r, high end: of a standard deviation the interval that has it [-]."""
        if self.r is not None and self.low is not None and self.high is not None:
            return self.low, self.r, self.high
        series = np.array([self.r] if self.series is None else self.series)
        r = float(series.mean())
        deviation = self.uncertainty or float(series.std(ddof=1)) / math.sqrt(series.size)
        return r - math.sqrt(3.0) * deviation, r, r + math.sqrt(3.0) * deviation


def read_measurements(*paths: str | Path) -> DataSet:
    """Read measured coefficients from files.

    Parameters
    ----------
    *paths : str or Path
        TOML with tables ``[[measurement]]``, where keys above them hold for all; or CSV, one row a measurement, its
        columns the keys, a series with spaces between its numbers. See `Measurement`.

    Returns
    -------
    DataSet
        All of them.

    Raises
    ------
    MeasurementError
        If a file cannot be read, or a measurement is not whole; the sentence names file, row, key and value.
    """
    if not paths:
        raise InvalidValueError("name at least one file of measurements")
    sets = [dataset_of(rows_in(Path(path)), Path(path).stem) for path in paths]
    return sets[0] if len(sets) == 1 else joined(sets, "+".join(each.name for each in sets), "measurements of files")


def rows_in(path: Path) -> list[Measurement]:
    """Return the measurements of a file."""
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise MeasurementError("cannot be read ({reason})", reason=getattr(error, "strerror", None) or str(error)).at(
            str(path)
        ) from error
    if len(data) > _LARGEST:
        raise MeasurementError(
            "has {size:.1f} MiB; files of measurements may have up to 16 MiB", size=len(data) / 2**20
        ).at(str(path))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MeasurementError("is not UTF-8 text (byte {byte})", byte=error.start).at(str(path)) from error
    kinds = {".toml": _tables, ".csv": _lines}
    if path.suffix.lower() not in kinds:
        raise MeasurementError(
            "measurements stand in .toml or .csv, got {extension!r}", extension=path.suffix or "no ending"
        ).at(str(path))
    found: list[Measurement] = []
    doubts: list[str] = []
    places: dict[str, str] = {}
    for place, keys in kinds[path.suffix.lower()](path, text):
        if len(found) == _MOST:
            raise MeasurementError("has more than {limit} measurements", limit=_MOST).at(str(path))
        try:
            found.append(Measurement.model_validate(keys))
        except ValidationError as error:
            with located(f"{path}, {place}", "file"):
                raise from_pydantic(error.errors(include_url=False), kind=MeasurementError) from error
        doubts += [f"{path.name}, {place}: {doubt}" for doubt in found[-1].doubts]
        row = found[-1].model_dump_json()
        if row in places:
            doubts.append(f"{path.name}, {place}: it is the same as {places[row]}, and counts twice")
        places.setdefault(row, place)
    if not found:
        raise MeasurementError("has no measurement").at(str(path))
    plausibility.warn(doubts[:3] + ([f"{path.name}: {len(doubts) - 3} more doubts like these"] if doubts[3:] else []))
    return found


def _tables(path: Path, text: str) -> Iterable[tuple[str, dict[str, Any]]]:
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise MeasurementError("is not TOML that can be read: {reason}", reason=str(error)[:200]).at(
            str(path)
        ) from error
    rows = tables.pop("measurement", None)
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise MeasurementError("has no tables [[measurement]]").at(str(path))
    for number, row in enumerate(rows, start=1):
        whole = {**tables, **row}
        numbers = {key: float(value) for key, value in whole.items() if type(value) is int}
        yield f"measurement {number}", whole | numbers


def _lines(path: Path, text: str) -> Iterable[tuple[str, dict[str, Any]]]:
    reader = csv.DictReader(io.StringIO(text), restkey="", strict=True)
    try:
        names = reader.fieldnames or ()
        if twice := [name for name in names if names.count(name) > 1]:
            raise MeasurementError("names a column twice, {column!r:.60}", column=twice[0]).at(str(path), 1)
        for row in reader:
            place = f"line {reader.line_num}"
            if "" in row or None in row.values():
                raise MeasurementError("has not as many fields as the first line has names").at(
                    str(path), reader.line_num
                )
            yield place, {key: _value(key, field.strip()) for key, field in row.items() if field.strip()}
    except csv.Error as error:
        raise MeasurementError("is no CSV ({reason})", reason=str(error)).at(str(path), reader.line_num) from error


def _value(key: str, field: str) -> Any:
    if key not in _NUMBERS:
        return field
    try:
        return [float(word) for word in field.split()] if key == "series" else float(field)
    except ValueError:
        return field  # which is refused as no number


_NUMBERS = {"slenderness_ratio", "mass", "r", "series", "uncertainty", "low", "high", *BlockSides.model_fields}


def dataset_of(rows: Sequence[Measurement], name: str) -> DataSet:
    """Return measurements as a data set."""
    low, r, high = np.ascontiguousarray(np.array([row.interval for row in rows]).T)
    return DataSet(
        name, f"{len(rows)} measurements of {name}",
        "; ".join(dict.fromkeys(row.source + (f", doi:{row.doi}" if row.doi else "") for row in rows)),
        np.array([row.ratio for row in rows]), r, low, high,
        np.array([math.nan if row.mass is None else row.mass for row in rows]),
        tuple(row.block for row in rows), tuple(row.group or row.laboratory or row.source for row in rows), {},
        tuple(interface_of(row.interface) for row in rows), tuple(row.laboratory or "" for row in rows),
    )  # fmt: skip


def measurement_of(found: Any, body: Block, **known: Any) -> Measurement:
    """Return what was identified from a recording as a measurement for the evidence.

    Parameters
    ----------
    found : Identification
        Of `rocking.identification.identify`; its mean coefficient counts.
    body : Block
        The block that rocked.
    **known
        What a recording does not tell: ``interface``, ``block``, ``method``, ``source``, ``licence`` and more, see
        `Measurement`.

    Returns
    -------
    Measurement
        For `write_measurements`.

    Raises
    ------
    InvalidValueError
        If it was refused, the body is no block, or a key is missing or unknown.
    """
    if found.refused:
        raise InvalidValueError("what was refused is no measurement: {reason}", reason=found.refused[0])
    given: object = body
    if not isinstance(given, Block) or not given.stands_on_corners:
        raise InvalidValueError(
            "{parameter} must be {allowed}: evidence is of rectangles, got {value}", parameter="body",
            allowed="a Block on its corners", value=body,
        )  # fmt: skip
    spread = (found.mean.high - found.mean.low) / (2.0 * NORMAL_95)
    keys = {
        "width": body.width, "height": body.height, "mass": body.mass, "r": found.mean.value, "uncertainty": spread,
    }  # fmt: skip
    try:
        row: Measurement = Measurement.model_validate({**keys, **known})
    except ValidationError as error:
        raise from_pydantic(error.errors(include_url=False)) from error
    return row


def write_measurements(rows: Sequence[Measurement], path: str | Path) -> Path:
    """Write measurements as CSV, which `read_measurements` reads again to the last digit.

    Parameters
    ----------
    rows : sequence of Measurement
        The measurements.
    path : str or Path
        File with the ending ``.csv``.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If there is no row, or the file has another ending.
    """
    path = Path(path)
    if not rows or path.suffix.lower() != ".csv":
        raise InvalidValueError(
            "write at least one measurement to a file .csv, got {count} to {file!r:.60}", count=len(rows),
            file=path.name,
        )  # fmt: skip
    names = [name for name in Measurement.model_fields if any(getattr(row, name) is not None for row in rows)]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows([_field(getattr(row, name)) for name in names] for row in rows)
    return path


def _field(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return "" if value is None else value if isinstance(value, str) else repr(value)
