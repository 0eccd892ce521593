"""Finished studies: results, histories behind their points and files, against the Python calls of the same."""

import csv
import io
import json
import re
import tomllib
from typing import Any, get_args
from xml.etree import ElementTree as ET

import h5netcdf
import numpy as np
import openpyxl
import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.app.answers import MEDIA_TYPES, JsonAnswer
from rocking.app.errors import NotFound, Refused
from rocking.app.inputs import Inputs, problem_from
from rocking.app.records import RecordStore
from rocking.app.settings import Limits
from rocking.app.studies.finished import Kind, written
from rocking.app.studies.history_at_point import HistoryPlace, cell_of, stretched_words
from rocking.app.studies.manager import StudyManager
from rocking.app.studies.results import contours_of, plain, result_of
from rocking.app.work import Remembered
from rocking.bodies import Block
from rocking.campaigns.jobs import Job
from rocking.motions import GroundMotion
from rocking.motions.formats import write_motion
from rocking.motions.pulses import catalogue, pulse
from rocking.outcome import Outcome
from rocking.studies._overturning_map import overturning_map
from rocking.studies._rocking_spectrum import rocking_spectrum
from rocking.studies.axis import axes
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_analysis
from rocking.studies.motion_sets import SyntheticSet

Tables = dict[str, Any]
BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)


def _json(study):
    """Return the result as a browser reads it; no number in it is not finite."""

    def refuse(name):
        raise AssertionError(name)

    return json.loads(bytes(JsonAnswer(result_of(study)).body), parse_constant=refuse)


def test_a_map_is_the_map_of_python(computed, map_job):
    """Every number of every restitution is that of the Python call, to the last digit."""
    told = _json(computed(map_job(8)))
    assert told["restitutions"] == ["ked", "housner"]
    axes = {side: np.array(told[side]["values"]) for side in "xy"}
    assert told["x"]["name"] == "frequency_ratio"
    for place, label in enumerate(told["restitutions"]):
        found = overturning_map(BLOCK, PULSE, ("frequency_ratio", axes["x"]), ("amplitude_ratio", axes["y"]), label)
        assert told["mode"][place] == found["mode"].values.tolist()
        assert told["outcome"][place] == found["outcome"].values.tolist()
        assert told["impacts"][place] == found["impacts"].values.tolist()
        assert told["peak"][place] == plain(found["peak_ratio"].values)
        assert sum(each["count"] for each in told["shares"][place]) == 64
    assert told["mode"][0] != told["mode"][1]


def test_cells_that_failed_have_no_number(computed, map_job):
    """Where there is no such block the peak is null, and the mode says so in words."""
    x, y = {"axis": "semi_diagonal", "values": [0.5, 2.0]}, {"axis": "width", "values": [0.5, 1.5]}
    told = _json(computed(map_job(map={"x": x, "y": y})))
    assert told["peak"][0][1][0] is None
    assert told["mode"][0][1][0] == -3
    assert told["mode_words"]["-3"] == "not computed"


def test_an_axis_may_be_the_restitution(computed, map_job):
    """A map over the coefficient has one sheet, and its axis has that name."""
    x, y = {"axis": "restitution", "values": [0.6, 0.7, 0.8]}, {"axis": "pga", "values": [4.0, 8.0]}
    told = _json(computed(map_job(map={"x": x, "y": y}, restitution={"model": "ked"})))
    assert np.shape(told["mode"]) == (1, 2, 3)
    assert told["x"]["name"] == "restitution"


def test_a_refined_map_has_its_boundary(computed, map_job):
    """The points and polylines of an adaptive map come with it, each column with its unit."""
    job = map_job(6, restitution={"model": "ked"})
    job["map"]["refine"] = 1
    told = _json(computed(job))
    assert set(told["tables"]) == {"refined", "boundary"}
    assert all({"name", "unit", "words", "values"} == set(column) for column in told["tables"]["boundary"])


def test_contours_part_what_overturns():
    """Lines run halfway between points that differ: around an island closed, through a band open, nowhere else."""
    x, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 10.0, 20.0])
    inside = np.zeros((3, 4), dtype=bool)
    assert contours_of(inside, x, y) == []
    inside[:, 2:] = True
    (line,) = contours_of(inside, x, y)
    assert sorted(line) == [[1.5, 0.0], [1.5, 10.0], [1.5, 20.0]]
    inside[:] = False
    inside[1, 1] = True
    (ring,) = contours_of(inside, x, y)
    assert ring[0] == ring[-1]
    assert sorted(map(tuple, ring[1:])) == [(0.5, 10.0), (1.0, 5.0), (1.0, 15.0), (1.5, 10.0)]


def test_spectra_are_those_of_python(computed, map_job):
    """The curves of one motion are the peaks of the Python call, null where the block overturned."""
    table = {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 4.0, 8.0]}
    job = map_job(campaign={"name": "x", "kind": "rocking-spectrum"}, body=None, map=None, spectrum=table)
    told = _json(computed(job))
    found = rocking_spectrum(PULSE, table["slenderness_angles"], table["periods"], "housner")
    mine = next(c for c in told["curves"] if c["restitution"] == "housner" and c["angle"] == 0.3)
    modes, peaks = found["mode"].values[0, 1], found["peak_ratio"].values[0, 1]
    assert mine["median"] == plain(np.where(modes >= 0, np.nan, peaks))
    assert mine["overturned"] == (modes >= 0).astype(float).tolist()
    assert mine["coefficient"] == pytest.approx([1.0 - 1.5 * np.sin(0.3) ** 2] * 3)


def test_fragility_is_that_of_python(computed, map_job):
    """Counts, medians, intervals and verdicts are those of the Python call; bands hold their curves."""
    levels = [2.0, 4.0, 6.0, 8.0, 10.0]
    job = map_job(
        campaign={"name": "x", "kind": "stripes"}, map=None, fragility={"levels": levels, "states": [0.5]},
        motions={"synthetic": "pulse-like", "count": 20, "seed": 7}, restitution={"model": "ked"},
    )  # fmt: skip
    told = _json(computed(job))
    found = multiple_stripe_analysis(BLOCK, SyntheticSet("pulse-like", 20, 7), levels, "ked", states=(0.5,))
    (mine,) = told["analyses"]
    for name, fit in found.fits.items():
        assert mine["fits"][name]["median"] == fit.median
        assert mine["fits"][name]["median_95"] == fit.summary()["median_95"]
        assert f"{name}: {fit.verdict}" in mine["sentences"]
    assert mine["points"]["overturned"]["reached"] == found.counts["overturned"].tolist()
    for curve in mine["curves"].values():
        if curve["low"] is not None:
            inside = np.array(curve["low"]) <= np.array(curve["probability"]) + 1e-12
            assert inside.all()
    assert mine["trials"] == [20] * 5


@pytest.mark.parametrize("kind", ["cloud", "incremental"])
def test_other_analyses_have_their_own(kind, computed, map_job):
    """A cloud has its points and its line, an incremental analysis its first crossings."""
    fragility = {"measure": "pgv"} if kind == "cloud" else {"levels": [2.0, 4.0, 8.0, 12.0]}
    pulses = [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0, 6.0) for p in (0.4, 0.7, 0.9)]
    job = map_job(campaign={"name": "x", "kind": kind}, map=None, fragility=fragility, motions={"pulse": pulses})
    told = _json(computed(job))
    assert [one["restitution"] for one in told["analyses"]] == ["ked", "housner"]
    own = {"regression"} if kind == "cloud" else {"first_crossings", "resurrection", "intervals"}
    assert own <= set(told["analyses"][0])


def test_plain_histories_are_counted(computed, map_job):
    """Each count is what a direct simulation of every motion says."""
    pulses = ["sine:amplitude=1,period=0.6", "sine:amplitude=1,period=1.2"]
    job = map_job(
        campaign={"name": "x", "kind": "histories"}, map=None, motions={"pulse": pulses},
        histories={"scales": [1.0, 4.0, 9.0]}, restitution={"value": 0.9},
    )  # fmt: skip
    told = _json(computed(job))
    for place, scale in enumerate([1.0, 4.0, 9.0]):
        ends = [rk.simulate(BLOCK, rk.pulses.pulse(words), 0.9, scale=scale).outcome.name for words in pulses]
        assert told["cells"]["overturned"][0][0][place] == ends.count("OVERTURNED")
        assert told["cells"]["lifted"][0][0][place] == 2 - ends.count("NO_UPLIFT")
    assert np.shape(told["mode"]) == (1, 2, 1, 3)


def test_minimum_accelerations_are_tables(computed, map_job):
    """What an adaptive search found comes as tables."""
    job = map_job(campaign={"name": "x", "kind": "minimum-acceleration"}, map=None, minimum={"points": 20})
    assert set(_json(computed(job))["tables"]) == {"crossings", "minima"}


@pytest.mark.parametrize("kind", ["stripes", "incremental", "minimum-acceleration"])
def test_lost_contact_stands_beside_the_verdicts(kind, computed, map_job):
    """Pulses of many g tear the body off the ground, in every kind of study; weak ones do not, and nothing is said."""
    pulses = ["sine:amplitude=3,period=0.6", "sine:amplitude=3,period=0.8"]
    for strong in (False, True):
        levels = [30.0, 60.0] if strong else [2.0, 2.2]
        own = {"fragility": {"levels": levels}} if kind != "minimum-acceleration" else {
            "minimum": {"points": 20, "levels": 1, "lowest": levels[0], "highest": levels[1]}
        }  # fmt: skip
        job = map_job(campaign={"name": "x", "kind": kind}, map=None, motions={"pulse": pulses}, **own)
        words = _json(computed(job))["contact"]
        if not strong:
            assert words == ""
            continue
        lost, of = map(int, re.findall(r"\d+", words)[:2])
        assert 0 < lost <= of
        (share,) = map(float, re.findall(r"\(([\d.]+) %\) the ground would have to pull", words))
        assert share == pytest.approx(100.0 * lost / of, abs=0.05)
        assert of == 8 if kind != "minimum-acceleration" else of >= 4 * 20


def test_what_was_looked_at_is_kept_until_it_is_deleted(computed, map_job):
    """A study is opened once; a deleted study leaves neither itself nor answers behind."""
    study = computed(map_job(3))
    manager = StudyManager(study.folder.path.parent.parent, Limits(), RecordStore(study.folder.path, Limits()))
    assert manager.open(study.folder) is manager.open(study.folder)
    assert manager.answers.get((study.id, "result"), lambda: b"x") == b"x"
    manager.delete(study.id)
    assert manager.answers.known((study.id, "result")) is None
    assert manager.opened.known(study.id) is None
    manager.close()


def test_memory_is_bounded():
    """What is kept beyond the bound pushes the oldest out; a result is made once, a failed one is made again."""
    kept, made = Remembered(64, len), []
    for number in range(5):
        assert len(kept.get(number, lambda: bytes(20))) == 20
    assert [kept.known(number) is None for number in range(5)] == [True, True, False, False, False]
    for _ in range(2):
        kept.get("once", lambda: made.append(1) or b"x")
        with pytest.raises(ZeroDivisionError):
            kept.get("never", lambda: made.append(2) or 1 / 0)
    assert made == [1, 2, 2]


RANGES = {
    "frequency_ratio": (1.0, 6.0), "amplitude_ratio": (0.8, 8.0), "scale": (0.5, 8.0), "pga": (2.0, 20.0),
    "pgv": (0.2, 2.0), "period": (0.2, 1.5), "duration": (0.2, 1.5), "semi_diagonal": (0.3, 3.0),
    "slenderness_ratio": (2.0, 8.0), "slenderness_angle": (0.1, 0.5), "width": (0.1, 1.0), "height": (0.5, 4.0),
    "restitution": (0.5, 0.99),
}  # fmt: skip

SECTION = {"units": "cm", "section": {"region": [{"outline": [[0, 0], [50, 0], [45, 190], [5, 190]], "density": 2400}]}}


NAMES = {outcome.code: outcome.name.lower() for outcome in Outcome}


def _axis(name, count=4):
    low, high = RANGES[name]
    return {"axis": name, "from": low, "to": high, "count": count}


def _cells(study):
    sizes = [study.job.job.study.dims[name] for name in study.job.job.study.dims if name != "restitution"]
    count = len(study.job.job.problem.restitutions)
    places = [HistoryPlace.of(study, x, y, r) for x in range(sizes[-1]) for y in range(sizes[0]) for r in range(count)]
    return [(place, cell_of(study, place, 50)) for place in places]


def test_every_axis_has_a_range_here():
    """A new axis must be tried here, too."""
    assert set(RANGES) == set(axes())


@pytest.mark.parametrize("name", RANGES)
def test_cells_of_every_axis_are_what_the_map_has(name, computed, map_job, records):
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
        question = problem_from(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        # the response has samples between the steps of the map: the same accuracy by other steps
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)
        assert cell["difference_rad"] < 1e-4
        assert cell["answer"]["peak_rotation_rad"] == response.peak_rotation
        assert cell["note"] == ""
        ends.add(cell["stored"]["outcome"])
    assert len(ends) > 1, "a map of one colour proves little"


def test_another_cell_is_another_history(computed, map_job, records):
    """A negative control: the inputs of the neighbour do not give the numbers of the cell."""
    study = computed(map_job(map={"x": _axis("frequency_ratio"), "y": {"axis": "pga", "values": [4.0, 4.01]}}))
    inputs = cell_of(study, HistoryPlace.of(study, 2, 1))["inputs"]
    question = problem_from(Inputs.model_validate(inputs), records)
    found = question.answer("ked").peak_rotation
    here, there = (cell_of(study, HistoryPlace.of(study, 2, y))["stored"]["peak_rotation_rad"] for y in (1, 0))
    assert found == pytest.approx(abs(here), rel=1e-9)
    assert found != pytest.approx(abs(there), rel=1e-6)


def test_sections_change_their_size(computed, map_job, records):
    """A polygon scaled by an axis is told point by point, and rocks as the map says."""
    study = computed(map_job(body=SECTION, map={"x": _axis("semi_diagonal"), "y": _axis("pga")}))
    for _, cell in _cells(study):
        question = problem_from(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


@pytest.fixture
def record(records, tmp_path):
    """Return the hash of an uploaded record: a sine that fades, in g, by our own writer."""
    time = np.arange(400) * 0.01
    motion = GroundMotion(3.0 * np.exp(-0.5 * time) * np.sin(8.0 * time), 0.01)
    write_motion(motion, tmp_path / "x.AT2", "peer")
    return records.add((tmp_path / "x.AT2").read_bytes(), "../My record (1).AT2").record


def test_cells_of_records_name_the_upload(record, computed, map_job, records):
    """The inputs of a cell name the record by its hash, and the store gives the same motion for it."""
    motions = {"records": [record], "scale": 2.0}
    study = computed(map_job(motions=motions, map={"x": _axis("width"), "y": _axis("scale")}))
    for _, cell in _cells(study):
        assert cell["inputs"]["motion"]["record"] == record
        question = problem_from(Inputs.model_validate(cell["inputs"]), records)
        response = question.answer(next(iter(question.restitutions.values())))
        assert response.outcome.code == cell["stored"]["outcome"]
        assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


@pytest.mark.parametrize("synthetic", [True, False], ids=["synthetic", "record"])
def test_stretched_records_are_shown_but_not_told(synthetic, record, computed, map_job):
    """Inputs cannot stretch a record: the response is there all the same, and a sentence says why no inputs are."""
    motions = {"synthetic": "pulse-like", "count": 1} if synthetic else {"records": [record]}
    study = computed(map_job(motions=motions, map={"x": _axis("duration", 3), "y": _axis("pga", 3)}))
    for _, cell in _cells(study):
        assert cell["inputs"] is None
        assert "stretched" in cell["note"]
        assert cell["answer"]["outcome"] == NAMES[cell["stored"]["outcome"]]
        assert cell["difference_rad"] < 1e-4


KINDS = {
    "rocking-spectrum": {
        "body": None, "map": None, "spectrum": {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 3.0, 4.0]},
    },
    "stripes": {"map": None, "fragility": {"levels": [2.0, 4.0, 6.0]}},
    "incremental": {"map": None, "fragility": {"levels": [2.0, 4.0, 6.0]}},
    "cloud": {"map": None, "fragility": {"measure": "pga"}},
    "histories": {"map": None, "histories": {"scales": [1.0, 2.0, 3.0]}},
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_points_of_other_studies_are_histories_too(kind, computed, map_job, records):
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
            question = problem_from(Inputs.model_validate(cell["inputs"]), records)
            response = question.answer(next(iter(question.restitutions.values())))
            assert response.outcome.code == cell["stored"]["outcome"]
            assert response.peak_rotation == pytest.approx(abs(cell["stored"]["peak_rotation_rad"]), rel=1e-4)


def test_draws_of_a_history_become_its_coefficient(computed, map_job, records):
    """A coefficient drawn once for a history is told as a number; one drawn at every impact cannot be."""
    for each, told in (("history", True), ("impact", False)):
        drawn = {"distribution": {"mean": 0.9, "deviation": 0.05, "each": each, "seed": 3}}
        study = computed(map_job(restitution=drawn, map={"x": _axis("width"), "y": _axis("scale")}))
        for _, cell in _cells(study):
            assert (cell["inputs"] is not None) == told
            assert cell["difference_rad"] < 1e-4
            if told:
                question = problem_from(Inputs.model_validate(cell["inputs"]), records)
                response = question.answer(next(iter(question.restitutions.values())))
                assert response.outcome.code == cell["stored"]["outcome"]


def test_cells_without_a_history_say_why(computed, map_job):
    """Where no such block can be made there is a sentence instead of a response."""
    x, y = {"axis": "semi_diagonal", "values": [0.5, 2.0]}, {"axis": "width", "values": [0.5, 1.5]}
    study = computed(map_job(map={"x": x, "y": y}))
    cell = cell_of(study, HistoryPlace.of(study, 0, 1))
    assert cell["stored"]["mode"] == -3
    assert cell["answer"] is None
    assert "semi-diagonal" in cell["note"]


@pytest.mark.parametrize("at", [(4, 0, 0), (0, 4, 0), (0, 0, 2), (-1, 0, 0)])
def test_points_outside_are_not_there(at, computed, map_job):
    """A number beyond the axes is no cell, and no other cell in its place."""
    study = computed(map_job(4))
    with pytest.raises(NotFound, match="must be a number from 0 to"):
        HistoryPlace.of(study, *at)


@pytest.mark.parametrize("name", sorted(catalogue()))
def test_stretched_words_are_the_stretched_pulse(name):
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


def test_blocks_of_spectra_are_those_of_the_study(computed, map_job):
    """The block behind a point of a spectrum has the angle and the period 2 pi / p of the point."""
    study = computed(map_job(campaign={"name": "x", "kind": "rocking-spectrum"}, **KINDS["rocking-spectrum"]))
    body = cell_of(study, HistoryPlace.of(study, 1, 1))["inputs"]["body"]
    side = Block(width=body["width"], height=body["height"]).side("right")
    assert side.slenderness_angle == pytest.approx(0.3, rel=1e-14)
    assert 2.0 * np.pi / side.frequency_parameter == pytest.approx(3.0, rel=1e-14)


NAME = '=cmd|" /C calc"!A0<script>alert(1)</script>'


@pytest.fixture
def study(computed, map_job):
    return computed(map_job(5, campaign={"name": NAME, "kind": "overturning-map"}))


def _written(study, kind, folder, what=None, restitution=0):
    path = folder / f"study.{kind}"
    written(study, kind, path, what, restitution)
    return path


def test_every_table_has_the_numbers_of_the_study(study, tmp_path):
    """CSV, Excel, MATLAB and netCDF hold the same modes and peaks, to the last digit."""
    modes, peaks = study.results["mode"], study.results["peak_ratio"]
    rows = list(csv.DictReader(io.StringIO(_written(study, "csv", tmp_path).read_text())))
    assert [int(row["mode"]) for row in rows] == modes.ravel().tolist()
    assert [float(row["peak_ratio"]) for row in rows] == peaks.ravel().tolist()
    sheet = openpyxl.load_workbook(_written(study, "xlsx", tmp_path))["histories"]
    head, *cells = sheet.iter_rows(values_only=True)
    assert [row[head.index("mode")] for row in cells] == modes.ravel().tolist()
    found = loadmat(_written(study, "mat", tmp_path), simplify_cells=True)["campaign"]
    assert np.array_equal(found["results"]["peak_ratio"], peaks)
    with h5netcdf.File(_written(study, "nc", tmp_path)) as file:
        assert np.array_equal(file["peak_ratio"][...], peaks)


def test_parquet_is_written(study, tmp_path):
    """A table for data frames, where pyarrow is there."""
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(_written(study, "parquet", tmp_path))
    assert table["mode"].to_pylist() == study.results["mode"].ravel().tolist()


def test_the_job_file_gives_the_same_study(study, tmp_path):
    """The command line takes the TOML and has the same histories, told by their key."""
    path = _written(study, "toml", tmp_path)
    assert tomllib.loads(path.read_text())["campaign"]["name"] == NAME
    assert Job.read(path).study.histories.key() == study.job.campaign.key


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_pictures_are_inert(kind, study, tmp_path):
    """A picture is one, and no script, event or address stands in its SVG."""
    first, second = (_written(study, kind, tmp_path, restitution=k).read_bytes() for k in (0, 1))
    assert first != second
    if kind == "png":
        assert first.startswith(b"\x89PNG")
        return
    for element in ET.fromstring(first).iter():
        assert element.tag.rpartition("}")[2] not in {"script", "foreignObject", "iframe"}
        assert not [name for name in element.attrib if name.lower().startswith("on")]
        links = [value for name, value in element.attrib.items() if name.endswith("href")]
        assert all(link.startswith(("#", "data:image/png")) for link in links)


def test_names_are_no_formulas(computed, map_job,
                               tmp_path):  # fmt: skip
    """A name that a spreadsheet would run is text in every cell of CSV and Excel."""
    study = computed(map_job(2, campaign={"name": NAME, "kind": "overturning-map"}))
    rows = csv.reader(io.StringIO(_written(study, "csv", tmp_path).read_text()))
    assert not [cell for row in rows for cell in row if cell[:1] in set("=+@\t\r")]
    book = openpyxl.load_workbook(_written(study, "xlsx", tmp_path))
    assert not [cell for sheet in book for row in sheet.iter_rows() for cell in row if cell.data_type == "f"]


@pytest.fixture
def stripes(computed, map_job):
    pulses = [f"sine:amplitude=1,period={p}" for p in (0.4, 0.5, 0.7, 0.9, 1.2)]
    fragility = {"levels": [2.0, 4.0, 6.0, 8.0], "states": []}
    campaign = {"name": NAME, "kind": "stripes"}
    tables = {"fragility": fragility, "motions": {"pulse": pulses}, "restitution": {"values": [0.98, 0.4]}}
    return computed(map_job(campaign=campaign, map=None, **tables))


def test_fragility_goes_to_openquake(stripes, tmp_path):
    """NRML is well formed, names the states, and is of the restitution that was asked for."""
    first, second = (_written(stripes, "xml", tmp_path, restitution=k).read_bytes() for k in (0, 1))
    root = ET.fromstring(first)
    assert root.tag == "{http://openquake.org/xmlns/nrml/0.5}nrml"
    assert b"<script>" not in first
    assert first != second


@pytest.mark.parametrize("what", ["fragility", "fema-p58"])
def test_curves_are_tables(what, stripes, tmp_path):
    """The parameters of the curves are written where they are asked for."""
    assert "overturned" in _written(stripes, "csv", tmp_path, what, 1).read_text()


def test_fragility_has_a_picture(stripes, tmp_path):
    """As a map has."""
    assert _written(stripes, "png", tmp_path).read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("kind", "what", "restitution", "error"),
    [
        ("xml", None, 0, Refused), ("csv", "fragility", 0, Refused), ("csv", "../../x", 0, Refused),
        ("csv", None, 9, NotFound), ("png", None, -1, NotFound),
    ],
)  # fmt: skip
def test_what_a_map_does_not_have_is_refused(kind, what, restitution, error, study, tmp_path):
    """A map has no fragility, no other restitution, and no file of any other name; no path is told."""
    with pytest.raises(error) as caught:
        _written(study, kind, tmp_path, what, restitution)
    assert str(tmp_path) not in str(caught.value)


def test_every_format_has_a_type():
    """None is sent as a page."""
    assert set(get_args(Kind)) == {"nc", "csv", "mat", "xlsx", "parquet", "toml", "png", "svg", "xml"}
    assert all("html" not in MEDIA_TYPES[kind] for kind in get_args(Kind))
