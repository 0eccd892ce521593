"""The command line as a user has it: exit code, what it prints, and how it refuses."""

import json

import pytest

from rocking.answers import Answer
from rocking.cli import main


@pytest.fixture(autouse=True)
def _no_lines(monkeypatch):
    """Write no line about the progress, however slow the machine is."""
    monkeypatch.setattr("rocking.cli.page.SECONDS", 1e6)


# modules of commands of whose answers some numbers are no quantities yet
INCOMPLETE = {"test_identify_command", "test_validate_command", "test_evidence_command"}


@pytest.fixture(autouse=True)
def _quantities(monkeypatch, request):
    """Let every answer that a test prints as JSON have a quantity, and so a unit, for each of its numbers."""
    plain, incomplete = Answer.plain, request.module.__name__.rpartition(".")[2] in INCOMPLETE

    def checked(answer):
        assert incomplete or answer.bare == []
        return plain(answer)

    monkeypatch.setattr(Answer, "plain", checked)


@pytest.fixture
def run(capsys, request):
    """Return what runs `rocking WORDS` after the COMMAND of the module: exit code, standard output, standard error."""
    command = getattr(request.module, "COMMAND", "").split()

    def call(*words):
        with pytest.raises(SystemExit) as stop:
            main([*command, *(str(word) for word in words)])
        printed = capsys.readouterr()
        return stop.value.code or 0, printed.out, printed.err

    return call


@pytest.fixture
def printed(run):
    """Return what gives the page of a run that succeeds."""

    def call(*words):
        code, out, err = run(*words)
        assert code == 0, err
        return out

    return call


@pytest.fixture
def answered(run):
    """Return what gives the JSON of a run that succeeds without a word on standard error."""

    def call(*words):
        code, out, err = run(*words, "--json")
        assert (code, err) == (0, "")
        return json.loads(out, parse_constant=pytest.fail)

    return call


@pytest.fixture
def refuses(run):
    """Return what asserts that a run ends with code 2 and one sentence on standard error, and prints no number."""

    def check(words, sentence):
        code, out, err = run(*words)
        assert (code, out) == (2, "")
        assert sentence in err
        assert err.startswith("rocking: ")
        assert err.count("\n") == 1

    return check
