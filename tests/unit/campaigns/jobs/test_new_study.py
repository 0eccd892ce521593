"""A new study is one file in `rocking.spec.questions`: for jobs, campaigns, exports, the application and the manual."""

import json
import re

import numpy as np
import pytest
from new_study import JOB, TABLES, added

from rocking import cli
from rocking.campaigns.jobs import Job, JobFolder, status_of
from rocking.errors import InvalidValueError
from rocking.spec.questions import question_in
from rocking.spec.reference import keys_of, reference

__all__ = ["added"]  # a fixture


@pytest.mark.slow
def test_one_file_is_a_study_everywhere(added, capsys):
    (added / "job.toml").write_text(JOB, encoding="utf-8")
    job = Job.read(added / "job.toml")
    assert job.study.dims == {"motion": 2, "scale": 2}
    assert (job.problem.answer()["outcome"] == 2).any()
    for words in (
        "check job.toml",
        "run job.toml --output c",
        "status c",
        "export c -o a.nc -o a.csv -o a.png",
    ):
        arguments = [str(added / word) if "." in word or word == "c" else word for word in words.split()]
        with pytest.raises(SystemExit, match="0"):
            cli.main(["campaign", *arguments, "--json"])
    assert capsys.readouterr().out.count('"kind": "polarity"') == 3
    assert (added / "a.png").read_bytes().startswith(b"\x89PNG")
    assert status_of(added / "c").complete
    assert JobFolder.open(added / "c").campaign.results()["outcome"].size == 4
    assert keys_of("polarity") == ["factor"]
    page = reference()["input_files"]
    assert "## [polarity]" in page
    assert "| `factor` | number |" in page.partition("## [polarity]")[2]


@pytest.mark.slow
def test_one_file_is_a_command(added, run, refuses, monkeypatch):
    """Its options are the keys of its table; files say the same, and the list has it."""
    words = [
        "polarity",
        "--width",
        "0.5",
        "--height",
        "2",
        "sine:amplitude=4,period=0.5",
        "ricker:amplitude=6,period=0.9",
    ]
    files = [word for name in ("a.png", "a.csv") for word in ("--output", added / name)]
    code, out, err = run(*words, "--factor", 2, "--json", *files)
    assert (code, err) == (0, "")
    answer = json.loads(out)
    assert answer["scale"] == [2.0, -2.0]
    assert 2 in np.ravel(answer["outcome"])
    assert (added / "a.png").read_bytes().startswith(b"\x89PNG")
    (added / "job.toml").write_text(JOB, encoding="utf-8")
    assert json.loads(run("polarity", added / "job.toml", "--json")[1])["outcome"] == answer["outcome"]
    monkeypatch.setenv("COLUMNS", "200")
    assert "Scale factor of both polarities [-]. [default: 1.0]" in run("polarity", "--help")[1]
    assert re.search(r"polarity +Every motion as recorded and reversed\.", run("--help")[1])
    refuses((*words, "--factor", "0"), "--factor must be")
    refuses(("polarities",), "polarit")


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"polarity": {"factor": -1.0}}, r"polarity\.factor must be a number > 0, got -1"),
        ({"polarity": {"factors": 1.0}}, "polarity: unknown key 'factors'; did you mean factor"),
        ({"polarity": None}, "polarity"),
        ({"map": {}}, r'kind = "polarity" does not accept \[map\]. Use \[polarity\]'),
        ({"body": None}, r"\[body\] is missing"),
    ],
)
def test_its_refusals_are_those_of_its_class(added, tables, words):
    with pytest.raises(InvalidValueError, match=words):
        question_in(TABLES | tables)
