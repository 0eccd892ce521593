"""Division of a campaign into chunks with names from hashes; results as sealed bytes."""

import hashlib
import json
import struct
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from rocking.campaigns.disk import CampaignDamagedError
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.studies.histories import LARGEST_CHUNK

MAGIC = b"ROCKSHRD"
FORMAT = 2  # version of the files of a campaign
_LENGTHS = struct.Struct("<8sII")
_SEAL = 32


def width(types: Mapping[str, Any]) -> int:
    """Return the size of the results of one history [bytes]."""
    return sum(np.dtype(kind).itemsize for kind in types.values())


def _kinds(header: Any) -> dict[str, np.dtype[Any]]:
    try:
        return {name: np.dtype(kind) for name, kind in header["columns"]}
    except (SyntaxError, TypeError, ValueError) as error:
        raise CampaignDamagedError("the header of the shard is not readable") from error


DEFAULT_CHUNK = 65536
"""Histories of a chunk of the fast engine: about 0.3 s of work; the safe storage needs a few milliseconds."""

REFERENCE_CHUNK = 256  # histories per chunk of the reference engine, which is about 100 times slower


class Chunk(NamedTuple):
    """The histories from `first` to before `last`; for a piece, `parent` is the name of its chunk."""

    number: int
    first: int
    last: int
    name: str
    parent: str = ""

    def piece(self, first: int, last: int) -> "Chunk":
        """Return a piece of this chunk with its own name, or the chunk itself for all its histories."""
        if (first, last) == (self.first, self.last):
            return self
        parent = self.parent or self.name
        name = hashlib.sha256(f"{parent} {first} {last}".encode()).hexdigest()
        return Chunk(self.number, first, last, name, parent)


@dataclass(frozen=True)
class Plan:
    """Data that determine the names of all chunks, and the bytes of their shards.

    >>> plan = Plan("0" * 64, 100, 40, "fast", "1.0")
    >>> [plan.chunk(k)[1:3] for k in range(plan.chunks)]
    [(0, 40), (40, 80), (80, 100)]
    """

    key: str  # hash that identifies the histories
    count: int  # number of histories
    size: int  # number of histories per chunk
    engine: str  # engine with fingerprint: "fast, 0123456789abcdef"
    software: str  # version of this package
    format: int = FORMAT  # version of the files

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name, value, low, high in (("count", self.count, 1, 1 << 48), ("chunk", self.size, 1, LARGEST_CHUNK)):
            if type(value) is not int or not low <= value <= high:
                raise InvalidValueError(
                    parameter=name,
                    allowed=f"a whole number of histories in [{low}, {high}]",
                    value=value,
                )  # fmt: skip

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.count // self.size)

    def chunk(self, number: int) -> Chunk:
        """Return a chunk. Its name is the SHA-256 of the plan without the chunk size, and of first and last history."""
        if not 0 <= number < self.chunks:
            raise InvalidValueError(parameter="chunk", allowed=f"in [0, {self.chunks - 1}]", value=number)
        first = number * self.size
        last = min(first + self.size, self.count)
        content = {name: value for name, value in asdict(self).items() if name != "size"}
        text = json.dumps(content | {"first": first, "last": last}, sort_keys=True)
        return Chunk(number, first, last, hashlib.sha256(text.encode()).hexdigest())


def pack(chunk: Chunk, arrays: Arrays) -> bytes:
    """Return the bytes of a shard; they contain no time, place or machine.

    The bytes contain in this order: magic word, version, length of the header, the header in JSON, the columns
    (little-endian), and the SHA-256 of all of these.
    """
    count = chunk.last - chunk.first
    kinds = {name: values.dtype.newbyteorder("<") for name, values in arrays.items()}
    columns = {name: np.ascontiguousarray(arrays[name][:count], kind).data for name, kind in kinds.items()}
    sums = {name: zlib.crc32(column) for name, column in columns.items()}
    content = {
        "name": chunk.name,
        "first": chunk.first,
        "last": chunk.last,
        "columns": [[name, kind.str] for name, kind in kinds.items()],
    }
    content["crc32"] = sums
    header = json.dumps(content, sort_keys=True, separators=(",", ":")).encode()
    head = _LENGTHS.pack(MAGIC, FORMAT, len(header)) + header
    digest = hashlib.sha256(head)
    for column in columns.values():
        digest.update(column)
    return b"".join([head, *columns.values(), digest.digest()])


def seal(data: bytes) -> str:
    """Return the seal at the end of a shard, 64 hexadecimal digits, without a check."""
    return data[-_SEAL:].hex()


def range_of(data: bytes) -> tuple[int, int]:
    """Return the first history of a shard, and the history after the last history."""
    header = _read_header(data, _payload_at(data))
    ends = header.get("first"), header.get("last")
    if not all(isinstance(end, int) for end in ends):
        raise CampaignDamagedError("the header of the shard contains no range of histories")
    return ends


def unpack(data: bytes, chunk: Chunk, sealed: str | None = None) -> Arrays:
    """Return the results of an unchanged shard."""
    offset = _payload_at(data)
    if hashlib.sha256(memoryview(data)[:-_SEAL]).digest() != data[-_SEAL:]:
        raise CampaignDamagedError(_where_broken(data, offset))
    header = _read_header(data, offset)
    if header.get("name") != chunk.name:
        raise CampaignDamagedError(
            "the shard contains chunk {name}, but chunk {expected} is required", name=str(header.get("name"))[:12],
            expected=chunk.name[:12],
        )  # fmt: skip
    if sealed is not None and seal(data) != sealed:
        raise CampaignDamagedError("the shard is valid, but its checksum differs from the recorded checksum")
    return _columns(data, offset, chunk, header)


def _columns(data: bytes, offset: int, chunk: Chunk, header: Any) -> Arrays:
    count, arrays = chunk.last - chunk.first, {}
    if header.get("first") != chunk.first or header.get("last") != chunk.last or not header.get("columns"):
        raise CampaignDamagedError("the header of the shard does not match the chunk")
    kinds = _kinds(header)
    if (due := offset + count * width(kinds) + _SEAL) != len(data):
        raise CampaignDamagedError(
            "the shard has {count} bytes, but {expected} bytes are required", count=len(data), expected=due
        )
    for name, kind in kinds.items():
        arrays[name] = np.frombuffer(data, kind, count, offset).astype(kind.newbyteorder("="), copy=False)
        offset += count * kind.itemsize
    return arrays


def _payload_at(data: bytes) -> int:
    """Check the first bytes; return the offset of the columns."""
    if len(data) < _LENGTHS.size + _SEAL:
        raise CampaignDamagedError("the shard is incomplete: it has only {count} bytes", count=len(data))
    magic, version, length = _LENGTHS.unpack_from(data)
    if magic != MAGIC:
        raise CampaignDamagedError("the file is not a shard: its first bytes are wrong")
    if version != FORMAT:
        raise CampaignDamagedError(
            "the shard has format {version}, but format {expected} is required", version=version, expected=FORMAT,
            hint="another version of rocking may have written the shard",
        )  # fmt: skip
    offset = _LENGTHS.size + int(length)
    if offset + _SEAL > len(data):
        raise CampaignDamagedError(
            "the shard is incomplete: it ends within its header, after {count} bytes", count=len(data)
        )
    return offset


def _where_broken(data: bytes, offset: int) -> str:
    """Return the name of the changed column, as far as the header allows."""
    with suppress(CampaignDamagedError, KeyError, TypeError, ValueError):
        header = _read_header(data, offset)
        count = int(header["last"]) - int(header["first"])
        kinds = _kinds(header)
        if (due := offset + count * width(kinds) + _SEAL) != len(data):
            return f"the shard is incomplete: it has {len(data)} bytes, but {due} bytes are required"
        for name, kind in kinds.items():
            end = offset + count * kind.itemsize
            if zlib.crc32(memoryview(data)[offset:end]) != header["crc32"][name]:
                return f"column {name} of the shard has changed"
            offset = end
    return "the checksum of the shard does not match its content"


def _read_header(data: bytes, offset: int) -> Any:
    try:
        header = json.loads(data[_LENGTHS.size : offset])
    except ValueError as error:
        raise CampaignDamagedError("the header of the shard is not readable") from error
    if not isinstance(header, dict):
        raise CampaignDamagedError("the header of the shard is not a JSON object")
    return header
