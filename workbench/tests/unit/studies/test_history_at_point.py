"""Histories behind the points of studies: stored to the last bit, and inputs that give them again."""

import numpy as np
import pytest

from rocking.bodies import Block
from rocking.motions import GroundMotion, pulses
from rocking.motions.formats import write_motion
from rocking.outcome import Outcome
from rocking.studies import axes
from rocking_workbench.errors import NotFound
from rocking_workbench.inputs import Inputs, problem_from
from rocking_workbench.studies.history_at_point import HistoryPlace, cell_of, stretched_words

RANGES = {
    "frequency_ratio": (1.0, 6.0), "amplitude_ratio": (0.8, 8.0), "scale": (0.5, 8.0), "pga": (2.0, 20.0),
    "pgv": (0.2, 2.0), "period": (0.2, 1.5), "duration": (0.2, 1.5), "semi_diagonal": (0.3, 3.0),
    "slenderness_ratio": (2.0, 8.0), "slenderness_angle": (0.1, 0.5), "width": (0.1, 1.0), "height": (0.5, 4.0),
    "restitution": (0.5, 0.99), "initial_rotation": (-0.2, 0.2), "initial_angular_velocity": (-1.0, 1.0),
}  # fmt: skip
SECTION = {"units": "cm", "section": {"region": [{"outline": [[0, 0], [50, 0], [45, 190], [5, 190]], "density": 2400}]}}
SPECTRUM = {"body": None, "spectrum": {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 3.0, 4.0]}}


def _map(x, y, count=4):
    def axis(name):
        low, high = RANGES[name]
        return {"axis": name, "from": low, "to": high, "count": count}

    return {"map": {"x": axis(x), "y": axis(y)}}


def _cells(study):
    sizes = [size for name, size in study.job.study.dims.items() if name != "restitution"]
    count = len(study.job.problem.restitutions)
    places = [HistoryPlace.of(study, x, y, r) for x in range(sizes[-1]) for y in range(sizes[0]) for r in range(count)]
    return [(place, cell_of(study, place, 50)) for place in places]


def _check_again(cell, records):
    """The inputs of a cell give the end and the peak that the study has: the same accuracy by other steps."""
    problem = problem_from(Inputs.model_validate(cell["inputs"]), records)
    response = problem.answer(next(iter(problem.restitutions.values())))
    assert response.outcome.code == cell["stored"]["outcome"]
    assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation"]), rel=1e-4)
    return response


def test_every_axis_has_a_range_here():
    """A new axis must be tried here, too."""
    assert set(RANGES) | {"friction", "azimuth"} == set(axes())


def test_with_friction_the_study_speaks(computed, map_job):
    """The numbers of the study, and where a response with friction is computed, as an axis and as a setting."""
    by_axis = {"map": {"x": {"axis": "friction", "values": [0.1, 0.4]}, "y": _map("pga", "width")["map"]["x"]}}
    for how in (by_axis, _map("width", "pga") | {"settings": {"friction": 0.3}}):
        study = computed(map_job(**how))
        answered = [cell for _, cell in _cells(study)]
        assert all("rocking simulate --friction" in cell["note"] for cell in answered)
        assert len({cell["stored"]["outcome"] for cell in answered}) > 1


@pytest.mark.parametrize("name", RANGES)
def test_cells_of_every_axis_are_what_the_map_has(name, computed, map_job, records):
    """Stored numbers are the map's to the last bit; the inputs of a cell give the same end and the same rotation."""
    other = "width" if name in {"scale", "pga", "amplitude_ratio", "pgv"} else "pga"
    many = {"model": "ked"} if name == "restitution" else {"models": ["ked"], "values": [0.85]}
    study = computed(map_job(**_map(name, other), restitution=many))
    ends = set()
    for place, cell in _cells(study):
        alone = study.job.study.histories.run(place.number, place.number + 1, threads=1)
        again = study.job.study.derived(place.number, place.number + 1, alone)
        stored = cell["stored"]
        assert (stored["outcome"], stored["peak_rotation"]) == (alone["outcome"][0], alone["peak_rotation"][0])
        assert (stored["mode"], stored["peak_ratio"]) == (again["mode"][0], again["peak_ratio"][0])
        assert cell["difference"] < 1e-4
        if name.startswith("initial_"):
            assert cell["inputs"] is None
            assert "cannot contain an initial rotation" in cell["note"]
        else:
            assert cell["answer"]["peak_rotation"] == _check_again(cell, records).peak_rotation
            assert cell["note"] == ""
        ends.add(stored["outcome"])
    assert len(ends) > 1, "a map of one colour proves little"


def test_another_cell_is_another_history(computed, map_job, records):
    """A negative control: the inputs of the neighbour do not give the numbers of the cell."""
    axes = {"x": _map("frequency_ratio", "pga")["map"]["x"], "y": {"axis": "pga", "values": [4.0, 4.01]}}
    study = computed(map_job(map=axes))
    here, there = (cell_of(study, HistoryPlace.of(study, 2, y)) for y in (1, 0))
    peak = problem_from(Inputs.model_validate(here["inputs"]), records).answer("ked").peak_rotation
    assert peak == pytest.approx(abs(here["stored"]["peak_rotation"]), rel=1e-9)
    assert peak != pytest.approx(abs(there["stored"]["peak_rotation"]), rel=1e-6)


@pytest.fixture(scope="module")
def record(records, tmp_path_factory):
    """Return the hash of an uploaded record: a sine that fades, in g, by our own writer."""
    time, path = np.arange(400) * 0.01, tmp_path_factory.mktemp("record") / "x.AT2"
    write_motion(GroundMotion(3.0 * np.exp(-0.5 * time) * np.sin(8.0 * time), 0.01), path, "peer")
    return records.add(path.read_bytes(), "../My record (1).AT2").record


def test_sections_and_records_are_among_the_inputs(record, computed, map_job, records):
    """A polygon scaled by an axis is told point by point, a record by its hash, and both rock as the map says."""
    for tables in (
        {"body": SECTION, **_map("semi_diagonal", "pga")},
        {"motions": {"records": [record], "scale": 2.0}, **_map("width", "scale")},
    ):
        for _, cell in _cells(computed(map_job(**tables))):
            _check_again(cell, records)
            assert cell["inputs"]["motion"].get("record") == (record if "motions" in tables else None)


@pytest.mark.parametrize("synthetic", [True, False], ids=["synthetic", "record"])
def test_stretched_records_are_shown_but_not_told(synthetic, record, computed, map_job):
    """Inputs cannot stretch a record: the response is there all the same, and a sentence says why no inputs are."""
    motions = {"synthetic": "pulse-like", "count": 1} if synthetic else {"records": [record]}
    names = {outcome.code: outcome.name.lower() for outcome in Outcome}
    for _, cell in _cells(computed(map_job(motions=motions, **_map("duration", "pga", 3)))):
        assert cell["inputs"] is None
        assert "stretched" in cell["note"]
        assert cell["answer"]["outcome"] == names[cell["stored"]["outcome"]]
        assert cell["difference"] < 1e-4


LEVELS = {"fragility": {"levels": [2.0, 4.0, 6.0]}}
SYNTHETIC = [{"synthetic": "pulse-like", "count": 3, "seed": 4}]
PULSES = [f"sine:amplitude={a},period=0.8" for a in (1.0, 1.5, 3.0)]
TWO_TABLES = [{"pulse": PULSES[:1]}, {"pulse": PULSES[1:], "scale": 2.0}]


@pytest.mark.parametrize(
    ("kind", "tables", "motions", "across", "motion"),
    [
        ("rocking-spectrum", SPECTRUM, TWO_TABLES, (3, 2), 2),
        ("stripes", LEVELS, SYNTHETIC, (3, 2), 0),
        ("incremental", LEVELS, TWO_TABLES, (3, 2), 0),
        ("cloud", {"fragility": {"im": "pga"}}, SYNTHETIC, (3, 1), 0),
        ("histories", {"histories": {"scales": [1.0, 2.0, 3.0]}}, TWO_TABLES, (3, 1), 2),
    ],
)
def test_points_of_other_studies_are_histories_too(kind, tables, motions, across, motion, computed, map_job, records):
    """Levels, motions, blocks and scales lead to the inputs of their histories as cells of maps do."""
    study = computed(map_job(campaign={"name": "x", "kind": kind}, motions=motions, map=None, **tables))
    for x, y in np.ndindex(across):
        _check_again(cell_of(study, HistoryPlace.of(study, x, y, 1, motion=motion)), records)


def test_blocks_of_spectra_are_those_of_the_study(computed, map_job):
    """The block behind a point of a spectrum has the angle and the period 2 pi / p of the point."""
    study = computed(map_job(campaign={"name": "x", "kind": "rocking-spectrum"}, map=None, **SPECTRUM))
    body = cell_of(study, HistoryPlace.of(study, 1, 1))["inputs"]["body"]
    side = Block(width=body["width"], height=body["height"]).side("right")
    assert side.slenderness_angle == pytest.approx(0.3, rel=1e-14, abs=0.0)
    assert 2.0 * np.pi / side.frequency_parameter == pytest.approx(3.0, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(("each", "has_inputs"), [("history", True), ("impact", False)])
def test_draws_of_a_history_become_its_coefficient(each, has_inputs, computed, map_job, records):
    """A coefficient drawn once for a history is told as a number; one drawn at every impact cannot be."""
    drawn = {"distribution": {"mean": 0.9, "deviation": 0.05, "each": each, "seed": 3}}
    for _, cell in _cells(computed(map_job(restitution=drawn, **_map("width", "scale")))):
        assert (cell["inputs"] is not None) == has_inputs
        assert cell["difference"] < 1e-4
        if has_inputs:
            _check_again(cell, records)


def test_cells_without_a_history_say_why(computed, map_job):
    """Where no such block can be made there is a sentence instead of a response."""
    x, y = {"axis": "semi_diagonal", "values": [0.5, 2.0]}, {"axis": "width", "values": [0.5, 1.5]}
    study = computed(map_job(map={"x": x, "y": y}))
    cell = cell_of(study, HistoryPlace.of(study, 0, 1))
    assert (cell["stored"]["mode"], cell["answer"]) == (-3, None)
    assert "semi-diagonal" in cell["note"]


@pytest.mark.parametrize("at", [(4, 0, 0), (0, 4, 0), (0, 0, 2), (-1, 0, 0)])
def test_points_outside_are_not_there(at, computed, map_job):
    """A number beyond the axes is no cell, and no other cell in its place."""
    with pytest.raises(NotFound, match=r"must be in 0 \.\.\. "):
        HistoryPlace.of(computed(map_job(4)), *at)


@pytest.mark.parametrize("name", sorted(pulses.catalogue()))
def test_stretched_words_are_the_stretched_pulse(name):
    """Every pulse of the catalogue, stretched in words, has the acceleration of the pulse at stretched times."""
    own = {
        "rectangular": "amplitude=2,duration=0.5", "type-c": "amplitude=2,period=0.5,n=2",
        "mavroeidis-papageorgiou": "velocity=0.7,period=0.9,cycles=2.5,phase=0.4",
        "harmonic": "amplitude=2,period=0.5,cycles=4",
    }  # fmt: skip
    words = f"{name}:{own.get(name, 'amplitude=2,period=0.5')}"
    before, after = pulses.pulse(words), pulses.pulse(stretched_words(words, 1.7))
    time = np.linspace(0.0, before.duration, 101)[1:-1]
    assert after.acceleration(1.7 * time) == pytest.approx(before.acceleration(time), abs=1e-9)
