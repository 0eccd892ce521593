"""The ledger: damage is noticed, never believed, and the shards make it anew."""

import random
import shutil
import sqlite3
from collections.abc import Callable

import numpy as np
import pytest
from campaign_jobs import flip

from rocking.campaigns import Campaign, CampaignDamagedError
from rocking.campaigns.ledger import Ledger, LedgerEntry
from rocking.campaigns.status import Meter

pytestmark = pytest.mark.verifies(room="campaigns")

FLIPS = 400
Shards = Callable[[Campaign], dict[str, str]]


def records(campaign):
    with Ledger(campaign.folder) as ledger:
        ledger.check(campaign.plan)
        return list(ledger.records())


@pytest.mark.slow
@pytest.mark.verifies("damage", "single bits of the ledger flipped")
def test_flipped_ledger_never_lies(finished, tmp_path):
    """Of 400 flips anywhere in the file each is refused with the way out, or changes nothing that is recorded."""
    good = records(finished)
    path, copy = finished.folder / "ledger.sqlite", tmp_path / "good"
    shutil.copy(path, copy)
    refused = []
    for bit in np.random.default_rng(2).integers(0, 8 * copy.stat().st_size, FLIPS):
        shutil.copy(copy, path)
        flip(path, int(bit))
        try:
            assert records(finished) == good
            assert finished.verify().is_complete
        except (CampaignDamagedError, sqlite3.DatabaseError):
            refused.extend(finished.verify().damaged)
    assert all("ledger.sqlite is damaged" in text and "run the campaign again" in text for text in refused)
    assert len(refused) > FLIPS / 20  # most bytes of the small file are empty room


@pytest.mark.slow
def test_flips_within_rows_are_all_refused(finished):
    """A row that was changed by a bit in a text or a number does not carry its own sum any more."""
    path = finished.folder / "ledger.sqlite"
    good = path.read_bytes()
    place = good.index(finished.plan.chunk(2).name.encode())
    for bit in range(8 * place, 8 * (place + 128), 7):
        path.write_bytes(good)
        flip(path, bit)
        with pytest.raises(CampaignDamagedError, match=r"ledger\.sqlite is damaged"):
            finished.results()


HARMS: dict[str, Callable[[bytes], bytes]] = {
    "overwritten": lambda data: b"no database at all" * 100,
    "cut short": lambda data: data[: len(data) // 2],
    "scrambled": lambda data: data[:100] + bytes(random.Random(1).sample(data[100:], len(data) - 100)),
    "without its version": lambda data: data[:60] + bytes(4) + data[64:4096] + b"?" * (len(data) - 4096),
}


@pytest.mark.slow
@pytest.mark.parametrize("harm", HARMS)
def test_run_makes_a_damaged_ledger_anew(finished, shards, harm):
    """Whatever became of the ledger, a run says so and adopts all shards; nothing is computed again or deleted."""
    before, digest = shards(finished), finished.sha256()
    path = finished.folder / "ledger.sqlite"
    path.write_bytes(HARMS[harm](path.read_bytes()))
    found = finished.verify()
    assert (found.is_complete, found.verified) == (False, 0)
    with pytest.raises(CampaignDamagedError, match=r"ledger\.sqlite is damaged .* run the campaign again"):
        finished.results()
    summary = finished.run(workers=1)
    assert (summary.adopted, summary.computed) == (6, 0)
    assert "kept as ledger.sqlite.damaged-1, and rebuilt from the shards" in summary.set_aside[0]
    assert finished.status().damaged == summary.set_aside
    assert (finished.verify().is_complete, shards(finished), finished.sha256()) == (True, before, digest)
    assert (finished.folder / "ledger.sqlite.damaged-1").exists()


def test_lost_ledger_is_made_by_the_next_run(finished):
    """Without a ledger nothing counts as finished; a run adopts the shards."""
    for path in finished.folder.glob("ledger.sqlite*"):
        path.unlink()
    assert finished.status().chunks_done == 0
    summary = finished.run(workers=1)
    assert (summary.adopted, summary.computed) == (6, 0)


@pytest.mark.parametrize("order", ["UPDATE chunks SET number = 77 WHERE number = 2", "UPDATE chunks SET seal = 'x'"])
def test_rows_that_were_meddled_with_are_refused(finished, order):
    """A valid database with an edited row is damaged all the same."""
    with sqlite3.connect(finished.folder / "ledger.sqlite") as database:
        database.execute(order)
    database.close()
    with pytest.raises(CampaignDamagedError, match=r"row .* has changed"):
        finished.results()


def test_ledger_of_another_campaign_is_refused(finished, make, tmp_path):
    """A ledger that was copied from elsewhere is not of this campaign, and a run takes nothing from it."""
    other = Campaign.create(tmp_path / "other", make(seed=8), 50)
    other.run(workers=1)
    shutil.copy(other.folder / "ledger.sqlite", finished.folder / "ledger.sqlite")
    with pytest.raises(CampaignDamagedError, match="chunk 0 is not of this campaign"):
        finished.results()
    assert finished.run(workers=1).computed == 0


def test_a_ledger_that_is_just_being_made_says_nothing_is_done(tmp_path, work):
    """Between the making of the file and of its tables, the status is that of a campaign that has not begun."""
    campaign = Campaign.create(tmp_path / "c", work)
    (campaign.folder / "ledger.sqlite").touch()
    assert Campaign.status_of(campaign.folder).chunks_done == 0


def told(ledger, between):
    """Histories that the ledger has, with something that happens between its two tables."""
    chunks = [record.last - record.first for record in ledger.records()]
    between()
    return sum(chunks) + sum(record.last - record.first for record in ledger.pieces())


def test_what_is_read_is_of_one_instant(tmp_path, work):
    """While a reader goes from chunks to pieces, these become a chunk: it still sees every history once."""
    campaign = Campaign.create(tmp_path / "c", work)
    whole = campaign.plan.chunk(0)
    half = whole.piece(whole.first, whole.first + 10)
    rest = "seal", 1, 1, 0.1, "worker", "now"
    with Ledger(campaign.folder, writable=True) as writer, Ledger(campaign.folder) as reader:

        def becomes_whole():
            writer.record(LedgerEntry(whole.number, whole.first, whole.last, whole.name, *rest))

        def in_pieces():
            writer.forget(whole.name)
            writer.record_piece(LedgerEntry(half.number, half.first, half.last, half.name, *rest))

        in_pieces()
        with reader.instant():
            assert told(reader, becomes_whole) == 10
        in_pieces()
        assert told(reader, becomes_whole) == 0  # negative control: as of two instants there is nothing
        assert told(reader, lambda: None) == whole.last - whole.first


def test_pieces_that_make_up_a_chunk_are_counted_as_histories(tmp_path, work):
    """As many histories as a chunk has, in pieces of two chunks, are not "0 chunks"."""
    plan = Campaign.create(tmp_path / "c", work, 50).plan
    meter = Meter(tmp_path, plan, None)
    first, second = plan.chunk(0), plan.chunk(1)
    half = plan.size // 2
    meter.begin(0, [(first.first, first.first + half), (second.first, second.first + plan.size - half)])
    assert meter.sentence() == f"{plan.size} of {plan.count} histories are safe"
    meter.begin(2, [first[1:3], second[1:3]])
    assert meter.sentence() == f"2 of {plan.chunks} chunks are safe"
