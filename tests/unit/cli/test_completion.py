"""What a shell offers on Tab, asked as the shells ask, and what `--help` prints."""

import os
import re
import subprocess
import sys

import pytest
import typer

import rocking as rk
from rocking.cli import main
from rocking.cli.application import application


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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "some", "other"),
    [
        ("rocking ", {"restitution", "simulate", "campaign"}, "ked"),
        ("rocking m", {"map", "models", "measurements"}, "restitution"),
        ("rocking record ", {"show", "batch", "convert", "formats"}, "map"),
        ("rocking simulate --re", {"--restitution"}, "--friction"),
        ("rocking simulate --restitution h", {"housner", "horizontal-momentum"}, "ked"),
        ("rocking restitution --restitution ked", {"ked", "ked-3d"}, "housner"),
        ("rocking examples st", {"statue", "stele", "stripes"}, "pier"),
        ("rocking models ked", {"ked", "ked-3d", "ked-3d-point"}, "housner"),
        ("rocking simulate b.toml ric", {"ricker:"}, "sine:"),
        ("rocking map --set settings.o", {"settings.order="}, "settings.gravity="),
        ("rocking simulate --set res", {"response.initial_rotation=", "restitution.value="}, "settings.order="),
        ("rocking map --set ", {"map.refine=", "motion.scale="}, "restitution.value="),
        ("rocking simulate --set response.f", {"response.friction="}, "map.x="),
    ],
)
def test_names_are_completed(line, some, other):
    """Commands, options, models, pulses and keys that begin as typed are offered, and no other."""
    words = offered(line)
    assert some <= set(words)
    assert other not in words


@pytest.mark.slow
def test_every_model_is_offered():
    """All models of the plane are offered where nothing is typed yet."""
    assert offered("rocking simulate --restitution ") == list(rk.restitution.models())


@pytest.mark.slow
def test_files_are_left_to_the_shell():
    """Where a record is meant nothing is offered, upon which shells offer files."""
    assert offered("rocking simulate body.toml ") == []


@pytest.mark.slow
def test_zsh_is_answered_too():
    """The same in the words of zsh."""
    assert "housner" in " ".join(offered("rocking simulate --restitution h", "zsh"))


LENGTH = "[m, or --units]"
SIZES = {**dict.fromkeys(("--width", "--height", "--depth"), LENGTH), "--density": "[kg/m3]"}
UNITS = {
    "restitution": SIZES,
    "simulate": {**SIZES, "--friction": "[-]", "--scale": "[-]"},
    "record show": {"--periods": "[s]"},
}


def shown(capsys, monkeypatch, command):
    """All options of a command; the lines of one option are one line, with single blanks."""
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit) as stop:
        main([*command.split(), "--help-all"])
    assert not stop.value.code
    return re.sub(r"[ \t]+", " ", re.sub(r"\n {20,}", " ", capsys.readouterr().out)).replace("- ", "-")


def leaves(command, name=""):
    """Every command by its words."""
    if not hasattr(command, "commands"):
        return {name.strip(): command}
    of_groups = [leaves(one, f"{name} {key}") for key, one in command.commands.items()]
    return {words: one for group in of_groups for words, one in group.items()}


COMMANDS = leaves(typer.main.get_command(application()))


@pytest.mark.parametrize("command", COMMANDS)
def test_no_word_of_the_help_is_lost(capsys, monkeypatch, command):
    """Every help text appears in full: what is in square brackets is not taken for a style and left out."""
    page = shown(capsys, monkeypatch, command)
    for parameter in COMMANDS[command].params:
        text = re.sub(r" +", " ", (parameter.help or "").replace("\\[", "["))
        assert text.replace("- ", "-") in page, parameter.name


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_at_most_40_lines(capsys, monkeypatch, command):
    """At 80 columns; an option that is left out is in --help-all, to which the help refers."""
    monkeypatch.setenv("COLUMNS", "80")
    pages = []
    for option in ("--help", "--help-all"):
        with pytest.raises(SystemExit):
            main([*command.split(), option])
        pages.append(capsys.readouterr().out)
    short, complete = pages
    assert len(short.splitlines()) <= 40
    assert f"rocking {command} --help-all" in short
    assert re.findall(r"^  (?:-o, )?--[a-z-]+", complete, re.M)
    assert "--quiet" in complete


@pytest.mark.parametrize("command", sorted(UNITS))
def test_quantities_have_their_unit(capsys, monkeypatch, command):
    """The line of each option that takes a quantity names its unit, within the panels; lengths say how to change it."""
    page = shown(capsys, monkeypatch, command)
    for option, unit in UNITS[command].items():
        (line,) = [line for line in page.splitlines() if re.search(rf" {option} +[<A-Z]", line)]
        assert unit in line
    assert "\nOutput:\n" in page


@pytest.mark.parametrize("group", [[], ["record"], ["campaign"], ["measurements"]])
def test_help_all_of_a_group_is_its_help(capsys, group):
    """A group of commands accepts --help-all; with an unknown option (negative control) it ends with code 2."""
    pages = []
    for option, code in (("--help", 0), ("--help-all", 0), ("--help-every", 2)):
        with pytest.raises(SystemExit) as stop:
            main([*group, option])
        assert (stop.value.code or 0) == code
        pages.append(capsys.readouterr().out)
    assert pages[0] == pages[1] != pages[2]
