"""Reading whatever format a file has, choosing components, provenance, writing, and damage of every kind."""

import hashlib
import math
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion
from rocking.motions.formats import (
    Component,
    Record,
    RecordFormat,
    Source,
    formats,
    read_motion,
    read_record,
    write_motion,
    write_record,
)

TEXT_FORMATS = ("peer", "esm", "cosmos", "csmip-v1", "csmip-v2")
COLUMNS = "0.00 0.0 1.0\n0.01 0.5 2.0\n0.02 -0.2 -3.0\n"


def _write(folder: Path, text: str, name: str = "hand.txt") -> Path:
    path = folder / name
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", TEXT_FORMATS)
def test_files_are_recognised_by_content_alone(name: str, made_up, tmp_path: Path) -> None:
    """A file under a misleading name is recognised by one format, and by no other but the last resort."""
    path = tmp_path / "misleading.sac"
    write_record(made_up("90"), path, name)
    assert read_record(path).format == name
    source, known = Source.of_path(path), formats()
    found = [one.name for one in known.values() if one.recognises(source)]
    # words above numbers may be those of columns too, which are tried where no other format is found
    assert [one for one in found if one != "columns" or name == "columns"] == [name]
    assert known[name].name == name
    assert known[name].title


def test_unknown_files_and_formats(tmp_path: Path) -> None:
    """The errors list what there is."""
    path = _write(tmp_path, "Dear reader,\nthis is no record.\n")
    with pytest.raises(RecordError, match=r"unknown format, allowed are peer, esm, .*columns"):
        read_record(path)
    with pytest.raises(InvalidValueError, match=r"format must be one of peer, esm, .*got 'at2'"):
        read_record(path, format="at2")
    with pytest.raises(RecordError, match="no such file"):
        read_record(tmp_path / "absent")
    with pytest.raises(RecordError, match="not a plain file"):
        read_record(tmp_path)
    with pytest.raises(RecordError, match="the file is empty"):
        read_record(_write(tmp_path, " \n", "empty"))


def test_a_file_above_256_mib_is_not_read(tmp_path: Path) -> None:
    """A byte more than 256 MiB is refused with both sizes, before the content is looked at."""
    path = tmp_path / "long.at2"
    with path.open("wb") as file:
        file.truncate(268_435_457)
    with pytest.raises(RecordError, match="268435457 bytes exceed the limit of 268435456"):
        read_record(path)


def test_ambiguous_file_names_its_candidates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, made_up) -> None:
    """Where two formats recognise a file, the error names both; format= decides."""
    path = tmp_path / "two"
    write_record(made_up("90"), path, "peer")
    monkeypatch.setattr("rocking.motions.formats.esm.Esm.recognises", lambda self, source: True)
    with pytest.raises(RecordError, match="ambiguous: peer, esm; add format="):
        read_record(path)
    assert read_record(path, format="peer").format == "peer"


KNET_WORDS = "Origin Time       1999/12/31 23:59:00\nSampling Freq(Hz) 100Hz\nScale Factor      2000(gal)/8388608\n"
PEER_WORDS = "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= 0.01 SEC\n"
SAMPLES = "0.0 0.125 -0.25\n0.5\n"


def test_a_file_with_the_headers_of_two_formats_is_ambiguous(tmp_path: Path) -> None:
    """A file typed by hand with words of K-NET above the size line of PEER is neither's until format= says whose."""
    both = _write(tmp_path, KNET_WORDS + PEER_WORDS + SAMPLES)
    with pytest.raises(
        RecordError, match=r"^hand\.txt: the format is ambiguous: peer, knet; add format= with one of these$"
    ):
        read_record(both)
    with pytest.raises(RecordError, match="ambiguous: peer, knet"):
        read_motion(both)
    (part,) = read_record(both, format="peer").components
    assert (part.acceleration.tolist(), part.unit, part.time_step) == ([0.0, 0.125, -0.25, 0.5], "g", 0.01)
    # settled the other way it is K-NET's reader that speaks, of its own header
    with pytest.raises(RecordError, match=r"^hand\.txt: K-NET header of 17 lines expected"):
        read_record(both, format="knet")


def test_either_header_alone_is_not_ambiguous(tmp_path: Path) -> None:
    """The control: without the words of K-NET the same file is PEER's, without the lines of PEER it is K-NET's."""
    alone = read_record(_write(tmp_path, "Somewhere\n" + PEER_WORDS + SAMPLES))
    assert (alone.format, alone.components[0].acceleration.tolist()) == ("peer", [0.0, 0.125, -0.25, 0.5])
    path = _write(tmp_path, KNET_WORDS + SAMPLES)
    assert [one.name for one in formats().values() if one.recognises(Source.of_path(path))] == ["knet"]
    with pytest.raises(RecordError, match=r"^hand\.txt: K-NET header of 17 lines expected"):
        read_record(path)


@pytest.mark.parametrize("word", ["nan", "NaN", "-nan", "inf", "-Inf", "Infinity", "1e999", "-1d400"])
@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("{}\n1\n2\n3\n", 1),
        ("# comment\n\n1\n{}\n2\nnan\n", 4),
        ("0.00 {}\n0.01 1\n0.02 2\n", 1),
        ("{0} {0}\n0.01 1\n0.02 2\n", 1),
        ("0.00,1.0\n0.01,2.0\n0.02,3.0\n0.03,4.0\n0.04,{}\n", 5),
        ("0,00;1,5\n0,01;{}\n0,02;2,5\n", 2),
        ("{0},{0}\n1,2\n", 1),
        ("time,acc [g]\n0.0,{}\n0.1,2\n", 2),
        ("time [s]\tx [g]\n{}\t1\n0.1\t2\n", 2),
        ("x,y\n0.0,{}\n0.1,2\n", 2),
    ],
)
def test_no_finite_number_on_the_first_lines_is_named(text: str, line: int, word: str, tmp_path: Path) -> None:
    """File, line and value are named, whether the format is told or not; with a finite number the file is columns."""
    path = _write(tmp_path, text.format(word))
    cause = "(: a sample has no value; .*)?"
    words = rf"^hand\.txt, line {line}: number (expected, found|is too large:) '{word}'{cause}$"
    for told in (None, "columns"):
        with pytest.raises(RecordError, match=words):
            read_motion(path, told, "g", 0.01)
    readers = formats().values()
    assert not any(one.recognises(Source.of_path(path)) for one in readers)
    finite = Source("finite", text.format("0").replace("nan", "3").encode())
    assert [one.name for one in readers if one.recognises(finite)] == ["columns"]


def test_no_finite_number_further_down_is_named_as_ever(tmp_path: Path) -> None:
    """Below the first lines the reader of columns, which recognises the file, names the same."""
    rows = [f"{0.01 * k:.2f} {k}" for k in range(20)]
    rows[10] = "0.10 nan"
    for told in (None, "columns"):
        with pytest.raises(
            RecordError, match=r"^hand\.txt, line 11: number expected, found 'nan': a sample has no value; .*$"
        ):
            read_motion(_write(tmp_path, "\n".join(rows)), told, "g")


@pytest.mark.parametrize(
    "text",
    [
        "Dear reader,\nnan is no record.\n",  # words beside it
        "nan\n1 2\n3 4 5\n",  # ragged
        " ".join(["1"] * 20) + " nan\n" + " ".join(["1"] * 21) + "\n",  # more columns than are read
        "nan x\n0.1 1\n0.2 2\n",  # another damage on the same line
        "x5\n1\nnan\n",  # damage of another kind before it
        "nano\n1\n2\n",  # a name
        "#RecordLength(sec): 50\n0 nan\n1 2\n",  # a comment of another format
        "nan\0\n1\n",  # no text
    ],
)
def test_files_that_would_be_no_columns_either_way_are_not_blamed_on_a_number(text: str, tmp_path: Path) -> None:
    """A NaN is named only where the file would be columns without it."""
    path = _write(tmp_path, text)
    with pytest.raises(RecordError) as refused:
        read_motion(path, units="g")
    assert "found 'nan'" not in str(refused.value)
    assert formats()["columns"].refusal(Source.of_path(path)) is None


def test_only_columns_speak_of_files_that_nobody_recognises() -> None:
    """A file that is recognised, and a format other than columns, give no refusal."""
    good, damaged = Source("good", COLUMNS.encode()), Source("damaged", COLUMNS.replace("0.5", "nan").encode())
    assert [name for name, one in formats().items() if one.refusal(good)] == []
    assert [name for name, one in formats().items() if one.refusal(damaged)] == ["columns"]


@pytest.mark.parametrize("name", [*TEXT_FORMATS, "columns", "smc-usgs", "knet", "cwa", "geonet-v2a", "bhrc"])
def test_forced_format_refuses_foreign_content(name: str) -> None:
    """A format forced onto text or bytes that are not its own refuses them and raises nothing else."""
    reader = formats()[name]
    for content in (b"Dear reader", b"\0\1\2", b"\xff" * 50, b"\n\n1", b"NPTS=1, DT=1"):
        source = Source("foreign", content)
        assert not reader.recognises(source) or (name, content) in {("peer", b"NPTS=1, DT=1"), ("columns", b"\n\n1")}
        with pytest.raises(RecordError):
            reader.read(source, "g", 0.01)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "add units="),
        ({"units": "cm/s"}, "units must be one of"),
        *(({"units": "g", "time_step": step}, "time_step") for step in (-0.01, math.nan, math.inf, "0.01", True)),
        ({"units": "g"}, "has the components column 2, column 3; add component="),
        (
            {"units": "g", "component": "EW"},
            "component must be the name of one component, got 'EW'; the file has column 2",
        ),
        ({"units": "g", "component": "column 2", "vertical": "Z"}, "vertical must be the name of one component"),
        ({"units": "g", "component": "column 2", "vertical": "column 2"}, "this is the vertical component"),
    ],
)
def test_nothing_is_guessed(options: dict[str, Any], message: str, tmp_path: Path) -> None:
    """Columns need units=, a step that is one, and names where there are several; no component is both parts."""
    with pytest.raises((RecordError, InvalidValueError), match=message):
        read_motion(_write(tmp_path, COLUMNS), **options)


def test_motion_in_si_with_provenance(tmp_path: Path) -> None:
    """A motion is in m/s2, named after the file where the file is silent, and says where it comes from."""
    path = _write(tmp_path, COLUMNS)
    motion = read_motion(path, units="g", component="Column 2", vertical="COLUMN 3")
    assert motion.acceleration.tolist() == [0.0, 0.5 * 9.80665, -0.2 * 9.80665]
    assert motion.vertical is not None
    assert motion.vertical.tolist() == [9.80665, 2.0 * 9.80665, -3.0 * 9.80665]
    assert motion.time_step == 0.01
    assert motion.name == "hand"
    assert (motion.metadata["format"], motion.metadata["unit"], motion.metadata["component"]) == (
        "columns",
        "g",
        "column 2",
    )
    assert motion.metadata["vertical component"] == "column 3"
    digest = hashlib.sha256(COLUMNS.encode()).hexdigest()
    assert motion.provenance[0] == f"read from hand.txt, SHA-256 {digest}, format columns, component column 2, unit g"


def test_components_of_unequal_length_are_cut(made_up, tmp_path: Path) -> None:
    """Both are cut to the shorter, and the provenance says so."""
    two = made_up("90", "UP")
    short = Component("UP", two.components[1].acceleration[:50], "m/s2", 0.02)
    path = tmp_path / "two.v2"
    write_record(Record("x", (two.components[0], short), metadata=two.metadata), path, "csmip-v2")
    motion = read_motion(path, component="90", vertical="up")
    assert motion.vertical is not None
    assert len(motion) == motion.vertical.size == 50
    assert motion.provenance[-1] == "components of 61 and 50 samples, both cut to 50"
    assert motion.name == "Somewhere Cellar"
    assert len(read_motion(path, component="90")) == 61
    slow = Component("UP", short.acceleration, "m/s2", 0.04)
    write_record(Record("x", (two.components[0], slow)), path, "csmip-v2")
    with pytest.raises(RecordError, match="resample"):
        read_motion(path, component="90", vertical="UP")


@pytest.mark.parametrize(
    "name",
    [*TEXT_FORMATS, "columns", "usc", "smc-boore", "csmnc", "unam", "itaca", "csn", "slist", "eqsig", "miniseed"],
)
def test_motions_come_back(name: str, tmp_path: Path) -> None:
    """A motion written and read again without options is the same to the digits of the format, whatever its unit."""
    if name == "miniseed":
        pytest.importorskip("obspy")
    time = np.arange(200) * 0.01
    motion = GroundMotion(3.0 * np.sin(9.0 * time), 0.01, name="A made-up one", metadata={"component": "90"})
    path = tmp_path / "motion"
    write_motion(motion, path, name, units="cm/s2")
    again = read_motion(path)
    # the coarsest, csmip-v1, has 0.001 g/10, half of which is 4.9e-4 m/s2
    np.testing.assert_allclose(again.acceleration, motion.acceleration, rtol=0.0, atol=4.91e-4)
    assert again.time_step == 0.01
    with pytest.raises(InvalidValueError, match="units must be one of"):
        write_motion(motion, path, name, units="furlong")


@pytest.mark.parametrize(
    ("samples", "unit", "step", "message"),
    [
        ([0.0, math.nan], "g", 0.01, "finite"),
        ([0.0, 1.0], "furlong", 0.01, "unit must be one of"),
        ([0.0, 1.0], "g", 0.0, "time step must be in"),
        ([0.0, 1.0], "g", math.nan, "time step must"),
    ],
)
def test_what_cannot_be_written(samples: list[float], unit: str, step: float, message: str, tmp_path: Path) -> None:
    """Samples that are not finite, a unit that is none, a step that is not positive, a folder that is not there."""
    record = Record("x", (Component("90", np.array(samples), unit, step),))
    for name in (*TEXT_FORMATS, "columns"):
        with pytest.raises(RecordError, match=message):
            write_record(record, tmp_path / "x", name)
    good = Record("x", (Component("90", np.array([0.0, 1.0]), "g", 0.01),))
    with pytest.raises(RecordError, match="No such file"):
        write_record(good, tmp_path / "absent" / "x.at2", "peer")


@pytest.mark.slow
@pytest.mark.parametrize("filler", [b"1", b" ", b"(", b"UNITS OF ", b"CHAN 1: "])
def test_endless_lines_do_not_hang(filler: bytes, made_up) -> None:
    """A line of 200 000 characters in any header line is read or refused at once, not searched for ever."""
    for name in TEXT_FORMATS:
        content = formats()[name].write(made_up("90"))
        lines = content.split(b"\n")
        for place in (0, 1, 6, 7, 13):
            longer = [*lines[:place], lines[place] + filler * (200_000 // len(filler)), *lines[place + 1 :]]
            source = Source("endless", b"\n".join(longer))
            with suppress(RecordError, InvalidValueError):
                formats()[name].read(source)
            for other in formats().values():
                other.recognises(source)


@st.composite
def _damages(draw: st.DrawFn, content: bytes) -> bytes:
    """Flip a byte, cut, or drop, double or swap lines, or replace a number."""
    lines = content.split(b"\n")
    here, there = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
    kind = draw(st.sampled_from(["byte", "cut", "drop", "double", "swap", "number"]))
    if kind == "byte":
        at = draw(st.integers(0, len(content) - 1))
        return content[:at] + bytes([draw(st.integers(0, 255))]) + content[at + 1 :]
    if kind == "cut":
        return content[: draw(st.integers(1, len(content)))]
    if kind == "drop":
        del lines[here]
    elif kind == "double":
        lines.insert(here, lines[there])
    elif kind == "swap":
        lines[here], lines[there] = lines[there], lines[here]
    else:
        new = draw(st.sampled_from([b"999999999", b"99999999999", b"-5", b"0", b"nan", b"1e308", b""]))
        lines[here] = re.sub(rb"\d+", new, lines[here], count=1)
    return b"\n".join(lines)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*TEXT_FORMATS, "columns"])
@given(data=st.data())
def test_damage_of_any_kind(name: str, data: st.DataObject) -> None:
    """A damaged file is refused by an error of the family, or is a record that its own header does not contradict."""
    reader = formats()[name]
    time = np.arange(40) * 0.02
    good = Record("x", (Component("90", np.sin(7.0 * time) * np.exp(-time), "m/s2", 0.02),))
    content = data.draw(_damages(reader.write(good)))
    source = Source("damaged", content)
    for other in formats().values():
        other.recognises(source)
    try:
        part = reader.read(source, "m/s2" if name == "columns" else None).components[0]
    except (RecordError, InvalidValueError):
        return
    assert np.isfinite(part.acceleration).all()
    assert 2 <= part.acceleration.size <= 41
    stated = {"peer": rb"NPTS= *(\d+)", "esm": rb"NDATA: *(\d+)", "cosmos": rb"(\d+) acceleration pts"}.get(name)
    if stated:
        count = re.search(stated, content)
        assert count is not None
        assert int(count[1]) == part.acceleration.size
    if part.stated_peak is not None:
        # half a unit of the last digit of peak (0.001 g) and sample (0.001 g/10), the coarsest of them
        assert abs(part.stated_peak - part.peak) <= {"g/10": 6.1e-3}.get(part.unit, 1.1e-3)


@pytest.mark.parametrize("where", ["recognises", "read"])
def test_whatever_a_reader_raises_is_a_refusal(where: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """File, format and cause are named; the error itself stays chained, so that a bug is seen."""
    path = _write(tmp_path, COLUMNS)
    home = type(formats()["columns"])
    cause = IndexError("list index out of range")

    def broken(*_: object) -> None:
        raise cause

    monkeypatch.setattr(home, where, broken)
    words = "during the detection of its format" if where == "recognises" else "as columns"
    with pytest.raises(
        RecordError, match=rf"hand\.txt: the file cannot be read {words} \(IndexError: list index"
    ) as caught:
        read_record(path, units="g")
    assert caught.value.__cause__ is cause


def test_rows_of_separators_alone_are_no_columns(tmp_path: Path, shared_records: Path) -> None:
    """A cone penetration test, which begins with empty rows: refused by the reader itself, not by the last door."""
    path = _write(tmp_path, ";;;\n;;;\nGround water:;0.94;m below ground level;\n;;;\n0.01;0.02;0.01;0\n")
    with pytest.raises(RecordError, match=r"hand\.txt, line 1: 1 to \d columns expected, found 0"):
        read_record(path, format="columns", units="g")
    with pytest.raises(RecordError, match="columns expected, found 0"):
        read_record(shared_records / "refused" / "columns" / "standard_1_pre_v0p5p4.csv", units="g")


def test_a_format_that_nothing_recognises_is_none():
    """A subclass with neither marks nor a way to recognise its files is refused when it is written."""
    with pytest.raises(TypeError, match="Nameless: define marks and top"):
        type("Nameless", (RecordFormat,), {"marks": ("HEADER",)})
