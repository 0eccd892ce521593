"""What settings take, and what they refuse."""

import math
from typing import Any

import pytest

from rocking.dynamics import Settings
from rocking.dynamics.settings import settings_of
from rocking.errors import InvalidValueError

NO_NUMBERS: list[Any] = [math.nan, math.inf, -math.inf, None, "1", True, [1.0, 2.0], 1j]
RANGES: dict[str, Any] = {
    "gravity": (r"\(0, 1e\+06\] m/s2", [0.0, -9.81, 1.1e6], [1e-9, 1e6]),
    "rest_speed": (r"\[0, 0.1\]", [-1e-9, 0.11], [0.0, 0.1]),
    "longest_step": (r"\[1e-06, 1\]", [0.0, 0.9e-6, 1.01], [1e-6, 1.0]),
    "tolerance": (r"\[1e-17, 0.001\]", [0.0, 0.9e-17, 0.0011], [1e-17, 1e-3]),
}


@pytest.mark.parametrize("name", RANGES)
@pytest.mark.parametrize("value", NO_NUMBERS)
def test_no_numbers(name: str, value: Any) -> None:
    """What is not one finite number is refused under its name; None stands for the usual value."""
    if value is None and name != "gravity":
        assert Settings(**{name: None}) == Settings()
        return
    with pytest.raises(InvalidValueError, match=f"{name} must be"):
        Settings(**{name: value})


@pytest.mark.parametrize("name", RANGES)
def test_ranges(name: str) -> None:
    """Numbers outside the range are refused with the range; the ends that belong to it are taken."""
    allowed, outside, inside = RANGES[name]
    changed: Any
    for value in outside:
        changed = {name: value}
        with pytest.raises(InvalidValueError, match=f"{name} must be in {allowed}, got"):
            Settings(**changed)
    for value in inside:
        changed = {name: value}
        assert getattr(Settings(**changed), name) == value


@pytest.mark.parametrize("value", [0, -1, 1.0, 2.5, True, None, "5", math.nan, math.inf, [1]])
def test_most_events(value: Any) -> None:
    """The number of impacts is a whole one from 1."""
    with pytest.raises(InvalidValueError, match="most_events must be a whole number >= 1, got"):
        Settings(most_events=value)


@pytest.mark.parametrize("value", [0, 1, None, "yes", 0.0, [True]])
def test_linear(value: Any) -> None:
    """The choice of equations is True or False, not something that resembles them."""
    with pytest.raises(InvalidValueError, match="linear must be True or False, got"):
        Settings(linear=value)


@pytest.mark.parametrize("value", [0, 2, 5, 7, 10, -8, "8", math.nan, True])
def test_order(value: Any) -> None:
    """Orders that were not compiled are refused, with those that were."""
    with pytest.raises(InvalidValueError, match=r"order must be one of \(4, 6, 8\), got"):
        Settings(order=value)


def test_options_of_a_call() -> None:
    """Options become fields; gravity is standard gravity unless said; unknown ones are refused with the known."""
    made = settings_of(9.81, {"linear": True, "order": 6})
    assert (made.gravity, made.linear, made.order) == (9.81, True, 6)
    assert Settings().gravity == 9.80665
    with pytest.raises(InvalidValueError, match=r"no option named 'tol'; there are gravity, linear, longest_step"):
        settings_of(9.81, {"tol": 1e-9})


def test_frozen_and_equal() -> None:
    """Settings cannot be changed, and equal ones are equal."""
    made = Settings(order=4)
    with pytest.raises(AttributeError):
        made.order = 8  # type: ignore[misc]
    assert made == Settings(order=4) != Settings(order=6)
