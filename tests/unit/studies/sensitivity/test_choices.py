"""Choices of restitution by name: every kind has one, two never share one."""

import pytest

from rocking.dynamics import RandomRestitution, SpeedRestitution
from rocking.errors import InvalidValueError, RockingError
from rocking.restitution import Fixed
from rocking.studies.sensitivity.restitutions import SampledRestitution, label_of, named_choices


@pytest.mark.parametrize(
    ("choice", "label"),
    [
        ("housner", "housner"),
        ("0.98*shifted-impulse:k=0.6", "0.98*shifted-impulse:k=0.6"),
        (Fixed(0.9), "fixed:r=0.9"),
        (0.85, "0.85"),
        ({"left": 0.8, "right": 0.9}, "left 0.8, right 0.9"),
        (SpeedRestitution([0.0, 1.0], [0.9, 0.8], times="ked"), "SpeedRestitution times ked"),
        (SampledRestitution([0.8, 1.0], 3), "drawn per history, 0.9 [0.805, 0.995], seed 3"),
        (RandomRestitution([0.8, 1.0], 3, times="ked"), "drawn per impact, 0.9 [0.805, 0.995], seed 3 times ked"),
    ],
)
def test_every_choice_has_a_name(choice, label):
    """Models, numbers, pairs and laws are named by what they are; draws with their median and 95 % range."""
    assert label_of(choice) == label


def test_a_dict_names_the_choices():
    """Names that the user gives are kept, in their order."""
    assert list(named_choices({"new": "ked", "old": "housner"})) == ["new", "old"]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["ked"], "at least two"),
        (["ked", "ked"], "'ked'"),
        ("ked", "list or a dict"),
        (0.9, "list or a dict"),
        ({"left": 0.8, "right": 0.9}, "one choice"),
        (["ked", {"left": 0.9}], "by side"),
        (["ked", None], "number"),
        (["ked", float("nan")], "finite"),
        ({"a": "ked", "b": "nonsense"}, "no restitution model"),
    ],
)
def test_what_cannot_be_compared_is_refused(given, message):
    """Fewer than two choices, equal names and what is no restitution are refused before anything is computed."""
    with pytest.raises(RockingError, match=message):
        named_choices(given)


def test_equal_choices_can_be_compared_under_names():
    """The same choice twice is allowed once it is named: the comparison must then find nothing."""
    assert named_choices({"a": 0.9, "b": 0.9}) == {"a": 0.9, "b": 0.9}
    with pytest.raises(InvalidValueError, match="name: choice"):
        named_choices([0.9, 0.9])
