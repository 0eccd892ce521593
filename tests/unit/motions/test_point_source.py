"""Point-source motions: spectra by hand, and ensembles against the target."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import trapezoid

from rocking.errors import InvalidValueError
from rocking.motions.synthetic import PointSource, point_source_motion
from rocking.motions.synthetic.point_source import window

pytestmark = pytest.mark.verifies(room="motions and records")

SOURCE = PointSource(magnitude=5.0, distance=20e3)


@pytest.mark.verifies(
    "closed form", "the formulas of Boore 2003 in the units of that paper", within="1e-12", doi="10.1007/PL00012553"
)
def test_source_by_hand_in_the_units_of_the_paper():
    """Moment, corner and spectrum are those of the formulas in dyn cm, bar, km/s and g/cm3, worked out separately."""
    moment = 10.0 ** (1.5 * 5.0 + 16.05)
    corner = 4.9e6 * 3.5 * (80.0 / moment) ** (1.0 / 3.0)
    assert pytest.approx(moment * 1e-7, rel=1e-13, abs=0.0) == SOURCE.moment
    assert SOURCE.corner_frequency == pytest.approx(corner, rel=1e-13, abs=0.0)
    f = 3.0
    constant = 0.55 * math.sqrt(0.5) * 2.0 / (4.0 * math.pi * 2.8 * 3.5**3 * 1.0) * 1e-20
    source = constant * moment * (2.0 * math.pi * f) ** 2 / (1.0 + (f / corner) ** 2)
    path = math.exp(-math.pi * f * 20.0 / (180.0 * f**0.45 * 3.5)) / 20.0
    expected_cm = source * path * math.exp(-math.pi * 0.04 * f)
    assert SOURCE.amplitude(np.array([f]))[0] == pytest.approx(0.01 * expected_cm, rel=1e-12, abs=0.0)


@pytest.mark.verifies("closed form", "flat, half, and f^-2", within="1e-5")
def test_spectrum_has_the_limits_of_an_omega_square_source():
    """Without losses, the displacement is flat below the corner, half of it at the corner, and falls as f^-2 above."""
    bare = PointSource(5.0, 2e3, kappa=0.0, quality=(1e12, 0.0))
    f = bare.corner_frequency * np.array([1e-3, 1.0, 1e3])
    flat = bare.amplitude(f) / (2.0 * np.pi * f) ** 2
    np.testing.assert_allclose(flat / flat[0], [1.0, 0.5, 1e-6], rtol=1e-5)


def test_spreading_is_continuous_in_pieces():
    """1/R to 40 km, then 1/sqrt(R): at 160 km half of the value at 40 km."""
    assert PointSource(5.0, 40e3).geometric_spreading() == pytest.approx(1.0 / 40.0)
    assert PointSource(5.0, 160e3).geometric_spreading() == pytest.approx(1.0 / 80.0)
    assert PointSource(5.0, 1e3).geometric_spreading() == 1.0


def test_window_peaks_at_a_fifth():
    """The window is 1 at its peak, 0.2, and 0.05 at its end, and nowhere above 1."""
    np.testing.assert_allclose(window(np.array([-1.0, 0.0, 0.2, 1.0])), [0.0, 0.0, 1.0, 0.05], rtol=0.0, atol=1e-15)
    assert window(np.linspace(0.0, 2.0, 1001)).max() <= 1.0


def _energies(count, step):
    """Squared Fourier amplitudes of an ensemble, over frequencies, in SI."""
    motions = [point_source_motion(SOURCE, seed=s, time_step=step) for s in range(count)]
    size = len(motions[0])
    return np.fft.rfftfreq(size, step), np.array([np.abs(step * np.fft.rfft(m.acceleration)) ** 2 for m in motions])


@pytest.mark.verifies(
    "repeated sampling", "the target spectrum, in six bands", within="4.5 standard errors", control="within"
)
def test_ensemble_has_the_target_spectrum():
    """In bands from 0.3 to 40 Hz the mean squared amplitude is the target's within 4.5 standard errors.

    The errors come from the scatter between motions: squared amplitudes are exponential, so that a band of n
    independent frequencies in N motions leaves 1 / sqrt(n N).
    """
    f, energies = _energies(300, 0.01)
    edges = [0.3, 1.0, 3.0, 8.0, 15.0, 25.0, 40.0]
    no_kappa = PointSource(5.0, 20e3, kappa=0.0)
    rejected = []
    for low, high in pairwise(edges):
        band = (f >= low) & (f < high)
        each = (energies[:, band] / SOURCE.amplitude(f[band]) ** 2).mean(axis=1)
        error = each.std(ddof=1) / math.sqrt(each.size)
        assert error < 0.08
        assert abs(each.mean() - 1.0) < 4.5 * error
        wrong = (energies[:, band] / no_kappa.amplitude(f[band]) ** 2).mean(axis=1)
        rejected.append(abs(wrong.mean() - 1.0) > 10.0 * wrong.std(ddof=1) / math.sqrt(wrong.size))
    # negative control: a target without kappa is rejected wherever it matters
    assert all(rejected[2:])


@pytest.mark.verifies("repeated sampling", "Parseval's theorem", within="4.0 standard errors")
def test_energy_is_that_of_the_target_at_any_step():
    """The integral of the squared motion is twice that of the squared spectrum up to Nyquist (Parseval), on average."""
    for step in (0.01, 0.004):
        values = [
            step * (point_source_motion(SOURCE, seed=s, time_step=step).acceleration ** 2).sum() for s in range(150)
        ]
        f = np.linspace(0.0, 0.5 / step, 200_001)
        expected = 2.0 * trapezoid(SOURCE.amplitude(f) ** 2, f)
        error = np.std(values, ddof=1) / math.sqrt(len(values))
        assert error < 0.03 * expected
        assert abs(np.mean(values) - expected) < 4.0 * error


def test_motion_lies_within_its_window():
    """Nearly all energy comes after the window's start and before its end."""
    motion = point_source_motion(SOURCE, seed=5)
    energy = np.cumsum(motion.acceleration**2) / (motion.acceleration**2).sum()
    start = 1.0 / SOURCE.corner_frequency
    end = start + 2.0 * SOURCE.duration
    assert np.interp(start, motion.time, energy) < 0.01
    assert np.interp(end, motion.time, energy) > 0.99


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"magnitude": 11.0}, "magnitude"),
        ({"distance": 20.0}, "enter metres"),
        ({"stress_drop": 80.0}, "bar"),
        ({"shear_velocity": 3.5}, "km/s"),
        ({"density": 2.8}, "g/cm3"),
        ({"kappa": math.nan}, "kappa"),
        ({"quality": (0.0, 0.5)}, "quality"),
        ({"quality": (100.0, 1.5)}, "quality"),
        ({"spreading": ((1.0, -1.0),)}, "spreading"),
        ({"spreading": ()}, "spreading"),
        ({"spreading": ((1000.0,), (2000.0, -1.0))}, "spreading"),
        ({"spreading": ((1000.0, -1.0), (500.0, -1.0))}, "increasing distances"),
        ({"spreading": ((1000.0, -1.0), (1000.0, -0.5))}, "increasing distances"),
        ({"spreading": ((1000.0, -5.5),)}, "exponent"),
        ({"spreading": ((1000.0, 5.5),)}, "exponent"),
        ({"quality": (100.0,)}, "quality"),
        ({"radiation": -0.5}, "radiation"),
    ],
)
def test_bad_sources_are_refused(options, match):
    """Values in the units of the paper, or outside their ranges, are refused by name."""
    with pytest.raises(InvalidValueError, match=match):
        PointSource(**{"magnitude": 5.0, "distance": 20e3, **options})


def test_times():
    """A duration that holds the window is that of the motion; one that cuts it, and too long a step, are refused."""
    assert point_source_motion(SOURCE, seed=1, duration=30.0).duration == pytest.approx(30.0)
    with pytest.raises(InvalidValueError, match="duration"):
        point_source_motion(SOURCE, seed=1, duration=1.0)
    with pytest.raises(InvalidValueError, match="time_step"):
        point_source_motion(SOURCE, seed=1, time_step=0.6)
