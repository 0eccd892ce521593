"""What a shell offers on Tab, asked as the shells ask."""

import os
import subprocess
import sys

import pytest

import rocking as rk


def offered(line, shell="bash"):
    """Words that are offered at the end of a line."""
    words = line.split()
    index = len(words) if line.endswith(" ") else len(words) - 1
    asked = {
        "_ROCKING_COMPLETE": f"complete_{shell}",
        "COMP_WORDS": line,
        "COMP_CWORD": str(index),
        "_TYPER_COMPLETE_ARGS": line,
    }
    command = [sys.executable, "-m", "rocking"]
    done = subprocess.run(command, env=os.environ | asked, capture_output=True, text=True, check=False)
    assert not done.stderr
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "some", "other"),
    [
        ("rocking ", {"cor", "simulate", "campaign"}, "ked"),
        ("rocking m", {"map", "minimum", "models", "motion"}, "cor"),
        ("rocking simulate --re", {"--restitution"}, "--friction"),
        ("rocking simulate --restitution h", {"housner", "horizontal-momentum"}, "ked"),
        ("rocking cor --restitution ked", {"ked", "ked-3d"}, "housner"),
        ("rocking example st", {"statue", "stele", "stripes"}, "pier"),
        ("rocking models ked", {"ked", "ked-3d", "ked-3d-point"}, "housner"),
        ("rocking simulate b.toml ric", {"ricker:"}, "sine:"),
        ("rocking map --set settings.o", {"settings.order="}, "settings.gravity="),
        ("rocking simulate --set res", {"response.free=", "restitution.value="}, "settings.order="),
        ("rocking map --set ", {"map.refine=", "motion.scale="}, "restitution.value="),
        ("rocking simulate --set response.f", {"response.free=", "response.friction="}, "map.x="),
    ],
)
def test_names_are_completed(line, some, other):
    """Commands, options, models, pulses and keys that begin as typed are offered, and no other."""
    words = offered(line)
    assert some <= set(words)
    assert other not in words


def test_every_model_is_offered():
    """All models of the plane are offered where nothing is typed yet."""
    assert offered("rocking simulate --restitution ") == list(rk.restitution.models())


def test_files_are_left_to_the_shell():
    """Where a record is meant nothing is offered, upon which shells offer files."""
    assert offered("rocking simulate body.toml ") == []


def test_zsh_is_answered_too():
    """The same in the words of zsh."""
    assert "housner" in " ".join(offered("rocking simulate --restitution h", "zsh"))
