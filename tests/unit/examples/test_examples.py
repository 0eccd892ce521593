"""The table of examples: what it promises is there, and every body and motion is what it says."""

import dataclasses
import math
import re
import tomllib

import numpy as np
import pytest
import shapely

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.examples import table
from rocking.motions import GroundMotion, measures, spectral_acceleration
from rocking.motions.formats import read_record
from rocking.restitution.space import edge_coefficient, spatial_models

ALL = rk.examples.catalogue()
BODIES, MOTIONS = (list(rk.examples.catalogue(kind)) for kind in ("body", "motion"))
PLANE = [name for name in BODIES if not isinstance(rk.examples.body(name), rk.Solid)]
SCALED = {"far-field": 0.35, "long": 0.35, "soft-soil": 0.35, "pulse": 0.5}
"""Peak ground accelerations that titles state [g]."""


def parts(name, **seed):
    """The motions of an example by axis; of a single one under an empty name."""
    made = rk.examples.motion(name, **seed)
    return made if isinstance(made, dict) else {"acceleration": made}


def test_every_file_has_its_entry_and_every_entry_its_files():
    """Nothing lies beside the table, nothing in it is missing; a file is called as its example."""
    named = {file for each in ALL.values() for file in each.files}
    there = {str(path.relative_to(table.HERE).as_posix()) for path in table.HERE.glob("*/*.*") if path.suffix != ".pyc"}
    assert named == there
    for each in ALL.values():
        assert not each.files or each.files[0].rpartition("/")[2].partition(".")[0] == each.name


def test_every_example_is_described():
    """A line on what it is, and commands that begin with the command and end in a file or a coefficient."""
    for each in ALL.values():
        assert 10 < len(each.title) <= 90, each.name
        assert each.title == each.title.strip(". ")
        assert each.commands
        assert all(command.startswith("rocking ") for command in each.commands)
        assert each.outputs
        assert bool(each.model) == (each.kind == "motion")
    assert len(ALL) > 20


@pytest.mark.parametrize("name", [n for n in ALL if ALL[n].files and ALL[n].files[0].endswith(".toml")])
def test_a_file_says_what_it_is(name):
    """The comment at the head of a file is not empty; the note of a body calls it invented or names a source."""
    text = rk.examples.path(name).read_text("utf-8")
    assert re.match(r"# \w[^\n]{20,}", text)
    if name in BODIES:
        note = tomllib.loads(text)["note"]
        assert "invented" in note or re.search(r"source.*: .*[a-z]+\.[a-z]+/\S+", note)


@pytest.mark.parametrize("name", PLANE)
def test_plane_bodies_have_a_coefficient_under_every_model(name):
    """Inside its domain a model gives what its equation gives; no body is symmetric."""
    body, known = rk.examples.body(name), rk.restitution.models()
    for model in (rk.restitution.model(each) for each in known if each not in {"fixed", "implied"}):
        found = [model.evaluate(body, foot) for foot in ("left", "right")]
        for one in found:
            assert not one.flags, (name, model.name)  # no example is outside the domain of a model
            assert one.coefficient == one.raw
            assert 0.0 < one.coefficient < 1.0
        assert not math.isclose(found[0].coefficient, found[1].coefficient, rel_tol=1e-6)


def test_a_body_outside_a_domain_would_be_noticed():
    """Negative control: a low block, in which Housner's impact stops the body."""
    assert rk.restitution.model("housner").evaluate(rk.Block(width=2.0, height=1.0)).flags


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(BODIES) - set(PLANE)))
@pytest.mark.filterwarnings("ignore:.*round base")
def test_solids_have_a_coefficient_under_every_model(name):
    """Over every edge, or in four directions of a round base: those of bodies that are not symmetric differ."""
    body = rk.examples.body(name)
    for model in spatial_models():
        found = [edge_coefficient(body, model, start=k) for k in range(4)]
        assert all(0.0 < r < 1.0 or (r == 0.0 and name == "drum") for r in found)  # so squat that it may stop
        assert len({round(r, 6) for r in found}) == {"bust": 4, "column": 4, "gravestone": 2}.get(name, 1)


@pytest.mark.parametrize("name", ["statue", "stele", "transformer", "pier"])
def test_mass_and_centre_of_sections(name):
    """By Shapely from the numbers in the file, without this package's integrals."""
    tables = tomllib.loads(rk.examples.path(name).read_text("utf-8"))
    scale = {"m": 1.0, "cm": 0.01}[tables["units"]]
    depth = scale * tables["section"]["depth"]
    shapes = [shapely.Polygon(each["outline"], each.get("holes")) for each in tables["section"]["region"]]
    masses = [
        shape.area * scale**2 * depth * each["density"]
        for shape, each in zip(shapes, tables["section"]["region"], strict=True)
    ]
    x = sum(m * shape.centroid.x * scale for m, shape in zip(masses, shapes, strict=True)) / sum(masses)
    body = rk.examples.body(name)
    assert math.isclose(body.mass, sum(masses), rel_tol=1e-12)
    assert math.isclose(body.centre[0], x, rel_tol=1e-12)


@pytest.mark.parametrize("name", BODIES)
def test_titles_state_the_height(name):
    """The highest point of the body, to the digits of the title."""
    body, said = rk.examples.body(name), re.search(r"([\d.]+) m high", ALL[name].title)
    if isinstance(body, rk.Solid):
        highest = max(part.box()[1, 2] for part in body.parts)
    elif isinstance(body, rk.Block):
        highest = body.height
    elif isinstance(body, rk.MassPoints):
        highest = body.points[:, 1].max()
    else:
        highest = max(region.outline[:, 1].max() for region in body.regions)
    assert said is not None
    assert math.isclose(highest, float(said[1]), abs_tol=1e-9)


@pytest.mark.parametrize("name", MOTIONS)
def test_records_are_read_back_to_the_last_bit(name, tmp_path):
    """Samples, step and unit: nothing has to be told to the reader."""
    rk.examples.write(name, tmp_path)
    record = read_record(tmp_path / f"{name}.csv")
    made = parts(name)
    assert [part.name for part in record.components] == list(made)
    for part, motion in zip(record.components, made.values(), strict=True):
        assert part.unit == "m/s2"
        assert part.time_step == motion.time_step
        assert np.array_equal(part.acceleration, motion.acceleration)
    assert "no record of an earthquake" in record.header


@pytest.mark.parametrize("name", MOTIONS)
def test_motions_say_what_they_are(name):
    """Model, seed, peak and duration in the metadata are those of the samples, and the name has the seed."""
    for motion in parts(name).values():
        said = motion.metadata
        assert said["peak ground acceleration"] == f"{np.abs(motion.acceleration).max():.4g} m/s2"
        assert said["duration"] == f"{(motion.acceleration.size - 1) * motion.time_step:.6g} s"
        assert said["model"]
        assert (said.get("seed"), "seed" in motion.name) == ((None, False) if name == "pulse" else ("1", True))


@pytest.mark.parametrize("name", [n for n in MOTIONS if n != "pulse"])
def test_a_seed_is_a_motion(name):
    """The same seed gives the same bits; another seed another motion, in every component."""
    one, again, other = (parts(name, seed=seed) for seed in (4, 4, 5))
    for axis, motion in one.items():
        assert np.array_equal(motion.acceleration, again[axis].acceleration)
        assert not np.array_equal(motion.acceleration, other[axis].acceleration)
    everything = [m.acceleration.tobytes() for seed in range(5) for m in parts(name, seed=seed).values()]
    assert len(set(everything)) == len(everything)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_titles_state_what_is_measured(seed):
    """Peaks to rounding; and each has what it is named for."""
    made = {name: rk.examples.motion(name, **({} if name == "pulse" else {"seed": seed})) for name in MOTIONS}
    peaks = {name: made[name].peak / 9.80665 for name in SCALED}
    assert peaks == pytest.approx(SCALED, rel=1e-12)
    three = [part.peak / 9.80665 for part in made["three-components"].values()]
    assert three == pytest.approx([0.4, 0.35, 0.2], rel=1e-12)
    lasting = {name: measures()["d5_95"].of(made[name]) for name in SCALED}
    assert 50.0 < lasting["long"] < 70.0
    assert max(lasting["far-field"], lasting["soft-soil"]) < 25.0
    assert 0.75 < measures()["pgv"].of(made["near-fault"]) < 1.1
    # a soft layer swings slowly: its spectrum is highest beyond 0.8 s, that of firm ground before
    periods = np.geomspace(0.1, 3.0, 40)
    highest = {
        name: periods[np.argmax([spectral_acceleration(made[name], period) for period in periods])]
        for name in ("soft-soil", "far-field")
    }
    assert highest["far-field"] < 0.8 < highest["soft-soil"]


def test_bodies_of_a_source_have_its_mass():
    """The cask weighs 25.6 short tons, the full barrel 45 kg and 225 l of wine, which its volume can hold."""
    cask, barrel = rk.examples.body("cask"), rk.examples.body("barrel")
    assert cask.mass == pytest.approx(25.6 * 907.18474, rel=2e-3)
    assert barrel.mass == pytest.approx(45.0 + 225.0, rel=1e-12)
    assert 0.225 < barrel.volume < 0.225 + 45.0 / 400.0  # oak weighs more than 400 kg/m3
    assert rk.examples.body("showcase").assumed != ()
    assert cask.known is None


def test_what_is_not_there():
    """Names are refused with what is close, wherever they are asked; a seed that is none, too."""
    for ask in (rk.examples.body, rk.examples.path, rk.examples.write):
        with pytest.raises(InvalidValueError, match="did you mean 'statue'"):
            ask("statu")
    with pytest.raises(InvalidValueError, match=r"body must be one of statue, .*barrel, got 'near-fault'"):
        rk.examples.body("near-fault")
    with pytest.raises(InvalidValueError, match="motion must be one of"):
        rk.examples.motion("statue")
    with pytest.raises(InvalidValueError, match="kind must be one of body, motion, list, input, job"):
        rk.examples.catalogue("bodies")
    with pytest.raises(InvalidValueError, match=r"near-fault is computed and has no file; use motion\('near-fault'\)"):
        rk.examples.path("near-fault")
    for seed in (-1, 1.5, True, "1", 2**61):
        with pytest.raises(InvalidValueError, match="seed must be a whole number"):
            rk.examples.motion("long", seed=seed)
    with pytest.raises(InvalidValueError, match="pulse has no seed, got 2"):
        rk.examples.motion("pulse", seed=2)


def test_a_file_of_the_user_is_not_written_over(tmp_path):
    """Refused before anything is written; what is the same is left; force writes over it."""
    mine = tmp_path / "near-fault.csv"
    mine.write_text("my own record")
    with pytest.raises(InvalidValueError, match=r"near-fault\.csv already exists"):
        rk.examples.write("statue", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["near-fault.csv"]
    assert mine.read_text() == "my own record"
    written = rk.examples.write("statue", tmp_path, force=True)
    assert rk.examples.write("statue", tmp_path) == written
    assert rk.read_body(written[0]).mass == rk.examples.body("statue").mass
    with pytest.raises(InvalidValueError, match="no folder"):
        rk.examples.write("statue", tmp_path / "none")


def test_a_folder_of_the_name_of_a_file_is_left(tmp_path):
    """Refused before anything is written, also with force."""
    (tmp_path / "near-fault.csv").mkdir()
    with pytest.raises(InvalidValueError, match=r"near-fault\.csv: a folder with this name exists"):
        rk.examples.write("statue", tmp_path, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["near-fault.csv"]


def test_the_catalogue_prints():
    """A line for each on a terminal; a row for each, escaped, in a notebook."""
    lines = repr(rk.examples.catalogue()).splitlines()
    assert [line.split()[0] for line in lines] == list(ALL)
    page = rk.examples.catalogue("job")._repr_html_()
    assert page.count("<tr>") == 1 + len(rk.examples.catalogue("job"))
    odd = {"x": dataclasses.replace(ALL["statue"], name="x", title="a < b")}
    assert "a &lt; b" in rk.examples.Catalogue(odd)._repr_html_()
    assert repr(rk.examples.Catalogue({})) == ""


def test_a_record_of_another_motion_would_be_noticed(tmp_path, monkeypatch):
    """Negative control: a maker that forgets its seed gives other samples than the table's."""
    monkeypatch.setitem(
        table.EXAMPLES,
        "long",
        dataclasses.replace(table.EXAMPLES["long"], make=lambda seed: GroundMotion([0.0, 1.0 + seed], 0.01)),
    )
    rk.examples.write("long", tmp_path)
    assert read_record(tmp_path / "long.csv").components[0].acceleration.tolist() == [0.0, 2.0]
