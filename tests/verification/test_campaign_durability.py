"""kill -9 at random instants: nothing acknowledged is lost, nothing is corrupt, the end is that of a quiet run.

How often is the environment variable ROCKING_KILLS: 30 if not given, 300 in `make durability`. Half as many single
workers are killed on top. What is acknowledged is told by the campaign through a pipe, right after each commit; the
ledger is read by plain SQL from a copy.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from waiting import HANG

from rocking.dynamics.plane import fast_engine

DRIVER = Path(__file__).parent / "durability" / "kill_driver.py"
ROUNDS = DRIVER.with_name("round_driver.py")
KILLS = int(os.environ.get("ROCKING_KILLS", "30"))
SHARES = {"serial": KILLS - KILLS // 2 - KILLS // 6, "fork": KILLS // 2, "spawn": KILLS // 6}

pytestmark = [
    pytest.mark.verifies("damage", control="test_careless_campaigns_are_caught", room="campaigns"),
    pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built"),
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="process groups and /proc of Linux"),
]


def found(folder: Path, *arguments: object, driver: Path = DRIVER) -> Any:
    """What the driver says: into files, since pipes would be held open by a process that outlives it."""
    command = [sys.executable, str(driver), str(folder), *map(str, arguments)]
    said, wrong = (folder.with_name(f"{folder.name}-{name}") for name in ("said", "wrong"))
    with said.open("w") as out, wrong.open("w") as err:
        done = subprocess.run(command, stdout=out, stderr=err, check=False, timeout=HANG + 20.0 * KILLS)
    assert done.returncode == 0, wrong.read_text()
    return json.loads(said.read_text())


@pytest.mark.slow
@pytest.mark.verifies(against="kill -9 of the whole process group, and a quiet run")
@pytest.mark.parametrize("pieces", [False, True], ids=["chunks", "pieces"])
@pytest.mark.parametrize("how", SHARES)
def test_killed_groups_lose_nothing(tmp_path: Path, how: str, pieces: bool) -> None:
    """The whole process group dies, in any phase: what was acknowledged is there, and the end is a quiet run's."""
    cut = ["--pieces"] if pieces else []
    kills = SHARES[how] if how == "spawn" else -(-SHARES[how] // 2)
    report = found(tmp_path, "--how", how, "--kills", kills, "--seed", 11, *cut)
    print(how, report)
    assert report["killed within a chunk"] > 0 or how == "spawn" or not pieces  # spawned workers take long to start
    assert report["kills"] >= kills
    assert report["wrong"] == []
    assert report["acknowledged, checked"] > 0


@pytest.mark.slow
@pytest.mark.verifies(against="kill -9 of single workers, and a quiet run")
def test_killed_workers_cost_nothing(tmp_path: Path) -> None:
    """Single workers die at random; the campaign goes on by itself to the same bytes."""
    report = found(tmp_path, "--how", "fork", "--kills", KILLS // 2, "--workers", "--seed", 12, "--pieces")
    print("workers", report)
    assert report["kills"] >= KILLS // 2
    assert report["wrong"] == []
    assert report["retries"] > 0


@pytest.mark.slow
@pytest.mark.verifies(against="kill -9 between and within rounds, and a quiet run", control="within")
def test_killed_rounds_lose_nothing(tmp_path: Path) -> None:
    """A refined map, each of whose rounds follows from the last, dies at random instants; its polylines stay."""
    report = found(tmp_path, "--kills", KILLS // 3, "--seed", 14, driver=ROUNDS)
    print("rounds", report)
    assert report["kills"] >= KILLS // 3
    assert report["wrong"] == []
    assert report["acknowledged, checked"] > 0
    careless = found(tmp_path / "careless", "--kills", 200, "--variant", "in-place", driver=ROUNDS)
    assert careless["wrong"]  # negative control: files cut short are seen


@pytest.mark.slow
@pytest.mark.verifies("negative control", "shards written in place, and records that come before them")
@pytest.mark.parametrize(
    ("variant", "sentences"),
    # recorded first, a shard is either missing at the kill or not yet whole
    [("in-place", ("incomplete",)), ("record-first", ("are recorded, and have no shard", "incomplete"))],
)
def test_careless_campaigns_are_caught(tmp_path: Path, variant: str, sentences: tuple[str, ...]) -> None:
    """Negative control: shards written in place, and records that come before shards, fail the same check."""
    report = found(tmp_path, "--variant", variant, "--kills", 200, "--seed", 13)
    print(variant, report)
    assert any(sentence in wrong for wrong in report["wrong"] for sentence in sentences)
