"""Directions of components (up, down, azimuth or unclear) from names, codes, angles or file names."""

import re
from collections.abc import Sequence
from typing import Any

from rocking.motions.motion import ORIENTATION

UP, DOWN, UNCLEAR = "up", "down", "unclear"
Direction = str | float | None
"""``up``, ``down``, ``unclear`` (may be vertical or inclined), an azimuth [degree], or None if missing."""

KEY = ORIENTATION
_INCLINED = 45.0, 5.0  # limits of inclined components, from vertical and horizontal [degree]
_UPRIGHT = re.compile(
    r"\+?(?:UP[CX]?|UPWARDS?|VERTI[CK]\w*|VERT?|VRT|VTCL?|V|Z|U|U-?D\d?|U[-/]D|UP[-/ ]?(?:TO[-/ ])?DO?W?N|"
    r"D[ÜU][ŞS]EY|[AC]Z)\+?",
    re.IGNORECASE,
)
_DOWN = re.compile(r"DO?W?N|DOWNWARDS?|D-?U|-(?:UP|Z|V)", re.IGNORECASE)
_SEED = re.compile(r"[FGDCESHBMLVURPTQ][HLGMN]([A-Z0-9])")
_COMPASS = re.compile(r"([NS])(?:ORTH|OUTH)?[\s.-]*(\d{1,3}(?:\.\d*)?)\s*(?:DEG\w*|°)?[\s.-]*([EW])(?:AST|EST)?", re.I)
_AZIMUTH = re.compile(r"[+]?(\d{1,4}(?:\.\d*)?)\s*(?:DEG\w*\.?|°)?", re.IGNORECASE)
_WORDS = {
    0.0: "N NS N-S SN S-N NORTH NORD NORTE KUZEY KG K-G",
    90.0: "E EW E-W WE W-E EAST EST OST ESTE DOGU DOĞU DB D-B",
    180.0: "S SOUTH SUR SÜD SUD GUNEY GÜNEY",
    270.0: "W WEST OVEST OUEST OESTE BATI",
}
_SIDES = {name: azimuth for azimuth, names in _WORDS.items() for name in names.split()}
_WHOLE_WORDS = re.compile(r"[^\W_]+")
_BESIDE = re.compile(
    r"A|ACC\w*|COMP\w*|CH\w*|DIR\w*|GROUND|MOTION|SENSOR|BESCHLEUNIGUNG|IVME|İVME|\d+|[GXY]|M|S|S2|CM|MS2",
    re.IGNORECASE,
)
_IN_NAME = r"(?:UP[CX]?|DO?WN|VERT(?:ICAL)?|VER|VRT|U-?D)\d?|[FGDCESHBMLVURPTQ][HLGMN]Z|[ZUV]"
_ENDINGS = re.compile(
    r"(?:\.(?:at2|smc|acc|asc|ascii|txt|dat|csv|tsv|cor|v[12]c?|s0a|raw|sac|mseed|ms|--|d|c|m))+$", re.I
)


def orientation(name: str) -> Direction:
    """Return the direction of a component from its name: ``up``, ``down``, ``unclear``, azimuth [degree], or None.

    >>> [orientation(name) for name in ("UP", "HNE", "N-S", "N20W", "090", "T", "acc_z [g]", "HNU")]
    ['up', 90.0, 0.0, 340.0, 90.0, None, 'up', 'unclear']
    """
    bare = " ".join(re.sub(r"\[[^\]]*\]|\([^)]*\)", " ", name[:200]).split()) or " ".join(name[:200].split())
    tokens = _WHOLE_WORDS.findall(bare)
    if (direction := _of_word(bare)) is not None or not tokens:
        return direction
    if len(tokens) == 1:
        return _of_word(re.sub(r"^(?:acc\w*?|a)(?=[xyz]$)", "", tokens[0], flags=re.IGNORECASE))
    direction = _of_words(tokens)
    return direction if direction is not None else _of_word(bare.split()[0])


def _of_word(word: str) -> Direction:
    upper = word.upper()
    if _DOWN.fullmatch(upper) or _UPRIGHT.fullmatch(upper):
        return DOWN if _DOWN.fullmatch(upper) else UP
    if azimuth := _AZIMUTH.fullmatch(upper):
        # codes above 360 in COSMOS and CSMIP: 400 is up (500 in older files)
        return float(azimuth[1]) % 360.0 if float(azimuth[1]) <= 360.0 else UNCLEAR
    if compass := _COMPASS.fullmatch(upper):
        return _of_compass(*compass.groups())
    # SEED Reference Manual 2.4, appendix A: A, B, C and U, V, W are inclined; 3 is the third of three components
    if seed := _SEED.fullmatch(word):
        directions: dict[str, Direction] = {"Z": UP, "N": 0.0, "E": 90.0}
        return directions.get(seed[1], None if seed[1] in "12RTXY" else UNCLEAR)
    return _SIDES.get(upper)


def _of_compass(north: str, degrees: str, east: str) -> Direction:
    turned = float(degrees) if (north == "N") == (east == "E") else -float(degrees)
    return (turned if north == "N" else 180.0 + turned) % 360.0 if float(degrees) <= 90.0 else UNCLEAR


def _of_words(tokens: Sequence[str]) -> Direction:
    """Return the direction of several words. It is unclear if the words contradict each other."""
    pairs = [(word, _of_word(word)) for word in tokens if not word.isdigit()]
    stated = [(word, side) for word, side in pairs if side is not None and (len(word) > 1 or word in "zZnNeE")]
    if all(_BESIDE.fullmatch(word) for word, side in pairs if side is None):
        stated = [(word, side) for word, side in pairs if side is not None and not _BESIDE.fullmatch(word)]
    sides = {side if isinstance(side, str) else "level" for _, side in stated}
    if len(sides) > 1:
        return UNCLEAR
    upright = next((side for _, side in stated if isinstance(side, str)), None)
    if len(stated) == 2 and upright is None:  # North-South
        first, second = (float(side) for _, side in stated)
        return first if abs(first - second) == 180.0 else None
    return upright or (stated[0][1] if len(stated) == 1 else None)


def of_angles(azimuth: float | None, from_up: float) -> Direction:
    """Return the direction of a sensor from its azimuth and its angle to the upward vertical [degree].

    >>> of_angles(90.0, 90.0), of_angles(0.0, 0.0), of_angles(None, 180.0), of_angles(0.0, 54.7)
    (90.0, 'up', 'down', 'unclear')
    """
    steep, level = _INCLINED
    if abs(from_up - 90.0) <= level:
        return None if azimuth is None else azimuth % 360.0
    if min(abs(from_up), abs(from_up - 180.0)) <= level:
        return UP if from_up < steep else DOWN
    return UNCLEAR


def both(stated: Direction, measured: Direction) -> Direction:
    """Return the second of two directions, or the first if the second is None; unclear if only one is vertical.

    >>> both("up", "down"), both("up", 90.0), both(None, 90.0), both(0.0, None)
    ('down', 'unclear', 90.0, 0.0)
    """
    if stated is None or measured is None:
        return stated if measured is None else measured
    return measured if isinstance(stated, str) == isinstance(measured, str) else UNCLEAR


def settled(sides: Sequence[Direction]) -> list[Direction]:
    """Return the directions of the components of one record. Two clear directions resolve an unclear third direction.

    >>> settled(["up", "unclear", "unclear"]), settled([0.0, 90.0, "unclear"]), settled(["unclear"] * 3)
    (['up', None, None], [0.0, 90.0, 'up'], ['unclear', 'unclear', 'unclear'])
    """
    upright = sum(side in {UP, DOWN} for side in sides)
    level = sum(isinstance(side, float) for side in sides)
    if len(sides) == 3 and UNCLEAR in sides:
        if upright == 1 and level < 2:
            return [None if side == UNCLEAR else side for side in sides]
        if level == 2:
            return [UP if side == UNCLEAR else side for side in sides]
    return list(sides)


def of_file_name(name: str) -> Direction:
    """Return ``up`` or ``down`` if the name of a file ends with such a word, otherwise None.

    >>> [of_file_name(name) for name in ("RSN8_ELC-UP.AT2", "A-CAT-DWN.AT2.smc", "group.txt", "NIG018UD.AT2", "x.UD2")]
    ['up', 'down', None, 'up', 'up']
    """
    ending = re.search(r"\.(U-?D|UP|VERT?|Z|V)\d?$", name, re.IGNORECASE)
    if ending and not re.search(r"\.V\d$", name, re.IGNORECASE):
        return UP
    stem = _ENDINGS.sub("", name)
    if match := re.search(rf"(?:^|[-_. ])({_IN_NAME})$", stem, re.IGNORECASE):
        return DOWN if _DOWN.fullmatch(match[1]) else UP
    if re.search(r"\.[FGDCESHBMLVURPTQ][HLGMN]Z\.", f".{name}."):
        return UP
    match = re.search(r"[0-9a-z](UP|DO?WN|VERT|UD|[BHE][HN]Z)$", stem) or (
        re.search(r"[A-Z]{2}(UP|DWN|VERT|[BHE][HN]Z)$", stem) if stem.isupper() else None
    )
    return None if match is None else DOWN if _DOWN.fullmatch(match[1]) else UP


def as_text(side: Direction) -> str:
    """Return a direction as text for metadata."""
    return "" if side is None else side if isinstance(side, str) else f"{side:g}"


def of_metadata(metadata: Any) -> Direction:
    """Return the direction from metadata: from the key of the direction, or from the name of the component."""
    if KEY in metadata:
        text = metadata[KEY]
        return None if not text else text if text in {UP, DOWN, UNCLEAR} else float(text)
    return orientation(metadata.get("component", ""))
