"""Errors and their hints as data: parameter, value, allowed values, places; the sentence is made of them."""

import ast
import math
import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from error_sources import family, finished_sentences, sources, taken_apart, without_facts

import rocking as rk
from rocking.errors import _EXTRAS, BodyFileError, InvalidValueError, RecordError, located
from rocking.messages import Amount, Index, Message, Option, Range, by_key

SOURCE = Path(rk.__file__).parent


def caught(call, *given, **more):
    with pytest.raises(rk.errors.RockingError) as stop:
        call(*given, **more)
    return stop.value


def test_a_value_out_of_range_is_known_by_its_parts():
    """Parameter, value, range and unit can be read without the sentence."""
    error = caught(rk.Block, width=-0.5, height=2.0)
    assert (error.parameter, error.value, error.unit) == ("width", -0.5, "m")
    assert error.value not in error.allowed
    assert 0.5 in error.allowed
    assert str(error) == "width must be > 0 m, got -0.5"


def test_tables_and_files_make_the_path(tmp_path):
    """A key of a file is named with its tables, in metres where the file is; pydantic's errors have the same form."""
    file = tmp_path / "pier.toml"
    file.write_text('units = "cm"\n[block]\nwidth = -50\nheight = 200\n', encoding="utf-8")
    error = caught(rk.read_body, file)
    assert (type(error), error.parameter, error.value, error.unit) == (BodyFileError, "block.width", -50, "cm")
    with pytest.raises(InvalidValueError) as stop, located("body"), located("pier.toml", "file"), located("block"):
        raise InvalidValueError(parameter="width", allowed=Range(0.0, math.inf, "m", low_open=True), value=0.0)
    assert stop.value.parameter == "body.block.width"
    assert str(stop.value) == "body: pier.toml: block: width must be > 0 m, got 0"
    # negative control: a file is no table
    assert "pier" not in stop.value.parameter


def test_each_door_spells_a_hint_in_its_own_way():
    """The option of a hint is data: Python, the command line and a form spell it."""
    error = RecordError(
        "the file does not state its unit", hint=Message("give {unit}", {"unit": Option("motion.units", "g")})
    )
    assert str(error) == 'the file does not state its unit; give units="g"'
    assert error.spelt(by_key) == "the file does not state its unit; give motion.units = g"
    assert (
        error.spelt(lambda option: f"--{option.name} {option.value}")
        == "the file does not state its unit; give --units g"
    )
    assert error.data()["hint"]["facts"]["unit"] == {"kind": "option", "path": "motion.units", "value": "g"}


def test_braces_of_a_value_stay():
    """What a user typed is no template."""
    error = InvalidValueError(parameter="name", allowed="text", value={"a": "{b}"})
    assert str(error) == "name must be text, got {'a': '{b}'}"
    assert str(RecordError("a {b} c")) == "a {b} c"


def test_errors_survive_another_process():
    """Pools of processes send errors as bytes, with all their parts."""
    error = RecordError("line of {count} numbers", count=3, hint="damaged?").at("a.txt", 7)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.places, again.facts) == (
        "a.txt, line 7: line of 3 numbers; damaged?",
        error.places,
        {"count": 3},
    )
    assert str(again.without_file("a.txt")) == "line 7: line of 3 numbers; damaged?"


def test_amounts_and_indices_are_data_too():
    """A page can say a length in the unit of its drawing and count regions from one."""
    overlap = caught(
        rk.Section,
        [rk.Region([(x, 0), (x + 1, 0), (x + 1, 1), (x, 1)], 2000.0) for x in (0.0, 0.5)],
    )
    assert (overlap.facts["first"], overlap.facts["second"]) == (Index(0), Index(1))
    assert overlap.facts["area"] == Amount(0.5, "m2", ".6g")


def test_data_of_any_number_is_json():
    """No fact breaks an answer: what is not finite has no number in JSON, and a whole number may be of any size."""
    facts = {"x": Amount(math.nan, "m"), "count": 10**400, "ratio": math.inf}
    data = RecordError("{x}, {count}, {ratio}", **facts).data()["facts"]
    assert (data["x"]["value"], data["count"], data["ratio"]) == (None, 10**400, "inf")


def test_value_and_limits_are_data():
    """A number stays at full precision, and the ends of a range are numbers; a value of another kind is a text."""
    length = Range(0.0, math.inf, "m", low_open=True)
    data = InvalidValueError(parameter="width", value=np.float64(-1 / 3), allowed=length).data()
    assert (data["value"], data["unit"]) == (-1 / 3, "m")
    assert data["allowed"] == {"sentence": "> 0 m", "low": 0.0, "high": None, "low_open": True, "high_open": False}
    data = caught(rk.Block, width="x" * 1000, height=2.0).data()
    assert (data["value"], data["allowed"], data["unit"]) == ("x" * 500, {"sentence": "a number [m]"}, "m")
    assert [InvalidValueError(value=value).data()["value"] for value in (True, None, math.nan, [0.5])] == [
        True, None, "nan", "[0.5]",
    ]  # fmt: skip
    assert RecordError("there is no such file").data()["allowed"] is None
    assert list(InvalidValueError("{parameter} is missing", parameter="width").data()["facts"]) == ["parameter"]


# texts of other libraries, or of processes, which have no parts
OTHERS = {
    "rocking/tables/arrays.py", "rocking/spec/reading.py", "rocking/motions/formats/obspy_reader.py",
    "rocking/motions/formats/foreign_worker.py", "rocking/motions/formats/reader.py",
    "rocking/bodies/formats/geojson.py", "rocking/identification/readers/reader.py",
    "rocking/bodies/formats/body_file.py", "rocking/bodies/formats/wkt.py",
    "rocking/evidence/measurement_file.py", "rocking/bodies/formats/words.py",
}  # fmt: skip


def test_no_sentence_of_an_error_is_read_back():
    """Whoever needs a fact of an error takes the fact: nothing splits, searches or compares its sentence."""
    assert {name for name, text in sources(SOURCE) if taken_apart(text)} <= OTHERS
    # negative control
    assert taken_apart('prefix = str(error).removeprefix("a: ")')


def test_every_template_has_its_facts():
    """A field in the text of an error is one of its facts."""
    assert {name: lines for name, text in sources(SOURCE) if (lines := without_facts(ast.parse(text)))} == {}
    # negative control
    assert without_facts(ast.parse('RecordError("{count} samples", number=3)')) == [1]


def test_errors_are_made_of_facts():
    """A value is a fact of the error, or the refused value: no sentence has it alone."""
    names = family()
    made = {name: finished_sentences(ast.parse(text), names) for name, text in sources(SOURCE)}
    assert {name: lines for name, lines in made.items() if lines} == {}
    # negative control
    assert finished_sentences(ast.parse('raise RecordError(f"{count} samples")'), names) == [1]


ROOT = Path(__file__).parents[2]
MAP = "map --width 1 --height 4 sine:amplitude=3,period=0.8 --x pga=0.1g:1g:3 --y width=1,2"
BLOCKED = "import sys; sys.modules[sys.argv[1]] = None; from rocking.cli import main; main(sys.argv[2:])"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("missing", "command", "wanted"),
    [
        ("xarray", f"{MAP} --output map.nc", "xarray"),
        ("matplotlib", f"{MAP} --output map.png", "matplotlib"),
        ("h5netcdf", f"{MAP} --output map.nc", '"rocking[netcdf]"'),
    ],
)
def test_the_missing_package_is_named(missing, command, wanted, tmp_path):
    """In a process that cannot import a package, the command names that one, and what to type."""
    words = [sys.executable, "-c", BLOCKED, missing, *command.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 2
    assert f" needs {missing}: pip install {wanted}\n" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_a_map_prints_without_the_packages_of_files(tmp_path):
    """Labelled arrays are made only when they are written or returned."""
    words = [sys.executable, "-c", BLOCKED, "xarray", *MAP.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True)
    assert "Lowest overturning" in done.stdout


def extras():
    """Extras of the project, with what each installs."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]


def test_extras_exist():
    """Every extra that a hint names is one of the project's and has the package."""
    for package, extra in _EXTRAS.items():
        name = {"cv2": "opencv-python-headless"}.get(package, package)
        assert any(re.match(rf"{name}\b", line) for line in extras()[extra]), package


def bare_extras(text):
    """Extras that a text tells to install without quotes, which some shells take for a pattern of file names."""
    return re.findall(r"pip install (?:-\S+ )*(?![\"'])[\w.]+\[\w+\]", text)


def test_every_hint_quotes_its_extra():
    """Sentences and pages with an extra to install have it in quotes, and only one function makes such sentences."""
    assert bare_extras("pip install rocking[dask]") == ["pip install rocking[dask]"]
    assert bare_extras('pip install "rocking[dask]"') == []
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]
    for path in [*pages, *(ROOT / "src").rglob("*.py"), *(ROOT / "src").rglob("*.js")]:
        text = path.read_text(encoding="utf-8")
        assert not bare_extras(text), path
        for named in re.findall(r"pip install \S*\brocking\[(\w+)\]", text):
            assert named in extras(), (path, named)
        assert "src" not in path.parts or "pip install" not in text or path.name == "errors.py", path
