"""The archive of inputs and record, read again: the same motion on another server, and hostile archives refused."""

import hashlib
import io
import struct
import zipfile

import numpy as np
import pytest
from fastapi.testclient import TestClient

from rocking.app.application import create_app
from rocking.app.errors import Refused
from rocking.app.settings import Limits, ServerSettings
from rocking.app.takeaway.archive import Archive

OCTETS = {"Content-Type": "application/octet-stream"}
BODY = {"units": "cm", "width": 50.0, "height": 200.0}
WAVE = 4.0 * np.sin(2.0 * np.pi * np.arange(300) * 0.01)
RECORD = "\n".join(f"{k * 0.01:.2f} {a:.6f}" for k, a in enumerate(WAVE)).encode()
TOML = '[response]\n[body]\nunits = "cm"\nwidth = 50\nheight = 200\n[motion]\nrecord = "wave.txt"\nunits = "m/s2"\n'


def packed(files, kind=zipfile.ZIP_DEFLATED):
    """Return an archive of files, given as pairs."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", kind) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return stream.getvalue()


def read(client, data):
    """Answer to a file of inputs."""
    return client.post("/api/inputs/read", content=data, headers=OCTETS)


@pytest.fixture
def other(tmp_path):
    """Return a script of another server, which has no record yet."""
    settings = ServerSettings(folder=tmp_path / "other", limits=Limits(upload_bytes=200_000))
    settings.folder.mkdir()
    app = create_app(settings)
    head = {"Authorization": f"Bearer {app.state.rocking.sessions.key}", "Origin": settings.origin}
    with TestClient(app, base_url=settings.origin, headers=head) as script:
        yield script


def test_a_bundle_gives_the_same_answer_on_another_server(client, other):
    """What one server packs another unpacks: inputs, record and response are the same to the last digit."""
    made = client.post("/api/records?name=my%20wave.txt", content=RECORD, headers=OCTETS).json()
    motion = {"record": made["record"], "file_name": made["file_name"], "units": "m/s2", "scale": 1.1}
    inputs = {"body": BODY, "motion": motion, "restitution": {"models": ["ked"]}}
    bundle = client.post("/api/inputs.zip", json=inputs).content
    again = read(other, bundle)
    assert again.status_code == 200
    assert again.json()["motion"] == motion
    assert [one["record"] for one in other.get("/api/records").json()] == [hashlib.sha256(RECORD).hexdigest()]
    first, second = (one.post("/api/response", json=again.json()).json() for one in (client, other))
    assert first["answers"] == second["answers"]
    bare = client.post("/api/inputs.toml", json=inputs).content
    other.delete(f"/api/records/{made['record']}")
    assert read(other, bare).status_code == 422  # the negative control: without its record it cannot be read


def test_a_bundle_without_a_record(client, other):
    """A pulse needs no record: the TOML of the archive is read."""
    inputs = {"body": BODY, "motion": {"pulse": "sine:amplitude=3,period=0.8"}}
    answer = read(other, client.post("/api/inputs.zip", json=inputs).content)
    assert answer.json()["motion"] == inputs["motion"]
    assert other.get("/api/records").json() == []


def test_an_archive_packed_by_hand(other):
    """The files of the archive, packed again by any program, are read; the record of the archive is the one meant."""
    other.post("/api/records?name=wave.txt", content=RECORD + b"\n3.00 0.0", headers=OCTETS)
    answer = read(other, packed([("wave.txt", RECORD), ("inputs.toml", "\ufeff" + TOML)], zipfile.ZIP_STORED))
    assert answer.status_code == 200
    assert answer.json()["motion"]["record"] == hashlib.sha256(RECORD).hexdigest()


def _encrypted():
    data = bytearray(packed([("response.toml", TOML)]))
    data[6] |= 1
    data[data.find(b"PK\x01\x02") + 8] |= 1
    return bytes(data)


def _damaged():
    data = bytearray(packed([("response.toml", TOML), ("wave.txt", RECORD)], zipfile.ZIP_STORED))
    data[data.find(RECORD) + 100] ^= 1
    return bytes(data)


def _lying():
    """A bomb that says it is small: 50 MB behind a stated size of 100 bytes."""
    data = bytearray(packed([("response.toml", TOML), ("wave.txt", b"0 0\n" * 12_500_000)]))
    for mark, place in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        start = data.rfind(mark)
        struct.pack_into("<I", data, start + place, 100)
    return bytes(data)


def _cut_by_nul():
    return packed([("response.toml", TOML), ("wave.txtX/../x", RECORD)]).replace(b"wave.txtX", b"wave.txt\0")


MANY = packed([(f"{k}.txt", "x") for k in range(9)])
HOSTILE = {
    "goes up": (packed([("response.toml", TOML), ("../wave.txt", RECORD)]), 422, "without folders"),
    "absolute": (packed([("/etc/response.toml", TOML)]), 422, "without folders"),
    "a drive": (packed([("C:response.toml", TOML)]), 422, "without folders"),
    "back slashes": (packed([("..\\response.toml", TOML)]), 422, "without folders"),
    "a folder": (packed([("a/", b""), ("a/response.toml", TOML)]), 422, "without folders"),
    "a name cut by NUL": (_cut_by_nul(), 422, "without folders"),
    "a bomb": (packed([("response.toml", TOML), ("wave.txt", b"0 0\n" * 12_500_000)]), 413, "more than"),
    "a bomb that lies": (_lying(), 422, "damaged"),
    "a TOML bomb": (packed([("response.toml", b"#" * 50_000_000)]), 413, "more than"),
    "nine files": (MANY, 413, "up to 8 files, this has 9"),
    "thousands of entries": (packed([(f"{k}", "") for k in range(1500)]), 413, "up to 8 files"),
    "encrypted": (_encrypted(), 422, "encrypted"),
    "another packing": (packed([("response.toml", TOML)], zipfile.ZIP_LZMA), 422, "pack it as usual"),
    "damaged": (_damaged(), 422, "damaged"),
    "cut off": (packed([("response.toml", TOML)])[:-30], 422, "no ZIP archive"),
    "only its first bytes": (b"PK\x03\x04", 422, "no ZIP archive"),
    "empty": (packed([]), 422, "one TOML file of inputs, it has 0"),
    "two inputs": (packed([("a.toml", TOML), ("b.toml", TOML)]), 422, "it has 2"),
    "no text": (packed([("response.toml", b"\xff\xfe")]), 422, "UTF-8"),
    "no record": (packed([("response.toml", TOML)]), 422, "was not uploaded here"),
    "a record that is none": (packed([("response.toml", TOML), ("wave.txt", b"hello")]), 422, "not recognised"),
    "an infinite record": (packed([("response.toml", TOML), ("wave.txt", b"0 0\n0.01 1e308")]), 422, "within 1e+06"),
    "an empty record": (packed([("response.toml", TOML), ("wave.txt", b" ")]), 422, "empty"),
    "bad inputs": (packed([("response.toml", TOML + "furlong = 1\n"), ("wave.txt", RECORD)]), 422, "furlong"),
    "it names itself": (packed([("a.toml", TOML.replace("wave.txt", "a.toml"))]), 422, "not recognised"),
    "the host's file": (packed([("a.toml", TOML.replace("wave.txt", "/etc/passwd"))]), 422, "not uploaded"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_archive_is_refused_and_nothing_is_kept(other, name):
    """Paths, bombs, damage and what is no motion are refused in words, with nothing written."""
    data, status, words = HOSTILE[name]
    answer = read(other, data)
    assert answer.status_code == status, answer.text
    assert words in answer.json()["error"]["message"]
    assert other.get("/api/records").json() == []


def test_two_files_of_one_name_are_refused():
    """Which of them would be meant is not guessed."""
    with pytest.warns(UserWarning, match="Duplicate name"):
        data = packed([("response.toml", TOML), ("response.toml", TOML)])
    with pytest.raises(Refused, match="two files of one name"):
        Archive(data)
