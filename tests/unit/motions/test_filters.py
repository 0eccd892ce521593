"""Elementary functions of sums and products: accuracy, and the same bits on every processor."""

import json
import math
import os
import subprocess
import sys

import mpmath
import numpy as np
import pytest
from benchmarks.synthetic import models
from benchmarks.timing import cpu_seconds

from rocking.motions import filters

pytestmark = pytest.mark.verifies(room="motions and records")

RANDOM = np.random.default_rng(3)
ARGUMENTS = {
    "exponential": np.concatenate([RANDOM.uniform(-708.0, 709.0, 300), RANDOM.uniform(-2.0, 2.0, 300)]),
    "logarithm": np.concatenate([10.0 ** RANDOM.uniform(-300.0, 300.0, 300), RANDOM.uniform(0.5, 2.0, 300)]),
    "cosine": RANDOM.uniform(-1000.0, 1000.0, 600),
    "sine": RANDOM.uniform(-1000.0, 1000.0, 600),
}
TRUTH = {"exponential": mpmath.exp, "logarithm": mpmath.log, "cosine": mpmath.cos, "sine": mpmath.sin}


def _found(name, x):
    pair = {"cosine": 0, "sine": 1}
    return filters.cosine_sine(x)[pair[name]] if name in pair else getattr(filters, name)(x)


@pytest.mark.verifies("computed anew", "mpmath with 30 digits", within="2.0 units in the last place")
@pytest.mark.parametrize("name", ARGUMENTS)
def test_functions_are_within_a_unit_or_so_of_the_last_digit(name, monkeypatch):
    """Against 30 digits; the functions without a compiler have the same bits as the compiled ones."""
    x = ARGUMENTS[name]
    found = _found(name, x)
    with mpmath.workdps(30):
        exact = [TRUTH[name](mpmath.mpf(float(one))) for one in x]
        # near a zero of cosine and sine the rounding of the angle counts: units of one there
        units = [max(abs(one), 1) if name in {"cosine", "sine"} else abs(one) for one in exact]
        error = max(float(abs(a - b) / unit) for a, b, unit in zip(found, exact, units, strict=True))
    assert error < 2.0 * 2.220446049250313e-16
    monkeypatch.setattr(filters, "compiled", lambda: None)
    np.testing.assert_array_equal(_found(name, x), found)


def test_numbers_in_equal_ratios(monkeypatch):
    """As in numpy to 4 units of the last digit, with exact ends; the same bits without a compiler."""
    low, high = np.array([2.0, 0.3, 1.0]), np.array([9.0, 0.7, 1.0])
    numbers = filters.geometric(low, high, 50)
    np.testing.assert_allclose(numbers, np.geomspace(low, high, 50, axis=1), rtol=1e-15)
    assert (numbers[:, 0] == low).all()
    assert (numbers[:, -1] == high).all()
    assert filters.geometric(2.0, 9.0, 1).tolist() == [2.0]
    assert filters.geometric(1e-300, 1e300, 3) == pytest.approx([1e-300, 1.0, 1e300], rel=1e-12)
    monkeypatch.setattr(filters, "compiled", lambda: None)
    np.testing.assert_array_equal(filters.geometric(low, high, 50), numbers)


def test_ends(monkeypatch):
    """Zero, infinity, what is below the smallest number, and the last arguments before."""
    assert filters.exponential(np.array([-np.inf, -709.0, 0.0])).tolist() == [0.0, 0.0, 1.0]
    outermost = np.array([-708.0 - 1e-9, -708.0, -707.5, 708.5, 709.0])
    expected = [0.0, *(math.exp(x) for x in outermost[1:])]
    assert filters.exponential(outermost) == pytest.approx(expected, rel=1e-15, abs=0.0)
    monkeypatch.setattr(filters, "compiled", lambda: None)
    assert filters.exponential(outermost) == pytest.approx(expected, rel=1e-15, abs=0.0)
    assert filters.logarithm(np.array([0.0, 1.0])).tolist() == [-np.inf, 0.0]


@pytest.mark.verifies("computed anew", "SciPy's matrix exponential", within="1e-12")
def test_transition_is_a_matrix_exponential():
    """Free vibration over a step is the exponential of the oscillator's matrix, also at critical damping."""
    from scipy.linalg import expm

    for damping in (0.0, 0.3, 1.0):
        matrix = np.array([[0.0, 1.0], [-49.0, -14.0 * damping]])
        np.testing.assert_allclose(filters.transition(7.0, damping, 0.13), expm(0.13 * matrix), rtol=1e-12)


_DIGESTS = """
import hashlib, json
import numpy as np
from rocking.motions.synthetic import (KanaiTajimi, NonstationaryFilter, PointSource, families, kanai_tajimi_motion,
    modulation_from_intensity, nonstationary_motion, point_source_motion)
q = modulation_from_intensity(1.0, 12.0, 8.0)
motions = {"nonstationary": nonstationary_motion(q, NonstationaryFilter(), seed=5, duration=20.0),
    "kanai-tajimi": kanai_tajimi_motion(KanaiTajimi(0.01), seed=5),
    "source": point_source_motion(PointSource(6.5, 2e4), seed=5)}
motions |= {"family " + name: one.motion(seed=3, number=k) for name, one in families().items() for k in (0, 1)}
found = {name: hashlib.sha256(motion.acceleration.tobytes()).hexdigest() for name, motion in motions.items()}
probe = np.linspace(0.0, 9.0, 4096)
found["probe"] = hashlib.sha256(np.exp(probe).tobytes() + np.sin(probe).tobytes()).hexdigest()
print(json.dumps(found))
"""
_NO_VECTORS = "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR AVX2 FMA3 X86_V3 X86_V4"


def _digests(**settings):
    run = [sys.executable, "-W", "ignore", "-c", _DIGESTS]
    done = subprocess.run(run, env=os.environ | settings, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.verifies("same bits", "instructions and libraries of other processors")
def test_a_seed_has_the_same_bits_on_every_processor():
    """Whatever NumPy, OpenBLAS and the C library take for the processor's abilities."""
    plain = _digests()
    probe = plain.pop("probe")
    probes = set()
    for settings in (
        {"NPY_DISABLE_CPU_FEATURES": _NO_VECTORS},
        {"OPENBLAS_CORETYPE": "Prescott", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX"},
    ):
        other = _digests(**settings)
        probes.add(other.pop("probe"))
        assert other == plain
    # negative control: on a processor with AVX-512, NumPy's own functions do differ
    if "AVX512_SKX" in np.show_config(mode="dicts")["SIMD Extensions"].get("found", []):
        assert probes != {probe}


@pytest.mark.speed
@pytest.mark.parametrize("model", ["filtered noise", "Kanai-Tajimi", "point source"])
def test_a_synthetic_motion_costs_about_as_much_as_its_random_numbers(model):
    """At most 15 times as much CPU as its 4001 random numbers: 0.4 ms where these take 0.04 ms (once: 30 to 600)."""
    make = models()[model]
    make(0)
    pairs = [
        (
            cpu_seconds(lambda s=seed: make(s)),
            cpu_seconds(lambda s=seed: np.random.default_rng(s).standard_normal(4001)),
        )
        for seed in range(201)
    ]
    ours, numbers = np.median(pairs, axis=0)
    assert ours < 15.0 * numbers
