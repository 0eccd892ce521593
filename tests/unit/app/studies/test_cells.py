"""The history behind a point of a picture."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rocking.app.errors import NotFound
from rocking.app.question import question_of
from rocking.app.records import RecordStore
from rocking.app.schemas.inputs import Inputs
from rocking.app.studies.history_at_point import HistoryPlace, cell_of, stretched_words
from rocking.app.studies.opened import OpenStudy
from rocking.bodies import Block
from rocking.motions import GroundMotion
from rocking.motions.formats import write_motion
from rocking.motions.pulses import catalogue, pulse
from rocking.outcome import Outcome
from rocking.studies.axis import axes

Tables = dict[str, Any]

RANGES = {
    "frequency_ratio": (1.0, 6.0), "amplitude_ratio": (0.8, 8.0), "scale": (0.5, 8.0), "pga": (2.0, 20.0),
    "pgv": (0.2, 2.0), "period": (0.2, 1.5), "duration": (0.2, 1.5), "semi_diagonal": (0.3, 3.0),
    "slenderness_ratio": (2.0, 8.0), "slenderness_angle": (0.1, 0.5), "width": (0.1, 1.0), "height": (0.5, 4.0),
    "restitution": (0.5, 0.99),
}  # fmt: skip

SECTION = {"units": "cm", "section": {"region": [{"outline": [[0, 0], [50, 0], [45, 190], [5, 190]], "density": 2400}]}}


NAMES = {outcome.code: outcome.name.lower() for outcome in Outcome}


def _axis(name: str, count: int = 4) -> Tables:
    low, high = RANGES[name]
    return {"axis": name, "from": low, "to": high, "count": count}


def _cells(study: OpenStudy) -> list[tuple[HistoryPlace, Tables]]:
    sizes = [study.job.job.study.dims[name] for name in study.job.job.study.dims if name != "restitution"]
    count = len(study.job.job.problem.restitutions)
    places = [HistoryPlace.of(study, x, y, r) for x in range(sizes[-1]) for y in range(sizes[0]) for r in range(count)]
    return [(place, cell_of(study, place, 50)) for place in places]


def test_every_axis_has_a_range_here() -> None:
    """A new axis must be tried here, too."""
    assert set(RANGES) == set(axes())


@pytest.mark.parametrize("name", RANGES)
def test_cells_of_every_axis_are_what_the_map_has(
    name: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """Stored numbers are the map's to the last bit; the inputs of a cell give the same end and the same rotation."""
    other = "width" if name in {"scale", "pga", "amplitude_ratio", "pgv"} else "pga"
    many = {"model": "ked"} if name == "restitution" else {"models": ["ked"], "values": [0.85]}
    study = computed(map_job(map={"x": _axis(name), "y": _axis(other)}, restitution=many))
    ends = set()
    for place, cell in _cells(study):
        alone = study.job.job.study.histories.run(place.number, place.number + 1, threads=1)
        again = study.job.job.study.derived(place.number, place.number + 1, alone)
        assert cell["stored"]["outcome"] == alone["outcome"][0]
        assert cell["stored"]["peak_rotation_rad"] == alone["peak_rotation"][0]
        assert cell["stored"]["mode"] == again["mode"][0]
        assert cell["stored"]["peak_rotation_over_alpha"] == again["peak_ratio"][0]
        question = question_of(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        # the response has samples between the steps of the map: the same accuracy by other steps
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)
        assert cell["difference_rad"] < 1e-4
        assert cell["answer"]["peak_rotation_rad"] == response.peak_rotation
        assert cell["note"] == ""
        ends.add(cell["stored"]["outcome"])
    assert len(ends) > 1, "a map of one colour proves little"


def test_another_cell_is_another_history(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """A negative control: the inputs of the neighbour do not give the numbers of the cell."""
    study = computed(map_job(map={"x": _axis("frequency_ratio"), "y": {"axis": "pga", "values": [4.0, 4.01]}}))
    inputs = cell_of(study, HistoryPlace.of(study, 2, 1))["inputs"]
    question = question_of(Inputs.model_validate(inputs), records)
    found = question.answer("ked").peak_rotation
    here, there = (cell_of(study, HistoryPlace.of(study, 2, y))["stored"]["peak_rotation_rad"] for y in (1, 0))
    assert found == pytest.approx(abs(here), rel=1e-9)
    assert found != pytest.approx(abs(there), rel=1e-6)


def test_sections_change_their_size(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """A polygon scaled by an axis is told point by point, and rocks as the map says."""
    study = computed(map_job(body=SECTION, map={"x": _axis("semi_diagonal"), "y": _axis("pga")}))
    for _, cell in _cells(study):
        question = question_of(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


@pytest.fixture
def record(records: RecordStore, tmp_path: Path) -> str:
    """Return the hash of an uploaded record: a sine that fades, in g, by our own writer."""
    time = np.arange(400) * 0.01
    motion = GroundMotion(3.0 * np.exp(-0.5 * time) * np.sin(8.0 * time), 0.01)
    write_motion(motion, tmp_path / "x.AT2", "peer")
    return records.add((tmp_path / "x.AT2").read_bytes(), "../My record (1).AT2").record


def test_cells_of_records_name_the_upload(
    record: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """The inputs of a cell name the record by its hash, and the store gives the same motion for it."""
    motions = {"records": [record], "scale": 2.0}
    study = computed(map_job(motions=motions, map={"x": _axis("width"), "y": _axis("scale")}))
    for _, cell in _cells(study):
        assert cell["inputs"]["motion"]["record"] == record
        question = question_of(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


@pytest.mark.parametrize("synthetic", [True, False], ids=["synthetic", "record"])
def test_stretched_records_are_shown_but_not_told(
    synthetic: bool, record: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """Inputs cannot stretch a record: the response is there all the same, and a sentence says why no inputs are."""
    motions = {"synthetic": "pulse-like", "count": 1} if synthetic else {"records": [record]}
    study = computed(map_job(motions=motions, map={"x": _axis("duration", 3), "y": _axis("pga", 3)}))
    for _, cell in _cells(study):
        assert cell["inputs"] is None
        assert "stretched" in cell["note"]
        assert cell["answer"]["outcome"] == NAMES[cell["stored"]["outcome"]]
        assert cell["difference_rad"] < 1e-4


KINDS: dict[str, Tables] = {
    "rocking-spectrum": {
        "body": None, "map": None, "spectrum": {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 3.0, 4.0]},
    },
    "stripes": {"map": None, "fragility": {"levels": [2.0, 4.0, 6.0]}},
    "incremental": {"map": None, "fragility": {"levels": [2.0, 4.0, 6.0]}},
    "cloud": {"map": None, "fragility": {"measure": "pga"}},
    "histories": {"map": None, "histories": {"scales": [1.0, 2.0, 3.0]}},
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_points_of_other_studies_are_histories_too(
    kind: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """Levels, motions, blocks and scales lead to the inputs of their histories as cells of maps do."""
    pulses = [f"sine:amplitude={a},period=0.8" for a in (1.0, 1.5, 3.0)]
    motions = [{"pulse": pulses[:1]}, {"pulse": pulses[1:], "scale": 2.0}]
    if kind in {"stripes", "cloud"}:
        motions = [{"synthetic": "pulse-like", "count": 3, "seed": 4}]
    study = computed(map_job(campaign={"name": "x", "kind": kind}, motions=motions, **KINDS[kind]))
    across = {"cloud": (3, 1), "histories": (3, 1)}.get(kind, (3, 2))
    for x in range(across[0]):
        for y in range(across[1]):
            cell = cell_of(
                study, HistoryPlace.of(study, x, y, 1, motion=2 if kind in {"rocking-spectrum", "histories"} else 0)
            )
            question = question_of(Inputs.model_validate(cell["inputs"]), records)
            response = question.answer(next(iter(question.restitutions.values())))
            assert response.outcome.code == cell["stored"]["outcome"]
            assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


def test_draws_of_a_history_become_its_coefficient(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables], records: RecordStore
) -> None:
    """A coefficient drawn once for a history is told as a number; one drawn at every impact cannot be."""
    for each, told in (("history", True), ("impact", False)):
        drawn = {"distribution": {"mean": 0.9, "deviation": 0.05, "each": each, "seed": 3}}
        study = computed(map_job(restitution=drawn, map={"x": _axis("width"), "y": _axis("scale")}))
        for _, cell in _cells(study):
            assert (cell["inputs"] is not None) == told
            assert cell["difference_rad"] < 1e-4
            if told:
                question = question_of(Inputs.model_validate(cell["inputs"]), records)
                response = question.answer(next(iter(question.restitutions.values())))
                assert response.outcome.code == cell["stored"]["outcome"]


def test_cells_without_a_history_say_why(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """Where no such block can be made there is a sentence instead of a response."""
    x, y = {"axis": "semi_diagonal", "values": [0.5, 2.0]}, {"axis": "width", "values": [0.5, 1.5]}
    study = computed(map_job(map={"x": x, "y": y}))
    cell = cell_of(study, HistoryPlace.of(study, 0, 1))
    assert cell["stored"]["mode"] == -3
    assert cell["answer"] is None
    assert "semi-diagonal" in cell["note"]


@pytest.mark.parametrize("at", [(4, 0, 0), (0, 4, 0), (0, 0, 2), (-1, 0, 0)])
def test_points_outside_are_not_there(
    at: tuple[int, int, int], computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """A number beyond the axes is no cell, and no other cell in its place."""
    study = computed(map_job(4))
    with pytest.raises(NotFound, match="must be a number from 0 to"):
        HistoryPlace.of(study, *at)


@pytest.mark.parametrize("name", sorted(catalogue()))
def test_stretched_words_are_the_stretched_pulse(name: str) -> None:
    """Every pulse of the catalogue, stretched in words, has the acceleration of the pulse at stretched times."""
    own = {
        "rectangular": "amplitude=2,duration=0.5", "type-c": "amplitude=2,period=0.5,n=2",
        "mavroeidis-papageorgiou": "velocity=0.7,period=0.9,cycles=2.5,phase=0.4",
        "harmonic": "amplitude=2,period=0.5,cycles=4",
    }  # fmt: skip
    words = f"{name}:{own.get(name, 'amplitude=2,period=0.5')}"
    before, after = pulse(words), pulse(stretched_words(words, 1.7))
    time = np.linspace(0.0, before.duration, 101)[1:-1]
    assert after.acceleration(1.7 * time) == pytest.approx(before.acceleration(time), abs=1e-9)


def test_blocks_of_spectra_are_those_of_the_study(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """The block behind a point of a spectrum has the angle and the period 2 pi / p of the point."""
    study = computed(map_job(campaign={"name": "x", "kind": "rocking-spectrum"}, **KINDS["rocking-spectrum"]))
    body = cell_of(study, HistoryPlace.of(study, 1, 1))["inputs"]["body"]
    side = Block(width=body["width"], height=body["height"]).side("right")
    assert side.slenderness_angle == pytest.approx(0.3, rel=1e-14)
    assert 2.0 * np.pi / side.frequency_parameter == pytest.approx(3.0, rel=1e-14)
