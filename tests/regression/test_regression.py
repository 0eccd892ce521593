"""Answers of an earlier version, kept to notice change: regression only, they say nothing of what is right.

Words, verdicts and counts are compared exactly, numbers to 1e-9, fitted ones to 1e-6, where searches end; where a
change is meant, CHANGELOG says so and `python tests/regression/golden.py commit` writes them anew.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rocking.dynamics.plane import fast_engine

HERE = Path(__file__).parent
FITTED = ("/league/", "/evidence/", "_95", "interval", "prediction")
PROGRAM = """
import gzip, json, sys
import golden, trees

def moved(now):
    said, fitted = trees.differences(kept, now, 1e-9), set(trees.differences(kept, now, 1e-6))
    return [line for line in said if line in fitted or not any(word in line for word in sys.argv[2:])]

kept = json.loads(gzip.decompress(golden.COMMITTED.read_bytes()))[sys.argv[1]]
now = json.loads(json.dumps(trees.thinned(golden.answers(sys.argv[1]))))
print(json.dumps(moved(now)))
where, number = next((w, v) for w, v in trees.leaves(now) if isinstance(v, float) and v > 1.0)
*path, last = (int(part) if part.isdigit() else part for part in where.split("/")[1:])
place = now
for part in path:
    place = place[part]
place[last] = number * (1.0 + 1e-8)
print(json.dumps(moved(now)))
"""


@pytest.mark.skipif(
    not fast_engine.available() or fast_engine.instruction_set() == "plain",
    reason="kernels without fused multiply-add have other last digits",
)
@pytest.mark.parametrize("group", ["python", "commands", "application"])
def test_answers_are_what_they_were(group: str) -> None:
    """No answer has moved; one number that moves by 1e-8 is noticed (the negative control)."""
    command = [sys.executable, "-c", PROGRAM, group, *FITTED]
    done = subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=True)
    moved, control = map(json.loads, done.stdout.splitlines())
    assert moved == []
    assert len(control) == 1
