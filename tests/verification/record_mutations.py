"""Damage to record files, the same for the same seed: what transfer, editors and copying by hand do to them."""

import random
import re
from collections.abc import Callable

HEADER_LINES = 50

Mutation = Callable[[bytes, random.Random], bytes]


def mutated(content: bytes, seed: int) -> bytes:
    """Return a damaged copy; about one in eight is damaged twice."""
    chance = random.Random(seed)
    for _ in range(2 if chance.random() < 0.125 else 1):
        content = chance.choice(MUTATIONS)(content, chance)
    return content


def _flip_bytes(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.randint(1, 3)):
        place = chance.randrange(len(changed) or 1)
        if changed:
            changed[place] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _any_byte(content: bytes, chance: random.Random) -> bytes:
    place = chance.randrange(len(content) + 1)
    return content[:place] + bytes([chance.randrange(256)]) + content[place + 1 :]


def _insert(content: bytes, chance: random.Random) -> bytes:
    place = chance.randrange(len(content) + 1)
    return (
        content[:place]
        + chance.choice([b" ", b"\t", b"-", b".", b"7", b"E", b"\n", b"\0", b",", b"x"])
        + content[place:]
    )


def _delete(content: bytes, chance: random.Random) -> bytes:
    place, length = chance.randrange(len(content) + 1), chance.choice([1, 1, 1, 2, 9])
    return content[:place] + content[place + length :]


def _truncate(content: bytes, chance: random.Random) -> bytes:
    return content[: chance.randrange(len(content) + 1)]


def _on_lines(change: Callable[[list[bytes], random.Random], None]) -> Mutation:
    def mutation(content: bytes, chance: random.Random) -> bytes:
        lines = content.split(b"\n")
        change(lines, chance)
        return b"\n".join(lines)

    return mutation


def _some_line(lines: list[bytes], chance: random.Random) -> int:
    # every other time in the header, where most of the meaning is
    return chance.randrange(min(len(lines), HEADER_LINES) if chance.random() < 0.5 else len(lines))


def _drop_line(lines: list[bytes], chance: random.Random) -> None:
    del lines[_some_line(lines, chance)]


def _drop_block(lines: list[bytes], chance: random.Random) -> None:
    first = _some_line(lines, chance)
    del lines[first : first + chance.randint(2, 20)]


def _duplicate_line(lines: list[bytes], chance: random.Random) -> None:
    place = _some_line(lines, chance)
    lines.insert(place, lines[place])


def _swap_lines(lines: list[bytes], chance: random.Random) -> None:
    first, second = _some_line(lines, chance), _some_line(lines, chance)
    lines[first], lines[second] = lines[second], lines[first]


def _append_copy(content: bytes, _: random.Random) -> bytes:
    return content + content


def _replace_number(pattern: bytes, words: Callable[[bytes, random.Random], bytes], header: bool = False) -> Mutation:
    form = re.compile(pattern)

    def mutation(content: bytes, chance: random.Random) -> bytes:
        end = len(b"\n".join(content.split(b"\n")[:HEADER_LINES])) if header else len(content)
        found = list(form.finditer(content, 0, end))
        if not found:
            return content
        hit = chance.choice(found)
        return content[: hit.start()] + words(hit[0], chance) + content[hit.end() :]

    return mutation


def _another_digit(_: bytes, chance: random.Random) -> bytes:
    return str(chance.randrange(10)).encode()


def _near_count(word: bytes, chance: random.Random) -> bytes:
    return str(max(0, int(word[:15]) + chance.choice([-8, -5, -1, 1, 5, 8, 100]))).encode().rjust(len(word))


def _huge(word: bytes, chance: random.Random) -> bytes:
    return chance.choice([b"9" * len(word), b"99999999", b"999999999", b"4294967295", b"9" * 30, b"1E300", b"9" * 5000])


def _no_number(word: bytes, chance: random.Random) -> bytes:
    return chance.choice(
        [b"*" * len(word), b"NaN", b"-inf", b"Infinity", b"", b" " * len(word), b"0", b"-0.0", b"1e999"]
    )


def _minus(word: bytes, _: random.Random) -> bytes:
    return b" " if word == b"-" else b"-"


MUTATIONS = (
    _flip_bytes,
    _any_byte,
    _insert,
    _delete,
    _truncate,
    _on_lines(_drop_line),
    _on_lines(_drop_block),
    _on_lines(_duplicate_line),
    _on_lines(_swap_lines),
    _append_copy,
    _replace_number(rb"\d", _another_digit),
    _replace_number(rb"\d", _another_digit, header=True),
    _replace_number(rb"(?<![\d.])\d+(?![\d.])", _near_count, header=True),
    _replace_number(rb"(?<![\d.])\d+(?![\d.])", _huge, header=True),
    _replace_number(rb"[+-]?\d+\.?\d*(E[+-]\d+)?", _no_number),
    _replace_number(rb"[+-]", _minus),
)
