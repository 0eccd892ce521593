"""Inventories as campaigns: the verdicts of the Python call, from chunks of any size, after kills and damage."""

import numpy as np
import pytest
from campaign_jobs import flip

from rocking.campaigns import CampaignDamagedError, CampaignIncompleteError
from rocking.campaigns.jobs import Job, JobFolder, assessment, export
from rocking.errors import InvalidValueError
from rocking.motions.formats import read_motion
from rocking.studies.inventory import Thresholds, assess, read_inventory
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.table import as_plain

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
    return as_plain(assess(read_inventory(path.parent / "objects.csv"), hazard, **options))


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
    found = as_plain(assessment(folder))
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
    assert as_plain(assessment(folder)) == wanted
    unscaled = JobFolder.create(
        tmp_path / "d", Job.of_text(path.read_text().replace('pga = "0.1g"\n', ""), folder=tmp_path)
    )
    unscaled.run(workers=1)
    assert as_plain(assessment(unscaled)) == wanted_of(path, Hazard.of_records(motions), **options)


def test_unfinished_and_damaged(job, tmp_path):
    """Before the last chunk nothing is said; an altered shard is refused and computed again; all is as it was."""
    folder = JobFolder.create(tmp_path / "c", Job.read(job(7)))
    with pytest.raises(CampaignIncompleteError, match="go on with"):
        assessment(folder)
    folder.run(workers=1)
    before = as_plain(assessment(folder))
    shard = sorted((tmp_path / "c" / "histories" / "shards").glob("*.shard"))[3]
    flip(shard, -8 * 40)
    with pytest.raises(CampaignDamagedError):
        assessment(folder)
    assert len(folder.run(workers=1).set_aside) == 1
    assert as_plain(assessment(folder)) == before


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
    with pytest.raises(InvalidValueError, match="has changed since the campaign began"):
        JobFolder.open(folder.path)


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('objects = "objects.csv"', 'objects = "none.csv"', r"none\.csv: No such file"),
        ('pga = "0.3g"', "", "how strong is the shaking"),
        ('pga = "0.3g"', 'pga = "0.3"', r"inventory: PGA must be a number with its unit"),
        ('pga = "0.3g"', 'pga = "0.3g"\npgv = "20cm/s"', "not both"),
        ('pga = "0.3g"', 'pga = "0.3g"\nthresholds = { rocking = 7.0 }', "rocking"),
        ("seed = 4", "seed = 4\npga = 3.0", "stands in .inventory."),
        ("seed = 4", 'seed = 4\n[settings]\nengine = "fast"', r"settings\.engine does not go with"),
        ("seed = 4", 'seed = 4\n[restitution]\nmodels = ["ked", "housner"]', "takes one"),
        ("seed = 4", "seed = 4\n[restitution.distribution]\nmean = 0.9\ndeviation = 0.1", "not a law of impacts"),
        ("seed = 4", 'seed = 4\n[body]\nunits = "m"\nwidth = 1\nheight = 4', "objects stand in the file"),
        (
            'synthetic = "firm-ground"\ncount = 12\nseed = 4',
            'pulse = "sine:amplitude=1,period=1"',
            "records, or one family",
        ),
        ('kind = "inventory"', 'kind = "cloud"', "does not go with"),
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
    from rocking.studies.inventory import InventoryObject

    vase = InventoryObject(name="vase", width=0.2, depth=0.2, height=1.0)
    hazard = Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.3g"), count=5, seed=1)
    lifted = {g: assess([vase], hazard, gravity=g).verdicts[0].worse.lifted for g in (9.80665, 98.0665)}
    assert lifted == {9.80665: 5, 98.0665: 0}
    heavy = assess([vase], hazard, gravity=98.0665).verdicts[0].worse
    assert np.isclose(heavy.uplift_acceleration, 98.0665 * 0.2, rtol=1e-12)
