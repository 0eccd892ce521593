"""The command line as a user has it: exit code, what it prints, and how it refuses."""

import pytest

from rocking.answers import Answer


@pytest.fixture(autouse=True)
def _no_lines(monkeypatch):
    """Write no line about the progress, however slow the machine is."""
    monkeypatch.setattr("rocking.cli.page.SECONDS", 1e6)


@pytest.fixture(autouse=True)
def _quantities(monkeypatch):
    """Let every answer that a test prints as JSON have a quantity, and so a unit, for each of its numbers."""
    plain = Answer.plain

    def checked(answer):
        assert answer.bare == []
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
