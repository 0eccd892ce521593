"""POST /api/response: numbers of the library, and thinned curves that keep what can be seen."""

import json
import math

import numpy as np
import pytest
from web_clients import refusal

import rocking as rk
from rocking import conventions
from rocking_workbench.api.response import thinned

BODY = {"units": "cm", "width": 50, "height": 200, "depth": 40, "density": 700, "name": "cabinet"}
BLOCK = rk.Block(width=50 * 0.01, height=200 * 0.01, depth=40 * 0.01, density=700.0)
PULSE = {"pulse": "sine:amplitude=3.2,period=0.8"}
MOTION = rk.pulses.sine(3.2, 0.8)


def asked(client, **changes):
    """Answer to a question about the cabinet."""
    document = {"body": BODY, "motion": PULSE, "restitution": {"models": ["ked", "housner"]}, **changes}
    answer = client.post("/api/response", json=document)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_each_restitution_has_an_answer_in_order(client):
    """Models, values and parameters are answered in the order they were chosen, with the library's own numbers."""
    found = asked(client, restitution={"models": ["ked", "0.97*housner"], "values": [0.9]})["answers"]
    for answer, choice in zip(found, ("ked", "0.97*housner", 0.9), strict=True):
        response = rk.simulate(BLOCK, MOTION, choice)
        assert answer["peak_rotation"] == response.peak_rotation
        assert [each["time"] for each in answer["impacts"]] == response.impacts["time"].tolist()
        assert answer["summary"] == response.summary
    assert [answer["label"] for answer in found] == ["ked", "0.97*housner", "0.9"]


# an asymmetric body: left and right differ in slenderness, in size and in what an impact costs
LEANING = {"units": "m", "trapezoid": {"base": 0.5, "top": 0.3, "height": 1.8, "lean": 0.1}}


def rattled(steps):
    """Text of a record of white noise for 20 s, at rest afterwards."""
    noise = np.random.default_rng(7).normal(scale=1.6, size=steps)
    return "".join(f"{20.0 * k / steps:.5f},{a:.9f}\n" for k, a in enumerate([0.0, *noise, 0.0])).encode()


def shaken(client):
    """A record that the server has, and its answer for the leaning body under KED."""
    sent = client.post(
        "/api/records", params={"name": "noise.csv"}, content=rattled(1000),
        headers={"Content-Type": "application/octet-stream"},
    )  # fmt: skip
    motion = {"record": sent.json()["record"], "units": "m/s2"}
    return lambda **more: asked(client, body=LEANING, motion=motion, restitution={"models": ["ked"]}, **more)


def test_curves_have_impacts_and_extremes(client):
    """Impacts more than a dot apart have the states before and after them; the peak that is drawn is the peak, between
    the samples too."""
    response = rk.simulate(BLOCK, MOTION, "ked")
    impacts = response.impacts[:8]
    assert np.diff(impacts["time"]).min() > 0.5
    answer = asked(client, points=20)["answers"][0]
    series = answer["series"]
    time, rotation, velocity = (np.array(series[name]) for name in ("time", "rotation", "angular_velocity"))
    assert np.all(np.diff(time) > 0.0)
    assert time.size <= 20 * (2 + 2 * 9)
    at = np.searchsorted(time, impacts["time"])
    assert np.array_equal(time[at], impacts["time"])
    assert not rotation[at].any()
    assert np.array_equal(velocity[at], impacts["velocity_before"])
    assert np.abs(rotation).max() == pytest.approx(response.peak_rotation, rel=1e-9)
    assert np.abs(response.rotation).max() < response.peak_rotation * (1.0 - 1e-8)  # no sample stands there
    whole = np.array(asked(client, points=2000)["answers"][0]["series"]["angular_velocity"])
    after = np.flatnonzero(np.isin(whole, impacts["velocity_after"]))
    assert after.size >= impacts.size
    assert {len(values) for values in series.values() if isinstance(values, list)} == {time.size}


@pytest.mark.parametrize("points", [30, 300])
def test_every_dot_has_the_extremes_of_every_curve(client, points):
    """Of a rattled leaning body each curve is drawn, in each dot, from its least to its largest value, gaps as gaps."""
    ask = shaken(client)
    whole, thin = (ask(points=k)["answers"][0]["series"] for k in (2000, points))
    assert whole["samples_shown"] == whole["samples"] > 1.2 * thin["samples_shown"]
    dot, drawn_in = (np.array(one["time"]) / whole["time"][-1] * points // 1 for one in (whole, thin))
    for name in set(whole) - {"time", "ground_displacement", "samples_shown", "samples"}:
        full, drawn = (np.array(one[name], dtype=float) for one in (whole, thin))
        assert np.isnan(full).any() <= np.isnan(drawn).any(), name
        for k in range(points):
            assert np.array_equal(extremes(full[dot == k]), extremes(drawn[drawn_in == k]), equal_nan=True), (name, k)


def extremes(values):
    """Least and largest of what is a number."""
    return (np.nan, np.nan) if np.isnan(values).all() else (np.nanmin(values), np.nanmax(values))


def test_a_part_of_the_time_is_drawn_with_all_its_detail(client):
    """Between two times every sample is there, as the library has it; over more of them the dots are as fine again."""
    ask = shaken(client)
    window = [4.03, 5.21]
    part = ask(points=100, window=window)["answers"][0]["series"]
    time = np.array(part["time"])
    step = 20.0 / 1000
    inside = step * np.arange(math.ceil(window[0] / step), math.floor(window[1] / step) + 1)
    assert np.abs(time[np.searchsorted(time, inside - 1e-9)] - inside).max() < 1e-9
    assert (time[0], time[-1]) == (pytest.approx(window[0], abs=step), pytest.approx(window[1], abs=step))
    coarse = ask(points=100)["answers"][0]["series"]
    assert sum(window[0] <= t <= window[1] for t in coarse["time"]) < inside.size


@pytest.mark.parametrize("window", [[2.0, 1.0], [1.0, 1.0], [1.0], "all", [0.0, 1e400], [None, 3.0]])
def test_a_part_that_is_none_is_refused(client, window):
    """A window backwards, empty or infinite is refused by its name."""
    text = json.dumps({"body": BODY, "motion": PULSE, "window": window}).replace("Infinity", "1e400")
    answer = client.post("/api/response", content=text, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert "window" in answer.text or "float64" in answer.text


def test_energy_adds_up_at_every_point(client):
    """Kinetic, potential and lost energy less work are what there was at the start, at the impacts too."""
    series = asked(client, motion=None, response={"initial_rotation": 0.6}, points=200)["answers"][0]["series"]
    kinetic, potential, lost, work = (
        np.array(series[name]) for name in ("kinetic_energy", "potential_energy", "energy_lost", "work_of_ground")
    )
    stored = kinetic + potential
    assert np.abs(stored + lost - work - stored[0]).max() < 1e-9 * stored.max()
    assert np.all(np.diff(lost) >= -1e-9 * stored.max())


def test_state_before_an_impact_is_that_of_free_flight(client):
    """Before the first impact of a body let go, the kinetic energy is the potential that it had: nothing is lost."""
    answer = asked(client, motion=None, response={"initial_rotation": 0.6})["answers"][0]
    series, first = answer["series"], answer["impacts"][0]["time"]
    k = series["time"].index(first)
    assert series["energy_lost"][k] == 0.0
    assert math.isclose(series["kinetic_energy"][k], series["potential_energy"][0], rel_tol=1e-10)
    alpha, inertia = BLOCK.slenderness_angle, BLOCK.side("right").moment_of_inertia
    fall = BLOCK.mass * conventions.g * BLOCK.semi_diagonal * (math.cos(0.4 * alpha) - math.cos(alpha))
    assert math.isclose(series["kinetic_energy"][k], fall, rel_tol=1e-9)
    assert math.isclose(0.5 * inertia * series["angular_velocity"][k] ** 2, fall, rel_tol=1e-9)


def test_ground_displacement_is_that_of_the_pulse(client):
    """The ground moves as the formula of the scaled pulse says, and stays where the pulse ends."""
    answer = asked(client, motion={**PULSE, "scale": 0.9})
    series = answer["answers"][0]["series"]
    time = np.minimum(series["time"], 0.8)
    omega = 2.0 * math.pi / 0.8
    expected = 0.9 * 3.2 / omega * (time - np.sin(omega * time) / omega)
    assert np.allclose(series["ground_displacement"], expected, rtol=1e-9, atol=1e-12)
    assert answer["motion"]["scale"] == 0.9


def test_verdict_says_whether_the_model_decides(client):
    """r = 1 overturns under a pulse that r = 0.3 survives: the verdict says so; one value alone decides nothing."""
    answer = asked(client, restitution={"values": [1.0, 0.3]}, motion={"pulse": "sine:amplitude=3.2,period=1.2"})
    outcomes = {one["outcome"] for one in answer["answers"]}
    assert answer["verdict"]["decides"] is (len(outcomes) > 1)
    alone = asked(client, restitution={"value": 0.3})["verdict"]
    assert alone["decides"] is False
    assert alone["sentence"].startswith("The body ")


def test_headline_states_whether_the_input_states_the_model(client):
    """The default model has its reason; the same model in the request is stated."""
    default = asked(client, restitution={"models": ["calibrated", "ked", "housner"]})["verdict"]["headline"]
    stated = asked(client, restitution={"models": ["calibrated"]})["verdict"]["headline"]
    assert "calibrated. It is the default" in default
    assert stated.endswith("calibrated, as stated in the input.")


def test_a_restitution_that_creates_energy_has_an_error_of_its_own(client):
    """Where one choice has no response, the others still answer; where none has, the question is refused."""
    found = asked(client, restitution={"models": ["ked"], "values": [1.2]})["answers"]
    assert "would create energy" in found[1]["error"]
    refused = client.post("/api/response", json={"body": BODY, "motion": PULSE, "restitution": {"value": 1.2}})
    assert "would create energy" in refusal(refused)


REFUSED = {
    "nothing moves": ({"motion": None}, "No ground motion"),
    "both": ({"response": {"initial_rotation": 0.5}}, "not both"),
    "nan": ({"motion": {**PULSE, "scale": 1e400}}, "exceeds the range of float64"),
    "zero scale": ({"motion": {**PULSE, "scale": 0.0}}, "scale must not be 0"),
    "unknown key": ({"moton": PULSE}, "did you mean motion?"),
    "two sources": ({"motion": {**PULSE, "synthetic": "pulse-like"}}, "exactly one of pulse, record, synthetic"),
    "no such record": ({"motion": {"record": "0" * 64}}, "upload the file again"),
    "path": ({"motion": {"record": "../../etc/passwd"}}, "motion.record"),
    "file": ({"body": {"file": "/etc/passwd"}}, "cannot open files by name"),
    "dxf": ({"body": {"units": "m", "section": {"region": [{"dxf": "/etc/x.dxf"}]}}}, "cannot open files by name"),
    "geojson": ({"body": {"units": "m", "section": {"region": [{"geojson": "a.json"}]}}}, "cannot open files by name"),
    "model": ({"restitution": {"model": "best"}}, "unknown restitution model 'best'"),
    "model in a file": ({"restitution": {"model": "/tmp/x.py"}}, "unknown restitution model"),
    "drawn per history": (
        {"restitution": {"distribution": {"mean": 0.9, "deviation": 0.01, "each": "history"}}},
        'must be "impact"',
    ),
    "points": ({"points": 5}, "points"),
    "two bodies": ({"body": {**BODY, "block": {"width": 1, "height": 2}}}, "exactly one of"),
    "half a size": ({"body": {"units": "m", "width": 1}}, "height is missing"),
    "no unit": ({"body": {"width": 1, "height": 2}}, "units is missing"),
    "geometry": ({"body": {"units": "m", "section": {"region": [{"outline": [[0, 0], [1, 1], [1, 0], [0, 1]]}]}}}, ""),
    "text": ({"body": {**BODY, "width": "50"}}, "must be a number"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals_are_sentences(client, case):
    """What cannot be computed is refused with a 400-range status and one sentence that says what to do."""
    changes, words = REFUSED[case]
    text = json.dumps({"body": BODY, "motion": PULSE, **changes}).replace("Infinity", "1e400")
    answer = client.post("/api/response", content=text, headers={"Content-Type": "application/json"})
    assert answer.status_code in {404, 422}
    error = answer.json()["error"]
    assert words in error["message"]
    assert "Traceback" not in answer.text


def test_too_many_restitutions_are_refused(client):
    """More than 24 restitutions are too large a question, for the screen and a table alike; 24 are not."""
    for path in ("response", "table/impacts.csv"):
        document = {"body": BODY, "motion": PULSE, "restitution": {"values": [0.01 * k for k in range(25)]}}
        answer = client.post(f"/api/{path}", json=document)
        assert (answer.status_code, answer.json()["error"]["kind"]) == (413, "too-large")
        assert "up to 24 restitutions can be compared, got 25" in answer.json()["error"]["message"]
    assert len(asked(client, restitution={"values": [0.5 + 0.01 * k for k in range(24)]})["answers"]) == 24


def test_a_response_of_millions_of_samples_is_refused_in_words(client):
    """A body of ten thousand kilometres rocks for more samples than can be shown: told in a sentence."""
    body = {"units": "m", "width": 1e7, "height": 2.0}
    answer = client.post("/api/response", json={"body": body, "motion": PULSE, "restitution": {"value": 0.5}})
    assert "samples" in refusal(answer)


TIME = np.linspace(0.0, 30.0, 30_001)
WAVE = np.sin(7.0 * TIME) * np.exp(-0.1 * TIME)
NOISE = np.random.default_rng(1).normal(size=TIME.size)
GAPS = np.where((TIME * 3.0) % 2.0 < 0.3, np.nan, 1.0 / np.maximum(np.abs(WAVE), 1e-9))
ONE_SIDED = np.where(WAVE > 0.0, 0.03 * WAVE, 1.7 * WAVE)
CURVES = {"wave": (WAVE,), "both": (WAVE, NOISE), "gaps": (GAPS, ONE_SIDED)}


def by_dot(points, window=(0.0, 30.0)):
    """Of every sample the dot over which it is drawn."""
    first, last = window
    return np.clip((TIME - first) / (last - first) * points, -1, points).astype(int)


@pytest.mark.parametrize("curves", CURVES)
@pytest.mark.parametrize("points", [10, 57, 640, 2000])
def test_every_dot_covers_what_all_samples_would(curves, points):
    """Each curve has in each dot its least and largest value, its first and last, and a gap where it has one."""
    kept = thinned(TIME, CURVES[curves], points)
    assert np.all(np.diff(kept) > 0)
    assert kept.size <= points * (2 + 4 * len(CURVES[curves])) + 2
    dot, chosen = by_dot(points), np.isin(np.arange(TIME.size), kept)
    for curve in CURVES[curves]:
        for k in range(points):
            whole, drawn = curve[dot == k], curve[(dot == k) & chosen]
            assert np.array_equal(extremes(whole), extremes(drawn), equal_nan=True)
            assert np.isnan(whole).any() == np.isnan(drawn).any()
            assert np.array_equal(whole[[0, -1]], drawn[[0, -1]], equal_nan=True)


def test_a_spike_of_one_sample_stays_and_nothing_else_would_have_it():
    """A spike of one sample is drawn wherever it stands; negative controls, every nth sample and means, lose it."""
    for place in (0, 1, 12_347, 15_000, TIME.size - 1):
        spike = ONE_SIDED.copy()
        spike[place] = -9.0
        assert spike[thinned(TIME, (NOISE, spike), 600)].min() == -9.0
    assert spike[:-1:15].min() > -9.0
    assert spike[:-1].reshape(-1, 15).mean(axis=1).min() > -9.0


def test_a_short_curve_is_kept_whole():
    """Nothing is left out where there are no more than two samples for each dot."""
    assert thinned(TIME[:50], (WAVE[:50],), 25).tolist() == list(range(50))


def test_part_of_the_time_is_cut_out_with_its_neighbours():
    """Within a window all samples are there once they fit, and one on either side: lines reach its ends."""
    kept = thinned(TIME, (NOISE,), 600, (7.0002, 7.9998))
    assert kept.tolist() == list(range(7000, 8001))
    wide = thinned(TIME, (NOISE,), 600, (5.0, 15.0))
    assert (wide[0], wide[-1]) == (5000, 15_000)
    dot, chosen = by_dot(600, (5.0, 15.0)), np.isin(np.arange(TIME.size), wide)
    for k in range(600):
        assert extremes(NOISE[dot == k]) == extremes(NOISE[(dot == k) & chosen])
    assert thinned(TIME, (NOISE,), 600, (40.0, 50.0)).tolist() == [TIME.size - 1]


def test_equal_times_are_no_matter():
    """Two values at one time, as at a jump that is drawn upright, are both kept."""
    time = np.repeat(np.arange(5000.0), 2)
    jump = np.tile([0.0, 1.0], 5000)
    kept = thinned(time, (jump,), 100)
    assert {*jump[kept]} == {0.0, 1.0}
