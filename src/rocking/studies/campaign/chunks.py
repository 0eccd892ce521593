"""How a campaign is cut: chunks of histories, each named by the hash of what it holds."""

import hashlib
import json
from dataclasses import asdict, dataclass
from typing import NamedTuple

from rocking.errors import InvalidValueError

FORMAT = 2
"""Version of the files of a campaign."""

DEFAULT_CHUNK = 65536
"""Histories of a chunk of the fast engine: about 0.3 s of work, beside which a few milliseconds of safety are small."""

REFERENCE_CHUNK = 256
"""Histories of a chunk of the reference engine, which takes a hundred times as long."""

LARGEST_CHUNK = 1 << 22
"""A chunk is held in memory as a whole: 0.3 GB."""


class Chunk(NamedTuple):
    """Some histories: from the first up to but not including the last; of a piece of a chunk, with the chunk's name."""

    number: int
    first: int
    last: int
    name: str
    of: str = ""

    def piece(self, first: int, last: int) -> "Chunk":
        """Return a piece of it, which is named by what it holds, too.

        Returns the piece; itself if that is all of it.
        """
        if (first, last) == (self.first, self.last):
            return self
        whole = self.of or self.name
        name = hashlib.sha256(f"{whole} {first} {last}".encode()).hexdigest()
        return Chunk(self.number, first, last, name, whole)


def default_chunk(engine: str, together: int = 1) -> int:
    """Return how many histories make a chunk, unless somebody wants another number."""
    usual = DEFAULT_CHUNK if engine.startswith("fast") else REFERENCE_CHUNK
    return max(usual - usual % together, usual if together > usual else 1)


@dataclass(frozen=True)
class Plan:
    """What fixes the name of every chunk, and with it the bytes of its shard.

    >>> plan = Plan("0" * 64, 100, 40, "fast", "1.0")
    >>> [plan.chunk(k)[1:3] for k in range(plan.chunks)]
    [(0, 40), (40, 80), (80, 100)]
    """

    key: str  # name of the histories
    count: int  # number of histories
    size: int  # histories of a chunk
    engine: str  # the engine that computes all of them, with the last digits that it gives: "fast, 0123456789abcdef"
    software: str  # version of this package
    format: int = FORMAT  # version of the files

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name, value, low, high in (("count", self.count, 1, 1 << 48), ("chunk", self.size, 1, LARGEST_CHUNK)):
            given: object = value
            if isinstance(given, bool) or not isinstance(given, int) or not low <= value <= high:
                raise InvalidValueError(f"{name} must be a whole number of histories in [{low}, {high}], got {value!r}")

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.count // self.size)

    def chunk(self, number: int) -> Chunk:
        """Return one of the chunks.

        Returns the chunk; its name is the SHA-256 of the plan without its size, and of the first and last history.
        """
        if not 0 <= number < self.chunks:
            raise InvalidValueError(f"chunk must be in [0, {self.chunks - 1}], got {number}")
        first = number * self.size
        last = min(first + self.size, self.count)
        content = {name: value for name, value in asdict(self).items() if name != "size"}
        text = json.dumps(content | {"first": first, "last": last}, sort_keys=True)
        return Chunk(number, first, last, hashlib.sha256(text.encode()).hexdigest())
