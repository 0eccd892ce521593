"""Every text reader against damaged files: a refusal, or a record that its own header does not contradict.

What the header states is read a second time by `stated_by_headers`, which shares nothing with the readers. The number
of damaged copies a format is 1000, or the environment variable ROCKING_FUZZ; the tests of miniSEED and SAC, beside
their other tests, follow it with a part of it, and so do lists of objects.
"""

import io
import os
import re
import time
import zipfile
from typing import Any

import numpy as np
import pytest
from random_cases import record
from unit.decision.inventory.museum_list import LIST, write_museum_list
from unit.decision.inventory.test_lists import open_document
from verification.record_mutations import mutated
from verification.stated_by_headers import HEADERS

from rocking.decision.inventory import read_inventory
from rocking.errors import InvalidValueError, RecordError, RockingError
from rocking.motions.formats import Component, Record, RecordFormat, Source, formats

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="motions and records")]

COPIES = int(os.environ.get("ROCKING_FUZZ", "1000"))
BINARY = {"miniseed", "sac"}
TEXT_FORMATS = [name for name in formats() if name not in BINARY]
UNCLEAR = "read, though the second reading does not understand the header"
SLOWEST = 60.0  # of CPU [s]


def samples(kind: RecordFormat) -> list[bytes]:
    """Valid files by the format's own writer: up to three of the shapes that it can hold."""
    found = []
    for names, count in (("90", 100), ("360", 200), ("U N E", 100), ("L V T", 100), ("N-S E-W U-D", 100)):
        try:
            found.append(kind.write(record(names, count, count)))
        except RecordError:
            continue
    return found[:3]


def read(kind: RecordFormat, content: bytes) -> Record:
    units = None if kind.states_unit else "cm/s2"
    return kind.read(Source("damaged", content), units, None if kind.states_time_step else 0.01)


def contradiction(name: str, content: bytes, record: Record) -> str | None:
    """What is wrong with a record, judged by the raw file; None if nothing is."""
    for part in record.components:
        values = part.acceleration
        if values.ndim != 1 or not 2 <= values.size <= len(content) or not np.isfinite(values).all():
            return f"{part.name}: shape {values.shape} of {len(content)} bytes, or not finite"
    if not record.components or name not in HEADERS:
        return None if record.components else "no component"
    text = content.decode("latin-1").replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
    try:
        stated = HEADERS[name](text)
    except (ValueError, IndexError, OverflowError, ZeroDivisionError, TypeError) as error:
        return f"{UNCLEAR}: {error!r}"
    if len(stated) != len(record.components):
        return f"{len(record.components)} components, the header states {len(stated)}"
    return next(filter(None, map(_at_odds, record.components, stated)), None)


@pytest.mark.verifies("behaviour")
def test_every_header_is_read_a_second_time():
    """A format without a reading of its own here would be damaged and compared with nothing."""
    assert set(TEXT_FORMATS) - {"columns"} <= set(HEADERS)


def _at_odds(part: Component, said: Any) -> str | None:
    peak = float(np.abs(part.acceleration).max())
    # samples at uneven times are resampled, and the reader says how many they were
    size = int(part.metadata["resampled"].split()[0]) if "resampled" in part.metadata else part.acceleration.size
    if size != said.samples:
        return f"{size} samples, the header states {said.samples}"
    if said.step is not None and abs(part.time_step - said.step) > 1e-6 * said.step:
        return f"step {part.time_step}, the header states {said.step}"
    if said.peak is not None and not abs(peak - said.peak) <= said.rounding + 1e-9:
        return f"peak {peak}, the header states {said.peak} +- {said.rounding}"
    return None


def findings(name: str, kind: RecordFormat, copies: int) -> tuple[list[str], int, int]:
    """What a reader gets wrong on damaged files, how many it refused, and how many could not be judged."""
    valid, wrong, refused = samples(kind), [], 0
    for seed in range(copies):
        content = mutated(valid[seed % len(valid)], seed)
        start = time.process_time()
        try:
            trouble = contradiction(name, content, read(kind, content))
        except (RecordError, InvalidValueError):
            trouble, refused = None, refused + 1
        except Exception as error:  # noqa: BLE001 - any other class is what this looks for
            trouble = f"{type(error).__name__}: {error}"
        if (spent := time.process_time() - start) > SLOWEST:
            trouble = f"took {spent:.1f} s of CPU"
        if trouble:
            wrong.append(f"seed {seed}: {trouble}")
    sure = [line for line in wrong if UNCLEAR not in line]
    return sure, refused, len(wrong) - len(sure)


@pytest.mark.verifies(
    "computed anew",
    "a second reading of the header that shares nothing with the reader",
    control="test_a_lax_reader_is_caught",
)
@pytest.mark.parametrize("name", TEXT_FORMATS)
def test_valid_files_are_recognised_by_their_own_reader_only_and_agree_with_their_headers(name: str) -> None:
    """What the writer writes is read back, agrees with the second reading of its header, and is no other format's."""
    kind = formats()[name]
    for content in samples(kind):
        assert contradiction(name, content, read(kind, content)) is None
        others = [other for other, reader in formats().items() if reader.recognises(Source("valid", content))]
        assert [other for other in others if other != "columns" or name == "columns"] == [name]


@pytest.mark.verifies(
    "damage",
    "2,000 damaged copies of each format, and a second reading of their headers",
    within="none; a share of 0.005 that cannot be judged",
    control="test_a_lax_reader_is_caught",
)
@pytest.mark.parametrize("name", TEXT_FORMATS)
def test_damaged_files_are_refused_or_agree_with_their_headers(name: str) -> None:
    """No damaged copy gives another exception, a hang, or a record that contradicts the raw header."""
    wrong, refused, unclear = findings(name, formats()[name], COPIES)
    assert not wrong, f"{len(wrong)} of {COPIES}: " + "; ".join(wrong[:8])
    # a damaged word of the header that the reader does not need and the second reading does
    assert unclear <= 0.005 * COPIES
    # damage that no header can show (a digit of a small sample) exists, but most of it must be seen
    assert refused > 0.35 * COPIES


@pytest.mark.verifies("damage", "damaged copies of every format, and noise")
def test_recognition_never_raises() -> None:
    """Every reader looks at every format's damaged files, and at noise, and answers yes or no."""
    readers = formats()
    for name in TEXT_FORMATS:
        for seed, content in enumerate(samples(readers[name])):
            for copy in range(max(COPIES // 50, 10)):
                source = Source("damaged", mutated(content, 1000 * seed + copy))
                assert {reader.recognises(source) for reader in readers.values()} <= {True, False}
    for content in (b"", b"\n", b"\0" * 700, bytes(range(256)) * 4, b"9" * 3000, b"\xff" * 3000):
        assert {reader.recognises(Source("noise", content)) for reader in readers.values()} <= {True, False}


class _Lax(RecordFormat):
    """A reader that believes whatever it finds: the negative control."""

    name, title = "knet", "a lax reader"

    def recognises(self, source: Source) -> bool:
        return True

    def write(self, record: Record) -> bytes:
        return formats()["knet"].write(record)

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        words = re.findall(r"-?\d+", "\n".join(source.lines[17:]))
        if not words:
            raise RecordError("nothing there")
        scale = re.search(r"(\d+)\(gal\)/(\d+)", "\n".join(source.lines))
        factor = float(scale[1]) / float(scale[2]) if scale else 1.0
        values = np.array([float(word) for word in words]) * factor
        return Record("knet", (Component("lax", values - values.mean(), "gal", 0.01),))


class _Raising(_Lax):
    """A reader that lets Python's own exceptions through: another negative control."""

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        rate: Any = source.lines[10].split()[2]
        return Record("knet", (Component("raising", np.zeros(int(rate[:-2])), "gal", 0.01),))


@pytest.mark.verifies("negative control", "readers that believe what they find, and let exceptions through")
def test_a_lax_reader_is_caught() -> None:
    """Readers that skip the checks are found out by counts, peaks and exceptions: the harness has teeth."""
    wrong, *_ = findings("knet", _Lax(), 400)
    assert any("samples, the header states" in line for line in wrong)
    assert any("peak" in line for line in wrong)
    assert len(wrong) > 40
    raised, *_ = findings("knet", _Raising(), 400)
    assert any("IndexError" in line or "ValueError" in line for line in raised)


def _repacked(content: bytes, member: str, seed: int) -> bytes:
    """A workbook of which one member is damaged, so that the damage reaches the reader."""
    file = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(file, "w") as new:
        for name in old.namelist():
            new.writestr(name, mutated(old.read(name), seed) if name == member else old.read(name))
    return file.getvalue()


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("kind", ["xlsx", "ods", "csv"])
def test_damaged_lists(kind, tmp_path):
    """A list with damage is read, each row an object or a reason, or refused by our exception, within seconds."""
    path = tmp_path / f"list.{kind}"
    write_museum_list(path)
    table = [line.split("|") for line in LIST.splitlines()]
    whole = {
        "xlsx": path.read_bytes(),
        "ods": open_document([[float(cell) if cell.isdigit() else cell for cell in row] for row in table[:8]]),
        "csv": "\n".join(";".join(row) for row in table).encode(),
    }[kind]
    member = {"xlsx": "xl/worksheets/sheet2.xml", "ods": "content.xml"}.get(kind)
    count, read_anyway = max(20, COPIES // {"xlsx": 25, "ods": 10, "csv": 10}[kind]), 0
    for seed in range(count):
        path.write_bytes(_repacked(whole, member, seed) if member and seed % 4 else mutated(whole, seed))
        begun = time.process_time()
        try:
            found = read_inventory(path)
        except RockingError:
            continue
        finally:
            assert time.process_time() - begun < SLOWEST, seed
        assert found.objects or found.not_assessed
        read_anyway += 1
    assert read_anyway > 0.1 * count
