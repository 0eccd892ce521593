"""The hand-made errors of benchmarks/mutants.toml belong to the sources and the tests as they are."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TABLES = tomllib.loads((ROOT / "benchmarks" / "mutants.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("kind", ["engine", "python"])
def test_the_text_of_every_error_is_once_in_its_file(kind):
    """An error whose old text has changed cannot be made, and `make mutants` would stop."""
    entries = TABLES[kind]
    counts = {
        entry["name"]: (ROOT / entry["file"]).read_text(encoding="utf-8").count(entry["old"]) for entry in entries
    }
    assert counts == dict.fromkeys(counts, 1)
    assert len(counts) == len(entries)


def test_every_test_of_an_error_exists():
    paths = {path for rows in TABLES["tests"].values() for path in rows}
    paths |= {path for entry in TABLES["python"] for path in entry["tests"]}
    assert sorted(path for path in paths if not (ROOT / path).exists()) == []
