"""Files of measured coefficients of restitution, in TOML or CSV: schema, reader and writer.

This module loads pydantic, so it is imported only to read or write a file.
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
from rocking.errors import InvalidValueError, MeasurementError, located, reason_of
from rocking.evidence.measurements import DataSet, interface_of, joined
from rocking.messages import Range

_LARGEST, _MOST = 16 * 2**20, 100_000  # maximum bytes of a file, maximum number of measurements
_RATIOS, _USUAL_RATIOS = (0.5, 200.0), (1.0, 30.0)
"""Allowed and usual range of h/b [-]. Below 0.71, a block stops at the first impact in Housner's model."""

_DEVIATIONS, _USUAL_DEVIATIONS = (1e-6, 0.29), (1e-4, 0.1)
"""Allowed and usual range of the standard deviation of r [-]; that of a uniform distribution from 0 to 1 is 0.29."""

Word = Annotated[str, Field(min_length=1, max_length=300)]
Coefficient = Annotated[float, Field(gt=0.0, le=2.0)]


class Measurement(BlockSides):  # type: ignore[misc]  # made of the fields of a block
    """One measured coefficient of restitution, or a series, of one homogeneous rectangle.

    Parameters
    ----------
    width, height : float, optional
        Full sizes of the block [m].
    source, licence : str
        Publication or author of the measurement; licence for use by others.
    interface : str
        Materials in contact, separated by a slash: ``granite/granite``.
    method : str
        Method of measurement: sound, video, laser, ...
    block : str
        Name of the block; rows of one block and slenderness have a common deviation.
    laboratory, group, material, doi, note : str, optional
        Laboratory; data set of the row (default: laboratory); material of the block; DOI of the source; remark.
    slenderness_ratio : float, optional
        h/b; or `width` and `height` [-].
    mass : float, optional
        Mass [kg].
    r : float, optional
        Ratio of velocities, not of energies; or `series` [-].
    series : list of float, optional
        Coefficients of two or more single impacts or trials; the mean and its standard error are used [-].
    uncertainty : float, optional
        Standard deviation of r; or `low` and `high` [-].
    low, high : float, optional
        Interval of rounding [-].

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

    model_config = ConfigDict(defer_build=False)  # built now, because the signature is documentation

    source: Word = Field(description="publication or author of the measurement")
    licence: Word = Field(description="licence for use by others, such as CC BY 4.0")
    interface: Word = Field(description="materials in contact, such as granite/granite")
    method: Word = Field(description="method of measurement: sound, video, laser, ...")
    block: Word = Field(description="name of the block; rows of one block have a common deviation")
    laboratory: Word | None = Field(None, description="laboratory of the measurement")
    group: Word | None = Field(
        None, description="data set of the measurement", json_schema_extra={"usual": "laboratory or source"}
    )
    material: Word | None = Field(None, description="material of the block")
    doi: Annotated[str, Field(pattern=r"^10\.\d{4,9}/\S+$", max_length=300)] | None = Field(
        None, description="DOI of the source, such as 10.3390/buildings14072119"
    )
    note: Word | None = Field(None, description="remark")
    slenderness_ratio: Positive | None = Field(None, description="h/b [-]; or width and height")
    mass: Positive | None = Field(None, description="mass [kg]")
    r: Coefficient | None = Field(None, description="coefficient, a ratio of velocities [-]; or series")
    series: Annotated[list[Coefficient], Field(min_length=2, max_length=_MOST)] | None = Field(
        None, description="coefficients of single impacts or trials [-]"
    )
    uncertainty: Positive | None = Field(None, description="standard deviation of r [-]; or low and high")
    low: Annotated[float, Field(ge=0.0)] | None = Field(None, description="lower end of the interval of rounding [-]")
    high: Positive | None = Field(None, description="upper end of the interval of rounding [-]")

    @model_validator(mode="after")
    def _whole(self) -> "Measurement":
        sizes, ends = (self.width is not None) + (self.height is not None), (self.low, self.high)
        if sizes != (2 if self.slenderness_ratio is None else 0):
            raise InvalidValueError("enter slenderness_ratio, or width and height")
        if (self.r is None) == (self.series is None):
            raise InvalidValueError("enter either r or series")
        uncertainties = [self.uncertainty is not None, None not in ends, self.series is not None]
        if sum(uncertainties) != 1 or (not uncertainties[1] and ends != (None, None)):
            raise InvalidValueError("enter the uncertainty of r: either uncertainty, or low and high, or a series")
        low, r, high = self.interval
        if not low <= r <= high or low == high:
            raise InvalidValueError(
                "{parameter} must be in an interval low < high, got {low:g} <= {r:g} <= {high:g}", parameter="r",
                value=r, low=low, r=r, high=high,
            )  # fmt: skip
        if r > 1.0:
            raise InvalidValueError(
                "{parameter} must be {allowed} because a rectangle cannot gain energy, got {value}",
                parameter="r", allowed=Range(-math.inf, 1.0), value=r,
            )  # fmt: skip
        if not _RATIOS[0] <= self.ratio <= _RATIOS[1]:
            raise InvalidValueError(
                "h/b must be in {low:g} to {high:g}, got {ratio:g}", low=_RATIOS[0], high=_RATIOS[1], ratio=self.ratio,
                hint="check that it is not b/h, and check the units of lengths",
            )  # fmt: skip
        if not _DEVIATIONS[0] <= self.deviation <= _DEVIATIONS[1]:
            raise InvalidValueError(
                "the standard deviation of {parameter} must be {low:g} to {high:g}, got {deviation:.3g}",
                parameter="r", low=_DEVIATIONS[0], high=_DEVIATIONS[1], deviation=self.deviation,
                hint="check that it is not in percent",
            )  # fmt: skip
        return self

    @property
    def deviation(self) -> float:
        """Standard deviation of r [-]."""
        low, _, high = self.interval
        return (high - low) / math.sqrt(12.0)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Unusual values."""
        messages = []
        if not _USUAL_RATIOS[0] <= self.ratio <= _USUAL_RATIOS[1]:
            messages.append(
                f"h/b = {self.ratio:.4g} is outside {_USUAL_RATIOS[0]:g} to {_USUAL_RATIOS[1]:g}; "
                "check that it is not b/h"
            )
        if not _USUAL_DEVIATIONS[0] <= self.deviation <= _USUAL_DEVIATIONS[1]:
            low, high = _USUAL_DEVIATIONS
            messages.append(f"a standard deviation of r of {self.deviation:.3g} is outside {low:g} to {high:g}")
        size = () if self.height is None else plausibility.of_body(0.5 * self.height, self.ratio, ())
        return (*messages, *size, *plausibility.of_coefficient(self.interval[1]))

    @property
    def ratio(self) -> float:
        """Slenderness ratio h/b [-]."""
        if self.width is not None and self.height is not None:
            return float(self.height / self.width)
        return self.slenderness_ratio or math.nan

    @property
    def interval(self) -> tuple[float, float, float]:
        """Lower end, r, upper end [-]. A standard deviation gives the uniform interval with this deviation."""
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
        TOML with tables ``[[measurement]]`` (keys above them apply to all), or CSV with one row per measurement and the
        keys as columns; numbers of a series are separated by spaces. See `Measurement`.

    Returns
    -------
    DataSet
        All measurements.

    Raises
    ------
    MeasurementError
        If a file cannot be read, or a measurement is incomplete; the message contains file, row, key and value.
    """
    if not paths:
        raise InvalidValueError("enter one or more files of measurements")
    sets = [dataset_of(rows_in(Path(path)), Path(path).stem) for path in paths]
    return sets[0] if len(sets) == 1 else joined(sets, "+".join(data.name for data in sets), "measurements of files")


def rows_in(path: Path) -> list[Measurement]:
    """Return the measurements of a file."""
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise MeasurementError("the file cannot be read ({reason})", reason=reason_of(error)).at(str(path)) from error
    if len(data) > _LARGEST:
        raise MeasurementError(
            "the file has {size:.1f} MiB; files of measurements may have up to 16 MiB", size=len(data) / 2**20
        ).at(str(path))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MeasurementError("the file is not UTF-8 text (byte {byte})", byte=error.start).at(str(path)) from error
    kinds = {".toml": _tables, ".csv": _lines}
    if path.suffix.lower() not in kinds:
        raise MeasurementError(
            "unsupported extension {extension!r}; use .toml or .csv", extension=path.suffix or "none"
        ).at(str(path))
    measurements: list[Measurement] = []
    doubts: list[str] = []
    first_locations: dict[str, str] = {}
    for location, keys in kinds[path.suffix.lower()](path, text):
        if len(measurements) == _MOST:
            raise MeasurementError("the file has more than {limit} measurements", limit=_MOST).at(str(path))
        try:
            measurements.append(Measurement.model_validate(keys))
        except ValidationError as error:
            with located(f"{path}, {location}", "file"):
                raise from_pydantic(error.errors(include_url=False), kind=MeasurementError) from error
        doubts += [f"{path.name}, {location}: {doubt}" for doubt in measurements[-1].doubts]
        row = measurements[-1].model_dump_json()
        if row in first_locations:
            doubts.append(f"{path.name}, {location}: duplicate of {first_locations[row]}, counted twice")
        first_locations.setdefault(row, location)
    if not measurements:
        raise MeasurementError("has no measurement").at(str(path))
    plausibility.warn(doubts[:3] + ([f"{path.name}: {len(doubts) - 3} more doubts like these"] if doubts[3:] else []))
    return measurements


def _tables(path: Path, text: str) -> Iterable[tuple[str, dict[str, Any]]]:
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise MeasurementError("the file is not readable TOML: {reason}", reason=str(error)[:200]).at(
            str(path)
        ) from error
    rows = tables.pop("measurement", None)
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise MeasurementError("the file has no tables [[measurement]]").at(str(path))
    for number, row in enumerate(rows, start=1):
        row_values = {**tables, **row}
        numbers = {key: float(value) for key, value in row_values.items() if type(value) is int}
        yield f"measurement {number}", row_values | numbers


def _lines(path: Path, text: str) -> Iterable[tuple[str, dict[str, Any]]]:
    reader = csv.DictReader(io.StringIO(text), restkey="", strict=True)
    try:
        names = reader.fieldnames or ()
        if twice := [name for name in names if names.count(name) > 1]:
            raise MeasurementError("column {column!r:.60} appears twice", column=twice[0]).at(str(path), 1)
        for row in reader:
            location = f"line {reader.line_num}"
            if "" in row or None in row.values():
                raise MeasurementError("the number of fields differs from the first line").at(
                    str(path), reader.line_num
                )
            yield location, {key: _value(key, field.strip()) for key, field in row.items() if field.strip()}
    except csv.Error as error:
        raise MeasurementError("the file is not a CSV file ({reason})", reason=str(error)).at(
            str(path), reader.line_num
        ) from error


def _value(key: str, field: str) -> Any:
    if key not in _NUMBERS:
        return field
    try:
        return [float(word) for word in field.split()] if key == "series" else float(field)
    except ValueError:
        return field  # the model rejects the text as not a number


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


def measurement_of(identification: Any, body: Block, **keys_of_user: Any) -> Measurement:
    """Return an identification from a recording as a measurement for the evidence.

    Parameters
    ----------
    identification : Identification
        Result of `rocking.identification.identify`; its mean coefficient is used.
    body : Block
        The measured block.
    **keys_of_user
        Keys that the recording does not contain: ``interface``, ``block``, ``method``, ``source``, ``licence`` and
        others of `Measurement`.

    Returns
    -------
    Measurement
        Measurement for `write_measurements`.

    Raises
    ------
    InvalidValueError
        If the identification was refused, the body is not a block, or a key is missing or unknown.
    """
    if identification.refused:
        raise InvalidValueError(
            "a refused identification cannot be used as a measurement: {reason}", reason=identification.refused[0]
        )
    block: object = body
    if not isinstance(block, Block) or not block.stands_on_corners:
        raise InvalidValueError(
            "{parameter} must be {allowed} because the evidence contains rectangles only, got {value}",
            parameter="body",
            allowed="a Block on its corners", value=body,
        )  # fmt: skip
    spread = (identification.mean.high - identification.mean.low) / (2.0 * NORMAL_95)
    keys = {
        "width": body.width, "height": body.height, "mass": body.mass, "r": identification.mean.value,
        "uncertainty": spread,
    }  # fmt: skip
    try:
        row: Measurement = Measurement.model_validate({**keys, **keys_of_user})
    except ValidationError as error:
        raise from_pydantic(error.errors(include_url=False)) from error
    return row


def write_measurements(rows: Sequence[Measurement], path: str | Path) -> Path:
    """Write measurements as CSV in full precision for `read_measurements`.

    Parameters
    ----------
    rows : sequence of Measurement
        The measurements.
    path : str or Path
        File with extension ``.csv``.

    Returns
    -------
    Path
        The written file.

    Raises
    ------
    InvalidValueError
        If there is no row, or the extension is not ``.csv``.
    """
    path = Path(path)
    if not rows or path.suffix.lower() != ".csv":
        raise InvalidValueError(
            "write one or more measurements to a .csv file, got {count} to {file!r:.60}", count=len(rows),
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
