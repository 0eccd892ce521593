"""Inputs as a file of the command line, and back: the identity, and the same question."""

import json
import shlex
import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from rocking.app.errors import Refused
from rocking.app.schemas.inputs import Inputs
from rocking.app.takeaway.inputs_file import commands, fingerprint, inputs_as_toml, inputs_from_toml
from rocking.cli.application import application
from rocking.spec.response import ResponseJob

HASH = "ab" * 32
POSITIVE = st.floats(1e-3, 1e3)
TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)
BLOCK = st.fixed_dictionaries(
    {"units": st.sampled_from(["m", "cm", "mm", "ft", "in"]), "width": POSITIVE, "height": POSITIVE},
    optional={"depth": POSITIVE, "density": POSITIVE, "name": TEXT},
)
SECTION = st.fixed_dictionaries(
    {
        "units": st.just("m"),
        "section": st.fixed_dictionaries(
            {
                "region": st.lists(
                    st.fixed_dictionaries(
                        {"outline": st.lists(st.lists(POSITIVE, min_size=2, max_size=2), min_size=3, max_size=9)},
                        optional={"density": POSITIVE},
                    ),
                    min_size=1,
                    max_size=3,
                )
            },
            optional={"depth": POSITIVE},
        ),
    }
)
PULSE = st.fixed_dictionaries({"pulse": st.just("sine:amplitude=3,period=0.8")}, optional={"scale": POSITIVE})
RECORD = st.fixed_dictionaries(
    {"record": st.just(HASH)},
    optional={
        "file_name": st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=60),
        "time_step": POSITIVE,
        "units": st.sampled_from(["g", "m/s2"]),
        "scale": POSITIVE,
    },
)
SYNTHETIC = st.fixed_dictionaries(
    {"synthetic": st.just("pulse-like")}, optional={"seed": st.integers(0, 2**63 - 1), "pga": POSITIVE}
)
RESTITUTION = st.one_of(
    st.fixed_dictionaries({"models": st.lists(st.sampled_from(["ked", "housner"]), min_size=1, max_size=2)}),
    st.fixed_dictionaries({"values": st.lists(st.floats(0.0, 1.0), min_size=1, max_size=3)}),
    st.fixed_dictionaries({"left": st.floats(0.0, 1.0), "right": st.floats(0.0, 1.0)}),
)
DOCUMENTS = st.fixed_dictionaries(
    {"body": BLOCK | SECTION},
    optional={
        "motion": PULSE | RECORD | SYNTHETIC | st.none(),
        "restitution": RESTITUTION,
        "response": st.fixed_dictionaries({}, optional={"free": st.floats(-1.0, 1.0), "assumed_friction": POSITIVE}),
        "settings": st.fixed_dictionaries({}, optional={"gravity": POSITIVE, "linear": st.booleans()}),
    },
)
EXAMPLE = {
    "body": {"units": "cm", "width": 50, "height": 200, "name": "Vase"},
    "motion": {"pulse": "sine:amplitude=3,period=0.8", "scale": 1.05},
    "restitution": {"models": ["ked", "housner"]},
    "response": {"assumed_friction": 0.4},
}


def known(word):
    """Find the one record that was uploaded."""
    return HASH if word == HASH else None


@settings(max_examples=150, deadline=None)
@given(DOCUMENTS)
def test_writing_and_reading_is_the_identity(document):
    """Inputs written and read are the same inputs, whatever they hold, with the same fingerprint."""
    inputs = Inputs.model_validate(document)
    read = inputs_from_toml(inputs_as_toml(inputs), known)
    assert read.model_dump() == inputs.model_dump()
    assert fingerprint(read) == fingerprint(inputs)


def test_another_digit_is_another_document():
    """The identity has teeth: the last digit of one number changes file and fingerprint."""
    one, two = ({**EXAMPLE, "response": {"assumed_friction": each}} for each in (0.4, 0.4000000000000001))
    first, second = Inputs.model_validate(one), Inputs.model_validate(two)
    assert inputs_as_toml(first) != inputs_as_toml(second)
    assert fingerprint(first) != fingerprint(second)


def test_the_command_line_reads_the_file(tmp_path):
    """`rocking simulate` reads what is written: same body, motion, scale, restitutions and friction."""
    path = tmp_path / "response.toml"
    path.write_text(inputs_as_toml(Inputs.model_validate(EXAMPLE)), encoding="utf-8")
    question = ResponseJob.read(path).problem
    assert (question.body.width, question.body.height) == (0.5, 2.0)
    assert (question.scale, question.assumed_friction) == (1.05, 0.4)
    assert list(question.restitutions) == ["ked", "housner"]


def test_the_words_are_one_line_of_a_shell():
    """The command can be split by a shell into its options, also where a name has quotes and spaces."""
    words = commands(Inputs.model_validate(EXAMPLE))
    assert words[0] == "rocking simulate response.toml"
    assert shlex.split(words[1]) == [
        "rocking", "simulate", "--width", "50.0", "--height", "200.0", "--units", "cm",
        "--motion", "sine:amplitude=3,period=0.8", "--scale", "1.05", "--friction", "0.4", "--restitution", "ked",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "change",
    [
        {"motion": {"synthetic": "pulse-like"}},
        {"restitution": {"left": 0.9, "right": 0.8}},
        {"settings": {"order": 8}},
        {"body": {"units": "m", "trapezoid": {"base": 1.0, "top": 0.5, "height": 2.0}}},
    ],
)
def test_what_words_cannot_say_is_left_to_the_file(change):
    """Where options of the command line do not exist, only the file is offered."""
    assert commands(Inputs.model_validate({**EXAMPLE, **change})) == ["rocking simulate response.toml"]


def test_a_record_is_named_beside_the_file():
    """On disk a record is a harmless name, and its hash stands in a comment of one line."""
    motion = {"record": HASH, "file_name": '../"x"\n[settings]\ngravity = 1.AT2'}
    text = inputs_as_toml(Inputs.model_validate({**EXAMPLE, "motion": motion}))
    assert tomllib.loads(text)["motion"] == {"record": "x_settings_gravity_1.AT2"}
    assert "settings" not in tomllib.loads(text)
    assert f"# record: {HASH} " in text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a = ", "not TOML"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = nan", "height"),
        ("[bodies]\nunits = 'm'", "no table"),
        ("[body]\nfile = '/etc/passwd'", "upload"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n[motion]\nrecord = '../../x.AT2'", "not uploaded"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n[motion]\nrecord = 3", "record"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n[settings]\nworkers = 3", "workers"),
        ("[body]\nunits = 'm'\n[[body.section.region]]\ndxf = '/etc/passwd'", "upload"),
        ("x = " + "[" * 2000, "TOML"),
        ("x = " + "9" * 5000, "TOML"),
        ("restitution = 3\n[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0", "restitution"),
    ],
)
def test_files_that_say_something_else_are_refused(text, words):
    """What is no file of inputs is refused in one sentence that names the cause."""
    with pytest.raises(Refused, match=words) as found:
        inputs_from_toml(text, known)
    assert "\n" not in str(found.value)


def test_a_record_may_be_given_by_hash_or_name():
    """A person may name an uploaded record by its hash or its file."""
    text = "[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n[motion]\nrecord = '{}'"
    assert inputs_from_toml(text.format(HASH), known).motion.record == HASH
    found = inputs_from_toml(text.format("x.AT2"), lambda word: HASH if word == "x.AT2" else None)
    assert (found.motion.record, found.motion.file_name) == (HASH, "x.AT2")


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"body": {"units": "mm", "width": 333.3, "height": 1234.5, "density": 777.7}},
        {"motion": None, "response": {"free": -0.7}},
        {"motion": {"pulse": "ricker:amplitude=2.9,period=1.1", "scale": -1.1}, "restitution": {"value": 0.91}},
        {"settings": {"gravity": 9.79, "linear": True, "engine": "reference"}},
    ],
)
def test_the_words_give_the_numbers_of_the_file(change, tmp_path, monkeypatch):
    """The command in words prints the same response as the command with the file, every number equal."""
    inputs = Inputs.model_validate({**EXAMPLE, "response": {}, **change})
    (tmp_path / "response.toml").write_text(inputs_as_toml(inputs), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    said = []
    for command in commands(inputs):
        done = CliRunner().invoke(application(), [*shlex.split(command)[1:], "--json"])
        assert done.exit_code == 0, done.output
        said.append(json.loads(done.stdout))
    assert len(said) == 2
    for answer in said:
        del answer["other_models"]  # the file names its own
    assert said[0] == said[1]
    assert said[0]["peak_rotation_rad"] > 0.0
