"""The door: what is let in, what is refused, and that a refusal names value, range and cause."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from rocking import checks, errors
from rocking.errors import InvalidValueError

NOT_NUMBERS = [
    None,
    "1",
    b"1",
    "",
    True,
    False,
    np.True_,
    1j,
    [1.0],
    (1.0, 2.0),
    {},
    object(),
    np.array([1.0]),
    np.ones(2),
    10**400,
]
NOT_FINITE = [float("nan"), float("inf"), -float("inf"), np.nan, np.float32("inf")]


@pytest.mark.parametrize("value", [3, 3.0, np.float32(3), np.int8(3), np.array(3.0), Fraction(3), Decimal(3)], ids=repr)
def test_numbers_pass(value):
    """Whatever is one real number becomes that float."""
    assert checks.number("x", value) == 3.0
    assert type(checks.number("x", value)) is float


def test_whole_numbers():
    """Python's and numpy's whole numbers within the range become an int; floats, booleans and others are refused."""
    for value in (1, 9, np.int8(9)):
        assert type(checks.whole("n", value, 1, 9)) is int
    for value in (0, 10, 1.0, True, None, "1", float("nan"), np.float64(2.0)):
        with pytest.raises(InvalidValueError, match=r"^n must be a whole number in \[1, 9\], got "):
            checks.whole("n", value, 1, 9)
    # a usual upper end is told only to who is beyond it
    for value, allowed in ((-1, ">= 0"), (0.5, ">= 0"), (2**63, r"in \[0, 2\^63\)")):
        with pytest.raises(InvalidValueError, match=f"^n must be a whole number {allowed}, got "):
            checks.whole("n", value)


@pytest.mark.parametrize("value", NOT_NUMBERS, ids=lambda value: type(value).__name__)
def test_what_is_no_number(value):
    """Strings, booleans, complex numbers, sequences and nothing are refused by name."""
    with pytest.raises(InvalidValueError, match=r"^height must be (a|one) number \[m\], got "):
        checks.number("height", value, "m")


@pytest.mark.parametrize("value", NOT_FINITE, ids=repr)
def test_what_is_not_finite(value):
    """NaN and infinities are refused by every check."""
    for check in (checks.number, checks.positive, checks.length, checks.density):
        with pytest.raises(InvalidValueError, match=r"x must be finite .*(nan|inf)"):
            check("x", value)
    with pytest.raises(InvalidValueError, match="must be finite"):
        checks.within("x", value, 0.0, float("inf"))


@pytest.mark.parametrize("value", [0, 0.0, -0.0, -1, -1e-300])
def test_what_is_not_positive(value):
    """Zero and below are refused with the value and the hint; the smallest number above zero is not."""
    with pytest.raises(InvalidValueError, match=r"^x must be > 0 m, got .*; upside down\?$"):
        checks.positive("x", value, "m", hint="upside down?")
    assert checks.positive("x", 5e-324) == 5e-324


@pytest.mark.parametrize("value", [1e-10, 1.1e9, 1e300])
def test_lengths_no_body_has(value):
    """Lengths outside 1e-9 to 1e9 m are refused with the range and the likely cause."""
    with pytest.raises(InvalidValueError, match=r"^width must be in \[1e-09, 1e\+09\] m, got .*; check the unit$"):
        checks.length("width", value)
    assert checks.length("width", 1e-9) == 1e-9
    assert checks.length("width", 1e9) == 1e9


def test_ends_of_a_range():
    """Closed ends are allowed, open ones refused, and the brackets in the message say which is which."""
    assert checks.within("k", 0.0, 0.0, 1.0) == 0.0
    assert checks.within("k", 1.0, 0.0, 1.0) == 1.0
    with pytest.raises(InvalidValueError, match=r"^k must be in \[0, 1\], got 1.2; too far$"):
        checks.within("k", 1.2, 0.0, 1.0, hint="too far")
    with pytest.raises(InvalidValueError, match=r"\(0, 1\)"):
        checks.within("k", 0.0, 0.0, 1.0, open_low=True, open_high=True)
    with pytest.raises(InvalidValueError, match=r"\[0, 1\)"):
        checks.within("k", 1.0, 0.0, 1.0, open_high=True)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ([1.0, -2.0, 0.0], "-2 at index 1"),
        ([[1.0, 2.0], [3.0, np.nan]], r"nan at index \(1, 1\)"),
        (0.0, "got 0$"),
        ([1.0, np.inf], "inf at index 1"),
        (["a"], "must be numbers"),
        ([True], "must be numbers"),
        ([1j], "must be numbers"),
        ([None], "must be numbers"),
        ([[1.0], [1.0, 2.0]], "must be numbers"),
        ("12", "must be numbers"),
    ],
)
def test_arrays(values, words):
    """An array with one bad value is refused, and that value is named with its index."""
    with pytest.raises(InvalidValueError, match=words):
        checks.positive_array("ratio", values)


def test_arrays_that_pass():
    """Arrays of numbers keep their shape; float64 is not copied."""
    given = np.ones((2, 3))
    assert checks.positive_array("ratio", given) is given
    assert checks.positive_array("ratio", [[1, 2]]).shape == (1, 2)
    assert checks.positive_array("ratio", []).shape == (0,)


@pytest.mark.parametrize("value", ["up", "", "Right", None, 1, ["left"], np.array(["left", "right"])], ids=repr)
def test_feet_and_units(value):
    """A foot is "left" or "right", a unit one of the list; anything else is refused by name."""
    with pytest.raises(InvalidValueError, match=r'^foot must be "left" or "right", got '):
        checks.foot("foot", value)
    with pytest.raises(InvalidValueError, match="m, cm, mm, ft, in"):
        checks.length_unit(value)
    assert checks.foot("foot", "left") == "left"
    assert checks.length_unit("in") == 0.0254  # exact, international inch


def test_one_family():
    """Every error is a RockingError, and what Python would have raised for the like."""
    family = [
        k
        for k in vars(errors).values()
        if getattr(k, "__module__", "") == errors.__name__ and isinstance(k, type) and not issubclass(k, Warning)
    ]
    assert all(issubclass(kind, errors.RockingError) for kind in family)
    assert issubclass(errors.GeometryError, InvalidValueError)
    assert issubclass(InvalidValueError, ValueError)
    assert issubclass(errors.UnknownModelError, LookupError)
    assert not issubclass(KeyError, errors.RockingError)


def test_finite_arrays():
    """Rows and tables of finite numbers of a shape become frozen copies; others are refused with shape or index."""
    given = np.array([[1, 2, 3], [4, 5, 6]])
    taken = checks.finite("points", given, "m", (None, 3))
    assert taken.tolist() == given.tolist()
    assert not taken.flags.writeable
    assert not np.shares_memory(taken, given)
    for values, shape, message in (
        ([1.0], (None,), r"^x must be a row of at least 2 finite numbers \[m\], got shape \(1,\)$"),
        ([1.0, 2.0], (3,), r"a row of 3 finite numbers \[m\], got shape \(2,\)"),
        ([[1.0, 2.0]], (None, 3), r"at least 2 x 3 finite numbers \[m\], got shape \(1, 2\)"),
        (1.0, (None,), r"got shape \(\)"),
        ([1.0, np.nan], (None,), r"^x must be finite \[m\], got nan at index 1$"),
        ([[1.0], [np.inf]], (2, 1), r"got inf at index \[1, 0\]"),
        (["1", "2"], (2,), "must be numbers"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            checks.finite("x", values, "m", shape, minimum=2)
