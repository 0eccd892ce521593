"""What a user sends takes bounded time and memory; what a disk or a link does is no error of the server."""

import errno
import math
import os

import numpy as np
import pytest

from rocking.errors import RecordError
from rocking_workbench import records
from rocking_workbench import records as record_folder
from rocking_workbench.api import response as answers
from rocking_workbench.errors import NoRoom, NotFound, TooLarge
from rocking_workbench.inputs import CAPS, MOST_RECORD_SAMPLES, check_file, check_record
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits

OCTETS = {"Content-Type": "application/octet-stream"}
BLOCK = {"units": "cm", "width": 50, "height": 200}
BODY_TOML = "[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n"
LONG = "0x" + "F" * 6000
QUIET = b"0.1\n" * 500


def kind_of(answer):
    """Status and kind of a refusal."""
    return answer.status_code, answer.json()["error"]["kind"]


@pytest.mark.parametrize(
    "text",
    [
        f'# record: {"ab" * 32} "a" b"\n{BODY_TOML}[motion]\nrecord = \'x\'\n',
        f"# record: {'ab' * 32} \"\\q\"\n{BODY_TOML}[motion]\nrecord = 'x'\n",
        f"[body]\nunits = 'm'\nwidth = {LONG}\nheight = 2.0",
        f"[body]\nunits = {LONG}\nwidth = 1.0\nheight = 2.0",
        f"{BODY_TOML}[motion]\nsynthetic = 'pulse-like'\nseed = {LONG}",
        f"{BODY_TOML}[settings]\n{'a.' * 3000}b = 1",
        f'{BODY_TOML}name = "a\\u0000b"',
    ],
)
def test_toml_of_inputs_that_json_could_not_say_is_refused(client, text):
    """A bad note, numbers of thousands of digits, depth and NUL are 422 with one sentence, never an error."""
    answer = client.post("/api/inputs/read", content=text.encode(), headers=OCTETS)
    assert kind_of(answer) == (422, "invalid-value")
    assert len(answer.json()["error"]["message"]) < 400


@pytest.mark.parametrize("key", ["width", "units", "depth"])
def test_toml_of_a_body_that_json_could_not_say_is_refused(client, key):
    """The same numbers in a body file are refused as a body file."""
    told = {"units": "'m'", "width": "1.0", "height": "2.0", key: LONG}
    content = "\n".join(f"{name} = {value}" for name, value in told.items()).encode()
    answer = client.post("/api/body/file?name=a.toml", content=content, headers=OCTETS)
    assert kind_of(answer) == (422, "body-file")


@pytest.mark.parametrize("piece", [b"1\n", b"0.01,1;\r\n", b"1 -2\t3\n"])
def test_a_record_of_endless_numbers_is_not_read(client, piece):
    """More numbers than a record has are refused before they are read; as many as it may have are not."""
    per = piece.count(b"1") + piece.count(b"2") + piece.count(b"3") if piece != b"0.01,1;\r\n" else 2
    check_record(piece * (MOST_RECORD_SAMPLES // per))
    content = piece * (MOST_RECORD_SAMPLES // per + 1)
    with pytest.raises(TooLarge, match=str(MOST_RECORD_SAMPLES)):
        check_record(content)
    assert kind_of(client.post("/api/records?name=a.txt", content=content, headers=OCTETS)) == (413, "too-large")


def test_samples_that_a_file_hides_are_counted_after_reading(client, monkeypatch):
    """Formats that pack samples densely are refused by what was read, and not kept."""
    monkeypatch.setattr("rocking_workbench.inputs.MOST_RECORD_SAMPLES", 499)
    monkeypatch.setattr("rocking_workbench.api.records.check_record", lambda content: None)
    assert kind_of(client.post("/api/records?name=a.txt", content=QUIET, headers=OCTETS)) == (413, "too-large")
    assert client.get("/api/records").json() == []


def test_responses_together_have_so_many_samples(client, monkeypatch):
    """One restitution fits under a cap that three of them pass; that question is refused before more is computed."""
    asked = {"body": BLOCK, "motion": {"pulse": "sine:amplitude=3,period=0.8"}, "points": 20}
    one = client.post("/api/response", json={**asked, "restitution": {"values": [0.9]}}).json()
    assert "error" not in one["answers"][0]
    three = {**asked, "restitution": {"values": [0.9, 0.91, 0.92]}}
    counted = []
    tried = answers._tried
    monkeypatch.setattr(answers, "_tried", lambda *given: counted.append(tried(*given)) or counted[-1])
    assert client.post("/api/response", json=three).status_code == 200
    monkeypatch.setattr(answers, "MOST_TOGETHER", counted[0].segments.count + 1)
    counted.clear()
    refused = client.post("/api/response", json=three)
    assert kind_of(refused) == (413, "too-large")
    assert "2 of 3 responses" in refused.json()["error"]["message"]
    assert len(counted) == 2


def test_a_tiny_body_under_many_restitutions_is_refused(client):
    """A grain under a long motion is upset soon, yet all its steps are counted: 24 restitutions are too many."""
    grain, long = (
        {"units": "mm", "width": 0.01, "height": 0.04},
        {"pulse": "harmonic:amplitude=5,period=0.8,cycles=100"},
    )
    many = {"values": [0.5 + 0.02 * k for k in range(24)]}
    answer = client.post("/api/response", json={"body": grain, "motion": long, "restitution": many})
    assert kind_of(answer) == (413, "too-large")


@pytest.mark.parametrize("piece", [b"0\r\nTEXT\r\n8\r\n0\r\n", b"999\n" + b"x" * 2000 + b"\n"])
def test_a_drawing_of_words_is_not_read(client, piece):
    """A drawing with very many parts or bytes, none of them an outline, is refused at once; a small one is not."""
    check_file(piece * 100, "a.dxf")
    content = piece * 30_000
    answer = client.post("/api/body/file?name=a.dxf&units=m", content=content[: 20 << 20], headers=OCTETS)
    assert kind_of(answer) == (413, "too-large")


def test_so_many_records_are_kept(tmp_path, monkeypatch):
    """One more than the largest number is refused; the same bytes again are not one more."""
    monkeypatch.setattr(records, "MOST_RECORDS", 2)
    store = RecordStore(tmp_path, Limits())
    for content in (b"1\n", b"2\n", b"2\n"):
        store.add(content, "a.txt")
    with pytest.raises(TooLarge, match="up to 2 records"):
        store.add(b"3\n", "a.txt")


def full(*_):
    """Say what a full disk says."""
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "/home/someone/records")


def test_a_full_disk_is_said_and_leaves_nothing(client, app, monkeypatch):
    """An upload to a full disk is a 507 in a sentence without paths; no part of it stays, and the next one works."""
    folder = app.state.rocking.records.folder
    write, seen = os.write, []

    def half(handle, data):
        if b"0.1" not in bytes(data[:10]) and b"record" not in bytes(data[:10]):
            return write(handle, data)
        seen.append(len(list(folder.rglob("*.part"))))
        return full()

    with monkeypatch.context() as patch:
        patch.setattr(os, "write", half)
        answer = client.post("/api/records?name=a.txt", content=QUIET, headers=OCTETS)
    assert kind_of(answer) == (507, "no-room")
    assert "someone" not in answer.text
    assert seen == [1]
    assert list(folder.rglob("*")) == []
    assert client.post("/api/records?name=a.txt", content=QUIET, headers=OCTETS).status_code == 200


def test_a_full_disk_keeps_the_earlier_name(tmp_path, monkeypatch):
    """Where the same bytes cannot be written under another name, they stay under the first."""
    store = RecordStore(tmp_path, Limits())
    sha = store.add(QUIET, "a.txt").record
    monkeypatch.setattr(record_folder, "write_new", full)
    with pytest.raises(NoRoom):
        store.add(QUIET, "b.txt")
    assert store.content(sha) == QUIET


def test_what_a_killed_server_left_is_swept(tmp_path):
    """Unfinished files of an earlier server go at the next start; what is finished stays."""
    store = RecordStore(tmp_path, Limits())
    sha = store.add(QUIET, "a.txt").record
    for place in (store.folder, store.folder / sha):
        (place / ".a.txt.77-00.part").write_bytes(b"half")
    again = RecordStore(tmp_path, Limits())
    assert list(again.folder.rglob("*.part")) == []
    assert again.content(sha) == QUIET


@pytest.mark.parametrize("what", ["file", "folder"])
def test_a_link_in_the_place_of_a_record_is_not_followed(client, app, tmp_path, what):
    """A record that somebody replaced by a link to a file elsewhere is not there: no archive hands that file out."""
    store = app.state.rocking.records
    sha = client.post("/api/records?name=a.txt&units=g&time_step=0.01", content=QUIET, headers=OCTETS).json()["record"]
    asked = {"body": BLOCK, "motion": {"record": sha, "file_name": "a.txt", "units": "g", "time_step": 0.01}}
    assert client.post("/api/inputs.zip", json=asked).status_code == 200
    other = tmp_path / "elsewhere"
    other.mkdir()
    (other / "a.txt").write_bytes(QUIET)  # the very same bytes: only the link gives it away
    path = store.path(sha)
    path.unlink()
    if what == "file":
        path.symlink_to(other / "a.txt")
    else:
        path.parent.rmdir()
        path.parent.symlink_to(other)
    for answer in (client.post("/api/inputs.zip", json=asked), client.get(f"/api/records/{sha}")):
        assert kind_of(answer) == (404, "not-found")
    with pytest.raises(NotFound):
        store.motion(sha, units="g", time_step=0.01)


def test_an_archive_has_only_what_was_uploaded(client, app):
    """Bytes that are not those of the hash are not handed out under its name."""
    store = app.state.rocking.records
    sha = store.add(QUIET, "a.txt").record
    store.path(sha).write_bytes(b"root:x:0:0")
    asked = {"body": BLOCK, "motion": {"record": sha, "file_name": "a.txt", "units": "g", "time_step": 0.01}}
    assert kind_of(client.post("/api/inputs.zip", json=asked)) == (422, "record")
    with pytest.raises(RecordError, match="changed"):
        store.content(sha)


def test_an_ordinary_record_is_far_from_the_cap():
    """Ten minutes of three components with time at 200 Hz are read."""
    check_record("\n".join("0.005 1.0 -2.0 3.0" for _ in np.arange(120_000)).encode())


def sheets(count):
    """Return a pile of thin slabs."""
    outlines = ([[0, k], [50, k], [50, k + 1], [0, k + 1]] for k in range(count))
    return {"units": "cm", "section": {"region": [{"outline": made, "density": 2000.0} for made in outlines]}}


def arches(count):
    """Return a wall on count + 1 feet."""
    made = [point for k in range(count) for point in ([2 * k, 0], [2 * k + 1, 0], [2 * k + 1.2, 1], [2 * k + 1.8, 1])]
    made += [[2 * count, 0], [2 * count + 1, 0], [2 * count + 1, 50], [0, 50]]
    return {"units": "m", "section": {"region": [{"outline": made, "density": 2000.0}]}}


def pierced(count):
    """Return a wall with a row of holes."""
    holes = [[[3 * k + 1, 1], [3 * k + 2, 1], [3 * k + 2, 2], [3 * k + 1, 2]] for k in range(count)]
    outline = [[0, 0], [3 * count + 1, 0], [3 * count + 1, 9], [0, 9]]
    return {"units": "m", "section": {"region": [{"outline": outline, "holes": holes, "density": 2000.0}]}}


def cloud(count):
    """Return points with mass on two feet."""
    points = [[math.cos(k), 1.5 + math.sin(k)] for k in range(count)]
    return {"units": "m", "mass_points": {"points": points, "masses": [1.0] * count, "feet": [-0.5, 0.5]}}


def disc(count):
    """Return a regular polygon."""
    return {"units": "m", "regular_polygon": {"sides": count, "radius": 1.0}}


def wkt(count):
    """Return squares in a pile, as a wkt."""
    squares = (f"((0 {k}, 50 {k}, 50 {k + 1}, 0 {k + 1}, 0 {k}))" for k in range(count))
    region = {"wkt": f"MULTIPOLYGON ({', '.join(squares)})", "units": "m", "density": 2000.0}
    return {"units": "m", "section": {"region": [region]}}


CASES = {
    "regions": (sheets, 250),
    "holes": (pierced, 500),
    "vertices": (disc, 10_000),
    "mass points": (cloud, 10_000),
    "stretches": (arches, 39),
    "wkt": (wkt, 250),
}


@pytest.mark.parametrize("endpoint", ["body", "impact"])
@pytest.mark.parametrize(("make", "most"), CASES.values(), ids=CASES)
def test_the_largest_body_is_answered_and_one_more_is_refused(client, make, most, endpoint):
    """At the cap there is an answer; one above it a 413 that names both numbers."""
    assert client.post(f"/api/{endpoint}", json={"body": make(most)}).status_code == 200
    refused = client.post(f"/api/{endpoint}", json={"body": make(most + 1)})
    assert (refused.status_code, refused.json()["error"]["kind"]) == (413, "too-large")
    extra = 1 if make is arches else 0
    for number in (most + extra, most + extra + 1):
        assert str(number) in refused.json()["error"]["message"]


def test_caps_are_told(client):
    """The API tells every cap among its limits."""
    assert CAPS.items() <= client.get("/api/info").json()["limits"].items()


@pytest.mark.parametrize(
    ("name", "piece"), [("a.wkt", b"1.25 2.5, "), ("a.json", b"[1.25, 2.5], "), ("a.dxf", b" 10\r\n1.25\r\n")]
)
def test_an_endless_body_file_is_not_read(client, name, piece):
    """A file of a hundred thousand points is refused at once; one of a thousand is left to the reader."""
    check_file(piece * 1000, name)
    with pytest.raises(TooLarge, match="vertices"):
        check_file(piece * 100_000, name)
    answer = client.post(
        f"/api/body/file?name={name}&units=m",
        content=piece * 100_000,
        headers={"Content-Type": "application/octet-stream"},
    )
    assert answer.status_code == 413
