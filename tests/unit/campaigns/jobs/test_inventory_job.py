"""Inventories as campaigns: the verdicts of the Python call, from chunks of any size, after kills and damage."""

import numpy as np
import pytest
from campaign_jobs import flip

from rocking import read_body, simulate
from rocking.campaigns import CampaignDamagedError, CampaignIncompleteError
from rocking.campaigns.jobs import Job, JobFolder, assessment, export
from rocking.decision.inventory import Thresholds, assess, read_inventory
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.ranking import answer_of
from rocking.errors import InvalidValueError
from rocking.motions.formats import read_motion

pytestmark = pytest.mark.slow

OBJECTS = """name,width_cm,depth_cm,height_cm,centre_of_mass_height_cm,note
tall vase,20,20,100,55,
cabinet,90,45,180,,locked
column,30,30,260,,
framed mirror,75,?,160,,
"""
JOB = """[campaign]
name = "objects"
kind = "inventory"
chunk = {chunk}
[inventory]
objects = "objects.csv"
pga = "0.3g"
[motions]
synthetic = "firm-ground"
count = 12
seed = 4
"""


@pytest.fixture
def job(tmp_path):
    """Write a list and a job beside it, with something replaced."""

    def write(chunk=64, old="", new=""):
        (tmp_path / "objects.csv").write_text(OBJECTS, encoding="utf-8")
        path = tmp_path / f"job-{chunk}.toml"
        text = JOB.format(chunk=chunk)
        assert old in text
        path.write_text(text.replace(old, new) if old else text, encoding="utf-8")
        return path

    return write


def wanted_of(path, hazard, **options):
    """The verdicts of the Python call, as plain values."""
    return answer_of(assess(read_inventory(path.parent / "objects.csv"), hazard, **options)).plain()


@pytest.mark.parametrize(
    ("chunk", "how"),
    [
        (1, {"workers": 1, "order_seed": 2}),
        (7, {"workers": 2}),
        (64, {"executor": "processes", "workers": 2, "start_method": "fork"}),
    ],
)
def test_campaign_is_assess(job, tmp_path, chunk, how):
    """Whatever the chunks and the workers: verdicts, ranks, lights and rows that were refused are those of `assess`."""
    path = job(chunk)
    folder = JobFolder.create(tmp_path / "c", Job.read(path))
    folder.run(**how)
    hazard = Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.3g"), count=12, seed=4)
    found = answer_of(assessment(folder)).plain()
    assert found == wanted_of(path, hazard)
    assert (len(found["objects"]), len(found["not_assessed"])) == (3, 1)


def test_records_thresholds_and_gravity(job, records, tmp_path):
    """Records as they are, a coefficient, thresholds and another gravity stand for the arguments of `assess`."""
    old = 'synthetic = "firm-ground"\ncount = 12\nseed = 4\n'
    path = job(5, old, 'records = "*.txt"\nunits = "m/s2"\n[restitution]\nvalue = 0.9\n[settings]\ngravity = 3.7\n')
    limits = 'pga = "0.1g"\nthresholds = { rocking = 0.1, overturning_red = 0.5 }\n'
    path.write_text(path.read_text().replace('pga = "0.3g"\n', limits))
    folder = JobFolder.create(tmp_path / "c", Job.read(path))
    folder.run(workers=1)
    motions = [read_motion(records / f"{name}.txt", units="m/s2") for name in ("one", "two")]
    options = {"restitution": 0.9, "thresholds": Thresholds(rocking=0.1, overturning_red=0.5), "gravity": 3.7}
    wanted = wanted_of(path, Hazard.of_records(motions, IntensityLevel.of("PGA", "0.1g")), **options)
    assert answer_of(assessment(folder)).plain() == wanted
    unscaled = JobFolder.create(
        tmp_path / "d", Job.of_text(path.read_text().replace('pga = "0.1g"\n', ""), folder=tmp_path)
    )
    unscaled.run(workers=1)
    assert answer_of(assessment(unscaled)).plain() == wanted_of(path, Hazard.of_records(motions), **options)


def test_unfinished_and_damaged(job, tmp_path):
    """Before the last chunk nothing is said; an altered shard is refused and computed again; all is as it was."""
    folder = JobFolder.create(tmp_path / "c", Job.read(job(7)))
    with pytest.raises(CampaignIncompleteError, match="go on with"):
        assessment(folder)
    folder.run(workers=1)
    before = answer_of(assessment(folder)).plain()
    shard = sorted((tmp_path / "c" / "histories" / "shards").glob("*.shard"))[3]
    flip(shard, -8 * 40)
    with pytest.raises(CampaignDamagedError):
        assessment(folder)
    assert len(folder.run(workers=1).set_aside) == 1
    assert answer_of(assessment(folder)).plain() == before


def test_every_history(job, tmp_path):
    """The histories behind the verdicts: motion, object with its line, direction and model of impact."""
    xr = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    folder = JobFolder.create(tmp_path / "c", Job.read(job()))
    folder.run(workers=1)
    found = xr.load_dataset(export(folder, tmp_path / "all.nc"), engine="h5netcdf")
    assert found["object"].values.tolist() == ["tall vase", "cabinet", "column"]
    assert found["row"].values.tolist() == [2, 3, 4]
    fell = (found["outcome"] == 2).sum("motion").sel(restitution="calibrated").max("direction")
    verdicts = {each.item.name: each.worse.overturned for each in assessment(folder).verdicts}
    assert dict(zip(found["object"].values.tolist(), fell.values.tolist(), strict=True)) == verdicts


def test_changed_list_is_refused(job, tmp_path):
    """A list that changed since the campaign began is another inventory."""
    folder = JobFolder.create(tmp_path / "c", Job.read(job()))
    (tmp_path / "objects.csv").write_text(OBJECTS.replace("20,20,100", "20,20,101"))
    with pytest.raises(InvalidValueError, match="The file changed after the start of the campaign"):
        JobFolder.open(folder.path)


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('objects = "objects.csv"', 'objects = "none.csv"', r"none\.csv: no such file"),
        ('pga = "0.3g"', "", "The intensity level is missing"),
        ('pga = "0.3g"', 'pga = "0.3"', r"inventory: PGA must be a number with its unit"),
        ('pga = "0.3g"', 'pga = "0.3g"\npgv = "20cm/s"', "not both"),
        ('pga = "0.3g"', 'pga = "0.3g"\nthresholds = { rocking = 7.0 }', "rocking"),
        ("seed = 4", "seed = 4\npga = 3.0", "set inventory.pga"),
        ("seed = 4", 'seed = 4\n[settings]\nengine = "fast"', r"settings\.engine is not allowed"),
        ("seed = 4", 'seed = 4\n[restitution]\nmodels = ["ked", "housner"]', "accepts one"),
        ("seed = 4", "seed = 4\n[restitution.distribution]\nmean = 0.9\ndeviation = 0.1", "not an impact law"),
        ("seed = 4", 'seed = 4\n[body]\nunits = "m"\nwidth = 1\nheight = 4', "the objects are in the file"),
        (
            'synthetic = "firm-ground"\ncount = 12\nseed = 4',
            'pulse = "sine:amplitude=1,period=1"',
            "records, or one family",
        ),
        ('kind = "inventory"', 'kind = "cloud"', "does not accept"),
    ],
)
def test_refusals(job, old, new, wanted):
    """What is missing, contradicts itself or belongs elsewhere is refused with the place where it stands."""
    with pytest.raises(InvalidValueError, match=wanted):
        Job.read(job(64, old, new))


def test_nothing_to_assess(job, tmp_path):
    """A list of which no row can be assessed is refused with the first reason."""
    path = job()
    (tmp_path / "objects.csv").write_text("name,width_cm,depth_cm,height_cm\nmirror,75,?,160\n")
    with pytest.raises(InvalidValueError, match="no object can be assessed; line 2"):
        Job.read(path)


def test_gravity_reaches_the_equations():
    """Closed form: b/h = 0.2 lifts at 0.2 of the gravity there is, so 0.3 g lifts on Earth and not at ten times g."""
    from rocking.decision.inventory import InventoryObject

    vase = InventoryObject(name="vase", width=0.2, depth=0.2, height=1.0)
    hazard = Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.3g"), count=5, seed=1)
    lifted = {g: assess([vase], hazard, gravity=g).verdicts[0].worse.lifted for g in (9.80665, 98.0665)}
    assert lifted == {9.80665: 5, 98.0665: 0}
    heavy = assess([vase], hazard, gravity=98.0665).verdicts[0].worse
    assert np.isclose(heavy.uplift_acceleration, 98.0665 * 0.2, rtol=1e-12)


SOLID = 'units = "m"\n[[solid.part]]\nbox = { width = 0.3, depth = 0.5, height = 0.9 }\ndensity = 2000\n'
MIXED = """name,width_cm,depth_cm,height_cm,centre_of_mass_height_cm,friction,body_file,units
tall vase,20,24,100,55,,,
chest,60,90,70,,0.35,,
bust,,,,,,bust.toml,m
mirror,75,?,160,,0.35,,
"""
SHORT = """[campaign]
name = "objects"
kind = "inventory"
chunk = 7
[inventory]
objects = "objects.csv"
[motions]
records = "shaking*.csv"
[restitution]
"""


@pytest.fixture
def mixed(tmp_path):
    """Write a list with bodies in space, two short records, and a job beside them; return the job and the hazard."""
    (tmp_path / "bust.toml").write_text(SOLID)
    (tmp_path / "objects.csv").write_text(MIXED, encoding="utf-8")
    time, motions = 0.02 * np.arange(76), []
    for k, (size, rate) in enumerate(((6.0, 14.0), (8.0, 9.0))):
        path = tmp_path / f"shaking{k}.csv"
        values = size * np.sin(rate * time) * np.exp(-2.0 * time)
        rows = (f"{t:.2f},{a:.9f}" for t, a in zip(time, values, strict=True))
        path.write_text("\n".join(["time [s],acceleration [m/s2]", *rows]))
        motions.append(read_motion(path))
    path = tmp_path / "short.toml"
    path.write_text(f"{SHORT}value = 0.9\n")
    return path, Hazard.of_records(motions)


def test_bodies_in_space_beside_plane_ones(mixed, tmp_path):
    """Objects with friction and of body files: from chunks that cut across them, the verdicts of `assess`."""
    path, hazard = mixed
    folder = JobFolder.create(tmp_path / "c", Job.read(path))
    folder.run(workers=2, order_seed=3)
    found = answer_of(assessment(folder)).plain()
    assert found == wanted_of(path, hazard, restitution=0.9)
    assert (len(found["objects"]), len(found["not_assessed"])) == (3, 1)
    assert found != wanted_of(path, hazard, restitution=0.9, friction=0.1)


def test_rows_in_space_are_single_histories(mixed, tmp_path):
    """Along its width an object in space is the history of `simulate`; along its depth it is another one."""
    xr = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    path, hazard = mixed
    path.write_text(f"{SHORT}value = 0.86\n[settings]\nfriction = 0.9\n")
    folder = JobFolder.create(tmp_path / "c", Job.read(path))
    folder.run(workers=1)
    whole = xr.load_dataset(export(folder, tmp_path / "all.nc"), engine="h5netcdf")
    assert whole["object"].values.tolist() == ["tall vase", "chest", "bust"]
    found = whole.sel(restitution="asked").isel(object=2, motion=1)
    one = simulate(read_body(tmp_path / "bust.toml"), hazard.motions[1], 0.86, friction=0.9)
    assert int(found["outcome"].sel(direction="width")) == one.outcome.code
    assert float(found["peak_rotation"].sel(direction="width")) == pytest.approx(one.peak_tilt, rel=1e-5)
    assert float(found["peak_rotation"].sel(direction="depth")) < 0.5 * one.peak_tilt
