"""A small study that campaigns are tried on."""

import hashlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from rocking.campaigns import Campaign
from rocking.dynamics import RandomRestitution
from rocking.studies import HistoryTable, MotionList

RANGES = {"alpha": (0.08, 0.5), "p": (0.9, 5.0), "r": (0.5, 0.95)}


def made(count: int = 300, seed: int = 5) -> HistoryTable:
    """Random blocks and coefficients under four pulses."""
    random = np.random.default_rng(seed)
    motions = MotionList([rk.pulses.sine(a, period) for a in (3.0, 8.0) for period in (0.4, 1.1)])
    values = {f"{n}_{side}": random.uniform(*RANGES[n], count) for n in RANGES for side in ("right", "left")}
    law = RandomRestitution.normal(0.95, 0.02, seed=3)
    return HistoryTable(motions, random.integers(0, len(motions), count), values, law=law)


@pytest.fixture
def work() -> HistoryTable:
    """300 histories."""
    return made()


@pytest.fixture
def make() -> Callable[..., HistoryTable]:
    """As many histories as wanted, of a seed."""
    return made


@pytest.fixture
def campaign(tmp_path: Path, work: HistoryTable) -> Campaign:
    """A campaign of 300 histories in 6 chunks, of which nothing is computed."""
    return Campaign.create(tmp_path / "c", work, 50)


@pytest.fixture
def finished(tmp_path: Path) -> Campaign:
    """A campaign of 300 histories in 6 chunks that is through."""
    campaign = Campaign.create(tmp_path / "campaign", made(), 50)
    campaign.run(workers=1)
    return campaign


@pytest.fixture
def shards() -> Callable[[Campaign], dict[str, str]]:
    """Names and hashes of the files that a campaign has made."""

    def look(campaign: Campaign) -> dict[str, str]:
        found = sorted((campaign.folder / "shards").glob("*.shard"))
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in found}

    return look
