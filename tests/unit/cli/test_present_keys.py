"""Options have the present keys: those of files of earlier versions are refused with the present name."""

import pytest

from rocking.spec.reference import reference

BLOCK = "--width", 0.5, "--height", 2
PULSE = "sine:amplitude=3,period=0.8"


@pytest.mark.parametrize(
    ("words", "old", "new"),
    [
        (("simulate", *BLOCK, PULSE, "--friction", 0.5), "settings.bounce=0.1", "settings.normal_restitution"),
        (("simulate", *BLOCK), "response.free=0.5", "response.initial_rotation"),
        (("predict", *BLOCK, PULSE), "predict.shares=true", "predict.contributions"),
        (("overturning-pga", *BLOCK, PULSE), "minimum.levels=3", "minimum.bisections"),
    ],
)
def test_keys_of_earlier_files_are_no_options(refuses, words, old, new):
    key = old.partition("=")[0]
    refuses((*words, "--set", old), f"unknown key '{key}'; did you mean {new}?")


def test_measures_are_refused_by_the_name_of_the_option(refuses):
    refuses(("fragility", *BLOCK, PULSE, "--im", "bogus"), "im must be one of")
    refuses(("code-checks", *BLOCK, PULSE, "--im", "bogus"), "im must be one of")


def test_help_of_the_initial_rotation_offers_no_word(run):
    text = " ".join(run("simulate", "--help")[1].split())
    assert "-x [-]" not in text
    assert "< 0 to the left" in text


def test_the_manual_names_commands_as_they_are():
    text = reference()["input_files"]
    assert "`rocking overturning-pga`" in text
    assert "`rocking minimum`" not in text
