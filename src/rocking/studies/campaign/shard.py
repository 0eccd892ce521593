"""The results of a chunk as bytes: a header, columns, and a seal that any change of any bit breaks."""

import hashlib
import json
import struct
import zlib
from typing import Any

import numpy as np

from rocking.dynamics.engine import RESULTS, Arrays
from rocking.studies.campaign.chunks import FORMAT, Chunk
from rocking.studies.campaign.errors import CampaignDamagedError

MAGIC = b"ROCKSHRD"
_LENGTHS = struct.Struct("<8sII")
_SEAL = 32


def pack(chunk: Chunk, arrays: Arrays) -> bytes:
    """Return the bytes of a shard: no time, place or machine is in them, so whoever makes them makes the same.

    Returns magic word, version, length of the header; the header in JSON; the columns, little-endian; SHA-256 of all
    that.
    """
    count = chunk.last - chunk.first
    columns = [np.ascontiguousarray(arrays[name][:count], _little(kind)).data for name, kind in RESULTS.items()]
    header = json.dumps(_header(chunk, columns), sort_keys=True, separators=(",", ":")).encode()
    head = _LENGTHS.pack(MAGIC, FORMAT, len(header)) + header
    made = hashlib.sha256(head)
    for column in columns:
        made.update(column)
    return b"".join([head, *columns, made.digest()])


def seal(data: bytes) -> str:
    """Return the seal that a shard bears, without breaking it open.

    Returns 64 hexadecimal digits: SHA-256 of all that stands before.
    """
    return data[-_SEAL:].hex()


def range_of(data: bytes) -> tuple[int, int]:
    """Return which histories a shard says that it holds.

    Returns from the first up to but not including the last.
    """
    header = _read_header(data, _payload_at(data))
    found = header.get("first"), header.get("last")
    if not all(isinstance(each, int) for each in found):
        raise CampaignDamagedError("its header does not say what it holds")
    return found


def unpack(data: bytes, chunk: Chunk, sealed: str | None = None) -> Arrays:
    """Return the results that a shard holds, if not a bit of it has changed."""
    place = _payload_at(data)
    if hashlib.sha256(memoryview(data)[:-_SEAL]).digest() != data[-_SEAL:]:
        raise CampaignDamagedError(_where_broken(data, place))
    header = _read_header(data, place)
    if header.get("name") != chunk.name:
        raise CampaignDamagedError(f"it holds another chunk, {str(header.get('name'))[:12]}, not {chunk.name[:12]}")
    if sealed is not None and seal(data) != sealed:
        raise CampaignDamagedError("it is whole, but not the one that the ledger recorded")
    return _columns(data, place, chunk, header)


def _columns(data: bytes, place: int, chunk: Chunk, header: Any) -> Arrays:
    count, arrays = chunk.last - chunk.first, {}
    if header.get("first") != chunk.first or header.get("last") != chunk.last or header.get("columns") != _names():
        raise CampaignDamagedError("its header does not fit its name")
    if place + count * _width() + _SEAL != len(data):
        raise CampaignDamagedError(f"it has {len(data)} bytes, {place + count * _width() + _SEAL} are due")
    for name, kind in RESULTS.items():
        arrays[name] = np.frombuffer(data, _little(kind), count, place).astype(kind, copy=False)
        place += count * np.dtype(kind).itemsize
    return arrays


def _payload_at(data: bytes) -> int:
    """Check the first bytes; where the columns start."""
    if len(data) < _LENGTHS.size + _SEAL:
        raise CampaignDamagedError(f"it was cut short: {len(data)} bytes are no shard")
    magic, version, length = _LENGTHS.unpack_from(data)
    if magic != MAGIC:
        raise CampaignDamagedError("it does not start as a shard does")
    if version != FORMAT:
        raise CampaignDamagedError(f"it says format {version}, not {FORMAT}; of another version of this package?")
    place = _LENGTHS.size + int(length)
    if place + _SEAL > len(data):
        raise CampaignDamagedError(f"it was cut short within its header: {len(data)} bytes")
    return place


def _where_broken(data: bytes, place: int) -> str:
    """Say which column changed, as far as the header can still tell."""
    try:
        header = _read_header(data, place)
        count = int(header["last"]) - int(header["first"])
        due = place + count * _width() + _SEAL
        if due != len(data):
            return f"it has {len(data)} bytes, {due} are due: cut short?"
        for name, kind in RESULTS.items():
            end = place + count * np.dtype(kind).itemsize
            if zlib.crc32(memoryview(data)[place:end]) != header["crc32"][name]:
                return f"column {name} has changed"
            place = end
    except (CampaignDamagedError, KeyError, TypeError, ValueError):
        pass
    return "its seal is broken"


def _read_header(data: bytes, place: int) -> Any:
    try:
        header = json.loads(data[_LENGTHS.size : place])
    except ValueError as error:
        raise CampaignDamagedError("its header cannot be read") from error
    if not isinstance(header, dict):
        raise CampaignDamagedError("its header is no header")
    return header


def _header(chunk: Chunk, columns: list[memoryview]) -> dict[str, Any]:
    sums = {name: zlib.crc32(column) for name, column in zip(RESULTS, columns, strict=True)}
    return {"name": chunk.name, "first": chunk.first, "last": chunk.last, "columns": _names(), "crc32": sums}


def _names() -> list[list[str]]:
    return [[name, _little(kind).str] for name, kind in RESULTS.items()]


def _little(kind: Any) -> Any:
    return np.dtype(kind).newbyteorder("<")


def _width() -> int:
    """Bytes of a history."""
    return sum(np.dtype(kind).itemsize for kind in RESULTS.values())
