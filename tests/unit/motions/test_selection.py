"""Target spectra against the printed tables, and records scaled to them in closed form."""

import math

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, flatfile, fourier_amplitudes, response_spectrum, selected, target_spectrum
from rocking.motions.components import Components
from rocking.motions.target_spectra import GROUNDS, asce7, eurocode8

pytestmark = pytest.mark.verifies(room="motions and records")

RNG = np.random.default_rng(3)
RECORDS = [
    Components(*(GroundMotion(np.convolve(row, np.hanning(9), "same"), 0.02, name=f"{k}") for row in pair), None)
    for k, pair in enumerate(RNG.standard_normal((6, 2, 600)))
]


@pytest.mark.verifies("published", "EN 1998-1:2004, Tables 3.2 and 3.3", within="1e-12", control="within")
def test_eurocode_8():
    """Ground C of type 1: 1.15 ag at T = 0, 2.5 times that from 0.2 to 0.6 s, then 1/T, 1/T^2 from 2 s; D differs."""
    top = 2.5 * 1.15 * 3.0
    times = [0.0, 0.1, 0.2, 0.6, 1.2, 4.0]
    expected = [1.15 * 3.0, 1.75 * 1.15 * 3.0, top, top, 0.5 * top, top * 0.6 * 2.0 / 16.0]
    assert eurocode8(3.0, "C")(times) == pytest.approx(expected, rel=1e-12)
    assert eurocode8(3.0, "D")(times) != pytest.approx(expected, rel=1e-12)
    assert eurocode8(3.0, "B", 2)([0.25, 1.2]) == pytest.approx([2.5 * 1.35 * 3.0, 2.5 * 1.35 * 3.0 * 0.25 / 1.2])
    # 3.2.2.2 (3): eta is 1 at 5 %, sqrt(10/15) at 10 %, and at least 0.55
    for damping, eta in ((0.05, 1.0), (0.1, (10.0 / 15.0) ** 0.5), (0.5, 0.55)):
        assert eurocode8(3.0, "A", 1, damping)([0.3]) == pytest.approx([7.5 * eta], rel=1e-12)


@pytest.mark.verifies("invariant", "branches that meet", within="1e-6", control="within")
def test_spectra_have_no_jumps():
    """The branches of every target meet at their corners, and not a tenth of a second beside them."""
    every = [(kind, ground, corners) for kind, grounds in GROUNDS.items() for ground, (_, *corners) in grounds.items()]
    corners = [(eurocode8(1.0, ground, kind), places) for kind, ground, places in every]
    corners.append((asce7(10.0, 6.0, 8.0), [0.12, 0.6, 8.0]))
    for target, places in corners:
        for place in places:
            low, high = target([place * (1.0 - 1e-9), place * (1.0 + 1e-9)])
            assert low == pytest.approx(high, rel=1e-6)
    assert target([0.6])[0] != pytest.approx(target([0.7])[0], rel=1e-6)


@pytest.mark.verifies("closed form", "ASCE/SEI 7-16, 11.4.6", within="1e-12", control="within")
def test_asce_7():
    """0.4 SDS at zero, SDS from 0.2 SD1/SDS to SD1/SDS, SD1/T, and SD1 TL/T^2 from TL on."""
    found = asce7(10.0, 6.0, 8.0)([0.0, 0.06, 0.12, 0.6, 3.0, 16.0])
    assert found == pytest.approx([4.0, 7.0, 10.0, 10.0, 2.0, 0.1875], rel=1e-12)
    assert target_spectrum("asce7:sds=1g,sd1=0.6g,tl=8")([0.3]) == pytest.approx([9.80665], rel=1e-12)


def test_a_target_in_a_file(tmp_path):
    """The heading states the unit; between the lines it is straight in ln Sa; a file without a unit is refused."""
    path = tmp_path / "uhs.csv"
    path.write_text("T [s];Sa [g]\n0,1;0,4\n1,0;0,1\n", encoding="utf-8")
    target = target_spectrum("uhs.csv", tmp_path)
    assert target([0.1, 0.55]) == pytest.approx([0.4 * 9.80665, 0.2 * 9.80665], rel=1e-12)
    with pytest.raises(InvalidValueError, match="periods of uhs"):
        target([2.0])
    for text, message in (("T,Sa\n0.1,0.4\n1,0.1\n", "with units"), ("T [s],Sa [g]\n1,0.4\n0.1,0.1\n", "must be >= 0")):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InvalidValueError, match=message):
            target_spectrum("uhs.csv", tmp_path)


@pytest.mark.parametrize(
    "words",
    ["eurocode9:ag=1", "eurocode8", "eurocode8:ag=1g,ground=F", "eurocode8:ag=1g,type=3", "eurocode8:ag=1.2.3",
     "asce7:sds=1g,sd1=0.6g", "asce7:sds=1g,sd1=9g,tl=1", "eurocode8:ag=-1", "eurocode8:ag=2s", 3],
)  # fmt: skip
def test_targets_that_are_none_are_refused(words):
    """What is misspelt, missing or outside of its range is no spectrum."""
    with pytest.raises(InvalidValueError):
        target_spectrum(words)


@pytest.mark.verifies("closed form", "copies of one record", within="1e-9", control="within")
def test_factors_undo_what_was_multiplied():
    """Copies of one record by 1/3, 1 and 2 get factors in the inverse ratio and one misfit; the mean has it too."""
    one = RECORDS[0]
    copies = [one.each(lambda part, f=f: part.scaled(f)) for f in (1.0 / 3.0, 1.0, 2.0)]
    found = selected(copies, "eurocode8:ag=2.0m/s2", most=100.0)
    order = np.argsort(found.factors)
    assert found.factors[order] / found.factors.min() == pytest.approx([1.0, 2.0, 6.0], rel=1e-9)
    assert found.misfits == pytest.approx(np.full(3, found.misfit), rel=1e-9)
    assert np.log(found.mean / found.target(found.periods)).mean() == pytest.approx(0.0, abs=1e-9)
    another = selected(RECORDS[1:2], "eurocode8:ag=2.0m/s2", most=100.0)
    assert found.misfits[0] != pytest.approx(another.misfit, rel=1e-9)


def test_the_closest_are_chosen(tmp_path):
    """The spectrum of one record as target: that record is chosen first, with factor 1 and no misfit."""
    periods = np.geomspace(0.1, 2.0, 25)
    alone = Components(RECORDS[4].x, None, None)
    values = response_spectrum(alone.x, periods).pseudo_acceleration
    rows = "\n".join(f"{float(t)!r},{float(a)!r}" for t, a in zip(periods, values, strict=True))
    (tmp_path / "own.csv").write_text(f"T [s],Sa [m/s2]\n{rows}\n", encoding="utf-8")
    found = selected([*RECORDS[:3], alone], target_spectrum("own.csv", tmp_path), 2, most=100.0)
    assert len(found.records) == 2
    assert found.records[0].x.name == "4"
    assert (found.factors[0], found.misfits[0]) == pytest.approx((1.0, 0.0), abs=1e-9)
    assert found.misfits[1] > 0.05
    assert "multiplied by" in found.records[1].x.provenance[-1]


def test_too_few_are_refused():
    """More records than there are, or factors beyond what is allowed, are refused with how many come close."""
    with pytest.raises(InvalidValueError, match="7 of 6 records are requested"):
        selected(RECORDS, "eurocode8:ag=2.0m/s2", 7, most=100.0)
    with pytest.raises(InvalidValueError, match="only 0 match Eurocode 8"):
        selected(RECORDS, "eurocode8:ag=20000m/s2", most=4.0)


@pytest.mark.verifies("closed form", "a sine of whole periods", within="1e-9", control="within")
def test_fourier_amplitude_of_a_sine():
    """A sine of amplitude A over a time D has A D / 2 at its frequency and nothing at twice it."""
    time = np.arange(1000) * 0.01
    frequencies, amplitudes = fourier_amplitudes(GroundMotion(3.0 * np.sin(2.0 * np.pi * 5.0 * time), 0.01))
    at = int(np.argmin(np.abs(frequencies - 5.0)))
    assert amplitudes[at] == pytest.approx(15.0, rel=1e-9)
    assert amplitudes[2 * at] < 1e-9
    # smoothing spreads it over its neighbours, and leaves what is flat alone
    assert fourier_amplitudes(GroundMotion([1.0] + [0.0] * 999, 0.01), [1.0, 5.0])[1] == pytest.approx([0.01, 0.01])


def test_smoothing_has_the_window_of_konno_and_ohmachi():
    """One line of a spectrum is smeared over its neighbours as (sin x / x)^4 of x = b lg(f / fc) says."""
    line, wanted, b = 5.0, 5.3, 20.0
    time = np.arange(1000) * 0.01
    smooth = fourier_amplitudes(GroundMotion(3.0 * np.sin(2.0 * np.pi * line * time), 0.01), [wanted], b)[1]
    weights = []
    for frequency in (0.1 * k for k in range(1, 501)):
        x = b * math.log10(frequency / wanted)
        weights.append((math.sin(x) / x) ** 4 if abs(x) > 1e-9 else 1.0)
    assert smooth == pytest.approx([15.0 * weights[49] / sum(weights)], rel=1e-9)


def test_flatfile():
    """Both components and all directions stand in one row; one component has no RotD; one that is zero is left out."""
    still = GroundMotion(np.zeros(600), 0.02, name="still")
    upright = Components(RECORDS[1].x, None, RECORDS[1].y)
    found = flatfile([RECORDS[0], upright, Components(still, None, None)], [0.2, 1.0])
    columns = found.table.columns
    assert columns["record"].values.tolist() == ["0", "1"]
    assert found.left_out[0][0] == "still"
    assert columns["pga_x"].values[0] == RECORDS[0].x.peak
    assert columns["pga_z"].values[1] == RECORDS[1].y.peak
    assert np.isnan(columns["pga_rotd100"].values[1])
    assert np.isnan(found.spectra["sa_rotd50"][1]).all()
    expected = response_spectrum(RECORDS[0].y, [0.2, 1.0]).pseudo_acceleration
    assert found.spectra["sa_y"][0] == pytest.approx(expected, rel=3e-4)
    assert {"sa_rotd50(0.2)", "sa_x(1)"} <= set(found.flat().columns)
    dataset = found.to_xarray()
    assert dataset["sa_rotd100"].dims == ("record", "period")
    assert dataset["sa_rotd100"].attrs["units"] == "m/s2"
