"""The list of the slowest tests names tests that exist, and says of each why it takes as long."""

import csv
from pathlib import Path

ROOT = Path(__file__).parents[2]


def faults(rows: list[dict[str, str]]) -> list[str]:
    """Return the tests of a list that do not exist, or that have no time or no reason."""

    def stands(row: dict[str, str]) -> bool:
        file, _, name = row["test"].partition("::")
        path = ROOT / file
        return path.is_file() and f"def {name}(" in path.read_text("utf-8")

    return [row["test"] for row in rows if not (stands(row) and float(row["seconds"]) > 0.0 and row["reason"])]


def test_every_slow_test_has_a_reason():
    """Negative control: a renamed test, and one without a reason."""
    with (ROOT / "tests/slowest.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert faults(rows) == []
    assert len(rows) > 80
    wrong = [rows[0] | {"test": rows[0]["test"] + "_once"}, rows[1] | {"reason": ""}]
    assert faults(wrong) == [row["test"] for row in wrong]
