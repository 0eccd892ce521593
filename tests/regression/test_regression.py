"""Answers of an earlier version, kept to notice change: regression only, they do not show what is right.

Words, verdicts and counts are compared exactly, numbers to 1e-6. Hashes and counts of work, which differ from one
processor to another, are left out. Where a change is meant, CHANGELOG gives it and
`python tests/regression/golden.py commit` writes the answers again.
"""

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from rocking.dynamics.plane import fast_engine

HERE = Path(__file__).parent
APPLICATION = pytest.mark.skipif(find_spec("rocking_workbench") is None, reason="rocking-workbench is not installed")
PROGRAM = """
import gzip, json, sys
import golden, trees

kept = json.loads(gzip.decompress(golden.COMMITTED.read_bytes()))[sys.argv[1]]
now = json.loads(json.dumps(trees.thinned(golden.answers(sys.argv[1]))))
print(json.dumps(trees.differences(kept, now, 1e-6)))
where, number = next((w, v) for w, v in trees.leaves(now) if isinstance(v, float) and v > 1.0)
*path, last = (int(part) if part.isdigit() else part for part in where.split("/")[1:])
branch = now
for part in path:
    branch = branch[part]
branch[last] = number * (1.0 + 1e-5)
print(json.dumps(trees.differences(kept, now, 1e-6)))
"""


@pytest.mark.slow
@pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")
@pytest.mark.parametrize("group", ["python", "commands", pytest.param("application", marks=APPLICATION)])
def test_answers_are_what_they_were(group: str) -> None:
    """No answer has moved; a change of one number by 1e-5 is noticed (the negative control)."""
    command = [sys.executable, "-c", PROGRAM, group]
    done = subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=True)
    moved, control = map(json.loads, done.stdout.splitlines())
    assert moved == []
    assert len(control) == 1
