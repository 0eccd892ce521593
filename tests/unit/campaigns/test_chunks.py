"""Chunks cover all histories once, named by what they hold; a shard is read as it was written, or not at all."""

import dataclasses
import hashlib
import json
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.campaigns import CampaignDamagedError
from rocking.campaigns import chunks as shard
from rocking.campaigns.chunks import Chunk, Plan
from rocking.dynamics.plane.fast_engine import RESULTS, empty_results
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="campaigns")

PLAN = Plan("a" * 64, 400, 40, "fast", "1.0")
CHUNK = PLAN.chunk(3)
FLIPS = 10_000


def arrays(seed=1, count=40):
    random = np.random.default_rng(seed)
    made = empty_results(count)
    for values in made.values():
        values[:] = random.integers(-100, 100, count)
    made["peak_rotation"][:5] = [np.nan, -0.0, 0.0, 5e-324, -np.inf]
    return made


def test_round_trip_keeps_every_bit():
    """NaN, signed zeros and the smallest numbers come back as they were, with their types."""
    found = shard.unpack(shard.pack(CHUNK, arrays()), CHUNK)
    for name, values in arrays().items():
        assert found[name].tobytes() == values.tobytes()
        assert found[name].dtype == RESULTS[name]


def test_format_is_what_the_page_says():
    """A reader written from the description alone, without this package's code, finds the same numbers."""
    data = shard.pack(CHUNK, arrays())
    assert hashlib.sha256(data[:-32]).digest() == data[-32:]
    magic, version, length = struct.unpack("<8sII", data[:16])
    header = json.loads(data[16 : 16 + length])
    assert (magic, version, header["first"], header["last"]) == (b"ROCKSHRD", 2, 120, 160)
    place = 16 + length
    for name, kind in header["columns"]:
        values = np.frombuffer(data, kind, 40, place)
        assert zlib.crc32(values.tobytes()) == header["crc32"][name]
        assert values.tobytes() == arrays()[name].tobytes()
        place += values.nbytes
    assert place == len(data) - 32


def test_bytes_are_those_of_the_second_version():
    """Campaigns that were begun long ago go on: the shard made by hand, of whatever arrays the numbers stand in."""
    plain = arrays()
    columns = {name: plain[name].astype(np.dtype(kind).newbyteorder("<")) for name, kind in RESULTS.items()}
    content = {
        "columns": [[name, values.dtype.str] for name, values in columns.items()],
        "crc32": {name: zlib.crc32(values.tobytes()) for name, values in columns.items()},
        "first": 120,
        "last": 160,
        "name": CHUNK.name,
    }
    header = json.dumps(content, separators=(",", ":"), sort_keys=True).encode()
    body = struct.pack("<8sII", b"ROCKSHRD", 2, len(header)) + header
    body += b"".join(values.tobytes() for values in columns.values())
    made = body + hashlib.sha256(body).digest()
    assert shard.pack(CHUNK, plain) == made
    assert shard.pack(CHUNK, {name: np.repeat(values, 2)[::2] for name, values in plain.items()}) == made
    swapped = {name: values.astype(values.dtype.newbyteorder(">")) for name, values in plain.items()}
    assert shard.pack(CHUNK, swapped) == made


def flipped(data, bit):
    changed = bytearray(data)
    changed[bit // 8] ^= 1 << bit % 8
    return bytes(changed)


def detected(data):
    try:
        shard.unpack(data, CHUNK)
    except CampaignDamagedError:
        return True
    return False


@pytest.mark.slow
def test_every_flipped_bit_is_detected():
    """10,000 single bits, spread over the whole shard at random: none is missed, none raises anything else."""
    data = shard.pack(CHUNK, arrays())
    bits = np.random.default_rng(7).integers(0, 8 * len(data), FLIPS)
    assert sum(detected(flipped(data, int(bit))) for bit in bits) == FLIPS
    assert not detected(data)


@pytest.mark.verifies("negative control", "a reader that checks heads and lengths alone")
def test_flips_are_missed_without_the_seal():
    """Negative control: a reader that checks magic word, version, header and length alone misses most flips."""

    def careless(data):
        try:
            return shard._columns(data, shard._payload_at(data), CHUNK, shard._read_header(data, 16 + length)) is None
        except CampaignDamagedError:
            return True

    data = shard.pack(CHUNK, arrays())
    length = struct.unpack("<8sII", data[:16])[2]
    bits = np.random.default_rng(7).integers(0, 8 * len(data), 500)
    assert sum(careless(flipped(data, int(bit))) for bit in bits) < 250


def test_every_truncation_is_detected():
    """A shard that was cut short after any byte, and one with a byte too many."""
    data = shard.pack(CHUNK, arrays())
    assert all(detected(data[:length]) for length in range(len(data)))
    assert detected(data + b"\0")


def test_whole_shards_elsewhere_are_refused():
    """A good shard under the name of another chunk, and one that the ledger does not know, are no results."""
    data = shard.pack(CHUNK, arrays())
    with pytest.raises(CampaignDamagedError, match="the shard contains chunk"):
        shard.unpack(data, PLAN.chunk(4))
    with pytest.raises(CampaignDamagedError, match="differs from the recorded checksum"):
        shard.unpack(data, CHUNK, shard.seal(shard.pack(CHUNK, arrays(2))))
    with pytest.raises(CampaignDamagedError, match="does not match the chunk"):
        shard.unpack(data, Chunk(3, 120, 161, CHUNK.name))


def test_damage_is_named():
    """The sentence says which column changed, or that the file was cut short."""
    data = shard.pack(CHUNK, arrays())
    with pytest.raises(CampaignDamagedError, match="column still_rocking of the shard has changed"):
        shard.unpack(flipped(data, 8 * (len(data) - 40)), CHUNK)
    with pytest.raises(CampaignDamagedError, match="the shard is incomplete: it has"):
        shard.unpack(data[:-100], CHUNK)
    with pytest.raises(CampaignDamagedError, match="format 1, but format 2 is required"):
        shard.unpack(flipped(flipped(data, 64), 65), CHUNK)


MANY = Plan("a" * 64, 1000, 64, "fast", "1.0")


@given(count=st.integers(1, 500), size=st.integers(1, 600))
def test_chunks_cover_every_history_once(count, size):
    """Whatever the size, the chunks put together are the histories from the first to the last."""
    plan = dataclasses.replace(MANY, count=count, size=size)
    chunks = [plan.chunk(k) for k in range(plan.chunks)]
    assert [n for chunk in chunks for n in range(chunk.first, chunk.last)] == list(range(count))
    assert len({chunk.name for chunk in chunks}) == plan.chunks


@pytest.mark.parametrize("change", [{"key": "b" * 64}, {"engine": "reference"}, {"software": "1.1"}, {"format": 1}])
def test_names_change_with_what_changes_the_bytes(change):
    """Other histories, another engine, version or format: another name."""
    assert dataclasses.replace(MANY, **change).chunk(0).name != MANY.chunk(0).name


def test_names_do_not_change_with_the_size():
    """The same histories have the same name however the rest is cut."""
    assert dataclasses.replace(MANY, size=32).chunk(2)[1:3] == (64, 96)
    assert dataclasses.replace(MANY, size=500).chunk(1).name == dataclasses.replace(MANY, size=500).chunk(1).name
    halves = dataclasses.replace(MANY, size=500), dataclasses.replace(MANY, size=1000)
    assert halves[0].chunk(0).name != halves[1].chunk(0).name


@pytest.mark.parametrize(
    ("name", "value"), [("size", 0), ("size", 1.5), ("size", True), ("size", 1 << 23), ("count", 0)]
)
def test_bad_numbers_are_refused(name, value):
    """Sizes and counts that are not whole numbers in range have a sentence."""
    with pytest.raises(InvalidValueError, match=r"must be a whole number of histories in \[1, "):
        dataclasses.replace(MANY, **{name: value})


def test_there_is_no_chunk_beyond_the_last():
    """Chunk 16 of 16 is refused."""
    with pytest.raises(InvalidValueError, match=r"chunk must be in \[0, 15\], got 16"):
        MANY.chunk(16)
