"""Adaptive studies as campaigns: round by round, the bits of the Python call, whatever interrupts them."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, digests, finished, flip, job, search

import rocking as rk
from rocking import conventions
from rocking.campaigns import (
    CampaignBusyError,
    CampaignDamagedError,
    CampaignIncompleteError,
    CampaignMismatchError,
)
from rocking.campaigns.disk import FolderLock
from rocking.campaigns.jobs import Job, JobFolder, answer, export, forecast, status_of
from rocking.dynamics import RandomRestitution
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.studies import SyntheticSet, boundary, minimum_overturning_accelerations, overturning_map

pytestmark = pytest.mark.slow

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")

MAP = """[map]
x = {{ axis = "frequency_ratio", values = [1.5, 3.0, 4.5] }}
y = {{ axis = "amplitude_ratio", values = [1.5, 4.0, 6.5] }}
refine = 1
boundary = "{by}"
tolerance = 0.01
"""
MINIMUM = search(6, 0.05)
VALUE = "[restitution]\nvalue = 0.9\n"
DRAWN = MINIMUM.replace("values = [0.85, 0.93]", "[restitution.distribution]\nmean = 0.9\ndeviation = 0.03")
BODIES = [rk.Block(width=0.5, height=2.0), rk.Block(width=0.3, height=1.5)]
SEARCH = {"max_pga": 25.0, "samples": 6, "bisections": 1, "tolerance": 0.05}
AXES = ("frequency_ratio", [1.5, 3.0, 4.5]), ("amplitude_ratio", [1.5, 4.0, 6.5])


def text_of(kind, chunk=64, seed=0, by="verdict"):
    """Text of a small job."""
    if kind == "map":
        return job("overturning-map", BODY, PULSE, VALUE, MAP.format(by=by), chunk=chunk, seed=seed)
    return job("minimum-acceleration", MINIMUM if kind == "minimum" else DRAWN, chunk=chunk, seed=seed)


def begun(path, kind, **changes):
    """A campaign of which nothing is computed."""
    return JobFolder.create(path, Job.of_text(text_of(kind, **changes)))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Campaigns that ran in one piece, by kind; not to be changed."""
    place = tmp_path_factory.mktemp("whole")
    return {kind: finished(place / kind, text_of(kind)) for kind in ("map", "minimum")}


def same_sheets(found, wanted):
    """Whether tables have the same bits."""
    assert list(found.tables) == list(wanted.tables)
    for name, sheet in wanted.tables.items():
        assert list(found.tables[name].columns) == list(sheet.columns)
        for column, each in sheet.columns.items():
            values = found.tables[name].columns[column].values
            assert np.array_equal(values, each.values, equal_nan=each.values.dtype.kind == "f"), column


@pytest.mark.parametrize("by", ["verdict", "mode"])
def test_refined_map_is_the_python_call(tmp_path, by):
    """Map, refined points and polylines in one netCDF file: every bit of `overturning_map` and `boundary`."""
    folder = finished(tmp_path / "c", text_of("map", by=by, chunk=7), workers=2)
    pulse, body = rk.pulses.sine(3.0, 0.6), BODIES[0]
    wanted = overturning_map(body, pulse, *AXES, 0.9, refine=1)
    found = xr.load_dataset(export(folder, tmp_path / "map.nc"), engine="h5netcdf")
    for name in wanted.data_vars:
        values = wanted[name].values
        assert np.array_equal(found[name].values, values.astype(found[name].dtype), equal_nan=values.dtype.kind == "f")
    assert found.sizes["point"] > 9
    lines = boundary(body, pulse, *AXES, 0.9, by=by, levels=1, tolerance=0.01)
    assert found.attrs["polylines"] == len(lines) > 0
    for k, line in enumerate(lines):
        own = found.isel(vertex=np.flatnonzero(found["boundary_line"] == k))
        assert np.array_equal(np.stack([own["boundary_x"], own["boundary_y"]], axis=1), line.points)
        assert np.array_equal(np.stack([own["boundary_mode_outside"], own["boundary_mode_inside"]], 1), line.modes)
        assert set(own["boundary_region"].values) == {line.region}
        assert set(own["boundary_closed"].values) == {int(line.closed)}


def test_verdict_changes_at_the_boundary(whole):
    """Independent of the rounds: the reference engine's verdict differs just below and just above bisected vertices."""
    _, lines = answer(whole["map"]).value
    points = np.concatenate([line.points for line in lines])
    upright = points[np.isin(points[:, 0], [1.5, 2.25, 3.0, 3.75, 4.5])][:4]
    p, alpha = BODIES[0].frequency_parameter, BODIES[0].slenderness_angle
    assert len(upright)
    for x, y in upright:
        falls = []
        for part in (0.994, 1.006):  # brackets are up to 1 % wide, the vertices their middles
            pulse = rk.pulses.sine(y * part * conventions.g * np.tan(alpha), 2.0 * np.pi / (x * p))
            falls.append(
                rk.simulate(BODIES[0], pulse, restitution=0.9, engine="reference").outcome is Outcome.OVERTURNED
            )
        assert falls[0] != falls[1]


@pytest.mark.parametrize("kind", ["minimum", "drawn"])
def test_minimum_is_the_python_call(tmp_path, kind):
    """Motions, restitutions and bodies searched together: each has every bit of the call for it alone."""
    folder = finished(tmp_path / "c", text_of(kind, chunk=64, seed=5))
    motions = SyntheticSet("pulse-like", 2, 3)
    drawn = [RandomRestitution.normal(0.9, 0.03, seed=5)]
    choices = [0.85, 0.93] if kind == "minimum" else drawn
    wanted = [
        each for k in range(2) for choice in choices
        for each in minimum_overturning_accelerations(BODIES, motions[k], choice, **SEARCH)
    ]  # fmt: skip
    found = answer(folder).value
    assert len(found) == len(wanted)
    assert sum(len(each) for each in wanted) > 4
    for one, other in zip(found, wanted, strict=True):
        for name, value in vars(other).items():
            assert np.array_equal(getattr(one, name), value, equal_nan=name == "resolution_below"), name


def test_tables_of_minima(whole, tmp_path):
    """A row for each motion, restitution and body, and one for each crossing; what is not there is empty."""
    parquet = pytest.importorskip("pyarrow.parquet")
    found = answer(whole["minimum"]).value
    table = parquet.read_table(export(whole["minimum"], tmp_path / "m.parquet", "minima")).to_pandas()
    assert table["minimum"].tolist() == pytest.approx(
        [np.nan if c.minimum is None else c.minimum for c in found], 0, 0, nan_ok=True
    )
    assert table["crossings"].tolist() == [len(each) for each in found]
    assert table["restitution"].tolist() == ["0.85", "0.85", "0.93", "0.93"] * 2
    assert table["body"].tolist() == [0, 1] * 4
    lines = export(whole["minimum"], tmp_path / "c.csv").read_text().splitlines()
    assert lines[0].startswith("motion,restitution,body,acceleration [m/s2],ratio,scale,width [m/s2]")
    assert [float(line.split(",")[-6]) for line in lines[1:]] == np.concatenate(
        [c.acceleration for c in found]
    ).tolist()
    both = xr.load_dataset(export(whole["minimum"], tmp_path / "m.nc"), engine="h5netcdf")
    assert (both.sizes["case"], both.sizes["crossing"]) == (8, len(lines) - 1)
    assert both.attrs["rounds"] == status_of(whole["minimum"].path).rounds


def test_nothing_to_find(tmp_path):
    """A map without a boundary and a search without a crossing are finished, and their tables are empty."""
    calm = text_of("map").replace("[1.5, 4.0, 6.5]", "[0.1, 0.2, 0.3]")
    folder = finished(tmp_path / "map", calm)
    assert xr.load_dataset(export(folder, tmp_path / "map.nc"), engine="h5netcdf").sizes["vertex"] == 0
    weak = text_of("minimum").replace("max_pga = 25.0", "min_pga = 0.1\nmax_pga = 0.5")
    folder = finished(tmp_path / "minimum", weak)
    assert export(folder, tmp_path / "c.csv").read_text().count("\n") == 1
    assert all(len(each) == 0 for each in answer(folder).value)


def test_bodies_that_fail_alone(tmp_path):
    """Where no history can be computed a row says so, and the others have their numbers."""
    words = text_of("minimum").replace("[minimum]", "[settings]\nmost_events = 1\n[minimum]")
    folder = finished(tmp_path / "c", words)
    columns = answer(folder).tables["minima"].columns
    assert (columns["failed"].values > 0).any()
    none = columns["failed"].values == columns["samples"].values
    assert np.isnan(columns["minimum"].values[none]).all()


FORKED = {"executor": "processes", "workers": 2, "start_method": "fork"}


@pytest.mark.parametrize(
    ("kind", "chunk", "how"),
    [
        ("map", 1, {"workers": 1, "order_seed": 3}),
        ("map", 7, {"workers": 2}),
        ("map", 7, FORKED),
        ("map", 64, {"workers": 2}),
        ("minimum", 1, {"workers": 1, "order_seed": 3}),
        ("minimum", 23, FORKED),
        ("minimum", 1000, {"workers": 2}),
    ],
)
def test_same_bits_whatever_computes(whole, tmp_path, kind, chunk, how):
    """Chunks of 1 to 1000, one worker or two, threads or processes: the same rounds, the same bits."""
    folder = finished(tmp_path / "c", text_of(kind, chunk=chunk), **how)
    assert digests(folder) == digests(whole[kind])
    same_sheets(answer(folder), answer(whole[kind]))


KILLED = """
import os, signal, sys
from rocking.campaigns import ledger
from rocking.campaigns.jobs import JobFolder, rounds
folder, where, after, sign = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
left = [after]
def dying(before, kind, name):
    def call(self, *given):
        if not before:
            found = getattr(kind, name + "_")(self, *given)
        left[0] -= 1
        if left[0] == 0:
            os.kill(os.getpid(), sign)
        return getattr(kind, name + "_")(self, *given) if before else found
    setattr(kind, name + "_", getattr(kind, name))
    setattr(kind, name, call)
if where == "within":
    dying(False, ledger.Ledger, "record")
else:
    dying(where == "before", rounds.Rounds, "compute")
JobFolder.open(folder).run(workers=1)
"""


def killed(folder, where, after, sign=9):
    """Run a campaign that ends itself; how it ended."""
    words = [sys.executable, "-c", KILLED, str(folder), where, str(after), str(sign)]
    return subprocess.run(words, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("kind", ["map", "minimum"])
def test_killed_and_resumed(whole, tmp_path, kind):
    """SIGKILL within rounds, before and after them: whoever goes on computes none of the finished ones again."""
    folder = begun(tmp_path / "c", kind, chunk=7)
    for where, after in (("within", 2), ("before", 3), ("after", 4)):
        assert killed(folder.path, where, after).returncode == -9
        found = status_of(folder.path)
        assert not found.complete
        assert found.status.histories_done > 0
        with pytest.raises(CampaignIncompleteError, match="go on with: rocking campaign resume"):
            export(folder, tmp_path / "r.csv", "histories")
        with pytest.raises(CampaignIncompleteError, match="go on with: rocking campaign resume"):
            answer(folder)
    before = status_of(folder.path).status
    done = JobFolder.open(folder.path).run(workers=1)
    after = status_of(folder.path)
    assert after.complete
    assert done.computed == after.status.chunks - before.chunks_done
    assert JobFolder.open(folder.path).run(workers=1).computed == 0
    assert digests(folder) == digests(whole[kind])
    same_sheets(answer(folder), answer(whole[kind]))


def test_stopped_between_rounds(whole, tmp_path):
    """SIGTERM between two rounds stops before the next one, in a sentence; it goes on from there."""
    folder = begun(tmp_path / "c", "map")
    done = killed(folder.path, "after", 2, sign=15)
    assert done.returncode != -15
    assert f"{folder.path}: stopped in round 3; nothing that was recorded before is lost; go on with" in done.stderr
    assert status_of(folder.path).rounds == 2
    folder.run(workers=1)
    assert digests(folder) == digests(whole["map"])


def test_altered_round_is_seen(whole, tmp_path):
    """Negative control: a byte of an inner round changed. Exports refuse it; a run computes it again and says so."""
    shutil.copytree(whole["map"].path, tmp_path / "c")
    folder = JobFolder(tmp_path / "c", whole["map"].job)
    flip(next((tmp_path / "c" / "round-002" / "shards").glob("*.shard")), 8 * 600)
    with pytest.raises(CampaignDamagedError, match="round-002"):
        answer(folder)
    with pytest.raises(CampaignDamagedError, match="round-002"):
        export(folder, tmp_path / "map.nc")
    assert not list(tmp_path.glob("*.nc"))
    done = folder.run(workers=1)
    assert (done.computed, len(done.set_aside)) == (1, 1)
    assert digests(folder) == digests(whole["map"])
    same_sheets(answer(folder), answer(whole["map"]))


def test_round_of_another_study_is_refused(whole, tmp_path):
    """A whole and sealed round that is not the one that the job asks for is refused: no bit of it gets in."""
    finished(tmp_path / "other2", text_of("map").replace("value = 0.9", "value = 0.91"))
    shutil.copytree(whole["map"].path, tmp_path / "c")
    shutil.rmtree(tmp_path / "c" / "round-001")
    shutil.copytree(tmp_path / "other2" / "round-001", tmp_path / "c" / "round-001")
    folder = JobFolder(tmp_path / "c", whole["map"].job)
    for ask in (lambda: answer(folder), lambda: folder.run(workers=1)):
        with pytest.raises(CampaignMismatchError, match="round-001"):
            ask()


@pytest.mark.parametrize(
    ("kind", "old", "new"),
    [
        ("drawn", "seed = 0", "seed = 1"),
        ("minimum", "samples = 6", "samples = 7"),
        ("map", "tolerance = 0.01", "tolerance = 0.1"),
    ],
)
def test_another_job_is_refused(tmp_path, kind, old, new):
    """The job in the folder changed afterwards, its seed or an option: what is there is not taken for its results."""
    finished(tmp_path / "c", text_of(kind))
    path = tmp_path / "c" / "job.toml"
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(CampaignDamagedError, match=r"job\.toml has changed since the campaign began"):
        JobFolder.open(tmp_path / "c")
    noted = tmp_path / "c" / "inputs.json"  # without the hash of the job, the rounds themselves tell
    noted.write_text(json.dumps({k: v for k, v in json.loads(noted.read_text()).items() if k != "job_sha256"}))
    changed = JobFolder.open(tmp_path / "c")
    with pytest.raises((CampaignMismatchError, CampaignDamagedError)):
        answer(changed)


def test_status_in_rounds(whole, tmp_path):
    """How many rounds have begun; complete only once the last one was asked for; another runner is kept out."""
    shutil.copytree(whole["map"].path, tmp_path / "c")
    found = status_of(tmp_path / "c")
    told = json.loads((tmp_path / "c" / "finished.json").read_text())
    assert found.complete
    assert told == {"rounds": found.rounds, "histories": found.status.histories}
    assert found.rounds == len(list((tmp_path / "c").glob("round-*")))
    (tmp_path / "c" / "finished.json").unlink()
    assert status_of(tmp_path / "c").status.complete
    assert not status_of(tmp_path / "c").complete
    folder = JobFolder(tmp_path / "c", whole["map"].job)
    with FolderLock(tmp_path / "c"):
        assert "process" in status_of(tmp_path / "c").status.running
        with pytest.raises(CampaignBusyError):
            folder.run(workers=1)
    assert folder.run(workers=1).computed == 0
    (tmp_path / "c" / "finished.json").write_text('{"rounds": 2, "histories": 9}')
    with pytest.raises(CampaignDamagedError, match="but the rounds have"):
        answer(folder)
    (tmp_path / "c" / "finished.json").write_text("?")
    with pytest.raises(CampaignDamagedError, match="remove it"):
        status_of(tmp_path / "c")


def test_forecast_is_of_the_first_round():
    """What is not known before it is found is not forecast."""
    assert forecast(Job.of_text(text_of("map"))).histories == 9
    assert forecast(Job.of_text(text_of("minimum"))).histories == 8 * 6


@pytest.mark.parametrize(
    ("kind", "old", "new", "wanted"),
    [
        ("map", "refine = 1\n", "", "boundary and tolerance requires the key refine"),
        ("map", "refine = 1", "refine = 13", "map.refine"),
        ("map", "values = [1.5, 3.0, 4.5]", "values = [1.5]", r"map\.refine: frequency_ratio must have at least 2"),
        ("map", "value = 0.9", "values = [0.8, 0.9]", "one restitution"),
        (
            "map",
            "value = 0.9",
            "[restitution.distribution]\nmean = 0.9\ndeviation = 0.1",
            "a random restitution has no boundary",
        ),
        ("minimum", "max_pga = 25.0", "min_pga = 50.0\nmax_pga = 25.0", "minimum: min_pga must be below max_pga"),
        ("minimum", "bisections = 1", "bisections = 13", r"minimum\.bisections"),
        ("minimum", "[minimum]", "[fragility]\n[minimum]", "does not accept"),
    ],
)
def test_refusals(kind, old, new, wanted):
    """What contradicts itself is refused with the place where it stands."""
    words = text_of(kind)
    assert old in words
    with pytest.raises(InvalidValueError, match=wanted):
        Job.of_text(words.replace(old, new))


def test_what_can_be_exported(whole, tmp_path):
    """What a kind does not have is refused by name, and so is a format."""
    for folder, what, name, wanted in (
        ("map", "crossings", "r.csv", "has no crossings"), ("minimum", "boundary", "r.csv", "has no boundary"),
        ("map", "boundary", "r.nc", "boundary can be written as"),
        ("map", "refined", "r.xml", "refined can be written as"),
    ):  # fmt: skip
        with pytest.raises(InvalidValueError, match=wanted):
            export(whole[folder], tmp_path / name, what)
    for what in ("refined", "boundary"):
        for suffix in (".csv", ".parquet", ".xlsx"):
            assert export(whole["map"], tmp_path / f"{what}{suffix}", what).stat().st_size > 100
    assert Path(tmp_path / "boundary.csv.provenance.json").is_file()
