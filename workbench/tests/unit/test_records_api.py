"""Uploaded records: what must be told, what is kept, and motions as the library measures them."""

import hashlib
import io
import re

import numpy as np
import pytest
from station_files import channel, station_xml
from web_clients import refusal

import rocking as rk
from rocking import conventions
from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, formats
from rocking_workbench.errors import NotFound, TooLarge
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits

OCTETS = {"Content-Type": "application/octet-stream"}
WAVE = 0.3 * np.sin(2.0 * np.pi * np.arange(800) * 0.01) * np.exp(-0.3 * np.arange(800) * 0.01)
COLUMNS = "\n".join(f"{k * 0.01:.2f} {value:.6f}" for k, value in enumerate(WAVE)).encode()
BARE = "\n".join(f"{value:.6f}" for value in WAVE).encode()

STATIONS = station_xml(channel(gain=2000.0))


def sent(client, content, name="a.txt", **query):
    """Answer to an upload."""
    return client.post("/api/records", params={"name": name, **query}, content=content, headers=OCTETS)


def test_what_a_file_does_not_say_is_asked_for(client):
    """Numbers alone need a unit and a step; with both told, nothing more is needed."""
    asked = sent(client, BARE).json()
    assert asked["needs"] == ["units", "time_step"]
    assert "gal" in asked["choices"]["units"]
    missing = "a.txt: the file does not state its time step; the file does not state its unit"
    assert asked["message"] == missing  # both, without arguments of the library
    assert asked["components"][0]["peak_ground_acceleration"] is None
    told = sent(client, BARE, units="g", time_step=0.01).json()
    assert told["needs"] == []
    assert np.isclose(told["components"][0]["peak_ground_acceleration"], np.abs(np.round(WAVE, 6)).max() * 9.80665)
    assert told["record"] == asked["record"] == hashlib.sha256(BARE).hexdigest()


def test_what_a_header_and_its_data_contradict_is_told(client):
    """A peak at another time than the header's is read with a doubt; without one the answer has none."""
    content = formats()["csmnc"].write(Record("", (Component("EW", WAVE, "m/s2", 0.01),)))
    assert sent(client, content, "a.dat").json()["doubts"] == ""
    late = sent(client, re.sub(rb"AT +\S+ SEC", b"AT  99.00 SEC", content), "a.dat").json()
    assert late["needs"] == []
    assert late["doubts"].startswith("a.dat: the header states the peak at 99 s, but the data have it at")


def test_several_components_are_asked_for(client):
    """A file of three columns has two components, of which one must be chosen."""
    rows = "\n".join(f"{k * 0.01:.2f} {a:.6f} {0.5 * a:.6f}" for k, a in enumerate(WAVE)).encode()
    asked = sent(client, rows, units="m/s2").json()
    assert asked["needs"] == ["component"]
    assert asked["choices"]["component"] == ["column 2", "column 3"]
    motion = {"record": asked["record"], "units": "m/s2", "component": "column 2", "vertical": "column 3"}
    answer = client.post("/api/motion", json={"motion": motion}).json()
    assert np.isclose(answer["peak_vertical_acceleration"], 0.5 * np.abs(WAVE).max(), atol=1e-6)
    assert "vertical_acceleration" in answer["series"]


def test_records_are_listed_and_removed(client):
    """What was sent is listed under a harmless name, and gone when removed, from memory too."""
    made = sent(client, COLUMNS, "../../=cmd|' /C calc'!A0<b>.csv", units="g").json()
    assert made["file_name"] == "cmd-C-calc-A0-b.csv"
    assert [one["record"] for one in client.get("/api/records").json()] == [made["record"]]
    motion = {"motion": {"record": made["record"], "units": "g"}}
    assert client.post("/api/motion", json=motion).status_code == 200
    assert client.delete(f"/api/records/{made['record']}").status_code == 200
    assert client.delete(f"/api/records/{made['record']}").status_code == 404
    assert client.post("/api/motion", json=motion).status_code == 404
    assert client.get("/api/records").json() == []


@pytest.mark.parametrize("content", [b"", b" \n", b"\x00\x01\x02", b"hello world\n" * 9])
def test_what_is_no_record_is_refused_and_not_kept(client, content):
    """Empty, binary or wordy files are refused with a sentence, and nothing is stored."""
    answer = sent(client, content)
    assert answer.status_code == 422
    assert answer.json()["error"]["kind"] == "record"
    assert "/tmp" not in answer.text
    assert client.get("/api/records").json() == []


@pytest.mark.parametrize(
    ("content", "told", "words"),
    [
        ("1e308\n-1e308\n0\n1", {"units": "g", "time_step": 0.01}, "within 1e+06 m/s2"),  # infinite in m/s2
        ("1e308\n-1e308\n0\n1", {"units": "mm/s2", "time_step": 0.01}, "within 1e+06 m/s2"),
        ("1e308\n-1e308\n0\n1", {}, "within 1e+06 m/s2"),  # in no unit
        ("1e5\n-1.1e9\n0\n1", {}, "within 1e+06 m/s2"),
        ("0\n1.02e5\n0\n1", {"units": "g", "time_step": 0.01}, "within 1e+06 m/s2"),  # a tenth of it in m/s2
        ("0 0 0\n0.01 1 1e308\n0.02 0 0", {"units": "g"}, "column 3"),
        ("0\n1\n0\n1", {"units": "g", "time_step": 5e-324}, "time step must be in"),
        ("0\n1\n0\n1", {"units": "g", "time_step": 1e308}, "time step must be in"),
        ("0 0\n5e-324 1\n1e-323 1", {"units": "g"}, "time step must be in"),
        ("-1e308 0\n1e308 1", {"units": "g"}, "time step must be in"),
        ("0\n0\n0\n-0.0", {"units": "g", "time_step": 0.01}, "zero throughout"),
        ("5e-324\n-1e-320\n0\n0", {"units": "mm/s2", "time_step": 0.01}, "zero throughout"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_what_no_ground_does_is_refused_and_not_kept(client, content, told, words):
    """Accelerations beyond all range in their unit, or in every unit, and impossible steps are refused in words."""
    assert words in refusal(sent(client, content.encode(), **told))
    assert client.get("/api/records").json() == []


def test_what_was_kept_once_and_is_no_motion_is_refused_when_looked_at(client):
    """A kept file, told a unit in which no ground moves so hard, is refused; with another unit it is read."""
    record = sent(client, b"0\n1.5e5\n0\n1").json()["record"]
    path = f"/api/records/{record}"
    assert client.get(path).status_code == 200
    assert client.get(path, params={"units": "g", "time_step": 0.01}).status_code == 422
    asked = {"motion": {"record": record, "units": "g", "time_step": 0.01}}
    assert client.post("/api/motion", json=asked).status_code == 422
    (part,) = client.get(path, params={"units": "gal", "time_step": 0.01}).json()["components"]
    assert part["peak_ground_acceleration"] == 1500.0


def test_a_table_with_names_is_taken(client):
    """A header is read: a unit that it states is not asked for, one that it does not state is."""
    plain = COLUMNS.replace(b" ", b",")
    assert sent(client, b"time,acc\n" + plain).json()["needs"] == ["units"]
    made = sent(client, b"time,acc [g]\n" + plain).json()
    assert made["needs"] == []
    (part,) = made["components"]
    assert (part["name"], part["unit"], part["samples"]) == ("acc", "g", 800)
    german = b"Zeit [s];Beschleunigung [m/s\xb2]\r\n" + plain.replace(b",", b";").replace(b".", b",")
    (part,) = sent(client, german).json()["components"]
    assert np.isclose(part["peak_ground_acceleration"], np.abs(np.round(WAVE, 6)).max(), rtol=1e-12)
    assert "no time among 'x', 'y'" in refusal(sent(client, b"x,y\n" + plain))


@pytest.mark.parametrize("pulse", ["sine:amplitude=3,period=0.8", "ricker:amplitude=2,period=0.37"])
def test_the_table_of_a_motion_comes_back(client, pulse, tmp_path):
    """The table "Motion: a, v, d" as CSV, dropped back, is the same motion: every sample, nothing asked."""
    asked = {"body": {"units": "m", "width": 0.6, "height": 1.8}, "motion": {"pulse": pulse}}
    table = client.post("/api/table/motion.csv", json=asked).content
    numbers = np.array([[float(word) for word in line.split(",")] for line in table.decode().splitlines()[1:]])
    made = sent(client, table, "motion.csv").json()
    assert made["needs"] == []
    assert made["components"][0]["name"] == "acceleration"
    (tmp_path / "motion.csv").write_bytes(table)
    motion = rk.read_motion(tmp_path / "motion.csv")
    assert motion.acceleration.tolist() == numbers[:, 1].tolist()
    assert np.allclose(motion.time, numbers[:, 0], rtol=0.0, atol=1e-12)


def test_the_table_of_a_record_comes_back(client):
    """The table of a scaled record with a vertical part has both, and they are the same to the last digit."""
    rows = "\n".join(f"{k * 0.01:.2f} {a:.6f} {0.5 * a:.6f}" for k, a in enumerate(WAVE)).encode()
    record = sent(client, rows).json()["record"]
    motion = {"record": record, "units": "g", "component": "column 2", "vertical": "column 3", "scale": 1.1}
    asked = {"body": {"units": "m", "width": 0.6, "height": 1.8}, "motion": motion}
    made = sent(client, client.post("/api/table/motion.csv", json=asked).content, "motion.csv").json()
    assert made["needs"] == ["component"]
    assert made["choices"]["component"] == ["acceleration", "vertical_acceleration"]
    again = {"record": made["record"], "component": "acceleration", "vertical": "vertical_acceleration"}
    first, second = (
        client.post("/api/motion", json={"motion": one, "points": 2000}).json()["series"] for one in (motion, again)
    )
    for name in ("acceleration", "vertical_acceleration"):
        assert first[name] == second[name]


def test_a_motion_has_the_numbers_of_the_library(client):
    """Intensity measures and spectrum of the scaled record equal those of the library to the last digit."""
    record = sent(client, COLUMNS, units="g").json()["record"]
    answer = client.post("/api/motion", json={"motion": {"record": record, "units": "g", "scale": -1.7}}).json()
    acceleration = np.array([float(line.split()[1]) for line in COLUMNS.decode().splitlines()]) * conventions.g
    motion = rk.GroundMotion(acceleration, 0.01).scaled(-1.7)
    assert answer["peak_ground_acceleration"] == motion.peak
    from rocking.motions import arias_intensity, response_spectrum

    values = answer["intensity"]
    assert values["arias"] == arias_intensity(motion)
    periods = np.array(answer["spectrum"]["period"])
    assert (
        answer["spectrum"]["pseudo_acceleration"]
        == response_spectrum(motion, periods, 0.05).pseudo_acceleration.tolist()
    )


def test_series_of_a_motion_keep_the_peaks(client):
    """Over 40 dots the largest acceleration of 800 samples is still there; part of the time has all its samples."""
    record = sent(client, COLUMNS, units="m/s2").json()["record"]
    asked = {"motion": {"record": record, "units": "m/s2"}, "points": 40, "spectrum": False}
    series = client.post("/api/motion", json=asked).json()["series"]
    assert series["samples_shown"] == len(series["time"]) <= 40 * 8 + 2 < series["samples"]
    part = client.post("/api/motion", json={**asked, "window": [1.0, 1.3]}).json()["series"]
    assert np.allclose(part["acceleration"], np.interp(part["time"], 0.01 * np.arange(WAVE.size), WAVE), atol=1e-6)
    assert len(part["time"]) >= 30
    assert np.isclose(np.abs(series["acceleration"]).max(), np.abs(WAVE).max(), atol=1e-6)


def test_synthetic_motions_depend_on_seed_and_member_alone(client):
    """The same family, seed and member are the same motion; another member is another; a level is met."""

    def peak(**more):
        answer = client.post("/api/motion", json={"motion": {"synthetic": "pulse-like", **more}, "spectrum": False})
        return answer.json()["peak_ground_acceleration"]

    assert peak(seed=3, member=2) == peak(seed=3, member=2) != peak(seed=3, member=1)
    assert np.isclose(peak(seed=3, member=2, pga=4.0), 4.0)


def test_a_kept_record_is_looked_at_again(client):
    """What a kept file holds is told as when it was sent, by what is said of it now; an unknown hash is not there."""
    made = sent(client, BARE, "plain.txt").json()
    path = f"/api/records/{made['record']}"
    assert client.get(path).json() == made
    told = client.get(path, params={"units": "gal", "time_step": 0.02}).json()
    assert told["needs"] == []
    (part,) = told["components"]
    assert part["samples"] == 800
    assert np.isclose(part["duration"], 799 * 0.02)
    assert np.isclose(part["peak_ground_acceleration"], np.abs(np.round(WAVE, 6)).max() * 0.01)
    assert client.get(path).json() == made  # what was said for once is not kept
    assert client.get(f"/api/records/{'0' * 64}").status_code == 404
    assert client.get("/api/records/..%2f..%2fetc").status_code == 404


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ({"units": "furlong"}, "units"),
        ({"format": "no-such"}, "no-such"),
        ({"time_step": -1}, "time_step"),
        ({"time_step": "nan"}, "time_step"),
        ({"format": "peer"}, "plain.txt"),
    ],
)
def test_what_is_wrongly_said_of_a_kept_record_is_refused(client, query, words):
    """A unit, a format or a step that cannot be is refused in a sentence that names it, and the file stays."""
    made = sent(client, BARE, "plain.txt").json()
    assert words in refusal(client.get(f"/api/records/{made['record']}", params=query))
    assert len(client.get("/api/records").json()) == 1


def packed(values, **how):
    """Return a miniSEED file of one channel."""
    obspy = pytest.importorskip("obspy")
    trace = obspy.Trace(np.asarray(values))
    trace.stats.update({"network": "XX", "station": "ABC", "channel": "HNE", "delta": 0.01})
    content = io.BytesIO()
    obspy.Stream([trace]).write(content, format="MSEED", **how)
    return content.getvalue()


def test_miniseed_of_real_numbers_needs_its_unit(client):
    """Real numbers may be accelerations: the unit is asked for, and said, they are read."""
    content = packed(WAVE)
    asked = sent(client, content, "a.mseed").json()
    assert asked["format"] == "miniseed"
    assert asked["needs"] == ["units"]
    (part,) = sent(client, content, "a.mseed", units="g").json()["components"]
    assert part["time_step"] == 0.01
    assert np.isclose(part["peak_ground_acceleration"], np.abs(WAVE).max() * 9.80665)


def test_counts_and_stations_are_refused_with_a_way_out(client):
    """Counts, and the StationXML beside them, are refused in words of the page: the step that takes both."""
    content = packed((WAVE * 1e5).astype(np.int32))
    for data, name, said in ((content, "a.mseed", "counts"), (STATIONS.encode(), "a.xml", "describes an instrument")):
        answer = sent(client, data, name)
        assert answer.status_code == 422
        told = answer.json()["error"]["message"]
        assert said in told
        assert "both files in the step \u201cRecords\u201d" in told
        assert "Python" not in told
    assert client.get("/api/records").json() == []


@pytest.mark.parametrize("order", [">", "<"])
def test_dense_miniseed_is_refused_before_it_is_unpacked(client, monkeypatch, order):
    """A small file of millions of packed samples is refused by its headers: nothing decodes it."""
    content = packed(np.zeros(2_100_000, dtype=np.int32), encoding="STEIM2", byteorder=order, reclen=4096)
    assert len(content) < 2_000_000  # as a text it would be far from the cap
    with monkeypatch.context() as patch:
        patch.setattr("rocking.motions.formats.miniseed.read_traces", lambda *_: pytest.fail("it was decoded"))
        answer = sent(client, content, "dense.mseed")
    assert answer.status_code == 413
    assert "got 2100000" in answer.json()["error"]["message"]
    few = packed(np.ones(1000), byteorder=order)  # the control: a usual one gets as far as the decoder
    assert sent(client, few, "usual.mseed").json()["components"][0]["samples"] == 1000


@pytest.fixture
def store(tmp_path):
    """A store with room for two kilobytes."""
    return RecordStore(tmp_path, Limits(upload_bytes=20_000, records_bytes=30_000))


def test_the_store_has_room_for_so_much(store):
    """Files beyond the limits are refused with a sentence; the same bytes twice take room once."""
    store.add(COLUMNS, "a.txt")
    store.add(COLUMNS, "b.txt")
    assert [one.file_name for one in store.stored()] == ["b.txt"]
    with pytest.raises(TooLarge, match="more than 20000"):
        store.add(b"1" * 20_001, "c.txt")
    store.add(b"1 2\n" * 4000, "d.txt")
    with pytest.raises(TooLarge, match="delete items"):
        store.add(b"2 3\n" * 4000, "e.txt")


def test_a_motion_is_read_once(store):
    """The second motion of the same file and options is the same object; another option is not."""
    sha = store.add(COLUMNS, "a.txt").record
    assert store.motion(sha, units="g") is store.motion(sha, units="g")
    assert store.motion(sha, units="gal") is not store.motion(sha, units="g")


def test_a_file_that_changed_on_disk_is_not_read(store):
    """Bytes that are not those of the hash are refused: the answer would not be what the link says."""
    sha = store.add(COLUMNS, "a.txt").record
    store.path(sha).write_bytes(COLUMNS + b"\n")
    with pytest.raises(RecordError, match="changed"):
        store.motion(sha, units="g")


@pytest.mark.parametrize("name", ["..", "/etc/passwd", "A" * 64, "0" * 63, ""])
def test_what_is_no_hash_names_nothing(store, name):
    """A path, a short or an upper-case word finds no file and touches none."""
    for ask in (store.path, store.delete, store.motion):
        with pytest.raises(NotFound):
            ask(name)


def test_files_are_private_and_a_strange_note_is_ignored(store):
    """Folder and files are of this user alone; a note that someone else wrote with a path in it is not followed."""
    sha = store.add(COLUMNS, "a.txt").record
    assert store.folder.stat().st_mode & 0o777 == 0o700
    assert store.path(sha).stat().st_mode & 0o777 == 0o600
    note = store.folder / f"{sha}.json"
    note.write_text(note.read_text().replace("a.txt", "../../x.txt"))
    assert store.stored() == []


def test_a_sheet_that_is_no_record_is_refused(client):
    """Rows of separators alone, as in a sheet of a cone penetration test: a refusal with its reason, no fault."""
    sheet = ";;;\n" * 3 + "Ground water:;0.94;m;\n" + "Depth (m);qc (MPa);fs (kPa);u (kPa)\n"
    sheet += "".join(f"{0.01 * k:.2f};{0.1 * k:.2f};0.01;0\n" for k in range(1, 400))
    answer = sent(client, sheet.encode(), units="g")
    assert answer.status_code == 422
    assert "columns" in answer.text
