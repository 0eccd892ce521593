"""Directions of components: no vertical one is a horizontal motion, and what belongs together is one record."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion, with_vertical
from rocking.motions.components import Components
from rocking.motions.formats import Component, Record, Source, formats, read_motion, read_records
from rocking.motions.formats.directions import of_file_name, orientation, settled

pytestmark = pytest.mark.verifies(room="motions and records")

BLOCK = rk.Section([rk.Region([(-0.3, 0.0), (0.3, 0.0), (0.3, 2.0), (-0.3, 2.0)], 2000.0)], feet=(-0.25, 0.3))
UPRIGHT = "U", "UP", "Up", "V", "VERT", "Vertical", "UD", "U-D", "Z", "HNZ", "BHZ", "10.HNZ", "acc_z", "az", "Düşey"
DOWN = "DOWN", "Dwn", "-Z", "D-U"
UNCLEAR = "HN3", "HNU", "HNW", "400", "500", "UP EW"
AZIMUTHS = {"360": 0.0, "090": 90.0, "S45W": 225.0, "N 20 W": 340.0, "EW": 90.0, "WE": 90.0, "HNN": 0.0, "Acc N": 0.0}
SILENT = "HN1", "T", "L", "x", "Acc_Y", "column 3", "CHAN 3", "acceleration", "unnamed", "L (A)"
# names of three components that the writer of a format holds, the vertical one last; alone where it holds one
NAMES = {"cwa": "N E U", "bhrc": "L T V", "nsmn": "N-S E-W U-D", "geonet-v1a": "N E Up", "geonet-v2a": "N E Up"}
CODES = {"miniseed", "sac", "slist", "esm", "csn"}


def test_words_of_directions():
    """Words, codes of SEED, azimuths and compass directions; what contradicts itself may be vertical."""
    assert {name: orientation(name) for name in UPRIGHT} == dict.fromkeys(UPRIGHT, "up")
    assert {name: orientation(name) for name in DOWN} == dict.fromkeys(DOWN, "down")
    assert {name: orientation(name) for name in UNCLEAR} == dict.fromkeys(UNCLEAR, "unclear")
    assert {name: orientation(name) for name in AZIMUTHS} == AZIMUTHS
    assert {name: orientation(name) for name in SILENT} == dict.fromkeys(SILENT)


def test_words_at_the_end_of_a_file_name():
    """A word after a mark, a digit or small letters counts; the end of a common word does not."""
    upright = (
        "RSN8_ELC-UP.AT2",
        "NIG018UD.AT2",
        "x.UD2",
        "XX.A..HNZ.mseed",
        "XXA-n.0.HNZ.--.V1c",
        "A-UP.AT2.smc",
        "z.txt",
    )
    level = "group.at2", "backup.txt", "sud.at2", "cloud.csv", "ce36456.V2", "x.v1", "ELC180.AT2", "a.HNE.sac"
    assert {of_file_name(name) for name in upright} == {"up"}
    assert of_file_name("A-DWN.at2") == "down"
    assert {of_file_name(name) for name in level} == {None}


@pytest.mark.parametrize("name", list(formats()))
def test_no_format_makes_a_vertical_component_horizontal(name, tmp_path):
    """What each format states to be vertical cannot shake sideways, alone or among three; its neighbours can."""
    kind = formats()[name]
    if name in {"miniseed", "sac"}:
        pytest.importorskip("obspy")
    names = NAMES.get(name, "HNN HNE HNZ" if name in CODES else "000 090 UP").split()
    for some in (names, names[:1], names[2:]):
        rows = [np.sin(0.1 * (k + 1) * np.arange(100)) for k in range(len(some))]
        rows = [row - row.mean() for row in rows]
        parts = tuple(Component(one, row, "m/s2", 0.01) for one, row in zip(some, rows, strict=True))
        try:
            content = kind.write(Record("made up", parts))
        except RecordError:
            continue
        # a format without names has the file's
        path = tmp_path / f"record_{some[0] if name in {'peer', 'eqsig'} and len(some) == 1 else 'of'}.dat"
        path.write_bytes(content)
        unit = None if kind.states_unit or name in {"miniseed", "sac", "columns"} else "m/s2"
        for one in kind.read(Source("record", content), unit).components:
            motion = read_motion(path, name, unit, component=one.name)
            upright = orientation(one.name) == "up" or (len(some) == 1 and some[0] == names[2])
            for use in (lambda m: rk.simulate(BLOCK, m), lambda m: Components(m, None, None), GroundMotion.segments):
                if not upright:
                    use(motion)
                    continue
                with pytest.raises(InvalidValueError, match="is vertical and cannot be a horizontal motion"):
                    use(motion)


def _motion(direction):
    return GroundMotion(np.sin(np.arange(50.0)), 0.02, None, "m", {"component": "c", "orientation": direction})


@pytest.mark.parametrize("direction", ["up", "down", "unclear"])
def test_every_door_refuses_a_vertical_motion(direction):
    """Simulations, studies and sets refuse it as a horizontal motion, and take it along z."""
    motion, level = _motion(direction), _motion("90")
    for use in (
        lambda m: rk.simulate(BLOCK, m),
        lambda m: rk.simulate(BLOCK, {"x": m, "z": level}),
        lambda m: rk.simulate(BLOCK, m, friction=0.4),
        lambda m: rk.simulate_many([BLOCK], [m]),
        lambda m: rk.simulate_many([BLOCK], [{"x": m, "z": level}]),
        lambda m: rk.overturning_map(BLOCK, m, ("scale", [1.0, 2.0]), ("friction", [0.3, 0.6])),
        lambda m: rk.fragility(BLOCK, [m], levels=[1.0, 2.0]),
        lambda m: rk.assess(BLOCK, [m]),
        lambda m: with_vertical(m, level),
    ):
        with pytest.raises(InvalidValueError, match="cannot be a horizontal motion"):
            use(motion)
    assert rk.simulate(BLOCK, {"x": level, "z": motion}).outcome is not None
    assert with_vertical(level, motion).peak_vertical == motion.peak


def _write(folder, name, form, component, k, **metadata):
    row = np.sin(0.1 * (k + 1) * np.arange(100))
    part = Component(component, row - row.mean(), "cm/s2", 0.01)
    folder.mkdir(exist_ok=True)
    (folder / name).write_bytes(formats()[form].write(Record(form, (part,), "", metadata)))


@pytest.mark.parametrize(
    ("form", "names", "directions"),
    [
        ("itaca", ("1_H1.cor.acc", "1_H2.cor.acc", "1_V.cor.acc"), ("WE", "NS", "UP")),
        ("smc-usgs", ("0210a.smc", "0210b.smc", "0210c.smc"), ("90", "360", "UP")),
        ("usc", ("17m30ln.s0a", "17m30ln.s0b", "17m30ln.s0c"), ("N90E", "N00E", "DOWN")),
        ("csmnc", ("ua0001.dat", "ua0002.dat", "ua0003.dat"), ("EW", "NS", "UD")),
        ("esm", ("A.HNE.ASC", "A.HNN.ASC", "A.HNZ.ASC"), ("HNE", "HNN", "HNZ")),
        ("cosmos", ("X-n.0.HNE.--.V1c", "X-n.0.HNN.--.V1c", "X-n.0.HNZ.--.V1c"), ("90", "360", "UP")),
    ],
)
def test_files_of_one_record_are_joined(tmp_path, form, names, directions):
    """Three files whose headers state one event and station are one record of x, y and z; those of another are not."""
    for k, (name, direction) in enumerate(zip(names, directions, strict=True)):
        _write(tmp_path, name, form, direction, k, event="Shake", station="Cellar", date="1999-01-01")
    _write(tmp_path, "other.dat", form, directions[0], 5, event="Another", station="Attic", date="1999-01-02")
    found = read_records(tmp_path)
    assert not found.left_out
    joined = [[None if part is None else part.metadata["file"] for part in record.parts] for record in found]
    assert sorted(joined, key=str) == sorted([list(names), ["other.dat", None, None]], key=str)
    sign = -1.0 if directions[2] == "DOWN" else 1.0
    (record,) = (one for one in found if one.z is not None)
    up = read_motion(tmp_path / names[2])
    assert record.z.acceleration == pytest.approx(sign * up.acceleration, abs=0.0)


def test_numbers_of_kik_net(tmp_path):
    """1 and 4 are N-S, 2 and 5 E-W, 3 and 6 vertical; the borehole and the surface are records of their own."""
    for number, ending in zip("142536", ("NS1", "NS2", "EW1", "EW2", "UD1", "UD2"), strict=True):
        _write(tmp_path, f"AOMH01.{ending}", "knet", number, int(number))
    with pytest.warns(UserWarning, match="borehole"):
        found = read_records(tmp_path)
    joined = [[part.metadata["file"] for part in record.parts] for record in found]
    assert joined == [[f"AOMH01.{end}{n}" for end in ("EW", "NS", "UD")] for n in (1, 2)]


@pytest.mark.parametrize(
    ("codes", "expected"),
    [
        ((360, 90, 400), [0.0, 90.0, "up"]),
        ((90, 401, 180), [90.0, "down", 180.0]),
        ((402, 403, 400), [None, None, "up"]),
        ((360, 90, 402), [0.0, 90.0, "up"]),  # a vertical whose sense is missing, by the COSMOS tables
        ((600, 601, 400), [None, None, "up"]),
        ((402,), ["unclear"]),
    ],
)
def test_codes_of_cosmos(tmp_path, codes, expected):
    """Azimuths above 360 are codes: what may be vertical is settled by the others or refused."""
    parts = [Component(str(code), np.sin(np.arange(90.0) * (k + 1)), "cm/s2", 0.01) for k, code in enumerate(codes)]
    path = tmp_path / "three.v1c"
    path.write_bytes(formats()["cosmos"].write(Record("cosmos", tuple(parts))))
    record = formats()["cosmos"].read(Source.of_path(path))
    assert settled([part.direction for part in record.components]) == expected
    motions = [read_motion(path, component=part.name) for part in record.components]
    for motion, side in zip(motions, expected, strict=True):
        if isinstance(side, str):
            with pytest.raises(InvalidValueError, match="vertical"):
                rk.simulate(BLOCK, motion)
    (found,) = read_records(tmp_path) if len(codes) == 3 else (None,)
    assert found is None or [part is not None for part in found.parts] == [True] * 3


def test_three_components_without_directions_are_left_out(tmp_path):
    """One of three may be vertical: a set leaves them out by name; two are taken as horizontal."""
    rows = "\n".join(f"{0.01 * k:.2f} {np.sin(k):.5f} {np.sin(2 * k):.5f} {np.sin(3 * k):.5f}" for k in range(50))
    (tmp_path / "three.txt").write_text(f"# units: g\n{rows}\n", "utf-8")
    with pytest.raises(RecordError, match="without a stated vertical one"):
        read_records(tmp_path)
    two = "\n".join(line.rpartition(" ")[0] for line in rows.splitlines())
    (tmp_path / "two.txt").write_text(f"# units: g\n{two}\n", "utf-8")
    found = read_records(tmp_path)
    assert [[part is not None for part in one.parts] for one in found] == [[True, True, False]]
    assert [name.rpartition("/")[2] for name, _ in found.left_out] == ["three.txt"]


def test_the_angle_of_a_sensor_governs(tmp_path):
    """SAC states the angle from the vertical: Z turned over points down; a level code on a vertical one is unclear."""
    obspy = pytest.importorskip("obspy")
    for code, angle, expected in (
        ("HNZ", 0.0, "up"), ("HNZ", 180.0, "down"), ("HN1", 0.0, "up"), ("HNE", 0.0, "unclear"), ("HN2", 90.0, 35.0),
    ):  # fmt: skip
        trace = obspy.Trace(np.sin(np.arange(200, dtype=np.float32)))
        trace.stats.update({"network": "XX", "station": "A", "channel": code, "delta": 0.01})
        trace.stats.sac = {"cmpinc": angle, "cmpaz": 35.0}
        path = tmp_path / f"{code}.{angle:g}.sac"
        trace.write(str(path), format="SAC")
        (part,) = formats()["sac"].read(Source.of_path(path), "m/s2").components
        assert part.direction == expected


def test_cases_of_kik_net_and_cosmos(case_records):
    """The files that were once read as horizontal motions are records of x, y and z."""
    with pytest.warns(UserWarning, match="borehole"):
        kik = read_records(case_records / "kiknet")
    assert [[part.metadata["file"][-3:] for part in one.parts] for one in kik] == [
        ["EW1", "NS1", "UD1"],
        ["EW2", "NS2", "UD2"],
    ]
    (cosmos,) = read_records(case_records / "cosmos_vertical_400")
    assert [part.metadata["file"].split(".")[2] for part in cosmos.parts] == ["HNE", "HNN", "HNZ"]
    for path in (case_records / "kiknet").glob("*.UD?"):
        with pytest.raises(InvalidValueError, match="is vertical"):
            rk.simulate(BLOCK, read_motion(path))
