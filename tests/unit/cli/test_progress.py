"""Progress on standard error where it is no terminal: a line every few seconds, and none with --json."""

import json
import time

import pytest

from rocking.cli import campaign_output, page
from rocking.errors import InvalidValueError

BLOCK = ("--width", 0.5, "--height", 2.0, "--motion", "sine:amplitude=3,period=0.6")
pytestmark = pytest.mark.verifies(room="the command line")


@pytest.fixture(autouse=True)
def _often(monkeypatch, _no_lines):
    monkeypatch.setattr(page, "SECONDS", 0.05)


def slow(*words, **options):
    """Take longer than several lines, and fail."""
    time.sleep(0.4)
    raise InvalidValueError("enough")


def test_lines_count(capsys):
    """Number done, total and time, a step by its name; nothing where the run is quiet or over at once."""
    with page.bar("motions", 5) as progress:
        progress(2)
        time.sleep(0.3)
        progress(1, "motion c")
        time.sleep(0.3)
    err = capsys.readouterr().err
    assert "rocking: motions: 2 of 5, 0 s\n" in err
    assert "rocking: motion c: 3 of 5, " in err
    with page.bar("motions", 5, quiet=True) as progress:
        progress(1)
        time.sleep(0.2)
    with page.bar("motions", 5):
        pass
    assert not capsys.readouterr().err
    time.sleep(0.2)
    assert not capsys.readouterr().err, "the lines end with the work"


def test_lines_end_with_an_error(capsys):
    with pytest.raises(ValueError, match="enough"), page.bar("reading"):  # noqa: PT012 - what takes time fails
        time.sleep(0.3)
        raise ValueError("enough")
    assert capsys.readouterr().err.startswith("rocking: reading, 0 s\n")
    time.sleep(0.2)
    assert not capsys.readouterr().err


def test_campaigns_have_lines(capsys):
    """The histories done and the time left, as far as known."""

    class Half:
        done_histories, total, rate, left = 50, 100, 3.0, None

    with campaign_output.bar("job", 100, quiet=False) as tell:
        time.sleep(0.2)
        tell(Half())
        time.sleep(0.3)
    err = capsys.readouterr().err
    assert "rocking: job: 0 of 100 histories, " in err
    assert "rocking: job: 50 of 100 histories, " in err
    with campaign_output.bar("job", 100, quiet=True) as tell:
        tell(Half())
        time.sleep(0.2)
    assert not capsys.readouterr().err


@pytest.mark.parametrize(
    ("place", "words", "line"),
    [
        ("rocking.reports.paper_document.reproduce", ("reproduce",), "recomputing tables and claims"),
        ("rocking.spec.prediction.PredictionProblem.of", ("predict", *BLOCK), "reading body and motions"),
        ("rocking.spec.prediction.PredictionProblem.answer", ("predict", *BLOCK), "motions: 0 of 1"),
        ("rocking.spec.prediction.PredictionProblem.of", ("assess", *BLOCK), "reading body and motions"),
        ("rocking.cli.responses.answer_of", ("simulate", *BLOCK), "history"),
    ],
)
def test_commands_have_lines(run, monkeypatch, place, words, line):
    """A line names the step of a command, on standard error alone; --json has none."""
    monkeypatch.setattr(place, slow)
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert f"rocking: {line}, 0 s\n" in err
    assert json.loads(run(*words, "--json")[2])["error"]["message"] == f"enough; see rocking {words[0]} --help"
