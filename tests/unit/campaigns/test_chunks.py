"""Chunks: they cover all histories once, and their names are made of what they hold."""

import dataclasses
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.campaigns.chunks import Plan
from rocking.errors import InvalidValueError

PLAN = Plan("a" * 64, 1000, 64, "fast", "1.0")


@given(count=st.integers(1, 500), size=st.integers(1, 600))
def test_chunks_cover_every_history_once(count: int, size: int) -> None:
    """Whatever the size, the chunks put together are the histories from the first to the last."""
    plan = dataclasses.replace(PLAN, count=count, size=size)
    chunks = [plan.chunk(k) for k in range(plan.chunks)]
    assert [n for chunk in chunks for n in range(chunk.first, chunk.last)] == list(range(count))
    assert len({chunk.name for chunk in chunks}) == plan.chunks


@pytest.mark.parametrize("change", [{"key": "b" * 64}, {"engine": "reference"}, {"software": "1.1"}, {"format": 1}])
def test_names_change_with_what_changes_the_bytes(change: dict[str, Any]) -> None:
    """Other histories, another engine, version or format: another name."""
    assert dataclasses.replace(PLAN, **change).chunk(0).name != PLAN.chunk(0).name


def test_names_do_not_change_with_the_size() -> None:
    """The same histories have the same name however the rest is cut."""
    assert dataclasses.replace(PLAN, size=32).chunk(2)[1:3] == (64, 96)
    assert dataclasses.replace(PLAN, size=500).chunk(1).name == dataclasses.replace(PLAN, size=500).chunk(1).name
    halves = dataclasses.replace(PLAN, size=500), dataclasses.replace(PLAN, size=1000)
    assert halves[0].chunk(0).name != halves[1].chunk(0).name


@pytest.mark.parametrize(
    ("name", "value"), [("size", 0), ("size", 1.5), ("size", True), ("size", 1 << 23), ("count", 0)]
)
def test_bad_numbers_are_refused(name: str, value: Any) -> None:
    """Sizes and counts that are not whole numbers in range have a sentence."""
    with pytest.raises(InvalidValueError, match=r"must be a whole number of histories in \[1, "):
        dataclasses.replace(PLAN, **{name: value})


def test_there_is_no_chunk_beyond_the_last() -> None:
    """Chunk 16 of 16 is refused."""
    with pytest.raises(InvalidValueError, match=r"chunk must be in \[0, 15\], got 16"):
        PLAN.chunk(16)
