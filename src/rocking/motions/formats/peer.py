"""PEER AT2: accelerations in g after a header of four lines, or after another header with the same last line."""

import re
from typing import ClassVar

from rocking.conventions import FloatArray
from rocking.motions.formats.headers import acceleration_unit, check_count, check_end, in_unit, step_between_samples
from rocking.motions.formats.numbers import in_columns, number, rows, whole
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_LONGEST_HEADER, _LONGEST_LINE = 60, 400
_KEYED = re.compile(r"\bNPTS\s*=.*\bDT\s*=|\bDT\s*=.*\bNPTS\s*=", re.IGNORECASE)
_OLD = re.compile(r"\s*(\S+)\s+(\S+)\s+NPTS\s*,\s*DT\s*(?:\(?SEC\)?)?[\s,.]*", re.IGNORECASE)
_UNIT = re.compile(r"\bUNITS?\s+(?:OF|ARE|IS|IN)\s*:?\s*(\(?[^\s,;.]*)", re.IGNORECASE)
_OTHER = re.compile(r"\s*(VELOCITY|DISPLACEMENT)\b.*(?:TIME|HISTORY|SERIES|UNITS)", re.IGNORECASE)
_IN_WORDS = re.compile(r"(\d+)\s+points\s+at\s+equal\s+spacing\s+of\s+(\d*\.\d+)\s*sec", re.IGNORECASE)
# in NGA files, the filter follows the step: "SEC,  -5 POLE @ .03000 HZ"
_REST = re.compile(r"[\s,.]*(SEC(ONDS?)?[\s.]*(,.*)?)?[\s,.]*")
_NUMBERS = re.compile(r"[\s\d.+\-EeDd]*\d[\s\d.+\-EeDd]*")
_PROSE = re.compile(r"\b[A-Za-z]{3,}\b.*\b[A-Za-z]{3,}\b")
_END = re.compile(r"\s*\*+\s*End\s+Data\s*\*+\s*", re.IGNORECASE)
_DATE = re.compile(r"\b\d{1,2}/\d{1,2}/\d{2,4}\b")


class Peer(RecordFormat):
    """PEER strong-motion database, before and after NGA."""

    name: ClassVar[str] = "peer"
    title: ClassVar[str] = "PEER AT2, Pacific Earthquake Engineering Research Center"
    suffixes: ClassVar[tuple[str, ...]] = (".at2",)
    notes: ClassVar[str] = (
        "Verified with seven real files of four header variants. `DT=` before `NPTS` and the `NPTS, DT` line without "
        "keys follow published examples. The files contain no peak: only the number of samples is checked."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if the file has titles, a line with only NPTS and DT, and then numbers."""
        line = _size_line(source) if source.is_text else None
        if not line or not (_OLD.fullmatch(source.lines[line]) or _keyed(source.lines[line])):
            return False
        follow = [
            text[:_LONGEST_LINE] for text in source.lines[line + 1 :] if text.strip() and not _END.fullmatch(text)
        ]
        return (
            any(text.strip() for text in source.lines[:line])
            and bool(follow)
            and _NUMBERS.fullmatch(follow[0]) is not None
            and not any(_PROSE.search(text) for text in follow)
        )

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component, named by its azimuth or direction, or "acceleration"."""
        line = _size_line(source) if source.is_text else None
        if line is None:
            raise source.error(None, "not a PEER file: no line with NPTS and DT near the top")
        header = source.lines[: line + 1]
        count, stated = _size(source, line)
        step = step_between_samples(source, stated, time_step)
        unit = acceleration_unit(source, _unit(source, header), units)
        for header_line, text in enumerate(header):
            for points, spacing in _IN_WORDS.findall(text):
                if whole(source, header_line, points, "number of points") != count or abs(float(spacing) - step) > 1e-9:
                    raise source.error(
                        header_line, "{points} points at {spacing} s here, but {count} at {step:g} s below",
                        points=points, spacing=spacing, count=count, step=step,
                    )  # fmt: skip
        values = _values(source, line + 1)
        check_count(source, count, values.size)
        metadata, name = _who(header)
        return Record(self.name, (Component(name, values, unit, step),), "\n".join(header), metadata)

    def write(self, record: Record) -> bytes:
        """Return the content of a PEER file, in g with 8 digits."""
        (values,) = in_unit(record, self.name, "g", 1)
        component = record.components[0]
        metadata = {"event": "unknown", "station": "unknown", **record.metadata}
        description = [
            one_line(metadata[key], 60).replace(",", " ") for key in ("event", "date", "station") if key in metadata
        ]
        lines = [
            "STRONG MOTION RECORD IN THE PEER FORMAT",
            ", ".join([*description, one_line(component.name, 20).replace(",", " ")]),
            "ACCELERATION TIME SERIES IN UNITS OF G",
            f"NPTS= {values.size}, DT= {component.time_step:.12g} SEC",
            *in_columns(values, 5, "{:16.7E}"),
        ]
        return ("\n".join(lines) + "\n").encode("latin-1")


def _size_line(source: Source) -> int | None:
    for line, text in enumerate(source.lines[:_LONGEST_HEADER]):
        # headers have no such long lines, for which patterns are slow
        if len(text) > _LONGEST_LINE:
            return None
        if _KEYED.search(text) or _OLD.fullmatch(text):
            return line
    return None


def _size(source: Source, line: int) -> tuple[int, float]:
    text = source.lines[line]
    old = _OLD.fullmatch(text)
    values = {"NPTS": old[1], "DT": old[2]} if old else _keyed(text)
    if values is None:
        raise source.error(line, "NPTS= and DT= expected once each, found {entry!r}", entry=text.strip()[:60])
    return whole(source, line, values["NPTS"], "number of samples", 2), number(source, line, values["DT"], "time step")


def _keyed(text: str) -> dict[str, str] | None:
    """Return the values of NPTS and DT; None if the line contains other text (text after the seconds is allowed)."""
    values = re.findall(r"\b(NPTS|DT)\s*=\s*([^\s,]+)", text.upper())
    remaining = re.sub(r"\b(NPTS|DT)\s*=\s*[^\s,]+", "", text.upper())
    return dict(values) if len(values) == len(dict(values)) == 2 and _REST.fullmatch(remaining) else None


def _unit(source: Source, header: list[str]) -> str | None:
    unit: str | None = None
    for line, text in enumerate(header):
        other = _OTHER.match(text)
        kind = f", a {other[1].lower()}; use the .AT2 file with the acceleration" if other else ""
        for stated in _UNIT.findall(text):
            if stated.strip("()").upper() != "G":
                raise source.error(
                    line, "PEER accelerations are in g, but the header states {entry!r}{kind}", entry=stated[:20],
                    kind=kind,
                )  # fmt: skip
            unit = "g"
        if kind:
            raise source.error(
                line, "PEER accelerations are in g, but the header states {entry!r}{kind}", entry=text.strip()[:40],
                kind=kind,
            )  # fmt: skip
    return unit


def _values(source: Source, first: int) -> FloatArray:
    for line in range(first, len(source.lines)):
        if _END.fullmatch(source.lines[line]):
            check_end(source, line + 1)
            return rows(source, first, line)
    return rows(source, first, len(source.lines))


def _who(header: list[str]) -> tuple[dict[str, str], str]:
    """Return metadata and component name from ``event date, station, component`` in headers of four lines."""
    metadata = {"title": header[0].strip()} if len(header) > 1 else {}
    corners = re.search(r"\bHP\s*=\s*(\S+)\s*Hz\s+LP\s*=\s*(\S+)\s*Hz", " ".join(header), re.IGNORECASE)
    if corners:
        metadata["filter"] = f"high-pass {corners[1]} Hz, low-pass {corners[2]} Hz"
    if len(header) != 4:
        return metadata, "acceleration"
    fields = [field_text.strip() for field_text in re.sub(r"\([^()]*\)", "", header[1]).split(",")]
    date = _DATE.search(header[1])
    if date:
        metadata["date"] = date[0]
    metadata["event"] = re.sub(r"\s+\d{1,2}/\d.*", "", fields[0])
    stations = [field_text for field_text in fields[1:-1] if field_text and not _DATE.fullmatch(field_text)]
    if stations or (len(fields) == 2 and fields[0]):
        metadata["station"] = ", ".join(stations) or metadata["event"]
    name = fields[-1] if len(fields) > 1 else ""
    return {key: value for key, value in metadata.items() if value not in {"", "unknown"}}, name or "acceleration"
