"""What finished studies tell of their results, against the Python calls of the same."""

import base64
import json
import re

import numpy as np
import pytest

import rocking as rk
from rocking.studies import SyntheticSet, overturning_map, rocking_spectrum
from rocking.studies.fragility import fragility_analysis, model_of
from rocking_workbench.answers import JsonAnswer
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits
from rocking_workbench.studies.answers import MapResult
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.studies.results import contours_of, packed, plain, result_of
from rocking_workbench.work import Remembered

BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)


@pytest.fixture(scope="module")
def result(computed, map_job):
    """Return a function that gives the result of a job as a browser reads it; no number in it is not finite."""

    def refuse(name):
        raise AssertionError(name)

    def of(kind="overturning-map", count=6, **tables):
        own = {"map": None} if kind != "overturning-map" else {}
        study = computed(map_job(count, campaign={"name": "x", "kind": kind}, **own, **tables))
        return json.loads(bytes(JsonAnswer(result_of(study)).body), parse_constant=refuse)

    return of


def test_a_map_is_the_map_of_python(result):
    """Every number of every restitution is that of the Python call, to the last digit."""
    answer = result(count=8)
    assert answer["restitutions"] == ["ked", "housner"]
    x, y = (("frequency_ratio", "amplitude_ratio")[k] for k in (0, 1))
    axes = {side: np.array(answer[side]["values"]) for side in "xy"}
    assert answer["x"]["name"] == x
    for place, label in enumerate(answer["restitutions"]):
        expected = overturning_map(BLOCK, PULSE, (x, axes["x"]), (y, axes["y"]), label)
        for key, name in {"mode": "mode", "outcome": "outcome", "impacts": "impacts", "peak": "peak_ratio"}.items():
            assert answer[key][place] == plain(expected[name].values)
        assert sum(each["count"] for each in answer["shares"][place]) == 64
    assert answer["mode"][0] != answer["mode"][1]


def unpacked(table):
    """Return the numbers of a packed table."""
    values = np.frombuffer(base64.b64decode(table["base64"]), np.dtype(table["kind"]).newbyteorder("<"))
    return values.reshape(table["shape"])


def test_large_maps_come_as_bytes(result, monkeypatch):
    """The same numbers, peaks in single precision, in fewer letters; what is small is told as it was."""
    plainly = result(count=8)
    monkeypatch.setattr("rocking_workbench.studies.results._PACKED", 100)
    answer = result(count=8)
    whole = {"id": "", "name": "", "kind": "overturning-map", **answer}
    MapResult.model_validate_json(json.dumps(whole))
    for key in ("outcome", "mode", "impacts"):
        assert unpacked(answer[key]).tolist() == plainly[key]
        assert answer[key]["kind"] in {"uint8", "int8"}
    peak = np.array(plainly["peak"], dtype=float)
    assert unpacked(answer["peak"]) == pytest.approx(peak, rel=1e-7, nan_ok=True)
    assert {key: answer[key] for key in ("x", "y", "shares")} == {key: plainly[key] for key in ("x", "y", "shares")}
    for values, kind in (([0, 255], "uint8"), ([-3, 127], "int8"), ([-3, 200], "int16"), ([0, 300], "uint16"),
                         ([-3, 1_000_000], "int32")):  # fmt: skip
        table = packed(np.resize(values, (1, 10, 10)))
        assert table["kind"] == kind
        assert np.unique(unpacked(table)).tolist() == values


def test_maps_over_other_axes(result):
    """Where there is no such block the peak is null and the mode says so; an axis may be the restitution."""
    failed = result(map={
        "x": {"axis": "semi_diagonal", "values": [0.5, 2.0]}, "y": {"axis": "width", "values": [0.5, 1.5]},
    })  # fmt: skip
    assert failed["peak"][0][1][0] is None
    assert failed["mode"][0][1][0] == -3
    assert failed["mode_words"]["-3"] == "not computed"
    over = {"x": {"axis": "restitution", "values": [0.6, 0.7, 0.8]}, "y": {"axis": "pga", "values": [4.0, 8.0]}}
    answer = result(map=over, restitution={"model": "ked"})
    assert np.shape(answer["mode"]) == (1, 2, 3)
    assert answer["x"]["name"] == "restitution"


def test_adaptive_studies_have_tables(result, map_job):
    """The points and polylines of an adaptive map come with it, each column with its unit; minima are tables alone."""
    refined = result(restitution={"model": "ked"}, map={**map_job()["map"], "refine": 1})
    assert set(refined["tables"]) == {"refined", "boundary"}
    assert all({"name", "unit", "description", "values"} == set(column) for column in refined["tables"]["boundary"])
    assert set(result("minimum-acceleration", minimum={"samples": 20})["tables"]) == {"crossings", "minima"}


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


def test_spectra_are_those_of_python(result):
    """The curves of one motion are the peaks of the Python call, null where the block overturned."""
    table = {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 4.0, 8.0]}
    curves = result("rocking-spectrum", body=None, spectrum=table)["curves"]
    expected = rocking_spectrum(PULSE, table["slenderness_angles"], table["periods"], "housner")
    (mine,) = (one for one in curves if one["restitution"] == "housner" and one["angle"] == 0.3)
    modes, peaks = expected["mode"].values[0, 1], expected["peak_ratio"].values[0, 1]
    assert mine["median"] == plain(np.where(modes >= 0, np.nan, peaks))
    assert mine["overturned"] == (modes >= 0).astype(float).tolist()
    assert mine["coefficient"] == pytest.approx([1.0 - 1.5 * np.sin(0.3) ** 2] * 3)


def test_fragility_is_that_of_python(result):
    """Counts, medians, intervals and verdicts are those of the Python call; bands hold their curves.

    Where curves cross, the page has those that are exported, the reason, and the verdict of each state alone.
    """
    levels = [2.0, 4.0, 6.0, 8.0, 10.0]
    answer = result(
        "stripes", fragility={"levels": levels, "limit_states": [0.5]}, restitution={"model": "ked"},
        motions={"synthetic": "pulse-like", "count": 20, "seed": 7},
    )  # fmt: skip
    expected = fragility_analysis(BLOCK, SyntheticSet("pulse-like", 20, 7), levels, "ked", limit_states=(0.5,))
    (mine,) = answer["analyses"]
    exported = model_of(expected, "block")
    assert exported.shared
    assert mine["adjusted"] == exported.adjusted
    for curve in exported.curves:
        fit = expected.fits[curve.state]
        assert mine["fits"][curve.state]["median"] == curve.median != fit.median
        assert mine["fits"][curve.state]["median_95"] == [None, None]
        assert (
            mine["curves"][curve.state]["probability"] == curve.probability(mine["curves"][curve.state]["x"]).tolist()
        )
        assert mine["verdicts"][curve.state] == fit.verdict_in("m/s2")
    assert set(mine["common"]) == set(exported.shared)
    one = result(
        "stripes", fragility={"levels": levels, "limit_states": ["overturning"]}, restitution={"model": "ked"},
        motions={"synthetic": "pulse-like", "count": 20, "seed": 7},
    )["analyses"][0]  # fmt: skip
    fit = expected.fits["overturned"]
    assert one["fits"]["overturned"]["median"] == fit.median
    assert one["fits"]["overturned"]["median_95"] == fit.summary()["median_95"]
    assert one["verdicts"] == {"overturned": fit.verdict_in("m/s2")}
    assert one["common"] == []
    assert one["adjusted"] == ""
    assert mine["points"]["overturned"]["reached"] == expected.counts["overturned"].tolist()
    banded = [curve for curve in mine["curves"].values() if curve["low"] is not None]
    assert all((np.array(each["low"]) <= np.array(each["probability"]) + 1e-12).all() for each in banded)
    assert mine["trials"] == [20] * 5


@pytest.mark.parametrize(
    ("kind", "fragility", "own"),
    [
        ("cloud", {"im": "pgv"}, {"regression"}),
        ("incremental", {"levels": [2.0, 4.0, 8.0, 12.0]}, {"first_crossings", "resurrection", "intervals"}),
    ],
)
def test_other_analyses_have_their_own(kind, fragility, own, result):
    """A cloud has its points and its line, an incremental analysis its first crossings."""
    pulses = [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0, 6.0) for p in (0.4, 0.7, 0.9)]
    analyses = result(kind, fragility=fragility, motions={"pulse": pulses})["analyses"]
    assert [one["restitution"] for one in analyses] == ["ked", "housner"]
    assert own <= set(analyses[0])


def test_plain_histories_are_counted(result):
    """Each count is what a direct simulation of every motion says."""
    pulses, scales = ["sine:amplitude=1,period=0.6", "sine:amplitude=1,period=1.2"], [1.0, 4.0, 9.0]
    answer = result("histories", motions={"pulse": pulses}, histories={"scales": scales}, restitution={"value": 0.9})
    for place, scale in enumerate(scales):
        ends = [rk.simulate(BLOCK, rk.pulses.pulse(words), 0.9, scale=scale).outcome.name for words in pulses]
        assert answer["cells"]["overturned"][0][0][place] == ends.count("OVERTURNED")
        assert answer["cells"]["lifted"][0][0][place] == 2 - ends.count("NO_UPLIFT")
    assert np.shape(answer["mode"]) == (1, 2, 1, 3)


@pytest.mark.parametrize("kind", ["stripes", "incremental", "minimum-acceleration"])
def test_lost_contact_stands_beside_the_verdicts(kind, result):
    """Pulses of many g tear the body off the ground, in every kind of study; weak ones do not, and nothing is said."""
    pulses = ["sine:amplitude=3,period=0.6", "sine:amplitude=3,period=0.8"]

    def answer(low, high):
        own = {"fragility": {"levels": [low, high]}} if kind != "minimum-acceleration" else {
            "minimum": {"samples": 20, "bisections": 1, "min_pga": low, "max_pga": high}
        }  # fmt: skip
        return result(kind, motions={"pulse": pulses}, **own)

    assert answer(2.0, 2.2)["contact"] == ""
    torn = answer(30.0, 60.0)
    words = torn["contact"]
    assert torn["messages"][words]["facts"]
    lost, of = map(int, re.findall(r"\d+", words)[:2])
    (share,) = map(float, re.findall(r"\(([\d.]+) %\); their results", words))
    assert 0 < lost <= of
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
