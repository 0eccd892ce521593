"""The document of one response: what it says becomes the question, and slips are refused by name."""

import json
import math

import numpy as np
import pytest

import rocking as rk
from rocking import examples
from rocking.errors import InvalidValueError, RockingError, located
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.reading import InputFiles, checked, read_text, tables_in, tables_of
from rocking.spec.response import ResponseProblem, response_problem

EXAMPLES = [
    path
    for path in sorted(examples.path("statue-released").parent.glob("*.toml"))
    if "[measurement]" not in path.read_text("utf-8")  # asked by `rocking identify`
]
BODY = '[body]\nunits = "cm"\nwidth = 50\nheight = 200\n'
TEXT = f'[response]\nassumed_friction = 0.4\n{BODY}[motion]\npulse = "sine:amplitude=3,period=0.8"\nscale = 1.2\n'


def problem_of(text, folder, files=None):
    return response_problem(checked(ResponseDocument, tables_of(text)), files or InputFiles(folder))


def problem_in(path):
    with located(str(path), "file"):
        return problem_of(read_text(path), path.parent)


def test_tables_become_the_question(tmp_path):
    """Body, motion, factor, friction, restitutions in their order, and settings are those of the file."""
    text = TEXT + '[restitution]\nmodels = ["housner"]\nvalues = [0.9]\n[settings]\ngravity = 9.81\nengine = "fast"\n'
    question = problem_of(text, tmp_path)
    assert question.body == rk.Block(width=0.5, height=2.0)
    assert (question.scale, question.assumed_friction, question.engine) == (1.2, 0.4, "fast")
    assert list(question.restitutions) == ["housner", "0.9"]
    assert question.settings.gravity == 9.81
    assert question.motion.peak == 3.0


def test_a_record_lies_beside_the_file(tmp_path):
    """A record is named relative to the file; its hash is noted; options for reading are taken."""
    (tmp_path / "a.txt").write_text("\n".join(f"{k * 0.01:.2f} {math.sin(k):.3f}" for k in range(50)))
    files = InputFiles(tmp_path)
    problem = problem_of(f'[response]\n{BODY}[motion]\nrecord = "a.txt"\nunits = "g"\n', tmp_path, files)
    assert np.array_equal(problem.motion.acceleration, rk.read_motion(tmp_path / "a.txt", units="g").acceleration)
    assert [item["path"] for item in files.facts()] == ["a.txt"]


def test_free_rocking_starts_at_a_share_of_the_slenderness_angle():
    """A share below zero leans to the left, over the angle of the left side."""
    question = ResponseProblem(rk.Block(width=1.0, height=4.0), None, initial_rotation=-0.5)
    assert math.isclose(question.rotation, -0.5 * math.atan(0.25))
    assert question.answer(0.9).rotation[0] == question.rotation


@pytest.mark.parametrize("given", [{"motion": None}, {"motion": rk.pulses.sine(1.0, 1.0), "initial_rotation": 0.5}])
def test_a_question_has_one_start(given):
    """Neither or both of a motion and a first rotation are no question."""
    with pytest.raises(InvalidValueError, match="motion"):
        ResponseProblem(rk.Block(width=1.0, height=4.0), **given)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run_as_they_say(path, run):
    """Every example is recognised, answered, and prints JSON with the restitutions that it lists."""
    question = problem_in(path)
    printed = json.loads(run("simulate", path, "--json")[1])
    assert [*printed["other_models"]] == [*question.restitutions][1:]
    first = question.answer(next(iter(question.restitutions.values())))
    assert printed["peak_rotation"] == first.peak_rotation


def test_the_example_of_a_decision_shows_one():
    """Under the pulse of the example KED overturns and Housner stands: two models, two verdicts."""
    question = problem_in(next(path for path in EXAMPLES if "pulse" in path.stem))
    outcomes = [question.answer(choice).outcome.name for choice in ("ked", "housner")]
    assert outcomes == ["OVERTURNED", "ROCKED"]


def test_a_body_file_is_not_a_response(tmp_path):
    """A body file, a record, a broken file and a missing one are something else."""
    for name, text in {"body.toml": BODY, "a.txt": TEXT, "broken.toml": "[response", "nul.toml": "\x00"}.items():
        (tmp_path / name).write_text(text)
        assert "response" not in (tables_in(tmp_path / name) or ())
    assert tables_in(tmp_path / "none.toml") is None


REFUSED = {
    "unknown table": (TEXT + "[friction]\n", "friction"),
    "unknown key": (TEXT.replace("scale", "scle"), "did you mean scale?"),
    "no body": ("[response]\ninitial_rotation = 0.5\n", "body is missing"),
    "nothing moves": (f"[response]\n{BODY}", "No ground motion"),
    "both": (TEXT.replace("assumed_friction = 0.4", "initial_rotation = 0.5"), "not both"),
    "two sources": (TEXT + 'record = "a.at2"\n', "exactly one of pulse, record, synthetic"),
    "pulse with units": (TEXT + 'units = "g"\n', "units is not allowed with pulse"),
    "zero": (TEXT.replace("1.2", "0.0"), "scale must not be 0"),
    "nan": (TEXT.replace("1.2", "nan"), "must be a finite number"),
    "body": (TEXT.replace("width = 50", "width = -50"), "body: block.width must be a number > 0"),
    "record": (TEXT.replace('pulse = "sine:amplitude=3,period=0.8"', 'record = "a.at2"'), "motion: a.at2"),
    "pulse": (TEXT.replace("sine:", "sinus:"), "motion: unknown pulse 'sinus'"),
    "two levels": (
        f'[response]\n{BODY}[motion]\nsynthetic = "pulse-like"\npga = 1.0\npgv = 1.0\n',
        "Use pga or pgv, not both",
    ),
    "model": (TEXT + '[restitution]\nmodel = "best"\n', "unknown restitution model 'best'"),
    "drawn per history": (
        TEXT + '[restitution.distribution]\nmean = 0.9\ndeviation = 0.01\neach = "history"\n',
        'must be "impact" for one history',
    ),
    "settings": (TEXT + "[settings]\norder = 5\n", "settings: order must be one of"),
    "not TOML": ("[response\n", "Invalid TOML"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_slips_are_refused_by_name(case, tmp_path):
    """Each refusal names the file and the key, and says what is allowed."""
    text, words = REFUSED[case]
    path = tmp_path / "question.toml"
    path.write_text(text)
    with pytest.raises(RockingError) as refused:
        problem_in(path)
    assert words in str(refused.value)
    assert str(refused.value).startswith(str(path))
