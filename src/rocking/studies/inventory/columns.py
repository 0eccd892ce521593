"""Columns of an inventory: what each holds by its name, in which unit, and which names are refused."""

import difflib
from collections.abc import Sequence
from dataclasses import dataclass

from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError

LENGTHS = ("width", "depth", "height", "base_width", "base_depth", "centre_of_mass_height")
"""Columns that are lengths; the name of the column ends with the unit, as in ``width_cm``."""

REQUIRED = ("name", "width", "depth", "height")
"""Columns that an inventory must have."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

WORDS = ("name", "count", "note")
"""Columns without a unit."""

_MEASURES = (*LENGTHS, "base", "weight")
_ALIASES = {"mass": "weight", "centre_of_gravity": "centre_of_mass_height", "com_height": "centre_of_mass_height"}
_FIELDS = {"weight": ("mass",), "base": ("base_width", "base_depth")}

# a column of such a name may decide the verdict: not to read it needs the user's word, not a guess
_TELLING = frozenset({
    "base", "foot", "feet", "centre", "gravity", "mass", "diameter", "height", "width", "depth", "weight",
})  # fmt: skip


@dataclass(frozen=True)
class InventoryColumn:
    """What a column holds."""

    fields: tuple[str, ...]  # fields of `InventoryObject` that it gives: a base without a direction gives both
    factor: float  # what turns its numbers into SI units
    title: str  # its name in the file


def columns_of(titles: Sequence[str], source: str) -> tuple[list[InventoryColumn | None], tuple[str, ...]]:
    """Return what the columns of a file hold.

    Returns columns: none for one that is not read; ignored: names of those that are not read.

    >>> columns, ignored = columns_of(["name", "base_cm", "room"], "list.csv")
    >>> columns[1].fields, ignored
    (('base_width', 'base_depth'), ('room',))
    """
    columns = [_column(title, source) for title in titles]
    fields = [field for column in columns if column for field in column.fields]
    for each in fields:
        if fields.count(each) > 1:
            raise InvalidValueError(f"{source}: two columns give the {each.replace('_', ' ')}; leave one")
    pairs = zip(titles, columns, strict=True)
    return columns, tuple(title.strip() for title, column in pairs if column is None and title.strip())


def has_required(titles: Sequence[str]) -> bool:
    """Return whether names are those of an inventory.

    Returns whether none that is needed is missing; units are not looked at.
    """
    stems = {_split(title)[0] for title in titles}
    return all(each in stems for each in REQUIRED)


def _split(title: str) -> tuple[str, str]:
    """Return what a column holds, and its unit."""
    plain = title.strip().casefold().replace("center", "centre")
    for mark in "()[]":
        plain = plain.replace(mark, " ")
    words = "_".join(plain.replace("_", " ").replace("-", " ").split())
    stem, _, unit = words.rpartition("_")
    whole, stem = _ALIASES.get(words, words), _ALIASES.get(stem, stem)
    return (stem, unit) if stem in _MEASURES and whole not in _MEASURES else (whole, "")


def _column(title: str, source: str) -> InventoryColumn | None:
    stem, unit = _split(title)
    if stem in _MEASURES:
        units = WEIGHTS if stem == "weight" else LENGTH_UNITS
        if unit not in units:
            known = ", ".join(f"{stem}_{each}" for each in units)
            raise InvalidValueError(f"{source}: column {title.strip()!r} must name its unit: {known}")
        return InventoryColumn(_FIELDS.get(stem, (stem,)), units[unit], title.strip())
    if stem in WORDS:
        return InventoryColumn((stem,), 1.0, title.strip())
    _refuse_measure(title.strip(), stem, source)
    return None


def _refuse_measure(title: str, words: str, source: str) -> None:
    """Refuse an unknown column that looks like a measure: the verdict might hang on it."""
    stem, _, unit = words.rpartition("_")
    measured = bool(stem) and (unit in LENGTH_UNITS or unit in WEIGHTS)
    close = difflib.get_close_matches(stem or words, _MEASURES, n=1, cutoff=0.8)
    if not (measured or close or _TELLING.intersection(words.split("_"))):
        return
    near = close or difflib.get_close_matches(stem or words, _MEASURES, n=3, cutoff=0.5) or _MEASURES
    names = ", ".join(f"{each}_{'kg' if each == 'weight' else 'cm'}" for each in near)
    raise InvalidValueError(
        f"{source}: column {title!r} is not known but looks like a measure; {names}? "
        "Rename it, or leave it out if it is none"
    )
