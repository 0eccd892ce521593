"""Facts of the library that the application shows: default restitution, measures, warnings, contours, old files."""

import json
import re
from pathlib import Path

import numpy as np
from web_clients import new_application, script_of

import rocking as rk
import rocking_workbench
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION
from rocking.motions import measures
from rocking.restitution.headline import label_of
from rocking.spec.questions import question_in
from rocking.spec.reading import tables_of
from rocking_workbench.api.body import described
from rocking_workbench.api.info import listed_measures
from rocking_workbench.inputs import Inputs
from rocking_workbench.studies.job_document import JobDocument
from rocking_workbench.studies.results import contours_of
from rocking_workbench.studies.study_folder import StudyFolder

DATA = Path(__file__).parents[3] / "tests" / "data"
OLD, NEW = DATA / "schema_1", DATA / "schema_2"


def test_requests_and_scripts_have_the_default_restitution():
    assert Inputs.model_fields["restitution"].default.models == [DEFAULT_RESTITUTION, *COMPARED_RESTITUTIONS]
    script = Path(rocking_workbench.__file__).parent / "static/app/inputs.js"
    models = re.search(r"DEFAULT_MODELS = (\[.*?\]);", script.read_text("utf-8"))
    assert json.loads(models[1]) == [DEFAULT_RESTITUTION, *COMPARED_RESTITUTIONS]
    form = script.parents[1].joinpath("views/space.js").read_text("utf-8")
    assert re.findall(r'\blaw: "(.*?)"', form) == [label_of(DEFAULT_RESTITUTION, in_space=True)]


def test_every_measure_is_listed():
    listed = {measure["name"]: measure for measure in listed_measures()}
    assert listed.keys() == measures().keys()
    assert listed["pga"]["unit"] == "m/s2"


def test_an_implausible_body_has_its_warning():
    assert "1000 m above the ground" in described(rk.Block(width=500.0, height=2000.0), 9.81, None)["warnings"][0]
    assert described(rk.Block(width=0.5, height=2.0), 9.81, None)["warnings"] == []


def test_a_long_run_study_needs_no_motions():
    tables = {"campaign": {"name": "a", "kind": "lyapunov"}, "body": {"units": "m", "width": 0.5, "height": 2.0}}
    document = JobDocument.of({**tables, "lyapunov": {"orbits": 3, "settled": 60, "kept": 20}})
    assert "motions" not in document.toml(str)
    assert document.histories == document.document.sizes[0] * document.document.sizes[1]


def test_lines_of_a_map_keep_away_from_what_has_no_result():
    """A row without results beside falls is no border between falling and standing."""
    inside = np.array([[True] * 4, [False] * 4, [False] * 4])
    grid = np.arange(4.0), np.arange(3.0)
    known = np.array([[True] * 4, [False] * 4, [True] * 4])
    assert contours_of(inside, *grid)
    assert contours_of(inside, *grid, is_known=known) == []


def test_a_project_of_schema_1_opens(tmp_path):
    """Inputs, forms and studies of a project file have the present keys, and its study is computed."""
    with script_of(new_application(tmp_path / "data")) as client:
        answer = client.post(
            "/api/projects/import", content=(OLD / "project.zip").read_bytes(),
            headers={"Content-Type": "application/octet-stream"},
        )  # fmt: skip
        assert answer.status_code == 201, answer.text
        document = answer.json()["document"]
    assert document["inputs"]["response"] == {"initial_rotation": 0.5, "assumed_friction": 0.6}
    form = document["forms"]["decide"]
    assert form["range"] == {"min_pga": "2", "max_pga": "9", "samples": "50", "bisections": "3"}


def test_a_study_of_schema_1_shows_present_keys():
    (path,) = (OLD / "application" / "studies").iterdir()
    assert question_in(StudyFolder(path).asked()) == question_in(tables_of((NEW / "stripes.toml").read_text("utf-8")))
