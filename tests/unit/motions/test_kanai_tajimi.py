"""Kanai-Tajimi motions: variance and correlation against closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from rocking.errors import InvalidValueError
from rocking.motions.synthetic import Envelope, KanaiTajimi, kanai_tajimi_motion

pytestmark = pytest.mark.verifies(room="motions and records")

LAYER = KanaiTajimi(density=0.02, frequency=2.5, damping=0.6)
FLAT = Envelope(rise=0.0, plateau=0.0, decay=0.0)


def _statistics(step, statistic):
    """Mean and standard error over 24 independent motions of 200 s."""
    values = [
        statistic(kanai_tajimi_motion(LAYER, FLAT, seed=s, time_step=step, duration=200.0).acceleration)
        for s in range(24)
    ]
    return np.mean(values), np.std(values, ddof=1) / math.sqrt(len(values))


@pytest.mark.verifies(
    "repeated sampling", "pi S0 w (1 + 4 z^2) / (2 z)", within="4.0 standard errors", control="within"
)
@pytest.mark.parametrize("step", [0.02, 0.15])
def test_ensemble_variance_is_the_closed_form(step):
    """At fine and coarse steps the variance is pi S0 w (1 + 4 z^2) / (2 z); without the 4 z^2 it is not."""
    w = 5.0 * math.pi
    expected = math.pi * 0.02 * w * (1.0 + 4.0 * 0.36) / 1.2
    assert pytest.approx(expected, rel=1e-14, abs=0.0) == LAYER.variance
    mean, error = _statistics(step, lambda a: np.mean(a * a))
    assert error < 0.02 * expected
    assert abs(mean - expected) < 4.0 * error
    assert abs(mean - expected / (1.0 + 4.0 * 0.36)) > 20.0 * error


@pytest.mark.verifies("computed anew", "SciPy's quadrature of the spectrum", within="1e-6")
def test_spectrum_and_variance_belong_together():
    """The power spectral density integrates to the variance, over all circular frequencies of either sign."""
    total = quad(lambda f: 4.0 * math.pi * float(LAYER.power(np.array(f))), 0.0, math.inf, limit=500)[0]
    assert total == pytest.approx(LAYER.variance, rel=1e-6)


@pytest.mark.verifies(
    "repeated sampling", "the cosine transform of the spectrum, by SciPy", within="4.0 standard errors"
)
@pytest.mark.parametrize("lag", [1, 3, 8])
def test_correlation_in_time_is_that_of_the_spectrum(lag):
    """Products of samples a lag apart have the mean that the spectrum gives, by cosine transform, within 4 errors."""
    step = 0.02
    tau = lag * step
    tail = {"weight": "cos", "wvar": 2.0 * math.pi * tau}
    expected = quad(lambda f: 4.0 * math.pi * float(LAYER.power(np.array(f))), 0.0, math.inf, limlst=500, **tail)[0]
    mean, error = _statistics(step, lambda a: np.mean(a[:-lag] * a[lag:]))
    assert error < 0.03 * LAYER.variance
    assert abs(mean - expected) < 4.0 * error


def test_envelope_has_its_three_parts():
    """Parabola to the rise, 1 to the plateau's end, exponential beyond."""
    found = Envelope(2.0, 4.0, 0.5)(np.array([0.0, 1.0, 2.0, 4.0, 6.0]))
    np.testing.assert_allclose(found, [0.0, 0.25, 1.0, 1.0, math.exp(-1.0)], rtol=1e-15)


def test_envelope_multiplies_the_stationary_motion():
    """With the same seed, motions with and without an envelope differ by that factor alone."""
    envelope = Envelope(1.0, 3.0, 0.7)
    with_it = kanai_tajimi_motion(LAYER, envelope, seed=9, duration=8.0)
    without = kanai_tajimi_motion(LAYER, FLAT, seed=9, duration=8.0)
    np.testing.assert_allclose(
        with_it.acceleration, envelope(without.time) * without.acceleration, rtol=1e-14, atol=1e-300
    )


def test_bad_values_are_refused():
    """Density, damping, envelope and step have ranges."""
    with pytest.raises(InvalidValueError, match="density"):
        KanaiTajimi(density=0.0)
    with pytest.raises(InvalidValueError, match="damping"):
        KanaiTajimi(density=1.0, damping=1.0)
    with pytest.raises(InvalidValueError, match="plateau"):
        Envelope(rise=5.0, plateau=4.0)


def test_limits_of_the_step_are_as_stated():
    """The refusal names the range, up to half a period of 0.4 s; steps just inside are taken, just outside not."""
    with pytest.raises(
        InvalidValueError, match=r"time_step must be in \[6\.3662e-05, 0\.2\) s for this layer, got 0\.5"
    ):
        kanai_tajimi_motion(LAYER, seed=1, time_step=0.5, duration=2.0)
    # a thousandth of a radian at 2.5 Hz
    least = 1e-3 / (5.0 * math.pi)
    for inside in (least * (1.0 + 1e-9), 0.2 * (1.0 - 1e-9)):
        assert kanai_tajimi_motion(LAYER, seed=1, time_step=inside, duration=3.0 * inside).time_step == inside
    for outside in (least * (1.0 - 1e-9), 0.2 * (1.0 + 1e-9)):
        with pytest.raises(InvalidValueError, match="for this layer"):
            kanai_tajimi_motion(LAYER, seed=1, time_step=outside, duration=3.0 * outside)
