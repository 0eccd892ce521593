"""What `--help` prints: every word that was written, and the unit of every quantity."""

import re

import pytest
import typer
from rich.text import Text

from rocking.cli import main
from rocking.cli.application import application

COMMANDS = typer.main.get_command(application()).commands
LENGTH = "[m, or --units]"
SIZES = {**dict.fromkeys(("--width", "--height", "--depth"), LENGTH), "--density": "[kg/m3]"}
UNITS = {"cor": SIZES, "simulate": {**SIZES, "--friction": "[-]", "--scale": "[-]"}, "motion": {"--periods": "[s]"}}


def shown(capsys, monkeypatch, command):
    """Help of a command on a wide page, with single blanks."""
    monkeypatch.setenv("COLUMNS", "300")
    monkeypatch.setenv("TERM", "dumb")
    with pytest.raises(SystemExit) as stop:
        main([command, "--help"])
    assert not stop.value.code
    return re.sub(r"[ \t]+", " ", capsys.readouterr().out)


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_no_word_of_the_help_is_lost(capsys, monkeypatch, command):
    """Every help text appears in full: what is in square brackets is not taken for a style and left out."""
    page = shown(capsys, monkeypatch, command)
    for parameter in COMMANDS[command].params:
        said = (parameter.help or "").replace("\\[", "[")
        assert said in page, parameter.name
    # negative control: without the backslash the unit would be gone
    assert Text.from_markup("Density [kg/m3].").plain == "Density ."


@pytest.mark.parametrize("command", sorted(UNITS))
def test_quantities_have_their_unit(capsys, monkeypatch, command):
    """The line of each option that takes a quantity names its unit, within the panels; lengths say how to change it."""
    page = shown(capsys, monkeypatch, command)
    for option, unit in UNITS[command].items():
        (line,) = [line for line in page.splitlines() if re.search(rf" {option} +[<A-Z]", line)]
        assert unit in line
    assert "\u256d\u2500 Output \u2500" in page
