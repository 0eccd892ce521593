"""The command line as a user has it: exit code, what it prints, and how it refuses."""

import pytest

from rocking.answers import Answer


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
def file(tmp_path):
    """Return what writes a file of the user's."""

    def write(text, name="body.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write
