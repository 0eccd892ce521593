"""What an earlier run has left: kept if whole, set aside if not, never trusted unread."""

import dataclasses
import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from campaign_jobs import flip

from rocking.campaigns import Campaign, CampaignDamagedError, CampaignIncompleteError, CampaignMismatchError, identity
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="campaigns")

DISK_FLIPS = 200
Shards = Callable[[Campaign], dict[str, str]]


def paths(campaign):
    return [campaign.folder / "shards" / f"{campaign.plan.chunk(k).name}.shard" for k in range(campaign.plan.chunks)]


@pytest.mark.slow
@pytest.mark.verifies("damage", "single bits of shards flipped on disk")
def test_flips_on_disk_are_found_and_mended(finished, shards):
    """200 flips of shards on disk: reading refuses them, a run sets them aside and computes the same bytes again."""
    before, digest = shards(finished), finished.sha256()
    random = np.random.default_rng(4)
    for _ in range(DISK_FLIPS // 5):
        hit = random.choice(6, 5, replace=False)
        for k in hit:
            flip(paths(finished)[k], int(random.integers(8 * paths(finished)[k].stat().st_size)))
        assert len(finished.verify().damaged) == 5
        with pytest.raises(CampaignDamagedError, match="run the campaign again to compute it"):
            finished.results()
        summary = finished.run(workers=1)
        assert (summary.computed, len(summary.set_aside)) == (5, 5)
        assert finished.verify().is_complete
    assert (shards(finished), finished.sha256()) == (before, digest)
    assert len(list((finished.folder / "shards").glob("*.damaged-*"))) == DISK_FLIPS
    assert len(finished.status().damaged) == DISK_FLIPS


@pytest.mark.slow
@pytest.mark.parametrize("length", [0, 1, 100, -1, None])
def test_truncated_shard_is_mended(finished, shards, length):
    """A shard that was cut short is set aside and computed again; one that somebody deleted too, and that is said."""
    before = shards(finished)
    path = paths(finished)[3]
    if length is None:
        path.unlink()
        assert "is missing" in finished.verify().damaged[0]
    else:
        path.write_bytes(path.read_bytes()[:length])
    summary = finished.run(workers=1)
    assert ("is missing" if length is None else "computed again") in summary.set_aside[0]
    assert shards(finished) == before


def test_shards_that_nobody_recorded_are_adopted_or_set_aside(finished, tmp_path, work):
    """Killed between writing and recording: whole shards count, broken ones and unfinished ones do not."""
    other = Campaign.create(tmp_path / "other", work, 50)
    mine, theirs = paths(other), paths(finished)
    mine[0].write_bytes(theirs[0].read_bytes())
    mine[1].write_bytes(theirs[1].read_bytes()[:-1])
    (other.folder / "shards" / f".{mine[2].name}.1-abc.part").write_bytes(b"half")
    summary = other.run(workers=1)
    assert (summary.adopted, summary.computed, len(summary.set_aside)) == (1, 5, 1)
    assert not list((other.folder / "shards").glob(".*"))
    assert other.sha256() == finished.sha256()


@pytest.mark.slow
def test_identity_that_changed_is_refused(finished, work):
    """No bit of campaign.json may change: 300 flips, each with a sentence and a way out."""
    path = finished.folder / "campaign.json"
    good = path.read_bytes()
    for bit in np.random.default_rng(3).integers(0, 8 * len(good), 300):
        path.write_bytes(good)
        flip(path, int(bit))
        with pytest.raises(CampaignDamagedError, match=r"campaign\.json: the file is damaged .* the shards are intact"):
            Campaign.open(finished.folder, work)
    for length in range(0, len(good), 97):
        path.write_bytes(good[:length])
        with pytest.raises(CampaignDamagedError, match="is damaged"):
            Campaign.open(finished.folder, work)
    path.write_bytes(good)
    assert Campaign.open(finished.folder, work).plan.key == finished.plan.key


def test_way_out_of_a_damaged_identity_works(finished, tmp_path, work):
    """A new campaign of the same histories adopts the shards of one whose campaign.json is lost."""
    other = Campaign.create(tmp_path / "other", work, 50)
    for path in paths(finished):
        os.link(path, other.folder / "shards" / path.name)
    assert other.run(workers=1).computed == 0
    assert other.sha256() == finished.sha256()


def test_other_histories_are_refused_by_name(finished, work, make):
    """What differs is named: settings, the law, the arrays."""
    settings = dataclasses.replace(work.settings, linear=True)
    with pytest.raises(CampaignMismatchError, match=r"settings\.linear was False, is True"):
        Campaign.open(finished.folder, dataclasses.replace(work, settings=settings))
    with pytest.raises(CampaignMismatchError, match=r"content\.alpha_left was .*; and \d more"):
        Campaign.open(finished.folder, make(seed=6))
    with pytest.raises(CampaignMismatchError, match="count was 300, is 301"):
        Campaign.open(finished.folder, make(301))


def test_other_versions_are_refused(finished, work, monkeypatch):
    """Results of two versions of the package, or of two engines, are not mixed."""
    monkeypatch.setattr(identity, "software", lambda: "9.9")
    with pytest.raises(CampaignMismatchError, match=r"The campaign was begun with software .*\. Results of 9\.9"):
        Campaign.open(finished.folder, work)


def test_histories_that_changed_are_refused_by_a_run(campaign, work):
    """Between creating and running, somebody writes into an array or a law: no chunk is computed of it."""
    work.values["scale"] = 2.0 * work.values["scale"]
    with pytest.raises(CampaignMismatchError, match=r"content\.scale was .*, is "):
        campaign.run(workers=1)
    work.values["scale"] = 0.5 * work.values["scale"]
    object.__setattr__(work, "law", dataclasses.replace(work.law, seed=4))  # type: ignore[type-var]
    with pytest.raises(CampaignMismatchError, match=r"law\.content\.seed was 3, is 4"):
        campaign.run(workers=1)
    assert campaign.status().chunks_done == 0


def test_folders_are_refused(finished, tmp_path, work):
    """No campaign, one that is there already, other things in the folder, a file in the way."""
    with pytest.raises(CampaignMismatchError, match="contains no campaign"):
        Campaign.open(tmp_path, work)
    with pytest.raises(CampaignMismatchError, match="already contains a campaign"):
        Campaign.create(finished.folder, work)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(CampaignMismatchError, match=r"not empty \(letter\.txt"):
        Campaign.create(tmp_path / "full", work)


def test_refusals_of_arguments(finished, tmp_path):
    """What is not an argument of a run has a sentence."""
    bad: list[tuple[dict[str, Any], str]] = [
        ({"executor": "threads"}, "executor must be"),
        ({"workers": 0}, "workers must be a whole number"),
        ({"executor": "processes", "workers": True}, "workers must be a whole number"),
        ({"executor": "processes", "start_method": "magic"}, "start_method must be one of"),
        ({"start_method": "fork"}, "applies to"),
        ({"progress": 3}, "progress must be a function"),
        ({"order_seed": -1}, "order_seed must be a whole number"),
    ]
    for arguments, words in bad:
        with pytest.raises(InvalidValueError, match=words):
            finished.run(**arguments)
    with pytest.raises(InvalidValueError, match="histories must be a Table"):
        Campaign.create(tmp_path / "new", 3)  # type: ignore[arg-type]
    assert not (tmp_path / "new").exists()


def test_unfinished_campaigns_give_no_numbers(campaign):
    """Results exist when all of them exist; there are no fill values."""
    for read in (campaign.results, campaign.sha256, lambda: next(campaign.pieces())):
        with pytest.raises(CampaignIncompleteError, match="0 of 6 chunks are finished"):
            read()
