"""Results and status: what is read is what the engine computed."""

import hashlib

import numpy as np
import pytest

from rocking.campaigns import Campaign, CampaignStorageError, Estimate, Progress, forecast
from rocking.dynamics.plane import fast_engine
from rocking.errors import InvalidValueError


def test_results_are_those_of_the_engine(finished, work):
    """Whole and in pieces: bit by bit what a bare run gives, with several outcomes."""
    bare = work.run(0, work.count, threads=1)
    whole = finished.results()
    assert set(whole) == set(fast_engine.RESULTS)
    assert len(set(bare["outcome"].tolist())) > 1
    for name, values in bare.items():
        assert whole[name].tobytes() == values.tobytes()
        assert whole[name].dtype == values.dtype
    ends = [(piece.first, piece.last) for piece in finished.pieces()]
    assert ends == [(k, k + 50) for k in range(0, 300, 50)]
    with pytest.raises(InvalidValueError, match="column must be one of outcome"):
        finished.results("height")


def test_hash_is_what_it_says(finished, work):
    """The hash of the results, computed here from a bare run by its description."""
    bare = work.run(0, work.count, threads=1)
    lines = [
        f"{k} {np.dtype(fast_engine.RESULTS[k]).name} {hashlib.sha256(bare[k].tobytes()).hexdigest()}\n"
        for k in fast_engine.RESULTS
    ]
    assert finished.sha256() == hashlib.sha256("".join(lines).encode()).hexdigest()


def test_progress_counts_up(tmp_path, work):
    """The first report is what was there, the last one is everything; time left is told when all parts were seen."""
    new = Campaign.create(tmp_path / "c", work, 64)
    seen: list[Progress] = []
    new.run(workers=1, progress=seen.append)
    assert [p.chunks_done for p in seen] == [0, 1, 2, 3, 4, 5]
    assert [p.done_histories for p in seen] == [0, 64, 128, 192, 256, 300]
    assert (seen[0].rate, seen[0].left, seen[-1].left) == (0.0, None, Estimate(0.0, 0.0, 0.0))
    assert all(p.rate > 0.0 for p in seen[1:])
    assert [p.left is None for p in seen] == [True, True, True, True, True, False]
    seen.clear()
    assert new.run(progress=seen.append).resumed == 5
    assert [p.chunks_done for p in seen] == [5]


def test_status_needs_no_histories(finished, tmp_path, work):
    """The folder alone tells how far it is, before, during and after."""
    status = Campaign.status_of(finished.folder)
    assert (status.histories_done, status.chunks_done, status.complete, status.running) == (300, 6, True, None)
    assert status.sentence == f"all 6 chunks (300 histories) are safe in {finished.folder}"
    new, seen = Campaign.create(tmp_path / "new", work, 100), []
    assert new.status().sentence.startswith("0 of 3 chunks (0 of 300 histories) are safe")
    new.run(workers=1, progress=lambda _: seen.append(new.status()))
    assert [s.chunks_done for s in seen] == [0, 1, 2, 3]
    assert "process" in str(seen[1].running)
    assert seen[1].sentence.endswith("runs it")


def test_status_writes_nothing(finished):
    """Looking leaves every file as it was."""

    def look():
        return {p.name: p.read_bytes() for p in finished.folder.rglob("*") if p.is_file()}

    before = look()
    finished.status()
    assert look() == before


def test_check_looks_ahead(tmp_path, work, monkeypatch):
    """The forecast has room for what is written, and a disk that is too small is refused before the work."""
    new = Campaign.create(tmp_path / "c", work, 50)
    ahead = new.check()
    assert (ahead.histories, ahead.chunks) == (300, 6)
    assert 0.0 < ahead.work.low < ahead.work.seconds < ahead.work.high
    new.run(workers=1)
    written = sum(path.stat().st_size for path in (new.folder / "shards").iterdir())
    assert written <= ahead.needed <= 20 * written
    assert new.check().needed == 0
    fresh = Campaign.create(tmp_path / "d", work, 50)
    monkeypatch.setattr(forecast.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 10}))
    with pytest.raises(CampaignStorageError, match="but only 0 MB are free"):
        fresh.check()
