"""Record files typed by hand and damaged, or written and read again: what the tests of every format ask."""

import re
from collections.abc import Sequence

import numpy as np
import pytest

from rocking.errors import RecordError
from rocking.motions.formats import Record, RecordFormat, Source


def refused(kind: RecordFormat, text: str, damages: Sequence[tuple[str, str, str]], *, once: bool = True) -> None:
    """A good file of which some words (not always `once` in it) become others is refused by a sentence.

    Where that begins with ``doubt:`` the file is read, and the sentence kept as a doubt.
    """
    good = Source("good", text.encode("latin-1"))
    kind.read(good)
    assert not good.doubts
    for old, new, message in damages:
        changed = text.replace(old, new, 1)
        assert text.count(old) == 1 or (not once and old in text), f"{old!r} stands {text.count(old)} times in the file"
        damaged = Source("damaged", changed.encode("latin-1"))
        if message.startswith("doubt:"):
            kind.read(damaged)
            assert re.search(message.removeprefix("doubt:"), "; ".join(damaged.doubts)), f"{new!r}: {damaged.doubts}"
            continue
        with pytest.raises(RecordError) as caught:
            kind.read(damaged)
        assert message in str(caught.value) or re.search(message, str(caught.value)), f"{new!r}: {caught.value}"


def read_back(kind: RecordFormat, record: Record, factor: float, *, rtol: float = 0.0, atol: float = 0.0) -> Record:
    """What is written is recognised, and read back to the digits of the format in the order of the file."""
    source = Source("written", kind.write(record))
    assert kind.recognises(source)
    again = kind.read(source)
    rows = {part.name: part for part in record.components}
    assert {part.name for part in again.components} == set(rows)
    for part in again.components:
        given = rows[part.name]
        np.testing.assert_allclose(part.acceleration, factor * given.acceleration, rtol=rtol, atol=atol)
        assert part.time_step == given.time_step
    return again
