"""Tangent dynamics of plane responses: derivatives by start and parameters against twins and independent programs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.dynamics.impact_laws import ImpactLaw, SpeedRestitution
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.plane.tangent import tangent_of
from rocking.motions.pulse import Sinusoids
from rocking.motions.segments import Segments

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="rocking in the plane")]
ENGINES = ("fast", "reference")
BLOCK = rk.Block(width=1.0, height=4.0)
LEANING = rk.MassPoints([[-0.4, 0.0], [0.6, 0.0], [0.25, 2.2], [0.1, 3.0]], [1.0, 1.0, 2.0, 1.0], feet=(-0.4, 0.6))


@pytest.fixture(autouse=True)
def _no_doubts(recwarn):
    """Contact forces are of no interest here."""


def formula(strength, length=20.0):
    """Return strength x sum sin(2 pi f t + i^2), f = 0.25 + 0.3 i Hz, i = 1 ... 10 [g]."""
    waves = tuple((strength * 9.81, 2.0 * math.pi * (0.25 + 0.3 * i), float(i * i)) for i in range(1, 11))
    return Sinusoids("sum of sines", waves, length, strength * 98.1, strength, 1.0)


def of_formula(strength, restitution, engine):
    """Return the response of the table of growth."""
    start = 0.3 * BLOCK.slenderness_angle
    options = {"gravity": 9.81, "duration": 20.0, "engine": engine, "rest_speed": 0.0}
    return rk.simulate(BLOCK, formula(strength), restitution, rotation=start, **options)


# strength, r: impacts, rotation, velocity / p, matrix in rotation and velocity / p, largest singular value
GROWTH = {
    (0.05, 0.9): (
        25, -0.0055873963856, 0.0264750571694, [[587.8254438, 209.0548626], [2262.889365, 804.7763759]], 2481.44635,
    ),
    (0.06, 31.0 / 34.0): (
        27, -0.0291590528680, -0.0358387301202, [[7.537782407, 2.976277026], [11.96556061, 4.725480176]], 15.20464376,
    ),
}  # fmt: skip


@pytest.mark.verifies("computed anew", "an independent program in Taylor series and DOP853", within="1e-9")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("case", GROWTH)
def test_growth_on_a_record(case, engine):
    """Ten digits of the matrix over 20 s and 25 impacts, and the product of the impacts' determinants."""
    impacts, rotation, velocity, matrix, largest = GROWTH[case]
    response = of_formula(*case, engine)
    tangent = response.tangent()
    p = tangent.frequency_parameter
    assert len(response.impacts) == impacts
    assert response.rotation[-1] == pytest.approx(rotation, abs=1e-11)
    assert response.angular_velocity[-1] / p == pytest.approx(velocity, abs=1e-11)
    assert tangent.by_start[-1] * [[1.0, p], [1.0 / p, 1.0]] == pytest.approx(np.array(matrix), rel=1e-9)
    assert tangent.growth[-1] == pytest.approx(largest, rel=1e-9)
    assert tangent.growth_rate[-1] == pytest.approx(math.log(largest) / 20.0, rel=1e-9)
    assert tangent.determinants.prod() == pytest.approx(case[1] ** (2 * impacts), rel=1e-13)
    assert np.linalg.det(tangent.by_start[-1]) == pytest.approx(tangent.determinants.prod(), rel=1e-6)


@pytest.mark.verifies("negative control", "the matrix of another record and coefficient")
def test_growth_depends_on_the_impacts():
    """Negative control: with another coefficient the matrix of the table is rejected."""
    tangent = of_formula(0.05, 0.899, "fast").tangent()
    assert abs(tangent.growth[-1] / 2481.44635 - 1.0) > 0.01


class Quadratic(ImpactLaw):
    """A law of its own, r = 0.95 - 0.1 v^2."""

    largest = 0.95

    def factor(self, speed, stream, impact):
        """Return the coefficient."""
        return 0.95 - 0.1 * min(speed, 2.0) ** 2


BY_SPEED = SpeedRestitution(at=[0.0, 4.0], factors=[1.0, 0.6], times=0.9)
RESTITUTIONS = ({"left": 0.8, "right": 0.9}, BY_SPEED, Quadratic())


def again(response, **changes):
    """Return the state at the last sample of the response with a change."""
    first = response.trajectory
    start = {"rotation": float(first.rotation[0]), "velocity": float(first.angular_velocity[0])}
    options = {"scale": response.scale, "stream": response.stream, "engine": "reference"} | start | changes
    parts = [options.pop(name, getattr(response, name)) for name in ("parameters", "segments", "settings")]
    twin = run(*parts, **options)
    return np.array([twin.rotation[-1], twin.angular_velocity[-1]])


def sides(response, **changes):
    """Return the parameters with a change of both sides."""
    return replace(
        response.parameters,
        **{
            foot: replace(side, **{name: getattr(side, name) + change for name, change in changes.items()})
            for foot in ("right", "left")
            for side in [getattr(response.parameters, foot)]
        },
    )


def differences(response, step=1e-7):
    """Return derivatives of the last state by central differences: two of the start, then four parameters.

    Two steps, extrapolated: where a difference grows 7,000 times, one step leaves an error of 2e-3.
    """
    first, segments = response.trajectory, response.segments
    scale = max(abs(response.scale), 1e-9)
    changes = [
        lambda d: {"rotation": float(first.rotation[0]) + d},
        lambda d: {"velocity": float(first.angular_velocity[0]) + d},
        lambda d: {"scale": response.scale + d * scale},
        lambda d: {"segments": Segments(segments.step / (1.0 + d), segments.horizontal, segments.vertical)},
        lambda d: {"parameters": sides(response, coefficient=d)},
        lambda d: {"parameters": sides(response, slenderness_angle=d)},
    ]
    coarse, fine = (
        [(again(response, **change(size)) - again(response, **change(-size))) / (2.0 * size) for change in changes]
        for size in (3.0 * step, step)
    )
    columns = [(9.0 * near - far) / 8.0 for near, far in zip(fine, coarse, strict=True)]
    end = response.time[-1]  # at a higher frequency the last sample comes earlier
    columns[3] += end * np.array([response.angular_velocity[-1], response.dense_output.acceleration[-1, 1]])
    return np.column_stack(columns)


def derivatives(tangent):
    """Return the derivatives of the last state in the order of `differences`."""
    return np.column_stack([tangent.by_start[-1], *(values[-1] for values in tangent.by_parameter.values())])


@pytest.mark.verifies("computed anew", "central differences", within="2e-5")
@settings(max_examples=15, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.sampled_from(RESTITUTIONS), st.booleans(), st.booleans(), st.sampled_from(ENGINES),
    st.floats(-0.12, 0.12), st.floats(0.02, 0.25),
)  # fmt: skip
def test_derivatives_are_those_of_twins(seed, law, linear, smooth, engine, rotation, strength):
    """Records with a vertical component and smooth pulses, bodies that are not symmetric, all laws, both engines."""
    random = np.random.default_rng(seed)
    if smooth:
        motion = formula(strength / 3.0, 3.0)
    else:
        horizontal, vertical = random.normal(scale=strength * 9.81, size=(2, 61)) * [[1.0], [0.3]]
        motion = rk.GroundMotion(horizontal, 0.05, vertical=vertical)
    if isinstance(law, Quadratic):
        engine = "reference"
    options = {"engine": engine, "linear": linear, "duration": 3.0, "rest_speed": 0.0}
    response = rk.simulate(LEANING, motion, law, rotation=rotation, angular_velocity=0.02, **options)
    assume(response.outcome.name == "ROCKED" and np.isfinite(response.rotation[-1]))
    before = np.abs(response.impacts["velocity_before"])
    assume(before.size and before.min() > 0.05 and len(response.uplifts) < 2)
    own, twins = derivatives(response.tangent()), differences(response)
    assert own == pytest.approx(twins, rel=2e-5, abs=2e-5 * np.abs(twins).max())


@pytest.mark.verifies("invariant", "the product of r d(r v)/dv over the impacts", within="1e-9")
@pytest.mark.parametrize("law", RESTITUTIONS)
def test_determinants(law):
    """The determinant at each sample is the product over the impacts before it, also where r depends on speed."""
    response = rk.simulate(
        LEANING, formula(0.05, 6.0), law, rotation=0.1, rest_speed=0.0, duration=6.0, engine="reference"
    )
    tangent = response.tangent()
    impacts = np.searchsorted(response.impacts["time"], tangent.time, side="right")
    products = np.append(1.0, np.cumprod(tangent.determinants))[impacts]
    assert impacts[-1] > 4
    errors = np.linalg.det(tangent.by_start) - products
    assert np.abs(errors).max() < 1e-13 * np.abs(tangent.by_start).max() ** 2 * 100.0
    constant = response.impacts["coefficient"] ** 2
    is_constant = np.abs(tangent.determinants / constant - 1.0).max() < 1e-12
    assert is_constant == isinstance(law, dict)  # control: r^2 is wrong for r(v)


@pytest.mark.verifies("computed anew", "central differences", within="1e-5")
@pytest.mark.parametrize("engine", ENGINES)
def test_after_a_rest_only_parameters_count(engine):
    """A pulse lifts the body from rest: no derivative by the start, those by parameters as of twins."""
    restitution, options = {"left": 0.8, "right": 0.85}, {"engine": engine, "duration": 0.8}
    response = rk.simulate(LEANING, rk.pulses.sine(3.6, 0.5), restitution, **options)
    options = {"engine": engine, "duration": 2.2, "rotation": 0.02}
    response_after = rk.simulate(LEANING, formula(0.12, 3.0), 0.3, **options)
    for item in (response, response_after):
        assert item.outcome.name == "ROCKED"
        own = derivatives(item.tangent())
        assert np.abs(own[:, 2:]).max() > 0.01
        assert own[:, 2:] == pytest.approx(differences(item)[:, 2:], rel=2e-5, abs=1e-5)
    rested = response_after.tangent()
    first_rest = np.flatnonzero(response_after.trajectory.rotation == 0.0)[0]
    assert np.all(rested.by_start[first_rest:] == 0.0)
    assert np.all(np.isneginf(rested.growth_rate[first_rest:]))


@pytest.mark.verifies("negative control", "a law without its slope")
def test_the_slope_of_the_law_counts():
    """Negative control: with r in place of d(r v)/dv the derivatives are not those of twins."""
    response = rk.simulate(LEANING, formula(0.05, 3.0), BY_SPEED, rotation=0.1, rest_speed=0.0, duration=3.0)
    twins = differences(response)[:, :2]
    flat = replace(response, parameters=replace(response.parameters, law=SpeedRestitution([0.0, 4.0], [1.0, 1.0])))
    assert tangent_of(response).by_start[-1] == pytest.approx(twins, rel=1e-5, abs=1e-6)
    assert np.abs(tangent_of(flat).by_start[-1] / twins - 1.0).max() > 0.01


def until(duration, amplitude=1.3):
    """Return a sine of 3 p that ends after a duration; amplitude over g alpha."""
    side = BLOCK.side("right", 9.81)
    peak = amplitude * 9.81 * side.slenderness_angle
    wave = (peak, 3.0 * side.frequency_parameter, 0.0)
    return Sinusoids("sine", (wave,), duration, peak, amplitude, 1.0)


@pytest.mark.verifies("computed anew", "an independent program of 40 digits", within="1e-13")
def test_the_first_peak_by_the_amplitude():
    """The derivative of the first peak of a slender body under a sine, 0.236936097334396549 alpha."""
    side = BLOCK.side("right", 9.81)
    time = 1.0114154702946756 / side.frequency_parameter
    options = {"linear": True, "gravity": 9.81, "engine": "reference", "duration": time}
    response = rk.simulate(BLOCK, until(time), 0.9, **options)
    assert response.angular_velocity[-1] == pytest.approx(0.0, abs=1e-14)
    derivative = -response.tangent().by_parameter["amplitude"][-1, 0] / (1.3 * side.slenderness_angle)
    assert derivative == pytest.approx(0.236936097334396549, rel=1e-13)


@pytest.mark.verifies("computed anew", "an independent program of 40 digits", within="1e-12")
@pytest.mark.parametrize("engine", ENGINES)
def test_the_boundary_of_overturning_by_restitution_and_frequency(engine):
    """At the boundary of one impact the unstable coordinate is zero; its derivatives give those of the amplitude."""
    side = BLOCK.side("right", 9.81)
    alpha, p = side.slenderness_angle, side.frequency_parameter
    boundary = 1.403565355642782661
    options = {"linear": True, "gravity": 9.81, "duration": 2.5 / p, "engine": engine}
    response = rk.simulate(BLOCK, until(2.0 * math.pi / (3.0 * p), boundary), 0.9, **options)
    assert len(response.impacts) == 1
    rotation, velocity = response.rotation[-1], response.angular_velocity[-1]
    assert abs(rotation) + abs(velocity) / p * np.sign(rotation * velocity) == pytest.approx(alpha, rel=1e-12)
    by = {name: values[-1] @ [1.0, 1.0 / p] for name, values in response.tangent().by_parameter.items()}
    by_amplitude = by["amplitude"] / boundary
    assert -by["restitution"] / by_amplitude == pytest.approx(-0.429631378847441066, rel=1e-12)
    assert -by["frequency"] / 3.0 / by_amplitude == pytest.approx(0.2495290741040314, rel=1e-12)


@pytest.mark.verifies("second engine", "twins of the engine with friction", within="1e-4")
def test_twins_with_friction_measure_the_same_change():
    """The relative change of a rotation by a change of 1e-6 in scale, through impacts with large friction."""
    motion, coefficients = formula(0.05, 3.0), {"left": 0.8, "right": 0.85}
    options = {"rotation": 0.1, "duration": 3.0}
    response = rk.simulate(LEANING, motion, coefficients, rest_speed=0.0, **options)
    ends = [
        rk.simulate(LEANING, motion, coefficients, friction=10.0, scale=1.0 + d, **options).rotation[-1]
        for d in (1e-6, -1e-6)
    ]
    own = response.tangent().by_parameter["amplitude"][-1, 0]
    assert own == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-4)


@pytest.mark.verifies("second engine", "peaks of the engine with friction whose motions differ by 1e-6", within="1e-3")
@pytest.mark.parametrize("strength", [1.6, 2.5])
def test_the_relative_change_of_the_peak(strength):
    """The change of the peak over that of the motion, of a body from rest; control: by the frequency."""
    body, time = rk.Block(width=5.0, height=20.0), np.arange(0.0, 8.0, 0.002)
    waves = sum(np.sin(2.0 * np.pi * (0.5 + 0.4 * i) * time + i * i) for i in range(4))
    motion, coefficients = rk.GroundMotion(strength * 1.3734 * waves, 0.002), {"left": 0.9, "right": 0.9}
    response = rk.simulate(body, motion, coefficients)
    options = {"friction": 10.0}
    peaks = [rk.simulate(body, motion, coefficients, scale=1.0 + d, **options).peak_rotation for d in (1e-6, -1e-6)]
    twins = abs(peaks[0] - peaks[1]) / (2e-6 * response.peak_rotation)
    tangent = response.tangent()
    answer = tangent.answer()
    assert len(response.impacts) > 30
    assert answer["relative_change"] == pytest.approx(twins, rel=1e-3)  # the peak of the tangent is that of a sample
    peak = np.argmax(np.abs(response.rotation))
    by_frequency = abs(tangent.by_parameter["frequency"][peak, 0] / response.rotation[peak])
    assert abs(by_frequency / twins - 1.0) > 0.05
    assert "growth_rate" not in answer  # at rest no difference of the start remains


@pytest.mark.verifies("computed anew", "central differences", within="1e-4")
@pytest.mark.parametrize("engine", ENGINES)
def test_growth_of_the_answer(engine):
    """The largest growth of a released body, its time and rate; without a motion no change of the peak by it."""

    p = BLOCK.frequency_parameter

    def free(rotation, velocity=0.0):
        options = {"angular_velocity": velocity * p, "rest_speed": 0.0, "duration": 4.0, "engine": engine}
        return rk.free_rocking(BLOCK, rotation=rotation, restitution=0.9, **options)

    response = free(0.1)
    answer = response.tangent().answer()
    at, d = np.searchsorted(response.time, answer["growth_time"]), 1e-7
    twins = [(free(0.1 + d), free(0.1 - d)), (free(0.1, d), free(0.1, -d))]
    columns = [
        [(high.rotation[at] - low.rotation[at]), (high.angular_velocity[at] - low.angular_velocity[at]) / p]
        for high, low in twins
    ]
    growth = np.linalg.norm(np.array(columns) / (2.0 * d), 2)
    assert growth > 3.0
    assert np.exp(answer["growth_rate"] * answer["growth_time"]) == pytest.approx(growth, rel=1e-4)
    assert "relative_change" not in answer
    fallen = rk.simulate(BLOCK, rk.pulses.sine(9.0, 1.0), 0.9)
    assert fallen.outcome.name == "OVERTURNED"
    assert not fallen.tangent().answer().values  # from rest, and a fallen body has no peak
