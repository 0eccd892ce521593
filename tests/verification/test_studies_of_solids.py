"""Bodies in space with friction at every door: what the reference engine gives one by one, and what is known."""

import json
import math
import re

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.conventions import g
from rocking.dynamics import HullSettings, SpatialBody, SpatialStart
from rocking.dynamics.batch import Batch
from rocking.dynamics.frictional.restitution import RestitutionOnHull
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.rows import Rows
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.errors import InvalidValueError
from rocking.outcome import UNCOUNTED, Outcome, Status
from rocking.studies import MotionList, Product, minimum_overturning_acceleration, overturning_map, rocking_spectrum
from rocking.studies.fragility import fragility_analysis

pytestmark = pytest.mark.verifies(room="rocking in space")

PULSE = rk.pulses.sine(amplitude=3.0, period=0.5)
BOTH = {"x": PULSE, "y": rk.pulses.ricker(amplitude=2.0, period=0.4)}
# a pedestal and an eccentric block on it: no symmetry
STATUE = Solid([Part(box(0.5, 0.7, 0.9), 2400.0), Part(box(0.3, 0.2, 0.5), 1500.0).moved(0.06, 0.1, 0.9)])
PLANE = rk.Block(width=1.0, height=4.0)
SHORT = Solid(Part(box(0.6, 0.5, 0.7), 2000.0))
BASE_ALONE = SpatialBody(
    1.0, np.array([0.0, 0.0, 1.0]), np.eye(3), 0.2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine, one history at a time", within="1e-6")
def test_a_cell_is_its_history():
    """Every cell of a batch is the history of `simulate`, of a body without symmetry under two components."""
    frictions, scales = [0.25, 0.7], [0.8, 2.2]
    found = rk.simulate_many(STATUE, BOTH, "ked", friction=frictions, scale=scales)
    for i, j in ((0, 0), (1, 1)):
        cell = found.isel(body=0, motion=0, restitution=0, start=0, scale=i, friction=j)
        one = rk.simulate(STATUE, BOTH, "ked", friction=frictions[j], scale=scales[i])
        assert int(cell.outcome) == one.outcome.code
        assert int(cell.pose) == one.pose
        assert float(cell.peak_tilt) == pytest.approx(one.peak_tilt, rel=1e-6, abs=1e-9)
        assert float(cell.sliding_distance) == pytest.approx(one.sliding_distance, rel=1e-6, abs=1e-7)
    assert len(set(found.outcome.values.ravel().tolist())) > 1


@pytest.mark.verifies("closed form", "a body slides before it rocks where friction is below tan alpha", within="exact")
def test_sliding_before_rocking():
    """A motion that grows from nothing first slides a box at mu g, or lifts it at g tan alpha; the control: both."""
    tangent = 0.5 / 1.6
    tower = SpatialBody.box(0.5, 0.6, 1.6)
    levels, frictions = np.array([0.19, 0.21, 0.3, 0.33]) * g / PULSE.peak, [0.2, 0.9]
    found = rk.simulate_many(tower, PULSE, "housner", friction=frictions, scale=levels).squeeze()
    for level, row in zip(levels * PULSE.peak / g, found.outcome.values, strict=True):
        for mu, outcome in zip(frictions, row, strict=True):
            if level < min(mu, tangent):
                assert outcome == Outcome.NO_UPLIFT.code
            elif mu < tangent:
                assert outcome == Outcome.SLID.code
            else:
                assert outcome in {Outcome.ROCKED.code, Outcome.OVERTURNED.code, Outcome.ROCKED_AND_SLID.code}
    assert set(found.sliding_distance.values[-1] > 1e-3) == {True, False}


@pytest.mark.verifies("closed form", "Coulomb friction under a constant acceleration, and its stop", within="1e-6")
def test_the_distance_of_a_box_that_slides():
    """Ground at a = 2 m/s2 for T, then at rest, with mu g = 1: it slides (a - mu g) a T^2 / (2 mu g) back."""
    mu, pull, duration = 1.0 / g, 2.0, 0.5
    response = rk.simulate(SHORT, rk.pulses.rectangular(pull, duration), "housner", friction=mu)
    expected = (pull - 1.0) * duration**2 / 2.0 + ((pull - 1.0) * duration) ** 2 / 2.0
    assert response.outcome is Outcome.SLID
    assert response.sliding_distance == pytest.approx(expected, rel=1e-6)
    assert response.at(response.end).centre[0, 0] == pytest.approx(-expected, rel=1e-6)
    assert rk.simulate(SHORT, rk.pulses.rectangular(pull, duration), "housner", friction=0.3).sliding_distance == 0.0


@pytest.mark.verifies("second engine", "the engine of flat bases, without friction", within="1e-6")
def test_rough_ground_is_today():
    """A box on rough ground swings as with the engine that never slides; on smooth ground it does not."""
    tower, start = SpatialBody.box(0.5, 0.6, 1.6), SpatialStart(0.1, 0.0)
    held = rk.free_rocking(tower, restitution="housner", start=start, duration=1.0)
    rough, smooth = (
        rk.free_rocking(tower, restitution="housner", start=start, friction=mu, duration=1.0) for mu in (1e3, 0.1)
    )
    assert rough.impacts["time"][0] == pytest.approx(held.impacts["time"][0], rel=1e-9)
    ratio = rough.impacts["energy_after"] / rough.impacts["energy_before"]
    known = held.impacts["energy_after"] / held.impacts["energy_before"]
    assert ratio[:2] == pytest.approx(known[:2], rel=1e-6)
    times = np.linspace(0.0, 0.9, 30)
    assert np.abs(rough.at(times).quaternion - held.at(times).quaternion).max() < 1e-7
    assert np.abs(smooth.at(times).quaternion - held.at(times).quaternion).max() > 1e-3


@pytest.mark.verifies("behaviour")
def test_a_response_is_its_states():
    """At ends of steps the response is the engine's own state, between them its rates are those of its places."""
    response = rk.simulate(STATUE, BOTH, friction=0.4, scale=1.5)
    history = response.trajectory
    states = response.at(history.time)
    last = np.append(np.diff(history.time) > 0.0, True)  # at an event the state after it
    assert states.quaternion[last] == pytest.approx(np.array([s.attitude for s in history.states])[last], abs=1e-12)
    assert states.centre_velocity[last] == pytest.approx(np.array([s.velocity for s in history.states])[last], abs=1e-9)
    middle = 0.5 * (np.array(history.time[1:]) + np.array(history.time[:-1]))
    wide = np.diff(history.time) > 1e-3
    h = 1e-5
    rate = (response.at(middle[wide] + h).centre - response.at(middle[wide] - h).centre) / (2.0 * h)
    assert response.at(middle[wide]).centre_velocity == pytest.approx(rate, abs=1e-6)
    assert response.tilt.max() <= response.peak_tilt + 1e-9
    data = response.to_xarray()
    assert {"tilt", "touching", "sliding", "centre_x"} <= set(data)
    assert data.attrs["setting_friction"] == 0.4
    rocked = rk.simulate(STATUE, BOTH, friction=0.8, scale=2.5)
    assert rocked.impacts.size > 10
    for name in ("time", "energy_before", "energy_after"):
        np.testing.assert_array_equal(rocked.to_xarray()[f"impact_{name}"], rocked.impacts[name])
    ends = [stop for _, stop, *_ in response.intervals]
    assert ends == sorted(ends)


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_threads_and_order_do_not_matter():
    """Other threads, another order of the rows, another order of the bodies: the same bits."""
    bodies, scales = [STATUE, SHORT], [0.7, 1.4, 2.1]
    ask = {"restitution": "ked", "friction": [0.3, 0.6]}
    one = rk.simulate_many(bodies, BOTH, scale=scales, threads=1, **ask)
    other = rk.simulate_many(bodies[::-1], BOTH, scale=scales[::-1], threads=2, **ask)
    for name in ("peak_tilt", "sliding_distance", "outcome", "end_time"):
        assert np.array_equal(one[name].values, other[name].values[::-1, :, ::-1], equal_nan=True)


@pytest.mark.slow
@pytest.mark.verifies("damage")
@pytest.mark.parametrize("engine", ["fast", "reference"])
def test_a_bad_row_touches_no_other(engine):
    """A body known by its base alone, and a start that is none, have a status; the others keep their bits."""
    ask = {"restitution": "housner", "friction": 0.3, "engine": engine}
    clean = rk.simulate_many(SHORT, PULSE, **ask)
    found = rk.simulate_many([BASE_ALONE, SHORT], PULSE, start=[SpatialStart(), SpatialStart(math.nan)], **ask)
    status = found.status.values[:, 0, 0, 0, 0]
    assert status.tolist() == [[Status.INVALID.code] * 2, [Status.GOOD.code, Status.INVALID.code]]
    assert np.isnan(found.overturned.values).sum() == 3
    for name in ("peak_tilt", "sliding_distance", "end_time"):
        assert found[name].values[1, 0, 0, 0, 0, 0] == clean[name].item()
    assert "a base but no hull" in json.loads(found.attrs["refused"])["0"]


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("how", "says"),
    [
        ({"friction": -0.1}, "friction must be in"),
        ({"friction": 2e6}, "friction must be"),
        (
            {"friction": 0.3, "normal_restitution": 0.2},
            "normal_restitution does not apply to a body in space with friction",
        ),
        ({"friction": 0.3, "order": 6}, "order does not apply to a body in space with friction"),
        ({"friction": 0.3, "linear": True}, "linear does not apply to a body in space with friction"),
        (
            {"friction": 0.3, "restitution": "horizontal-momentum-3d"},
            "must be 'housner-3d', 'ked-3d', 'calibrated-3d' or",
        ),
        ({"friction": 0.3, "restitution": 1.2}, "restitution must be in"),
    ],
)
def test_refusals(how, says):
    """What cannot be meant is refused in one sentence, of one history as of many."""
    for ask in (rk.simulate, rk.simulate_many):
        with pytest.raises(InvalidValueError, match=says):
            ask(SHORT, PULSE, **how)


@pytest.mark.verifies("damage")
def test_a_body_of_known_moments_has_no_ked():
    """Of a body whose mass, centre and inertia are stated, KED does not know where the mass is."""
    known = Solid(box(0.5, 0.6, 1.6), mass=300.0, centre=(0.02, 0.0, 0.7))
    with pytest.raises(InvalidValueError, match="distribution of mass"):
        rk.simulate(known, PULSE, "ked", friction=0.4)
    assert rk.simulate(known, PULSE, "housner", friction=0.2).outcome is Outcome.SLID


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_commands(tmp_path, answered):
    """The option of the command gives what Python gives; a picture and a table are written."""
    text = 'units = "m"\n[[solid.part]]\nbox = { width = 0.6, depth = 0.5, height = 0.7 }\ndensity = 2000\n'
    (tmp_path / "body.toml").write_text(text)
    out = [f"picture={tmp_path / 'a.png'}", f"csv={tmp_path / 'a.csv'}", tmp_path / "a.html"]
    words = ["simulate", tmp_path / "body.toml", "sine:amplitude=3,period=0.5", "--friction", "0.2"]
    told = answered(*words, *(word for file in out for word in ("--output", file)))
    one = rk.simulate(SHORT, PULSE, friction=0.2)
    assert told["outcome"] == "slid"
    assert told["sliding_distance"] == pytest.approx(one.sliding_distance, rel=1e-9)
    assert (tmp_path / "a.png").stat().st_size > 1000
    assert "friction 0.2" in (tmp_path / "a.html").read_text()
    assert (tmp_path / "a.csv").read_text().startswith("time [s],quaternion_s")


# ---- studies --------------------------------------------------------------------------------------------------------


def _same(cell, one):
    """A cell of a study and the history of `simulate`; a fall is a quarter turn in studies."""
    assert int(cell.outcome) == one.outcome.code
    fell = one.outcome is Outcome.OVERTURNED
    assert float(cell.peak_rotation) == pytest.approx(0.5 * math.pi if fell else one.peak_tilt, rel=1e-6, abs=1e-8)
    assert int(cell["mode"]) == (UNCOUNTED if fell else -2 if one.outcome.code in {0, 4} else -1)
    if fell:
        assert float(cell.overturning_time) == pytest.approx(one.overturning_time, rel=1e-5)


@pytest.mark.verifies("second engine", "the reference engine, one history at a time", within="1e-6")
def test_a_map_is_its_single_histories():
    """Cell by cell, two components of unequal length, time stretched for both, a body without symmetry."""
    periods, scales = [0.4, 0.8], [1.0, 4.0]
    found = overturning_map(STATUE, BOTH, ("period", periods), ("scale", scales), "housner", friction=0.8)
    for i, j in ((0, 1), (1, 1)):
        slow = periods[j] / 0.5
        longer = {"x": rk.pulses.sine(3.0, periods[j]), "y": rk.pulses.ricker(2.0, 0.4 * slow)}
        _same(found.isel(scale=i, period=j), rk.simulate(STATUE, longer, "housner", scale=scales[i], friction=0.8))
    assert len(set(found["mode"].values.ravel().tolist())) > 1


@pytest.mark.verifies("second engine", "the reference engine on a body of the size itself", within="1e-6")
def test_size_friction_and_restitution_are_axes():
    """A body of another size is the body itself scaled; friction and coefficient are those of each row."""
    sizes, frictions = [0.4, 1.2], [0.25, 0.8]
    found = overturning_map(STATUE, BOTH, ("semi_diagonal", sizes), ("friction", frictions), 0.9)
    size = SpatialBody.of(STATUE).size
    for i, j in ((0, 0), (1, 1)):
        one = rk.simulate(STATUE.scaled(size=sizes[j] / size), BOTH, 0.9, friction=frictions[i])
        _same(found.isel(semi_diagonal=j, friction=i), one)
    drawn = overturning_map(STATUE, BOTH, ("restitution", [0.7, 0.95]), ("scale", [2.2]), friction=0.8)
    _same(drawn.isel(scale=0, restitution=0), rk.simulate(STATUE, BOTH, 0.7, scale=2.2, friction=0.8))
    peaks = drawn.peak_rotation.values.ravel()
    assert peaks[0] != peaks[1]


@pytest.mark.verifies("second engine", "the reference engine under components turned by hand", within="1e-6")
def test_azimuth_is_an_axis():
    """A motion turned from x towards y has a part along y; turned the other way it is another motion."""
    angles, turns = [0.0, 0.7, 2.4, 3.9], [0.8, 3.4]
    found = overturning_map(STATUE, PULSE, ("azimuth", angles), ("scale", turns), "housner", friction=0.8)
    for j, angle in enumerate(angles):
        parts = {"x": PULSE.scaled(math.cos(angle)), "y": PULSE.scaled(math.sin(angle))}
        _same(found.isel(azimuth=j, scale=1), rk.simulate(STATUE, parts, "housner", scale=3.4, friction=0.8))
    wrong = {"x": PULSE.scaled(math.cos(0.7)), "y": PULSE.scaled(-math.sin(0.7))}
    other = rk.simulate(STATUE, wrong, "housner", scale=3.4, friction=0.8)
    assert float(found.peak_rotation.isel(azimuth=1, scale=1)) != pytest.approx(other.peak_tilt, rel=1e-3)
    with pytest.raises(InvalidValueError, match="azimuth varies only for a 3D body"):
        overturning_map(PLANE, PULSE, ("azimuth", angles), ("scale", turns))


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the engine of flat bases, without friction", within="1e-6")
def test_without_friction_nothing_slides():
    """A study that is told no friction has the peaks and falls of `simulate` without friction while contact holds."""
    scales = [1.9, 2.6, 3.0]
    ask = (STATUE, BOTH, ("scale", scales), ("period", [0.5]), "housner")
    found = overturning_map(*ask)
    peaks = [rk.simulate(STATUE, BOTH, "housner", scale=scale).peak_tilt for scale in scales]
    assert found.peak_rotation.values.ravel() == pytest.approx(peaks, rel=1e-6)
    assert found.attrs["setting_friction"] == NEVER_SLIDES
    assert overturning_map(*ask, friction=0.3).peak_rotation.values.ravel() != pytest.approx(peaks, rel=1e-2)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "histories on both sides of the minimum", within="1e-3")
def test_the_minimum_is_where_the_verdict_changes():
    """Just below the least acceleration `simulate` stands, just above it falls; little friction needs no less."""
    found = minimum_overturning_acceleration(STATUE, BOTH, friction=0.8, samples=30, bisections=1, tolerance=1e-6)
    scale = found.minimum / 3.0
    verdicts = [rk.simulate(STATUE, BOTH, friction=0.8, scale=s * scale).outcome for s in (0.999, 1.001)]
    assert verdicts[0] is not Outcome.OVERTURNED
    assert verdicts[1] is Outcome.OVERTURNED
    assert set(found.modes[found.modes >= 0].tolist()) == {UNCOUNTED}
    smooth = minimum_overturning_acceleration(STATUE, BOTH, friction=0.05, samples=12, max_pga=20.0, bisections=0)
    assert smooth.minimum is None
    assert smooth.failed == 0


@pytest.mark.slow
@pytest.mark.verifies("second engine", "`simulate_many` over the same motions", within="exact")
def test_fragilities():
    """Stripes, cloud and incremental analysis count the verdicts of `simulate_many`, of motions of two components."""
    motions = [{"x": rk.pulses.sine(1.0, period), "y": rk.pulses.sine(0.6, 1.3 * period)} for period in (0.4, 0.7, 1.0)]
    levels = [2.0, 5.0, 8.0]
    found = fragility_analysis(STATUE, motions, levels, friction=0.7)
    many = rk.simulate_many(STATUE, motions, friction=0.7, scale=levels)
    fell = many.overturned.values[0, :, :, 0, 0, 0]
    assert np.array_equal(found.responses.overturned.reshape(fell.shape), fell)
    assert 0 < fell.sum() < fell.size
    assert found.uplift.threshold is None
    assert (
        fragility_analysis(STATUE, motions, scale=5.0, friction=0.7, analysis="cloud").responses.overturned.sum()
        == fell[:, 1].sum()
    )
    smooth = fragility_analysis(STATUE, motions, levels, friction=0.05)
    assert not (smooth.responses.overturned > 0.0).any()
    ida = fragility_analysis(STATUE, motions[:2], levels, friction=0.7, analysis="incremental")
    assert np.array_equal(ida.responses.overturned.reshape(2, 3), fell[:2])


@pytest.mark.verifies("damage")
def test_a_bad_row_of_a_study_touches_no_other():
    """A row with NaN or infinity in one number is refused by itself, in any number of threads the same bits."""
    settings = study_settings(STATUE, {"friction": 0.4})
    parameters = mechanics_of(settings).parameters(STATUE, "housner", settings)
    sides = {name: float(values[0]) for name, values in sides_of([parameters]).items()}
    values = {name: np.full(40, value) for name, value in sides.items()}
    values |= {"scale": np.linspace(0.5, 3.0, 40), "friction": np.full(40, 0.4)}
    batch = Batch([PULSE.segments()], parameters.law, settings)
    clean, _ = batch.run(40, Rows.of(40, **values).part, threads=1)
    ill = np.arange(1, 40, 3)
    names = ("scale", "friction", "p_right", "r_right", "alpha_right")
    for k, row in enumerate(ill):
        values[names[k % len(names)]][row] = (np.nan, np.inf)[k % 2] if k % len(names) != 1 else np.inf
    values["r_right"][ill[3]] = 1.5
    found, _ = batch.run(40, Rows.of(40, **values).part, threads=2)
    refused = np.array([k for k in ill if names[(k - 1) // 3 % 5] not in {"friction", "alpha_right"}])
    assert (found["status"][refused] == Status.INVALID.code).all()
    fine = np.setdiff1d(np.arange(40), ill)
    for name in ("peak_rotation", "impacts", "outcome", "overturning_time"):
        assert np.array_equal(found[name][fine], clean[name][fine], equal_nan=True)


@pytest.mark.verifies("behaviour")
def test_the_name_of_histories_knows_the_body():
    """Studies that differ in the shape alone, the model or the friction have other names."""
    names = set()
    for body, model, mu in [(STATUE, "ked", 0.5), (SHORT, "ked", 0.5), (STATUE, "housner", 0.5), (STATUE, "ked", 0.6)]:
        settings = HullSettings(gravity=g, friction=mu)
        parameters = mechanics_of(settings).parameters(body, model, settings)
        sides = {name: np.array([[0.4]]) for name in sides_of([parameters])}
        names.add(Product(MotionList([BOTH]), sides, np.ones(1), law=parameters.law, settings=settings).key())
    assert len(names) == 4
    assert isinstance(parameters.law, RestitutionOnHull)


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda: overturning_map(SHORT, PULSE, ("width", [1.0]), ("period", [0.5]), friction=0.3), "only for a Block"),
        (lambda: overturning_map(PLANE, BOTH, ("scale", [1.0]), ("period", [0.5])), "along x and z only, got y"),
        (lambda: minimum_overturning_acceleration(BASE_ALONE, PULSE, "housner", friction=0.3), "a base but no hull"),
        (lambda: minimum_overturning_acceleration(SHORT, PULSE, None, friction=0.3), "restitution"),
        (lambda: fragility_analysis(PLANE, [BOTH, BOTH], [1.0]), "along x and z only, got y"),
        (lambda: rocking_spectrum(SHORT, [0.2], [1.0]), "must be ground motions or pulses, got Solid"),
        (lambda: rocking_spectrum(BOTH, [0.2], [1.0]), "along x and z only, got y"),
    ],
)
def test_refusals_of_studies(ask, says):
    """What a study of a body in space cannot do is said in one sentence."""
    with pytest.raises(InvalidValueError, match=says):
        ask()


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_commands_of_studies(tmp_path, answered):
    """A map and a minimum of the command line, and of a job file, are those of Python; pictures are drawn."""
    body = "[[solid.part]]\nbox = { width = 0.5, depth = 0.6, height = 1.2 }\ndensity = 2000\n"
    (tmp_path / "body.toml").write_text(f'units = "m"\n{body}')
    tall = Solid(Part(box(0.5, 0.6, 1.2), 2000.0))
    words = [tmp_path / "body.toml", "sine:amplitude=3,period=0.5", "--friction", "0.6"]
    out = ["--output", f"picture={tmp_path / 'map.png'}"]
    told = answered("map", *words, "--x", "scale=1:4:4", "--y", "period=0.4:0.8:3", *out)
    grid = overturning_map(tall, PULSE, ("scale", [1, 2, 3, 4]), ("period", [0.4, 0.6, 0.8]), friction=0.6)
    assert told["mode"] == grid["mode"].values.tolist()
    assert (tmp_path / "map.png").stat().st_size > 1000
    least = answered("overturning-pga", *words, "--samples", "20", "--bisections", "0")["minimum_acceleration"]
    python = minimum_overturning_acceleration(tall, PULSE, friction=0.6, samples=20, bisections=0).minimum
    assert least == pytest.approx(python, rel=1e-9)


@pytest.fixture
def records(tmp_path):
    """Files of a statue without symmetry and of two motions of three components, and what Python makes of them."""
    parts = "[[solid.part]]\nbox = { width = 0.5, depth = 0.7, height = 0.9 }\ndensity = 2400\n"
    more = "[[solid.part]]\nbox = { width = 0.3, depth = 0.2, height = 0.5 }\ndensity = 1500\nat = [0.06, 0.1, 0.9]\n"
    (tmp_path / "statue.toml").write_text(f'units = "m"\n{parts}{more}')
    times, motions = np.arange(0.0, 1.5, 0.02), []
    for k, period in enumerate((0.6, 0.9)):
        both = {}
        for axis, size, slow in (("x", 2.0, 1.0), ("y", 1.6, 1.4), ("z", 1.0, 0.5)):
            values = size * np.sin(2.0 * np.pi * times / (slow * period))
            path = tmp_path / f"{axis}{k}.csv"
            np.savetxt(path, np.c_[times, values], "%.17g", ",", header="time [s],acceleration [m/s2]", comments="")
            both[axis] = rk.read_motion(path)
        motions.append(both)
    return tmp_path, motions


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_components_of_studies_in_files_and_commands(records, answered):
    """x, y and z of [[motions]], and of the option --motion, are the components that Python takes."""
    folder, motions = records
    body, (x, y, z) = folder / "statue.toml", (f"{axis}={folder / axis}0.csv" for axis in "xyz")
    axes = ("--x", "scale=2.8,3.2", "--y", "friction=0.3,0.8")
    told = answered("map", body, x, "--motion", y, "--motion", z, *axes)
    ask = (("scale", [2.8, 3.2]), ("friction", [0.3, 0.8]))
    python = overturning_map(STATUE, motions[0], *ask)
    assert told["peak_ratio"] == pytest.approx(python.peak_ratio.values, rel=1e-12)
    assert told["motion"]["name"] == "x0, y0, z0"
    alone = answered("map", body, x, *axes)
    assert alone["motion"]["name"] == "x0"
    assert alone["peak_ratio"] != pytest.approx(python.peak_ratio.values, rel=1e-3)

    job = "[body]\nfile = 'statue.toml'\n[map]\nx = { axis = 'scale', values = [1.4, 1.6] }\n"
    job += "y = { axis = 'friction', values = [0.3, 0.8] }\n[motions]\nscale = 2\nx = { record = 'x0.csv' }\n"
    job += "y = { record = 'y0.csv', scale = 1.0 }\nz = { record = 'z0.csv' }\n"
    (folder / "job.toml").write_text(job)
    assert answered("map", folder / "job.toml")["peak_ratio"] == told["peak_ratio"]
    (folder / "job.toml").write_text(job.replace("scale = 1.0", "scale = 0.5"))
    assert answered("map", folder / "job.toml")["peak_ratio"] != told["peak_ratio"]


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_fragilities_of_components_in_files_and_commands(records, answered):
    """An axis that is named again begins the next motion; a campaign of the job file has the numbers of Python."""
    folder, motions = records
    words = [f"{axis}={folder / axis}{k}.csv" for k in (0, 1) for axis in "xy"]
    pairs = [{axis: motion[axis] for axis in "xy"} for motion in motions]
    levels, how = [3.0, 6.0, 9.0], ("--friction", "0.7", "--levels", "3,6,9")
    told = answered("fragility", folder / "statue.toml", *words, *how)
    found = fragility_analysis(STATUE, pairs, levels, friction=0.7)
    assert told["motions"]["names"] == ["x0, y0, none", "x1, y1, none"]
    fell = found.responses.overturned.sum(axis=0).ravel().tolist()
    assert told["results"][0]["reached"]["overturned"] == fell
    assert 0 < sum(fell) < 6
    crossed = [words[0], words[3], words[2], words[1]]
    names = answered("fragility", folder / "statue.toml", *crossed, *how)["motions"]["names"]
    assert names == ["x0, y1, none", "x1, y0, none"]
    job = "[campaign]\nname = 'a'\nkind = 'stripes'\n[body]\nfile = 'statue.toml'\n[settings]\nfriction = 0.7\n"
    job += "[fragility]\nlevels = [3, 6, 9]\n"
    for k in (0, 1):
        job += f"[[motions]]\nx = {{ record = 'x{k}.csv' }}\ny = {{ record = 'y{k}.csv' }}\n"
    (folder / "job.toml").write_text(job)
    assert answered("fragility", folder / "job.toml")["results"] == told["results"]


@pytest.mark.verifies("damage")
@pytest.mark.parametrize(
    ("motions", "says"),
    [
        ("x = { record = 'x0.csv' }\nrecords = 'y0.csv'", "Give records separately for the motions along x, y and z"),
        ("x = { record = 'x0.csv', vertical = 'UP' }\nz = { record = 'z0.csv' }", "vertical motion appears twice"),
        ("x = { records = 'x0.csv' }", "unknown key"),
        ("x = { record = 'x0.csv' }\ny = { record = 'gone.csv' }", "motions\\[0\\]: y: gone.csv"),
    ],
)
def test_components_that_are_refused(records, run, motions, says):
    """What components cannot be is said in one sentence."""
    folder, _ = records
    job = "[body]\nfile = 'statue.toml'\n[settings]\nfriction = 0.7\n[minimum]\n[[motions]]\n"
    (folder / "job.toml").write_text(job + motions)
    code, _, err = run("overturning-pga", folder / "job.toml")
    assert code == 2
    assert re.search(says, err)


LIST = """name,width_cm,depth_cm,height_cm,centre_of_mass_height_cm,friction,body_file,units
plane,20,30,90,40,,,
smooth,20,30,90,40,0.1,,
rough,20,30,90,40,1e6,,
statue,,,,,0.2,statue.toml,
held,,,,,,statue.toml,
gone,,,,,,gone.stl,mm
both,20,30,90,,,statue.toml,
negative,20,30,90,,-1,,
"""


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the plane engine, and `simulate_many` of the body itself", within="exact")
def test_an_inventory_of_solids(records, answered):
    """A box on rough ground falls as often as its rectangle, a smooth one slides; bad rows are told and touch none."""
    folder, motions = records
    pairs = [rk.motions.scaled_to(both["x"], "pga", 7.0) for both in motions]
    (folder / "list.csv").write_text(LIST)
    found = rk.inventory(folder / "list.csv", pairs)
    row = {str(name): k for k, name in enumerate(found.object.values)}
    fell, slid = (found[name].values[0] for name in ("overturned", "slid"))
    assert fell[row["rough"]].tolist() == fell[row["plane"]].tolist()
    assert fell[row["rough"]].sum() > 0
    assert fell[row["smooth"]].tolist() == [0, 0]
    assert slid[row["smooth"]].tolist() == [2, 2]
    assert found.uplift_acceleration.values[row["smooth"]] == pytest.approx(0.1 * g, rel=1e-12)
    assert found.uplift_acceleration.values[row["rough"]] == pytest.approx(g * 0.1 / 0.4, rel=1e-9)
    for j, axis in enumerate("xy"):
        one = rk.simulate_many(STATUE, [{axis: motion} for motion in pairs], friction=0.2)
        assert (
            slid[row["statue"], j]
            == np.isin(one.outcome.values, [Outcome.SLID.code, Outcome.ROCKED_AND_SLID.code]).sum()
        )
        assert fell[row["statue"], j] == (one.overturned.values > 0).sum()
    assert slid[row["held"]].sum() == 0
    assert found.not_assessed.values.tolist() == ["gone", "both"]  # a friction that cannot be is left aside, and said
    assert ["no such file" in found.reason.values[0], "Clear" in found.reason.values[1]] == [True, True]

    clean = "\n".join(line for line in LIST.splitlines() if line.split(",")[0] not in {"gone", "both"})
    (folder / "clean.csv").write_text(clean)
    alone = rk.inventory(folder / "clean.csv", pairs)
    assert np.array_equal(alone.high_rotation.values, found.high_rotation.values)

    words = ("inventory", folder / "list.csv", "--motion", folder / "x0.csv", "--pga", "7m/s2")
    told = {one["name"]: one for one in answered(*words)["objects"]}
    assert [one["slid"] for one in told["smooth"]["directions"]] == [1, 1]
    assert told["plane"]["friction"] is None
    sliding = {one["name"]: one for one in answered(*words, "--friction", "0.1")["objects"]}
    assert [one["slid"] for one in sliding["plane"]["directions"]] == [1, 1]
    assert sliding["rough"]["directions"] == told["rough"]["directions"]
    job = (
        "[inventory]\nobjects = 'list.csv'\npga = '7m/s2'\n[settings]\nfriction = 0.1\n[motions]\nrecords = 'x0.csv'\n"
    )
    (folder / "job.toml").write_text(job)
    assert {one["name"]: one for one in answered("inventory", folder / "job.toml")["objects"]} == sliding
