"""Record files that are named one by one, as a shell expands `kiknet/*`: they are joined as those of a folder are."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import Component, Record, formats, read_records
from rocking.spec.construction import motions_of
from rocking.spec.motion_tables import MotionTable
from rocking.spec.reading import InputFiles

pytestmark = pytest.mark.verifies(room="motions and records")

BODY = ["--width", "0.4", "--height", "1.6"]
TRIPLETS = {
    "knet": (("A0101.EW2", "A0101.NS2", "A0101.UD2"), ("5", "4", "6")),
    "itaca": (("1_H1.cor.acc", "1_H2.cor.acc", "1_V.cor.acc"), ("WE", "NS", "UP")),
    "smc-usgs": (("0210a.smc", "0210b.smc", "0210c.smc"), ("90", "360", "UP")),
    "usc": (("17m30ln.s0a", "17m30ln.s0b", "17m30ln.s0c"), ("N90E", "N00E", "DOWN")),
    "cosmos": (("X-n.0.HNE.--.V1c", "X-n.0.HNN.--.V1c", "X-n.0.HNZ.--.V1c"), ("90", "360", "UP")),
}


def _write(folder, form, name, direction, k, event="Shake", station="Cellar", date="1999-01-01"):
    folder.mkdir(exist_ok=True)
    row = np.sin(0.1 * (k + 1) * np.arange(100)) * 200.0
    part = Component(direction, row - row.mean(), "cm/s2", 0.01)
    told = {"event": event, "station": station, "date": date}
    (folder / name).write_bytes(formats()[form].write(Record(form, (part,), "", told)))
    return folder / name


@pytest.fixture(params=TRIPLETS)
def triplet(request, tmp_path):
    """Return a folder with the three files of one record, as the writer of a format makes them."""
    for k, (name, direction) in enumerate(zip(*TRIPLETS[request.param], strict=True)):
        _write(tmp_path / "set", request.param, name, direction, k)
    return tmp_path / "set"


def _files(records):
    return [[None if part is None else part.metadata["file"] for part in record.parts] for record in records]


@pytest.mark.slow
def test_named_files_are_one_record_in_python(triplet):
    """A list of paths in any order, or of a file and a pattern, gives what the folder gives, with the same numbers."""
    (whole,) = read_records(triplet)
    paths = sorted(triplet.iterdir(), reverse=True)
    for places in (paths, [str(path) for path in paths], [paths[0], triplet / "*"], [triplet]):
        (record,) = read_records(places)
        assert _files([record]) == _files([whole])
        for part, other in zip(record.parts, whole.parts, strict=True):
            np.testing.assert_array_equal(part.acceleration, other.acceleration)
    (alone,) = read_records(paths[:1])
    assert sum(part is not None for part in alone.parts) == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        "simulate", "fragility --levels 0.2,0.4", "code-checks --levels 0.3", "assess --restitution ked",
        "predict --set predict.count=16", "spectrum --periods 1:4:3",
    ],
)  # fmt: skip
def test_every_command_joins_named_files(run, tmp_path, command):
    """Each command answers of the three files what it answers of their folder; alone the vertical one is refused."""
    names, directions = TRIPLETS["itaca"]
    for k, (name, direction) in enumerate(zip(names, directions, strict=True)):
        _write(tmp_path / "set", "itaca", name, direction, k)
    words = command.split()
    words += [] if words[0] == "spectrum" else BODY
    code, out, err = run(*words, tmp_path / "set", "--json")
    assert code == 0, err
    named = [tmp_path / "set" / name for name in names]
    again = run(*words, *named, "--json")
    assert again[0] == 0, again[2]
    assert json.loads(again[1]) == json.loads(out)
    code, _, err = run(*words, named[2])
    assert code != 0
    assert "vertical" in err


def test_a_list_in_a_file_joins_them(triplet):
    """A table of motions that names the three files has what one that names their folder has."""
    names = [path.name for path in sorted(triplet.iterdir())]
    for paired in (False, True):
        listed = motions_of([MotionTable(records=names)], InputFiles(triplet), paired=paired)
        whole = motions_of([MotionTable(records=".")], InputFiles(triplet), paired=paired)
        assert len(listed) == len(whole) == (1 if paired else 2)
        assert listed.description() == whole.description()


@pytest.mark.parametrize("other", [{"station": "Attic"}, {"event": "Another"}])
def test_files_of_two_stations_or_events_stay_apart(tmp_path, other):
    """Negative control: horizontal components that headers say are of two stations or events are two motions."""
    paths = [_write(tmp_path, "esm", "A.HNE.ASC", "HNE", 0), _write(tmp_path, "esm", "B.HNN.ASC", "HNN", 1, **other)]
    assert _files(read_records(paths)) == [["A.HNE.ASC", None, None], ["B.HNN.ASC", None, None]]
    paths[1] = paths[1].rename(tmp_path / "A.HNN.ASC")  # even where names say that they belong together
    assert _files(read_records(paths)) == [["A.HNE.ASC", None, None], ["A.HNN.ASC", None, None]]
    table = MotionTable(records=[path.name for path in paths])
    with pytest.warns(UserWarning, match="components of different"):
        motions = motions_of([table], InputFiles(tmp_path), paired=True)
    assert len(motions) == 2


def test_a_vertical_file_of_another_station_is_left_out_aloud(tmp_path):
    """It becomes no horizontal motion, nor the vertical one of a station that it is not of."""
    _write(tmp_path, "esm", "A.HNE.ASC", "HNE", 0)
    _write(tmp_path, "esm", "B.HNZ.ASC", "HNZ", 1, station="Attic")
    with pytest.warns(UserWarning, match="vertical component of a record without horizontal component"):
        motions = motions_of([MotionTable(records=["A.HNE.ASC", "B.HNZ.ASC"])], InputFiles(tmp_path))
    assert len(motions) == 1
    assert motions[0].vertical is None


def test_what_is_named_and_cannot_be_used_is_refused(run, tmp_path):
    """A damaged file among those that are named is refused by its name; one that is named twice, and no name at all."""
    names, directions = TRIPLETS["itaca"]
    paths = [_write(tmp_path, "itaca", *each, 0) for each in zip(names, directions, strict=True)]
    damaged = tmp_path / "damaged.at2"
    damaged.write_text("A\nB\nC\nNPTS= 9, DT= .01 SEC\n1 2 3\n", encoding="utf-8")
    code, _, err = run("simulate", *BODY, *paths, damaged)
    assert code != 0
    assert "damaged.at2: " in err
    for folder in ("a", "b"):  # of two files of one name in two folders, the second is damaged
        (tmp_path / folder).mkdir()
    shutil.copy(paths[0], tmp_path / "a" / "same.at2")
    shutil.copy(damaged, tmp_path / "b" / "same.at2")
    with pytest.raises(RecordError, match=r"records: b/same\.at2: "):
        motions_of([MotionTable(records=["a/same.at2", "b/same.at2"])], InputFiles(tmp_path))
    with pytest.raises(InvalidValueError, match="appears twice"):
        motions_of([MotionTable(records=[names[0], names[0]])], InputFiles(tmp_path))
    with pytest.raises(RecordError, match="no file: 0 files"):
        read_records([])


def test_kik_net_as_a_shell_expands_it(run, tmp_path):
    """The shared files: six are two records, of the borehole and of the surface; skipped where they are absent."""
    folder = Path(__file__).parents[4] / "shared" / "data" / "cases" / "records" / "kiknet"
    if not folder.is_dir():
        pytest.skip("shared cases of records are absent")
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    code, out, err = run("simulate", *BODY, *sorted(tmp_path.iterdir()), "--json")
    assert code == 0, err
    assert len(json.loads(out)["motions"]) == 4
    with pytest.warns(UserWarning, match="borehole"):
        records = read_records(sorted(tmp_path.iterdir()))
    assert [[part.metadata["file"][-3:] for part in each.parts] for each in records] == [
        ["EW1", "NS1", "UD1"],
        ["EW2", "NS2", "UD2"],
    ]
