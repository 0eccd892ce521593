"""Foreign readers in a process of their own: crashes, hangs and hunger are refusals, and the next file is read."""

import os
import subprocess
import sys
import textwrap
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rocking.errors import MissingExtraError, RecordError
from rocking.motions.formats import Source, foreign
from rocking.motions.formats.foreign import ForeignReader
from rocking.motions.formats.sac import read_traces

SCRIPT = """
import os, signal, sys, time
import numpy as np

def answer(request, content):
    kind = request["kind"]
    if kind == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if kind == "sleep":
        time.sleep(60)
    if kind == "deaf":
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})
        time.sleep(60)
    if kind == "spin":
        while True:
            pass
    if kind == "hunger":
        return {"held": np.zeros(2**27).size}, []
    if kind == "leave":
        os._exit(3)
    if kind == "raise":
        raise IndexError("list index out of range")
    print("chatter", flush=True)
    os.write(1, b"more of it")
    return {"length": len(content), "worker": os.getppid()}, [np.arange(3.0), np.arange(4, dtype=np.int32)]
"""
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="memory and time of a file are limited on Linux")
FILE = Source("a.bin", b"12345")


@pytest.fixture
def reader(tmp_path: Path) -> Any:
    """A reader that misbehaves on request."""
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    made = ForeignReader(script, "the library", "library", seconds=2.0, memory=2**28)
    yield made
    made.close()


def test_descriptions_and_arrays_come_back_whatever_is_printed(reader: ForeignReader) -> None:
    """Numbers and types survive; what a library prints does not come between them."""
    said, (real, whole) = reader.answer(FILE, {"kind": "read"}, b"12345")
    assert said["length"] == 5
    assert real.tolist() == [0.0, 1.0, 2.0]
    assert (whole.tolist(), whole.dtype) == ([0, 1, 2, 3], np.int32)


@LINUX
@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ("crash", r"a\.bin: the library crashes \(SIGSEGV\)"),
        ("sleep", r"a\.bin: the library requires more than 2 s"),
        ("spin", r"a\.bin: the library requires more than 2 s"),
        ("hunger", r"a\.bin: the library requires more than 0\.25 GiB"),
        ("leave", r"a\.bin: the library crashes"),
        ("raise", r"a\.bin: the library cannot read the file: list index out of range"),
    ],
)
def test_what_goes_wrong_is_a_refusal_and_the_next_file_is_read(reader: ForeignReader, kind: str, message: str) -> None:
    """The loaded reader is the same before and after: only the process of the file ends."""
    before = reader.answer(FILE, {"kind": "read"}, b"")[0]["worker"]
    with pytest.raises(RecordError, match=message):
        reader.answer(FILE, {"kind": kind}, b"")
    assert reader.answer(FILE, {"kind": "read"}, b"")[0]["worker"] == before


@LINUX
def test_a_process_of_a_file_that_outlives_its_reader_keeps_nobody(
    reader: ForeignReader, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Deaf to its alarm it sleeps on with the reader's pipes in its hands, and nobody waits for it."""
    monkeypatch.setattr(foreign, "TO_START", 4.0)
    with pytest.raises(RecordError, match="requires more than 2 s"):
        reader.answer(FILE, {"kind": "deaf"}, b"")
    assert reader.answer(FILE, {"kind": "read"}, b"")[0]["length"] == 0


@LINUX
def test_the_misbehaviour_is_real(tmp_path: Path) -> None:
    """Negative control: the same call within a process ends that process."""
    call = textwrap.dedent(SCRIPT) + "\nanswer({'kind': 'crash'}, b'')"
    assert subprocess.run([sys.executable, "-c", call], check=False).returncode < 0


def test_a_reader_that_was_ended_meanwhile_is_started_again(reader: ForeignReader) -> None:
    """Somebody killed it between two files: the second one is read all the same."""
    first = reader.answer(FILE, {"kind": "read"}, b"")[0]["worker"]
    (idle,) = reader._idle[os.getpid()]
    idle.kill()
    idle.wait()
    assert reader.answer(FILE, {"kind": "read"}, b"")[0]["worker"] != first


def test_threads_do_not_hear_each_other(reader: ForeignReader) -> None:
    """Each gets the answer to its own file."""
    with ThreadPoolExecutor(4) as crew:
        found = list(crew.map(lambda n: reader.answer(FILE, {"kind": "read"}, b"x" * n)[0]["length"], range(40)))
    assert found == list(range(40))


def test_a_missing_library_is_named(tmp_path: Path) -> None:
    """The error says what to install."""
    script = tmp_path / "script.py"
    script.write_text("import no_such_library_anywhere", encoding="utf-8")
    made = ForeignReader(script, "the library", "library")
    with pytest.raises(MissingExtraError, match="needs no_such_library_anywhere: pip install"):
        made.answer(FILE, {})
    made.close()


def test_without_forks_a_crash_is_a_refusal_too(reader: ForeignReader, tmp_path: Path) -> None:
    """As on Windows: the files share a process, which ends with the first bad one, and another one starts."""
    worker = Path(sys.modules[ForeignReader.__module__].foreign_worker.__file__)
    plain = tmp_path / "foreign_worker.py"
    plain.write_text(
        worker.read_text(encoding="utf-8").replace('FORKS = sys.platform == "linux"', "FORKS = False"), encoding="utf-8"
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rocking.motions.formats.foreign.foreign_worker.__file__", str(plain))
        patch.setattr("rocking.motions.formats.foreign.TO_START", 20.0)
        for kind, message in (("raise", "list index"), ("crash", "crashes"), ("leave", "crashes")):
            with pytest.raises(RecordError, match=message):
                reader.answer(FILE, {"kind": kind}, b"")
            assert reader.answer(FILE, {"kind": "read"}, b"123")[0]["length"] == 3


def test_scripts_without_a_main_guard_read_through_obspy(tmp_path: Path) -> None:
    """The other process runs none of the user's program."""
    pytest.importorskip("obspy")
    script = tmp_path / "numbers.py"
    script.write_text(
        "import numpy as np\n"
        "import rocking as rk\n"
        "from rocking.motions.formats import read_record, write_motion\n"
        "print('once')\n"
        "write_motion(rk.GroundMotion(np.sin(np.arange(50.0)), 0.01), 'a.mseed', 'miniseed')\n"
        "print(read_record('a.mseed', units='m/s2').components[0].acceleration.size)\n",
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, "-P", script.name], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["once", "50"]


def test_the_file_that_ended_the_process(shared_records: Path) -> None:
    """ObsPy crashes; the reader of miniSEED finds out before that, since a record states 62009 samples."""
    pytest.importorskip("obspy")
    source = Source.of_path(shared_records / "refused" / "mseed" / "segv.mseed")
    for _ in range(2):
        with pytest.raises(RecordError, match=r"segv\.mseed: ObsPy"):
            read_traces(source, "MSEED")
