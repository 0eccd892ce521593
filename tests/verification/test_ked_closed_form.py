"""KED of the rectangle: the closed form against 30-digit quadrature, series limits and printed numbers.

REF numbers (CONTRIBUTING.md), to 40 digits. Printed numbers:
Mao et al. 2024, Table 2, doi:10.3390/buildings14072119.
"""

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from rocking.restitution import Housner, Ked

pytestmark = pytest.mark.verifies(room="restitution in the plane")

SLENDERNESS = [
    *np.geomspace(1e-3, 1e3, 49).tolist(),
    0.29,
    0.2999999,
    0.3,
    0.3000001,
    0.31,
    0.35,
    0.5,
    1.0,
    2.0,
]

REF = {
    0.25: "0.123089312869877367",
    0.5: "0.299020542163116491",
    0.5**0.5: "0.43292138285247002",
    1.0: "0.58227881856382706",
    1.5: "0.742610458368304321",
    2.0: "0.830309150037216034",
    2.85: "0.904545191226176899",
    3.0: "0.912562883840427077",
    3.75: "0.940898907220637169",
    4.0: "0.947366835032369679",
    4.33: "0.95441345470936079",
    5.88: "0.97412901538086492",
    6.75: "0.980058152725725648",
    8.33: "0.986647476866856073",
    9.75: "0.990137623528762014",
    15.0: "0.995733988994752789",
    30.0: "0.998910951613764409",
}

TABLE_2 = {
    2: "0.83030915",
    2.85: "0.90454519",
    3: "0.91256288",
    4: "0.94736684",
    4.33: "0.95441345",
    5.88: "0.97412902",
    8.33: "0.98664748",
}


def by_quadrature(ratio):
    """Eq. 17, Mao et al. 2024, B = 1: the inner integral over x is y^3 atan(B/y), the outer one is
    numerical."""
    with mp.workdps(36):
        h = mp.mpf(ratio)
        cuts = [mp.mpf(0), *(mp.mpf(10) ** k for k in range(-2, 4) if 10.0**k < ratio), h]
        kept = mp.quad(lambda y: y**3 * mp.atan(1 / y), cuts)
        inertia = mp.quad(lambda y: y**2 + mp.mpf(1) / 3, [0, h])
        return mp.sqrt(kept / inertia)


def error(found, expected):
    """Relative error of a float against a long number."""
    with mp.workdps(36):
        return abs(float((mp.mpf(float(found)) - expected) / expected))


def textbook_form(ratio):
    """The closed form in double precision as it is printed: cancels for squat blocks."""
    kept = ratio**3 / 12 - ratio / 4 + np.arctan(ratio) / 4 + ratio**4 / 4 * np.arctan(1 / ratio)
    return float(np.sqrt(np.abs(kept) / (ratio * (1 + ratio**2) / 3)))


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "Eq. 17 of Mao et al. 2024 as it stands, 25 digits",
    within="1e-15",
    doi="10.3390/buildings14072119",
)
def test_reduced_integral_is_the_double_integral():
    """The one-dimensional oracle equals the double integral of Eq. 17 evaluated as it stands, to 1e-15."""
    with mp.workdps(25):
        numerator = mp.quad(lambda y, x: y**4 / (y**2 + (1 - x) ** 2), [0, 1, 2], [0, 0.5, 1])
        denominator = mp.quad(lambda y, x: y**2 + (1 - x) ** 2, [0, 2], [0, 1])
        double = mp.sqrt(numerator / denominator)
    assert error(by_quadrature(2.0), double) < 1e-15


@pytest.mark.verifies(
    "computed anew",
    "Eq. 17 of Mao et al. 2024 by 30-digit quadrature",
    within="1e-13",
    control="test_quadrature_criterion_rejects_wrong_forms",
    doi="10.3390/buildings14072119",
)
@pytest.mark.parametrize("ratio", SLENDERNESS)
def test_closed_form_against_quadrature(ratio, agreement):
    """Vectorised closed form and series agree with 30-digit quadrature to 1e-13 relative."""
    agreement(error(Ked().of_slenderness([ratio])[0], by_quadrature(ratio)), 1e-13)


@pytest.mark.verifies("negative control", "the form that cancels, a wrong power, and Housner's model")
def test_quadrature_criterion_rejects_wrong_forms():
    """Negative control: the cancelling textbook form, a wrong power and Housner all fail the same
    criterion."""
    squat = [ratio for ratio in SLENDERNESS if ratio < 0.02]
    assert all(error(textbook_form(ratio), by_quadrature(ratio)) > 1e-13 for ratio in squat)
    assert error(textbook_form(2.0), by_quadrature(2.0)) < 1e-13
    wrong_power = 8 / 12 - 0.5 + np.arctan(2) / 4 + 2**3 / 4 * np.arctan(0.5)
    assert error(np.sqrt(wrong_power / (2 * 5 / 3)), by_quadrature(2.0)) > 1e-13
    assert error(Housner().of_slenderness([2.0])[0], by_quadrature(2.0)) > 1e-13


@pytest.mark.verifies("computed anew", "coefficients to 15 digits and more", within="1e-14")
@pytest.mark.parametrize(("ratio", "value"), REF.items())
def test_reference_values(ratio, value, agreement):
    """KED of rectangles: REF values to 1e-14, for arrays and for a Block of any size."""
    block = rk.Block(width=3.0, height=3.0 * ratio, depth=0.2, density=100.0)
    agreement(error(Ked().of_slenderness([ratio])[0], mp.mpf(value)), 1e-14)
    # a Block's own height/width is rounded: its ratio may be one unit in the last place off
    assert error(rk.coefficient_of_restitution(block, "ked"), mp.mpf(value)) < 1e-14
    assert error(rk.coefficient_of_restitution(block, "ked", foot="left"), mp.mpf(value)) < 1e-14


@pytest.mark.verifies(
    "published",
    "Table 2, column r_r, Mao et al. 2024",
    within="all printed digits",
    control="within",
    doi="10.3390/buildings14072119",
)
@pytest.mark.parametrize(("ratio", "printed"), TABLE_2.items())
def test_table_2_to_all_digits(ratio, printed):
    """The r_r column of Table 2 (Mao et al. 2024), to all 8 printed digits."""
    block = rk.Block(width=1.0, height=ratio)
    assert f"{rk.coefficient_of_restitution(block, 'ked'):.8f}" == printed
    assert f"{rk.coefficient_of_restitution(block, 'housner'):.8f}" != printed
    assert f"{rk.coefficient_of_restitution(block, 'horizontal-momentum'):.8f}" != printed


@pytest.mark.verifies("closed form", "(3 pi / 8) l^3 (1 - 8 l / (5 pi))", within="2.0 l^2", control="within")
def test_squat_limit():
    """Squat limit: r^2 = (3 pi/8) l^3 (1 - 8 l/(5 pi) + O(l^2)); an exponent or factor off by little
    fails."""

    def follows(leading):
        ratios = np.array([1e-4, 1e-3, 1e-2])
        residual = Ked().of_slenderness(ratios) ** 2 / leading(ratios) - 1.0 + 8.0 * ratios / (5.0 * np.pi)
        return bool((np.abs(residual) <= 2.0 * ratios**2).all())

    assert follows(lambda ratio: 3.0 * np.pi / 8.0 * ratio**3)
    assert not follows(lambda ratio: 3.0 * np.pi / 8.0 * ratio**3.001)
    assert not follows(lambda ratio: 1.001 * 3.0 * np.pi / 8.0 * ratio**3)


@pytest.mark.verifies(
    "closed form", "1 - 1/l^2 + 3 pi / (16 l^3) + 1 / (5 l^4)", within="2.0 / l of the last term", control="within"
)
def test_slender_limit():
    """Slender limit: r = 1 - 1/l^2 + 3 pi/(16 l^3) + 1/(5 l^4) + ... (the last term from the integrals)."""

    ratios = np.array([30.0, 100.0, 300.0])

    def follows(cubic):
        residual = Ked().of_slenderness(ratios) - (1.0 - ratios**-2.0 + cubic * ratios**-3.0)
        return bool((np.abs(residual * ratios**4 - 0.2) <= 2.0 / ratios + 1e-6).all())

    assert follows(3.0 * np.pi / 16.0)
    assert not follows(3.0 * np.pi / 8.0)
    assert not follows(0.0)


@pytest.mark.verifies("closed form", "two thirds", within="2e-4", control="within")
def test_slender_loss_is_two_thirds_of_housner():
    """In the slender limit KED loses 2/3 of the energy that Housner's model loses."""
    ratio = np.array([1e4])
    loss = {model: 1.0 - model.of_slenderness(ratio)[0] ** 2 for model in (Ked(), Housner())}
    # losses of 3e-8 keep about 8 digits; the next term of the series is 6e-5
    assert loss[Ked()] / loss[Housner()] == pytest.approx(2.0 / 3.0, rel=2e-4)
    assert loss[Ked()] / loss[Housner()] != pytest.approx(3.0 / 4.0, rel=2e-4)


@pytest.mark.verifies("invariant", "growing between cos^2 alpha and 1", control="within")
def test_monotone_and_between_its_bounds():
    """r grows with slenderness from 0 to 1 and lies between cos^2(alpha) and 1, without
    jumps."""
    ratios = np.geomspace(1e-3, 1e3, 4001)
    r = Ked().of_slenderness(ratios)
    assert (np.diff(r) > 0.0).all()
    assert (r >= ratios**2 / (1.0 + ratios**2)).all()
    assert (r < 1.0).all()
    # control: Housner's curve has a flat part and runs below cos^2(alpha)
    housner = Housner().of_slenderness(ratios)
    assert not (np.diff(housner) > 0.0).all()
    assert not (housner >= ratios**2 / (1.0 + ratios**2)).all()


@pytest.mark.verifies("same bits", "the same ratios in arrays of other shapes")
def test_any_shape_of_array():
    """Scalars, empty, integer, 2-D, strided and long arrays give the same numbers in the shape that was
    asked."""
    ked = Ked()
    ratios = np.geomspace(0.01, 100.0, 40000)
    whole = ked.of_slenderness(ratios)
    assert ked.of_slenderness(2).shape == ()
    assert ked.of_slenderness([]).shape == (0,)
    assert np.array_equal(ked.of_slenderness(ratios.reshape(200, 200)), whole.reshape(200, 200))
    assert np.array_equal(ked.of_slenderness(ratios[::-3]), whole[::-3])
    assert ked.of_slenderness(np.array([1, 2], dtype=np.int16))[1] == ked.of_slenderness(2.0)
    assert ratios[0] == 0.01  # the caller's array is left alone
