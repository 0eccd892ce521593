"""Answers of an earlier version, kept to notice change: regression only, they say nothing of what is right.

Words, verdicts and counts are compared exactly, numbers to 1e-9; where a change is meant, CHANGELOG says so and
`python tests/regression/golden.py commit` writes them anew.
"""

import gzip
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
PROGRAM = """
import json, sys
import golden, trees
print(json.dumps(trees.thinned(golden.answers(sys.argv[1]))))
"""


@pytest.fixture(scope="module")
def kept() -> Any:
    """Return the answers that were kept."""
    return json.loads(gzip.decompress((HERE / "answers.json.gz").read_bytes()))


@pytest.mark.parametrize("group", ["python", "commands", "application"])
def test_answers_are_what_they_were(kept: Any, group: str) -> None:
    """No answer has moved by more than 1e-9, and no word or count at all."""
    sys.path.insert(0, str(HERE))
    try:
        import trees
    finally:
        sys.path.remove(str(HERE))
    said = subprocess.run(
        [sys.executable, "-c", PROGRAM, group], cwd=HERE, capture_output=True, text=True, check=True
    ).stdout
    now = json.loads(said)
    assert trees.differences(kept[group], now, 1e-9) == []
    # negative control: one number that moves by 1e-8, or one word, is noticed
    where, number = next((w, v) for w, v in trees.leaves(now) if isinstance(v, float) and v > 1.0)
    place = now
    *path, last = where.split("/")[1:]
    for part in path:
        place = place[int(part) if isinstance(place, list) else part]
    place[int(last) if isinstance(place, list) else last] = number * (1.0 + 1e-8)
    assert len(trees.differences(kept[group], now, 1e-9)) == 1
