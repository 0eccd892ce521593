"""Inputs as a file and as a command, TOML and names of our own, and archives that somebody sent."""

import hashlib
import io
import json
import shlex
import string
import struct
import tomllib
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner
from web_clients import new_application, script_of

from rocking.cli.application import application
from rocking.errors import InvalidValueError
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.reading import InputFiles, checked, tables_of
from rocking.spec.response import response_problem
from rocking.tables import escaped
from rocking_workbench.downloads.archive import Archive
from rocking_workbench.downloads.inputs_file import commands, fingerprint, inputs_as_toml, inputs_from_toml
from rocking_workbench.errors import Refused
from rocking_workbench.inputs import Inputs
from rocking_workbench.plain_text import plain_line, record_file_name, toml_of, toml_value

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
        # requests and files that hold a NUL are refused as a whole
        "file_name": st.text(
            st.characters(exclude_categories=["Cs"], exclude_characters="\0"), min_size=1, max_size=60
        ),
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
        "response": st.fixed_dictionaries(
            {}, optional={"initial_rotation": st.floats(-1.0, 1.0), "assumed_friction": POSITIVE}
        ),
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
    text = inputs_as_toml(Inputs.model_validate(EXAMPLE))
    question = response_problem(checked(ResponseDocument, tables_of(text)), InputFiles(tmp_path))
    assert (question.body.width, question.body.height) == (0.5, 2.0)
    assert (question.scale, question.assumed_friction) == (1.05, 0.4)
    assert list(question.restitutions) == ["ked", "housner"]


def test_the_words_are_one_line_of_a_shell():
    """The command can be split by a shell into its options, also where a name has quotes and spaces."""
    words = commands(Inputs.model_validate(EXAMPLE))
    assert words[0] == "rocking simulate response.toml"
    assert shlex.split(words[1]) == [
        "rocking", "simulate", "--width", "50.0", "--height", "200.0", "--units", "cm",
        "--motion", "sine:amplitude=3,period=0.8", "--scale", "1.05",
        "--set", "response.assumed_friction=0.4", "--restitution", "ked",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "change",
    [
        {"motion": {"synthetic": "pulse-like"}},
        {"restitution": {"left": 0.9, "right": 0.8}},
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
        ("a = ", "TOML is not readable"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = nan", "height"),
        ("[bodies]\nunits = 'm'", "unknown table"),
        ("[body]\nfile = '/etc/passwd'", "upload"),
        ("[body]\nunits = 'm'\nwidth = 1.0\nheight = 2.0\n[motion]\nrecord = '../../x.AT2'", "not stored here"),
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


def test_an_initial_rotation_in_degrees_becomes_a_fraction():
    """The page has a slider for the fraction of the slenderness angle, atan(b / h) of a block."""
    text = "[body]\nunits = 'm'\nwidth = 1.0\nheight = 4.0\n[response]\ninitial_rotation = '{}'"
    for word, degrees in (("5deg", 5.0), ("-0.1rad", -np.degrees(0.1))):
        inputs = inputs_from_toml(text.format(word), known)
        expected = degrees / np.degrees(np.arctan(1.0 / 4.0))
        assert inputs.response.initial_rotation == pytest.approx(expected, rel=1e-12)
        assert inputs_from_toml(inputs_as_toml(inputs), known) == inputs


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
        {"motion": None, "response": {"initial_rotation": -0.7}},
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
        # of other models too, of which the file names its own
        del answer["other_models"], answer["units"], answer["messages"]
    assert said[0] == said[1]
    assert said[0]["peak_rotation"] > 0.0


OCTETS = {"Content-Type": "application/octet-stream"}
BODY = {"units": "cm", "width": 50.0, "height": 200.0}
WAVE = 4.0 * np.sin(2.0 * np.pi * np.arange(300) * 0.01)
COLUMN = "\n".join(f"{k * 0.01:.2f} {a:.6f}" for k, a in enumerate(WAVE)).encode()
TOML = '[response]\n[body]\nunits = "cm"\nwidth = 50\nheight = 200\n[motion]\nrecord = "wave.txt"\nunits = "m/s2"\n'


def packed(files, kind=zipfile.ZIP_DEFLATED):
    """Return an archive of files, given as pairs."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", kind) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return stream.getvalue()


def read(client, data):
    """Answer to a file of inputs."""
    return client.post("/api/inputs/read", content=data, headers=OCTETS)


@pytest.fixture
def other(tmp_path):
    """Return a script of another server, which has no record yet."""
    with script_of(new_application(tmp_path / "other", {"upload_bytes": 200_000})) as asking:
        yield asking


def test_a_bundle_gives_the_same_answer_on_another_server(client, other):
    """What one server packs another unpacks: inputs, record and response are the same to the last digit."""
    made = client.post("/api/records?name=my%20wave.txt", content=COLUMN, headers=OCTETS).json()
    motion = {"record": made["record"], "file_name": made["file_name"], "units": "m/s2", "scale": 1.1}
    inputs = {"body": BODY, "motion": motion, "restitution": {"models": ["ked"]}}
    bundle = client.post("/api/inputs.zip", json=inputs).content
    again = read(other, bundle)
    assert again.status_code == 200
    assert again.json()["motion"] == motion
    assert [one["record"] for one in other.get("/api/records").json()] == [hashlib.sha256(COLUMN).hexdigest()]
    first, second = (one.post("/api/response", json=again.json()).json() for one in (client, other))
    assert first["answers"] == second["answers"]
    bare = client.post("/api/inputs.toml", json=inputs).content
    other.delete(f"/api/records/{made['record']}")
    assert read(other, bare).status_code == 422  # the negative control: without its record it cannot be read


def test_a_bundle_without_a_record(client, other):
    """A pulse needs no record: the TOML of the archive is read."""
    inputs = {"body": BODY, "motion": {"pulse": "sine:amplitude=3,period=0.8"}}
    answer = read(other, client.post("/api/inputs.zip", json=inputs).content)
    assert answer.json()["motion"] == inputs["motion"]
    assert other.get("/api/records").json() == []


def test_an_archive_packed_by_hand(other):
    """The files of the archive, packed again by any program, are read; the record of the archive is the one meant."""
    other.post("/api/records?name=wave.txt", content=COLUMN + b"\n3.00 0.0", headers=OCTETS)
    answer = read(other, packed([("wave.txt", COLUMN), ("inputs.toml", "\ufeff" + TOML)], zipfile.ZIP_STORED))
    assert answer.status_code == 200
    assert answer.json()["motion"]["record"] == hashlib.sha256(COLUMN).hexdigest()


def _encrypted():
    data = bytearray(packed([("response.toml", TOML)]))
    data[6] |= 1
    data[data.find(b"PK\x01\x02") + 8] |= 1
    return bytes(data)


def _damaged():
    data = bytearray(packed([("response.toml", TOML), ("wave.txt", COLUMN)], zipfile.ZIP_STORED))
    data[data.find(COLUMN) + 100] ^= 1
    return bytes(data)


def _lying():
    """A bomb that says it is small: 50 MB behind a stated size of 100 bytes."""
    data = bytearray(packed([("response.toml", TOML), ("wave.txt", b"0 0\n" * 12_500_000)]))
    for mark, place in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        start = data.rfind(mark)
        struct.pack_into("<I", data, start + place, 100)
    return bytes(data)


def _cut_by_nul():
    return packed([("response.toml", TOML), ("wave.txtX/../x", COLUMN)]).replace(b"wave.txtX", b"wave.txt\0")


MANY = packed([(f"{k}.txt", "x") for k in range(9)])
HOSTILE = {
    "goes up": (packed([("response.toml", TOML), ("../wave.txt", COLUMN)]), 422, "folders are not allowed"),
    "absolute": (packed([("/etc/response.toml", TOML)]), 422, "folders are not allowed"),
    "a drive": (packed([("C:response.toml", TOML)]), 422, "folders are not allowed"),
    "back slashes": (packed([("..\\response.toml", TOML)]), 422, "folders are not allowed"),
    "a folder": (packed([("a/", b""), ("a/response.toml", TOML)]), 422, "folders are not allowed"),
    "a name cut by NUL": (_cut_by_nul(), 422, "folders are not allowed"),
    "a bomb": (packed([("response.toml", TOML), ("wave.txt", b"0 0\n" * 12_500_000)]), 413, "more than"),
    "a bomb that lies": (_lying(), 422, "damaged"),
    "a TOML bomb": (packed([("response.toml", b"#" * 50_000_000)]), 413, "more than"),
    "nine files": (MANY, 413, "up to 8 files, got 9"),
    "thousands of entries": (packed([(f"{k}", "") for k in range(1500)]), 413, "up to 8 files"),
    "encrypted": (_encrypted(), 422, "encrypted"),
    "another packing": (packed([("response.toml", TOML)], zipfile.ZIP_LZMA), 422, "unsupported compression"),
    "damaged": (_damaged(), 422, "damaged"),
    "cut off": (packed([("response.toml", TOML)])[:-30], 422, "ZIP archive is not readable"),
    "only its first bytes": (b"PK\x03\x04", 422, "ZIP archive is not readable"),
    "empty": (packed([]), 422, "one TOML input file, got 0"),
    "two inputs": (packed([("a.toml", TOML), ("b.toml", TOML)]), 422, "got 2"),
    "no text": (packed([("response.toml", b"\xff\xfe")]), 422, "UTF-8"),
    "no record": (packed([("response.toml", TOML)]), 422, "is not stored here"),
    "a record that is none": (packed([("response.toml", TOML), ("wave.txt", b"hello")]), 422, "unknown format"),
    "an infinite record": (packed([("response.toml", TOML), ("wave.txt", b"0 0\n0.01 1e308")]), 422, "within 1e+06"),
    "an empty record": (packed([("response.toml", TOML), ("wave.txt", b" ")]), 422, "empty"),
    "bad inputs": (packed([("response.toml", TOML + "furlong = 1\n"), ("wave.txt", COLUMN)]), 422, "furlong"),
    "it names itself": (packed([("a.toml", TOML.replace("wave.txt", "a.toml"))]), 422, "unknown format"),
    "the host's file": (packed([("a.toml", TOML.replace("wave.txt", "/etc/passwd"))]), 422, "not stored here"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_archive_is_refused_and_nothing_is_kept(other, name):
    """Paths, bombs, damage and what is no motion are refused in words, with nothing written."""
    data, status, words = HOSTILE[name]
    answer = read(other, data)
    assert answer.status_code == status, answer.text
    assert words in answer.json()["error"]["message"]
    assert other.get("/api/records").json() == []


def test_two_files_of_one_name_are_refused():
    """Which of them would be meant is not guessed."""
    with pytest.warns(UserWarning, match="Duplicate name"):
        data = packed([("response.toml", TOML), ("response.toml", TOML)])
    with pytest.raises(Refused, match="two files with the same name"):
        Archive(data)


ALLOWED = set(string.ascii_letters + string.digits + "._-")
FORMULAS = ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", " =1", "\u202e=1", "\x00=1", "\uff1d1", "\uff0b1"]


@given(st.text(max_size=300))
def test_lines_are_printable_and_bounded(text):
    """Whatever comes in, one printable line of bounded length comes out, and doing it twice changes nothing."""
    line = plain_line(text)
    assert line.isprintable()
    assert len(line) <= 160
    assert plain_line(line) == line


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas_become_text(text):
    """What a spreadsheet would compute gets an apostrophe, also behind white space and invisible marks."""
    assert escaped(plain_line(text)).startswith("'")


@pytest.mark.parametrize("text", ["Vase 3", "3-1", "a=b", "'quoted", "(-1)", ""])
def test_other_text_stays(text):
    """Text that starts no formula is not touched: the negative control of the rule above."""
    assert escaped(plain_line(text)) == text


STRANGE = [
    "../../etc/passwd",
    "..",
    "",
    "a/b\\c",
    "CON",
    "nul.txt",
    "x" * 5000,
    "*?[ab]",
    "-rf",
    "\ud800",
    ".hidden",
    "a:b",
]


def check_file_name(name):
    safe = record_file_name(name)
    assert safe
    assert set(safe) <= ALLOWED
    assert not safe.startswith((".", "-"))
    assert len(safe) <= 82
    assert safe.lower() not in {"response.toml", "readme.txt"}
    assert safe.partition(".")[0].lower() not in {"con", "nul", "aux", "prn", "lpt1"}


@given(st.text(max_size=300))
def test_file_names_are_harmless(name):
    """Any name becomes letters, digits, dots, dashes and underscores: no folder, not hidden, not reserved, bounded."""
    check_file_name(name)


@pytest.mark.parametrize(
    "name", [*STRANGE, "a\x00b", "a\u202etxt.exe", "'; DROP TABLE", "~root", "%2e%2e%2f", "LPT1.AT2"]
)
def test_names_that_somebody_might_try_are_harmless(name):
    """The same of names that lead out of a folder, hide, or are reserved somewhere."""
    check_file_name(name)


def test_ordinary_file_names_stay():
    """A usual name of a record keeps every character, its ending in particular."""
    for name in ("RSN1106_KOBE_KJM000.AT2", "x.smc", "IWT0101103111446.EW", "record-1.csv"):
        assert record_file_name(name) == name


WORDS = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(2**63), 2**63 - 1)
FLAT = st.booleans() | NUMBERS | WORDS | st.lists(NUMBERS, max_size=30) | st.lists(st.lists(NUMBERS, max_size=3))
TABLES = st.recursive(
    st.dictionaries(WORDS, FLAT, max_size=4),
    lambda inner: st.dictionaries(WORDS, FLAT | inner | st.lists(inner, min_size=1, max_size=3), max_size=4),
    max_leaves=8,
)


@given(TABLES)
def test_what_is_written_is_read(document):
    """Keys and text with any character, numbers to the last digit, tables in tables and lists of tables survive."""
    read = tomllib.loads(toml_of(document))
    assert read == document
    assert repr(read) == repr(document) or sorted(read) == sorted(document)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_keep_every_digit(number):
    """A float comes back with the same bits, the sign of zero included."""
    read = tomllib.loads(f"x = {toml_value(number)}")["x"]
    assert isinstance(read, float)
    assert read.hex() == number.hex()


def test_text_cannot_leave_its_quotes():
    """A name that looks like TOML stays a name, and what cannot be seen is spelled out."""
    name = 'x"\n[restitution]\nvalue = 0.1\n#\u202e\x7f'
    text = toml_of({"body": {"name": name}})
    assert tomllib.loads(text) == {"body": {"name": name}}
    assert text.count("\n") == 2
    assert "\u202e" not in text


def test_what_toml_does_not_know_is_refused():
    """A value of another kind is refused with its name."""
    with pytest.raises(InvalidValueError, match="object"):
        toml_value(object())
