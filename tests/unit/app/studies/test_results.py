"""What the browser is told of finished studies, against the Python calls that compute the same."""

import json
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.app.answers import JsonAnswer
from rocking.app.studies.opened import OpenStudies, OpenStudy
from rocking.app.studies.results import contours_of, plain, result_of
from rocking.studies._overturning_map import overturning_map
from rocking.studies._rocking_spectrum import rocking_spectrum
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_analysis
from rocking.studies.motion_sets import SyntheticSet

Tables = dict[str, Any]
BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)


def _json(study: OpenStudy) -> Any:
    """Return the result as a browser reads it; no number in it is not finite."""

    def refuse(name: str) -> None:
        raise AssertionError(name)

    return json.loads(bytes(JsonAnswer(result_of(study)).body), parse_constant=refuse)


def test_a_map_is_the_map_of_python(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> None:
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


def test_cells_that_failed_have_no_number(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """Where there is no such block the peak is null, and the mode says so in words."""
    x, y = {"axis": "semi_diagonal", "values": [0.5, 2.0]}, {"axis": "width", "values": [0.5, 1.5]}
    told = _json(computed(map_job(map={"x": x, "y": y})))
    assert told["peak"][0][1][0] is None
    assert told["mode"][0][1][0] == -3
    assert told["mode_words"]["-3"] == "not computed"


def test_an_axis_may_be_the_restitution(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """A map over the coefficient has one sheet, and its axis has that name."""
    x, y = {"axis": "restitution", "values": [0.6, 0.7, 0.8]}, {"axis": "pga", "values": [4.0, 8.0]}
    told = _json(computed(map_job(map={"x": x, "y": y}, restitution={"model": "ked"})))
    assert np.shape(told["mode"]) == (1, 2, 3)
    assert told["x"]["name"] == "restitution"


def test_a_refined_map_has_its_boundary(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """The points and polylines of an adaptive map come with it, each column with its unit."""
    job = map_job(6, restitution={"model": "ked"})
    job["map"]["refine"] = 1
    told = _json(computed(job))
    assert set(told["tables"]) == {"refined", "boundary"}
    assert all({"name", "unit", "words", "values"} == set(column) for column in told["tables"]["boundary"])


def test_contours_part_what_overturns() -> None:
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


def test_spectra_are_those_of_python(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> None:
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


def test_fragility_is_that_of_python(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> None:
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
def test_other_analyses_have_their_own(
    kind: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """A cloud has its points and its line, an incremental analysis its first crossings."""
    fragility = {"measure": "pgv"} if kind == "cloud" else {"levels": [2.0, 4.0, 8.0, 12.0]}
    pulses = [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0, 6.0) for p in (0.4, 0.7, 0.9)]
    job = map_job(campaign={"name": "x", "kind": kind}, map=None, fragility=fragility, motions={"pulse": pulses})
    told = _json(computed(job))
    assert [one["restitution"] for one in told["analyses"]] == ["ked", "housner"]
    own = {"regression"} if kind == "cloud" else {"first_crossings", "resurrection", "intervals"}
    assert own <= set(told["analyses"][0])


def test_plain_histories_are_counted(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> None:
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


def test_minimum_accelerations_are_tables(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """What an adaptive search found comes as tables."""
    job = map_job(campaign={"name": "x", "kind": "minimum-acceleration"}, map=None, minimum={"points": 20})
    assert set(_json(computed(job))["tables"]) == {"crossings", "minima"}


@pytest.mark.parametrize("kind", ["stripes", "incremental", "minimum-acceleration"])
def test_lost_contact_stands_beside_the_verdicts(
    kind: str, computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
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


def test_what_was_looked_at_is_kept_until_it_is_deleted(
    computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]
) -> None:
    """A study is opened once and an answer made once; a deleted study leaves nothing behind."""
    study, kept, made = computed(map_job(3)), OpenStudies(), []

    def make() -> bytes:
        made.append(1)
        return b"x"

    assert kept.get(study.folder) is kept.get(study.folder)
    assert kept.answer((study.id, "result"), make) == kept.answer((study.id, "result"), make) == b"x"
    assert made == [1]
    kept.forget(study.id)
    assert kept.known((study.id, "result")) is None


def test_memory_is_bounded(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> None:
    """Answers beyond 64 MiB push the oldest out."""
    kept = OpenStudies()
    for number in range(5):
        kept.answer((f"{number}", "result"), lambda: bytes(20 * 2**20))
    assert kept.known(("0", "result")) is None
    assert kept.known(("4", "result")) is not None
