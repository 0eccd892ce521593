"""Folders as users have them: one array file, earthquakes, scans with their own units, one axis, raw records."""

import math
import warnings

import numpy as np
import pytest
from outcome_folders import BODY, TOML, seen

import rocking as rk
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.motions.formats.reader import read_record
from rocking.spec.array_file import ArrayFile
from rocking.spec.construction import motion_of
from rocking.spec.motion_tables import OneMotionTable
from rocking.spec.prediction import _azimuth
from rocking.spec.reading import CommandFiles

COMMAND = "validate-predictions"
pytestmark = pytest.mark.verifies(room="studies")
STEP = 0.01
POINTS = [(x, y, z) for z in (0, 1600) for x, y in ((0, 0), (400, 0), (400, 400), (0, 400))]
FACES = ["4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]


def _array_folder(folder, motions=6, *, own_earthquakes=False):
    """Fill a folder with invented trials in one array file; every earthquake has two levels of its record."""
    random, arrays, rows = np.random.default_rng(23), {"time_step": STEP}, ["shake,earthquake,overturned"]
    for k in range(motions):
        record = rk.pulses.sine(random.uniform(2.0, 6.0), random.uniform(0.3, 1.4)).sampled(STEP)
        for level, scale in enumerate((0.7, 1.6)):
            name = f"shake{k}{level}"
            unit = 1e-4
            arrays[name] = np.rint(scale * record.acceleration / unit).astype(np.int32)
            arrays[f"{name}_unit"] = unit
            overturned, _ = seen(record, scale, random)
            rows.append(f"{name},{name if own_earthquakes else f'quake {k}'},{overturned}")
    np.savez(folder / "table_motions.npz", **arrays)
    (folder / "outcomes.csv").write_text("\n".join(rows), "utf-8")
    (folder / "body.toml").write_text(TOML.partition("[motion]")[0], "utf-8")
    return folder


def test_array_file_gives_the_answer_of_single_records(answered, tmp_path):
    """The same accelerations in text files, with the earthquakes in the table, have the same scores."""
    folder = _array_folder(tmp_path)
    result = answered(folder, "--set", "predict.count=8")
    with np.load(folder / "table_motions.npz") as arrays:
        for name in (key for key in arrays.files if f"{key}_unit" in arrays.files):
            values = arrays[name] * float(arrays[f"{name}_unit"])
            (folder / f"{name}.txt").write_text("\n".join(f"{v!r}" for v in values.tolist()), "utf-8")
    (folder / "table_motions.npz").unlink()
    table = (folder / "outcomes.csv").read_text("utf-8").splitlines()
    texts = [row.replace(",", ".txt,", 1) for row in table[1:]]
    (folder / "outcomes.csv").write_text("\n".join([table[0], *texts]), "utf-8")
    words = ("--set", "predict.count=8", "--units", "m/s2", "--set", f"motion.time_step={STEP}")
    assert answered(folder, *words)["events"] == result["events"]
    assert result["ignored"] == []


def test_tests_of_one_earthquake_are_one_cluster(answered, tmp_path):
    """Without the column, each array is a motion of its own."""
    together, apart = tmp_path / "together", tmp_path / "apart"
    together.mkdir()
    apart.mkdir()
    few = ("--set", "predict.count=4")
    by_earthquake = answered(_array_folder(together), *few)["events"]["overturning"]
    by_shake = answered(_array_folder(apart, own_earthquakes=True), *few)["events"]["overturning"]
    assert (by_earthquake["outcomes"], by_earthquake["motions"]) == (12, 6)
    assert (by_shake["outcomes"], by_shake["motions"]) == (12, 12)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda arrays: arrays.pop("time_step"), "has no time step; add motion.time_step"),
        (lambda arrays: arrays.pop("shake_unit"), "has no unit; add motion.units"),
        (lambda arrays: arrays.update(shake=np.ones((3, 3))), "must be 1-D"),
        (lambda arrays: arrays.update(shake=np.array(["a", "b"])), "must contain numbers"),
        (lambda arrays: arrays.pop("shake"), "The array 'shake' is not in motions.npz"),
        (lambda arrays: arrays.update(shake_unit=-1.0), "shake_unit"),
    ],
)
def test_damaged_array_files(tmp_path, change, reason):
    arrays = {"shake": np.array([0.0, 1.0, -1.0]), "shake_unit": 0.5, "time_step": STEP}
    change(arrays)
    np.savez(tmp_path / "motions.npz", **arrays)
    with pytest.raises(InvalidValueError) as error:
        ArrayFile(tmp_path / "motions.npz").motion("shake", {})
    assert reason in str(error.value)


def test_array_file_without_numpy_format(tmp_path):
    (tmp_path / "motions.npz").write_bytes(b"no archive")
    with pytest.raises(InvalidValueError, match="not a readable array file"):
        ArrayFile(tmp_path / "motions.npz").motion("shake", {})


def test_scan_with_units_in_its_body_file(answered, tmp_path):
    """A body file that names the scan is the body; the result is that of the scan in the unit of the option."""
    lines = [*(f"v {x} {y} {z}" for x, y, z in POINTS), *(f"f {face}" for face in FACES)]
    (tmp_path / "rock.obj").write_text("\n".join(lines), "utf-8")
    _array_folder(tmp_path, motions=2)
    (tmp_path / "body.toml").unlink()
    few = ("--set", "predict.count=4", "--set", "predict.azimuth=0.0")
    by_option = answered(tmp_path, *few, "--units", "mm,m/s2")
    (tmp_path / "body.toml").write_text(
        "units = 'm'\n[[solid.part]]\nmesh = { file = 'rock.obj', units = 'mm' }\n", "utf-8"
    )
    assert answered(tmp_path, *few)["events"] == by_option["events"]


def test_axis_in_the_frame_of_the_file(tmp_path):
    """The file has y up; the axis (1, 0, -1) of the file is horizontal, at 45 degrees from x."""
    lines = [*(f"v {x} {z} {-y}" for x, y, z in POINTS), *(f"f {face}" for face in FACES)]
    (tmp_path / "rock.obj").write_text("\n".join(lines), "utf-8")
    solid = rk.read_body(tmp_path / "rock.obj", units="mm", up="y")
    along = solid.turn @ np.array([1.0, 0.0, -1.0])
    azimuth = _azimuth(solid, [1.0, 0.0, -1.0], None)
    cosine, sine = math.cos(azimuth), math.sin(azimuth)
    turned = (cosine * along[0] - sine * along[1], sine * along[0] + cosine * along[1])
    np.testing.assert_allclose(turned, (math.sqrt(2.0), 0.0), atol=1e-12)  # along x of the motion
    assert abs(azimuth) % (0.5 * math.pi) == pytest.approx(0.25 * math.pi)
    with pytest.raises(InvalidValueError, match="horizontal direction"):
        _azimuth(solid, [0.0, 1.0, 0.0], None)
    with pytest.raises(InvalidValueError, match="not both"):
        _azimuth(solid, [1.0, 0.0, 0.0], 0.2)
    with pytest.raises(InvalidValueError, match="scans only"):
        _azimuth(BODY, [1.0, 0.0, 0.0], None)


def test_doubts_about_raw_records_follow_the_steps(tmp_path):
    """A constant offset is a doubt; after the step mean there is none, after the step scale there still is."""
    samples = 0.2 + 3.0 * np.sin(2.0 * np.pi * np.arange(1000) * 0.01)
    (tmp_path / "raw.txt").write_text("\n".join(f"{v:.9g}" for v in samples.tolist()), "utf-8")

    def doubts(*steps):
        table = OneMotionTable(record="raw.txt", units="m/s2", time_step=0.01, process=list(steps) or None)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            motion_of(table, CommandFiles(tmp_path))
        return [str(item.message) for item in caught if issubclass(item.category, PlausibilityWarning)]

    raw, scaled = doubts(), doubts("scale:factor=0.5")
    assert len(raw) == len(scaled) == 1
    assert "check the baseline correction" in raw[0]
    assert "check the baseline correction" in scaled[0]
    assert scaled[0] != raw[0]  # of the processed record
    assert doubts("mean") == []


def test_times_with_an_offset_are_one(tmp_path):
    """Loggers add a clock: equal steps are one time, different steps are refused (test_column_words)."""
    rows = [f"{0.01 * k:.2f},{k % 3 - 1},{1000.0004 + 0.01 * k:.4f},{k % 5 - 2}" for k in range(50)]
    (tmp_path / "log.csv").write_text("time [s],table [g],time [s],model [g]\n" + "\n".join(rows), "utf-8")
    record = read_record(tmp_path / "log.csv")
    assert [component.time_step for component in record.components] == [0.01, 0.01]
    assert record.components[1].acceleration[:3].tolist() == [-2.0, -1.0, 0.0]


def test_update_writes_the_model_error_of_the_body(answered, run, tmp_path):
    """The file of --update is the input of predict; the earthquakes are scored without their own tests."""
    folder, own = _array_folder(tmp_path, motions=8), tmp_path / "own.json"
    result = answered(folder, "--set", "predict.count=16", "--update", str(own))["updated"]
    assert result["events"]["overturning"]["outcomes"] == 16
    assert "16 tests of this body" in result["source"]
    prediction = rk.predict(BODY, rk.pulses.sine(4.0, 0.8), model_error=str(own), count=16)
    assert prediction.inputs["model_error"] == result["model_error"]
    code, out, _ = run(folder, "--set", "predict.count=16", "--update", str(own))
    assert code == 0
    assert "Updated model error: uplift acceleration times" in out
