"""Without Dask, a campaign on a cluster says what to install."""

import sys
from pathlib import Path

import pytest

from rocking.campaigns import Campaign, DaskExecutor
from rocking.errors import MissingExtraError
from rocking.studies import HistoryTable


def test_missing_dask_has_a_sentence(tmp_path: Path, work: HistoryTable, monkeypatch: pytest.MonkeyPatch) -> None:
    """The extra is named."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"needs distributed: pip install '\.\[dask\]'"):
        Campaign.create(tmp_path / "c", work).run(DaskExecutor("tcp://127.0.0.1:9"))
