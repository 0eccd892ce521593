"""What files of many channels share: naming them by direction or number, and the event in their text lines."""

import re
from collections.abc import Sequence
from dataclasses import replace

from rocking.motions.formats.record import Component

Channel = tuple[list[str], str, Component]
"""Header lines of a channel, the one with its number and direction, and its samples."""

LONGEST_LINE = 200
"""Characters of a header line that patterns look at."""


def distinct_names(channels: Sequence[Channel]) -> tuple[Component, ...]:
    """Return the components named by direction, or by channel number where directions repeat."""
    found = [re.search(r"CHAN\s*(\d+)\s*:\s*(.*?)\s*(?:DEG\b.*)?$", label, re.IGNORECASE) for _, label, _ in channels]
    numbers = [one[1] if one else str(place) for place, one in enumerate(found, 1)]
    names = directions = [one[2].strip() if one else "" for one in found]
    if len({name.casefold() for name in directions}) < len(channels) or "" in directions:
        unique = len(set(numbers)) == len(channels)
        names = [f"CHAN {n}" for n in (numbers if unique else range(1, len(channels) + 1))]
    return tuple(
        replace(part, name=name, metadata={"channel": chan, "direction": direction})
        for (_, _, part), name, chan, direction in zip(channels, names, numbers, directions, strict=True)
    )


def names_in(texts: Sequence[str]) -> dict[str, str]:
    """Return event and station from the text lines after the titles."""
    station = re.search(r"STATION NO\.?\s*(\w+)", texts[3][:LONGEST_LINE], re.IGNORECASE)
    found = {
        "event": texts[0].strip(),
        "date": texts[1].split("(")[0].strip(),
        "station number": station[1] if station else "",
        "station": texts[4].strip(),
    }
    return {key: value for key, value in found.items() if value}
