"""The documentation of the keys of a question, and the options that say them, come from its tables."""

from pathlib import Path

from rocking.spec.reference import reference

ROOT = Path(__file__).parents[2]


def test_the_documentation_of_keys_is_that_of_the_tables():
    """docs/questions.md ends with what the tables say of themselves; every key has its meaning."""
    text = reference()
    assert (ROOT / "docs" / "questions.md").read_text(encoding="utf-8").endswith(text)
    rows = [line for line in text.splitlines() if line.startswith("| `")]
    assert [row for row in rows if row.endswith("|  |")] == []
