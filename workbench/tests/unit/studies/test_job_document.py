"""Jobs that browsers send: what is refused before anything is opened, also mutated; names of studies."""

import copy
import itertools
import json
import tempfile
import tomllib
import unicodedata
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking import examples
from rocking.campaigns.jobs import Job
from rocking.errors import InvalidValueError, RockingError
from rocking.spec.motion_tables import MotionTable
from rocking_workbench.errors import TooLarge
from rocking_workbench.inputs import MOTION_KEYS
from rocking_workbench.plain_text import shown
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.folder import is_id, new_id
from rocking_workbench.runs.runner import Runner
from rocking_workbench.settings import Limits
from rocking_workbench.studies import job_document
from rocking_workbench.studies.job_document import JobDocument, launched_kinds
from rocking_workbench.studies.manager import StudyManager

EXAMPLES = examples.path("overturning-map").parent
LAUNCHED = [
    path
    for path in sorted(EXAMPLES.glob("*.toml"))
    if tomllib.loads(path.read_text())["campaign"]["kind"] in launched_kinds()
]
SHA = "ab" * 32

REGION = {"outline": [[0, 0], [1, 0], [1, 2]]}
HOSTILE = {
    "a body file": {"body": {"file": "/etc/passwd"}},
    "a body file beside sizes": {"body": {"units": "m", "width": 1.0, "height": 2.0, "file": "x.toml"}},
    "a drawing": {"body": {"units": "m", "section": {"region": [{"dxf": "/etc/passwd"}]}}},
    "a map of outlines": {"body": {"units": "m", "section": {"region": [REGION, {"geojson": "http://x/a"}]}}},
    "bodies in a list": {"body": [{"file": "a"}]},
    "a model in a file": {"restitution": {"model": "/etc/mine.py:Mine"}},
    "a model in a file among others": {"restitution": {"models": ["ked", "mine.py"]}},
    "a factor in a file": {"restitution": {"distribution": {"mean": 0.9, "deviation": 0.1, "times": " mine.py:Mine"}}},
    "an absolute record": {"motions": {"records": "/etc/passwd"}},
    "a record above": {"motions": {"records": ["../../x.AT2"]}},
    "a pattern of records": {"motions": {"records": ["*.AT2"]}},
    "an address of a record": {"motions": [{"records": ["http://127.0.0.1/x"]}]},
    "a hash with more behind it": {"motions": {"records": [SHA + "/../x"]}},
    "a hash in capitals": {"motions": {"records": [SHA.upper()]}},
    "a hash and a line": {"motions": {"records": [SHA + "\n"]}},
    "a record that is a number": {"motions": {"records": [1]}},
    "an inventory": {"campaign": {"name": "x", "kind": "inventory"}, "inventory": {"objects": "/etc/passwd"}},
    "an unknown kind": {"campaign": {"name": "x", "kind": "shell"}},
    "no campaign": {"campaign": None},
    "an unknown table": {"exec": {"command": "id"}},
    "an unknown key": {"settings": {"plugin": "os"}},
    "an infinite number": {"settings": {"gravity": float("inf")}},
    "no number": {"settings": {"gravity": float("nan")}},
    "a truth value for a number": {"settings": {"gravity": True}},
    "a word for a number": {"settings": {"gravity": "9.81"}},
    "no motion": {"motions": []},
    "a name that is too long": {"campaign": {"name": "x" * 300, "kind": "overturning-map"}},
}


@pytest.mark.parametrize("tables", HOSTILE.values(), ids=HOSTILE)
def test_hostile_jobs_are_refused(tables, map_job):
    """What names a file, or is no job, is refused in one sentence; the job without it is not."""
    with pytest.raises(InvalidValueError) as caught:
        JobDocument.of(map_job(**tables))
    assert "\n" not in str(caught.value)
    assert "/etc/passwd" not in str(caught.value) or len(str(caught.value)) < 300
    JobDocument.of(map_job())


@pytest.mark.parametrize("file", ["/etc/passwd", "../x.txt", None])
def test_a_vertical_part_in_a_file_is_refused_unread(file, map_job):
    with pytest.raises(InvalidValueError, match=r"motions\.vertical_file names a file, which is not allowed here"):
        JobDocument.of(map_job(motions=[{"records": [SHA], "vertical_file": file}]))
    with pytest.raises(InvalidValueError, match=r"motions\.x names a file, which is not allowed here"):
        JobDocument.of(map_job(motions=[{"x": {"record": file}, "y": {"record": file}}]))
    with pytest.raises(InvalidValueError, match=r"motions\.files is not allowed here; write one table of motions per"):
        JobDocument.of(map_job(motions=[{"records": [SHA], "files": {SHA: {"units": "g"}}}]))


def test_only_keys_that_are_known_to_name_no_file_are_taken(map_job, monkeypatch):
    """The keys of motions are a list of what is allowed: one that is not on it, perhaps a new one, is refused."""
    refused = {"records", "files", "vertical_file", "x", "y", "z", "process", "target", "mirrored", "periods"}
    assert MotionTable.model_fields.keys() - MOTION_KEYS == refused
    motion = {"synthetic": "pulse-like", "count": 2, "pga": 4.0}
    JobDocument.of(map_job(motions=motion))
    monkeypatch.setattr(job_document, "MOTION_KEYS", MOTION_KEYS - {"pga"})
    with pytest.raises(InvalidValueError, match=r"motions\.pga names a file"):
        JobDocument.of(map_job(motions=motion))
    with pytest.raises(InvalidValueError, match="body: unknown key 'mesh'"):
        JobDocument.of(map_job(body={"units": "m", "mesh": "/etc/passwd"}))


@pytest.mark.parametrize("given", [None, 1, "x", [], [{}]])
def test_what_is_no_object_is_refused(given):
    """A job is an object of tables."""
    with pytest.raises(InvalidValueError, match="job must be an object"):
        JobDocument.of(given)


def test_what_is_nested_too_deep_or_too_long_is_refused(map_job):
    """Neither recursion nor memory is at the mercy of a document."""
    deep = 1
    for _ in range(10_000):
        deep = [deep]
    with pytest.raises(InvalidValueError, match="nested"):
        JobDocument.of(map_job(body={"units": "m", "x": deep}))
    with pytest.raises(InvalidValueError, match="500000 values"):
        JobDocument.of(map_job(body={"points": [0.0] * 600_000}))


@pytest.mark.parametrize("path", LAUNCHED, ids=lambda path: path.stem)
def test_a_job_sent_as_json_is_the_job_of_the_file(path):
    """Every example goes through JSON and comes back as a job file with the same histories, told by their key."""
    job = JobDocument.of(json.loads(json.dumps(tomllib.loads(path.read_text()))))
    text = job.toml(lambda sha256: sha256)
    mine, theirs = Job.of_text(text).study.histories, Job.read(path).study.histories
    assert mine.key() == theirs.key()
    assert job.histories == theirs.count <= job.most


def test_records_become_paths_in_the_study(map_job):
    """Each record stands in the job file under the path that it has in the study."""
    job = JobDocument.of(map_job(motions=[{"records": [SHA], "units": "g"}, {"records": SHA}]))
    told = tomllib.loads(job.toml(lambda sha256: f"records/{sha256}/a.txt"))
    assert [table["records"] for table in told["motions"]] == [[f"records/{SHA}/a.txt"]] * 2
    assert job.records == [SHA]


def test_names_survive_the_job_file(map_job):
    """Quotes, line breaks and signs of TOML in words stay words."""
    name = 'a"b\\ \n[campaign]\nkind = "x" \x7f \u202e \U0001f600'
    job = JobDocument.of(map_job(campaign={"name": name, "kind": "overturning-map"}))
    assert tomllib.loads(job.toml(str))["campaign"]["name"] == name


MANY = {
    "restitutions": {"restitution": {"values": [k / 100 for k in range(65)]}},
    "states": {
        "campaign": {"name": "x", "kind": "stripes"}, "map": None,
        "fragility": {"levels": [1.0], "limit_states": [k / 100 for k in range(1, 22)]},
    },
    "motions": {
        "campaign": {"name": "x", "kind": "cloud"}, "map": None, "fragility": {},
        "motions": {"synthetic": "pulse-like", "count": 2001},
    },
    "blocks times restitutions": {
        "campaign": {"name": "x", "kind": "rocking-spectrum"}, "map": None, "body": None,
        "spectrum": {"slenderness_angles": [0.1, 0.2], "periods": {"from": 1, "to": 9, "count": 25_001}},
    },
    "bodies": {
        "campaign": {"name": "x", "kind": "histories"}, "map": None,
        "body": [{"units": "m", "width": 0.5, "height": 2.0}] * 1001,
    },
}  # fmt: skip


@pytest.mark.parametrize("what", MANY)
def test_what_takes_long_to_be_made_is_too_large(what, map_job):
    """Few histories may still be much work for the server: that is refused with the number."""
    with pytest.raises(TooLarge, match=f"the job has [0-9]+ {what}"):
        JobDocument.of(map_job(**MANY[what]))


def test_numbers_beyond_all_numbers_are_refused(map_job):
    """A whole number that no float64 holds is a refusal, not an accident."""
    with pytest.raises(InvalidValueError, match=r"settings\.gravity"):
        JobDocument.of(map_job(settings={"gravity": 10**400}))


def _section(regions):
    outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]
    return {"units": "m", "section": {"region": [{"outline": outline, "density": 1.0}] * regions}}


def test_a_body_is_as_small_as_elsewhere(map_job):
    """A study takes no body that the page of bodies refuses, nor many that are too large together."""
    JobDocument.of(map_job(body=_section(250)))
    with pytest.raises(TooLarge, match="250 regions, got 251"):
        JobDocument.of(map_job(body=_section(251)))
    points = {"points": [[0.0, 1.0]] * 10_001, "masses": [1.0] * 10_001, "feet": [0.0, 1.0]}
    with pytest.raises(TooLarge, match="points"):
        JobDocument.of(map_job(body={"units": "m", "mass_points": points}))
    many = {
        "campaign": {"name": "x", "kind": "histories"},
        "body": [_section(250)] * 5,
        "motions": {"pulse": "sine:amplitude=3,period=0.6"},
    }
    with pytest.raises(TooLarge, match="1250 regions of bodies"):
        JobDocument.of(many)


JOBS = [
    {
        "campaign": {"name": "m", "kind": "overturning-map", "seed": 1},
        "body": {"units": "m", "width": 0.5, "height": 2.0},
        "motions": [{"pulse": ["sine:amplitude=3,period=0.6"], "scale": 1.5}],
        "restitution": {"models": ["ked"], "values": [0.8]},
        "map": {"x": {"axis": "frequency_ratio", "from": 1, "to": 6, "count": 3},
                "y": {"axis": "pga", "values": [1, 2]}},
        "settings": {"gravity": 9.81, "linear": False, "engine": "auto"},
    },
    {
        "campaign": {"name": "s", "kind": "stripes"},
        "body": {"units": "cm", "section": {"region": [{"outline": [[0, 0], [50, 0], [25, 100]], "density": 2400}]}},
        "motions": {"pulse": ["sine:amplitude=1,period=0.6", "ricker:amplitude=1,period=0.5"]},
        "restitution": {"distribution": {"mean": 0.9, "deviation": 0.05, "each": "history"}},
        "fragility": {"im": "pga", "levels": [1.0, 2.0], "limit_states": [0.5]},
    },
    {
        "campaign": {"name": "r", "kind": "rocking-spectrum"},
        "motions": {"synthetic": "pulse-like", "count": 2, "pga": 4.0},
        "spectrum": {"slenderness_angles": [0.2], "periods": {"from": 1.5, "to": 3, "count": 2, "spacing": "log"}},
    },
]  # fmt: skip

ANYTHING = st.one_of(
    st.none(), st.booleans(), st.integers(-(10**20), 10**20), st.floats(), st.text(max_size=20),
    st.sampled_from(["ked", "pga", "mm", "cloud", "\ud800", "1e999", "sine:amplitude=1e300,period=1e-300"]),
    st.lists(st.integers(-3, 3), max_size=3), st.dictionaries(st.text(max_size=5), st.integers(), max_size=2),
    st.sampled_from([1e-300, 1e300, 5e-324, 1e-9, 1e9, 0, -1]),
)  # fmt: skip


def _places(value, path=()):
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inside:
        yield (*path, key)
        yield from _places(each, (*path, key))


PLACES = [(number, path) for number, job in enumerate(JOBS) for path in _places(job)]


def _refusal(manager, job):
    try:
        manager.create(None, job)
    except RockingError as error:
        return str(error)
    return ""


@settings(max_examples=250, deadline=None)
@given(st.sampled_from(PLACES), ANYTHING)
def test_anything_in_any_place_is_refused_or_launched(place, value):
    """What comes out is a study or a sentence of this package, without the path of a folder in it."""
    job = copy.deepcopy(JOBS[place[0]])
    *way, last = place[1]
    inside = job
    for key in way:
        inside = inside[key]
    inside[last] = value
    with tempfile.TemporaryDirectory() as folder:
        limits = Limits(histories=1000)
        manager = StudyManager(Path(folder), limits, RecordStore(Path(folder), limits), Runner(0), workers=1)
        refusal = _refusal(manager, job)
        assert folder not in refusal
        assert bool(refusal) != bool(list((Path(folder) / "studies").iterdir()))
        manager.close()


def test_the_jobs_themselves_are_launched(tmp_path):
    """What is mutated is no wreck to begin with, and every place of it was reached."""
    manager = StudyManager(tmp_path, Limits(), RecordStore(tmp_path, Limits()), Runner(0), workers=1)
    assert len({manager.create(None, job) for job in JOBS}) == 3
    assert len(PLACES) == sum(1 for job in JOBS for _ in itertools.islice(_places(job), 1000)) > 60
    manager.close()


@given(st.text())
def test_what_is_shown_is_one_line_that_hides_nothing(text):
    """Control characters, direction marks and halves of characters never reach a page."""
    made = shown(text)
    assert made == made.strip()
    assert 0 < len(made) <= 120
    assert not {unicodedata.category(mark) for mark in made} & {"Cc", "Cf", "Cs", "Co", "Cn"}


@pytest.mark.parametrize("text", ["", "..", "0" * 15, "0" * 17, "A" * 16, "g" * 16, "0" * 16 + "\n", "../" + "0" * 13])
def test_only_drawn_names_are_folders(text):
    """What is not sixteen hexadecimal digits is no study; what is drawn is."""
    assert not is_id(text)
    assert is_id(new_id())
