"""What the columns of a list hold: by the words of its header, in the language that knows most of them."""

# ruff: noqa: RUF001 - signs and words of other alphabets are meant

import csv
import difflib
import re
import tomllib
import unicodedata
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError

WORDS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("header_words.toml").read_text("utf-8"))
"""Words of lists in seven languages: of headers, by what the column holds, and of cells."""

SIZES = ("width", "depth", "height", "length", "diameter")
LENGTHS = (*SIZES, "base", "base_width", "base_depth", "base_diameter", "pedestal", "centre_of_mass_height")
"""What a column of lengths may hold."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

FACTORS = LENGTH_UNITS | WEIGHTS
TEXTS = ("name", "note", "body_file", "units", "shape", "consequence", "photo", "number")
"""Columns whose cells are no numbers."""

_MEASURES = (*LENGTHS, "weight")
_FIELDS = {"weight": ("mass",), "base": ("base_width", "base_depth"), "base_diameter": ("base_width", "base_depth")}
_FILLERS = frozenset({"in", "en", "σε", "ca", "max", "maximal", "total", "gesamt", "approx", "about"})


def plain(text: str) -> str:
    """Return words alone: small letters without accents, parted by blanks.

    >>> plain("  Höhe (cm)"), plain("Ø-Base_mm"), plain("YÜKSEKLİK")
    ('hohe cm', 'ø base mm', 'yukseklik')
    """
    small = text.lower().replace("⌀", "ø").replace("ı", "i").replace("ς", "σ").replace("center", "centre")
    letters = "".join(c for c in unicodedata.normalize("NFKD", small) if not unicodedata.combining(c))
    return " ".join(re.findall(r"[^\W_]+", letters))


def words_of(text: str) -> set[str]:
    """Return the words of a table, an umlaut in both its spellings."""
    both = (text, text.replace("ä", "ae").replace("ö", "oe").replace("ü", "ue"))
    words = {plain(word) for one in both for word in one.split(",")}
    return words | {word.replace("ß", "ss") for word in words if not word.startswith("maß")}  # Masse is the weight


_HEADERS = {
    language: {word: field for field, text in fields.items() for word in words_of(text)}
    for language, fields in WORDS["headers"].items()
}
UNITS = {word: unit for unit, text in WORDS["units"].items() for word in words_of(text)}
_MEASURED = {
    word for words in _HEADERS.values() for word, field in words.items() if field in _MEASURES and len(word) > 1
}
_TELLING = words_of(WORDS["telling"]) | {token for word in _MEASURED for token in word.split() if len(token) > 3}
_WITHIN = tuple(word for word in _TELLING if len(word) > 4 and word.isalpha())


@dataclass(frozen=True)
class InventoryColumn:
    """What a column holds."""

    stem: str  # what its title names
    fields: tuple[str, ...]  # fields of `InventoryObject` that it gives, in the order of the parts of its cells
    factor: float | None  # what turns its numbers into SI units; None where the cells or a column of units say it
    title: str  # its name in the file


@dataclass(frozen=True)
class Header:
    """A row of titles, understood."""

    columns: tuple[InventoryColumn | None, ...]  # None for one that is not read
    language: str

    @property
    def known(self) -> set[str]:
        """What it gives."""
        return {each.stem for each in self.columns if each} | {f for each in self.columns if each for f in each.fields}

    @property
    def missing(self) -> list[str]:
        """What a list must have and this one does not."""
        known = self.known
        missing = [] if {"name", "number"} & known else ["name"]
        if "body_file" in known or {"diameter", "height"} <= known or ("size" in known and "height" not in known):
            return missing
        wanted = ("width", "height") if {"width", "shape"} <= known else ("width", "depth", "height")
        return missing + [each for each in wanted if each not in known]


def _stem_in(words: list[str], fields: Mapping[str, str]) -> tuple[str, str]:
    """Return what words of a title name in one language, and its unit."""
    if whole := fields.get(" ".join(words)):
        return whole, ""
    kept = list(words)
    while kept and kept[-1] in _FILLERS - UNITS.keys():
        kept.pop()
    unit = UNITS[kept.pop()] if kept and kept[-1] in UNITS else ""  # at the end: a foot width is no width in feet
    bare = [word for word in kept if word not in _FILLERS]
    stem = fields.get(" ".join(kept)) or fields.get(" ".join(bare), "")
    return (stem, unit) if stem in {*_MEASURES, "size"} or not unit else ("", "")


def _stem(title: str, language: str) -> tuple[str, str]:
    """Return what a title names, in a language or any other, and its unit; nothing of one that is not known."""
    words = plain(title).split()
    tables = (_HEADERS[language], _HEADERS["en"], *_HEADERS.values())
    return next((found for fields in tables if (found := _stem_in(words, fields))[0]), ("", ""))


def order_of(title: str, language: str = "en") -> tuple[str, ...]:
    """Return the order of the parts of a measure that a title states.

    >>> order_of("Maße (HxBxT) in cm"), order_of("height*width*depth"), order_of("Maße")
    (('height', 'width', 'depth'), ('height', 'width', 'depth'), ())
    """
    words = plain(re.sub(r"[×✕*/]", " x ", title)).split()
    joined = re.compile(r"[a-zø](?:x[a-zø]){1,2}")
    tokens = [
        token for word in words for token in (" x ".join(word[::2]).split() if joined.fullmatch(word) else [word])
    ]
    best: list[str] = []
    run: list[str] = []
    for k, token in enumerate(tokens):
        side = side_of(token, language)
        if side and (not run or (k > 1 and tokens[k - 1] == "x")):
            run.append(side)
        elif token != "x":
            run = [side] if side else []
        best = max(best, list(run), key=len)
    return tuple(best) if 2 <= len(best) <= 3 and len(set(best)) == len(best) else ()


def side_of(token: str, language: str = "en") -> str:
    """Return which measure a letter or word stands for."""
    if token == "ø":
        return "diameter"
    found = WORDS["sides"].get(token) or _stem(token, language)[0]
    return found if found in SIZES else ""


def header_of(titles: Sequence[str], mapped: Mapping[str, str] | None = None) -> Header:
    """Return what the titles of a list mean, in the language that knows most; mapped: what the user says of some.

    >>> found = header_of(["Objekt", "Höhe (cm)", "Breite cm", "Tiefe in cm"])
    >>> found.language, [each.fields[0] for each in found.columns]
    ('de', ['name', 'height', 'width', 'depth'])
    """
    own = {plain(title): target for title, target in (mapped or {}).items()}
    meant = [own.get(plain(title), title) for title in titles]
    words = [plain(title).split() for title in meant]
    hits = {language: sum(bool(_stem_in(each, fields)[0]) for each in words) for language, fields in _HEADERS.items()}
    language = max(hits, key=lambda each: hits[each])
    columns = [_column(title, target, language) for title, target in zip(titles, meant, strict=True)]
    known = {field for each in columns if each for field in each.fields}
    if "length" in known:
        side = next((way for way in ("width", "depth") if way not in known), "length")
        columns = [
            each and replace(each, fields=tuple(side if f == "length" else f for f in each.fields)) for each in columns
        ]
    stems = [each.stem if each else "" for each in columns]
    for k, each in enumerate(columns):
        if each and each.stem not in _MEASURES and each.stem in stems[:k]:
            columns[k] = None  # the first of several is taken
    return Header(tuple(columns), language)


def _column(title: str, meant: str, language: str) -> InventoryColumn | None:
    stem, unit = _stem(meant, language)
    order = order_of(meant, language)
    if order:
        stem = "size"
        unit = unit or next(
            (UNITS[word] for word in reversed(plain(meant).split()) if word in UNITS and len(word) > 1), ""
        )
    if not stem:
        return None
    if stem in _MEASURES or stem == "size":
        if unit and unit not in (WEIGHTS if stem == "weight" else LENGTH_UNITS):
            return None
        fields = order or () if stem == "size" else _FIELDS.get(stem, (stem,))
        return InventoryColumn(stem, fields, FACTORS[unit] if unit else None, title.strip())
    return InventoryColumn(stem, (stem,), 1.0, title.strip())


def check_header(header: Header, titles: Sequence[str], source: str, dismissed: Collection[str] = ()) -> None:
    """Refuse a field that two columns give, and an unknown column that looks like a measure: it might decide."""
    fields = [field for each in header.columns if each and each.stem != "size" for field in each.fields]
    for each in fields:
        if fields.count(each) > 1:
            raise InvalidValueError(f"{source}: two columns give the {each.replace('_', ' ')}; leave one")
    if "length" in fields:
        title = next(each.title for each in header.columns if each and "length" in each.fields)
        raise InvalidValueError(
            f"{source}: column {title!r:.60} is not known but looks like a measure, beside width and depth; "
            f"{_remedy(title)}"
        )
    passed = {plain(title) for title in dismissed}
    for title, column in zip(titles, header.columns, strict=True):
        if column is None and plain(title) not in passed:
            _refuse_measure(title.strip(), source, header.language)


def _remedy(title: str) -> str:
    return f'rename it, or say what it is: columns "{title:.60}=width_cm"; nothing after "=" leaves it out'


_PEDESTAL, _HEIGHT = re.compile("sockel|pedestal|plinth|piedistallo|zoccolo|peana"), re.compile("hoe?he|height|alt")


def _refuse_measure(title: str, source: str, language: str) -> None:
    words = plain(title)
    stem, _, unit = words.rpartition(" ")
    if {_stem(title, language)[0], _stem(stem, language)[0]} & {"number", "note", "name", "weight", "size", "pedestal"}:
        return  # it does not decide, or says no more than others
    if _PEDESTAL.search(words) and _HEIGHT.search(words):
        return  # of what an object stands on; the report says that it was not read
    close = difflib.get_close_matches(stem if stem and unit in UNITS else words, _MEASURED, n=1, cutoff=0.8)
    tokens = words.split()
    told = _TELLING.intersection(tokens) or any(part in token for part in _WITHIN for token in tokens)
    if not ((stem and unit in UNITS) or close or told):
        return
    if (known := _stem(stem, language)[0]) in LENGTHS:
        units = ", ".join(f"{known}_{each}" for each in LENGTH_UNITS)
        raise InvalidValueError(f"{source}: column {title!r:.60} must name its unit: {units}")
    own = (stem or words).replace(" ", "_")
    near = difflib.get_close_matches(own, _MEASURES, n=1, cutoff=0.8)
    near = near or difflib.get_close_matches(own, _MEASURES, n=3, cutoff=0.5) or list(_MEASURES)
    names = ", ".join(f"{each}_{'kg' if each == 'weight' else 'cm'}" for each in near)
    raise InvalidValueError(
        f"{source}: column {title!r:.60} is not known but looks like a measure; {names}? {_remedy(title)}"
    )


def mapping_of(text: str | Mapping[str, str] | None) -> dict[str, str]:
    """Return what a user says of columns, own titles to ours; an empty one is not read, one with a comma is quoted.

    >>> mapping_of("Objekt=name, Maß B=width_cm, Rahmenbreite=")
    {'Objekt': 'name', 'Maß B': 'width_cm', 'Rahmenbreite': ''}
    >>> mapping_of('"Tiefe, innen"=, "Höhe, gesamt"=height_cm')
    {'Tiefe, innen': '', 'Höhe, gesamt': 'height_cm'}
    """
    if text is None:
        return {}
    if not isinstance(text, Mapping):
        fields = next(csv.reader([" ".join(text.split())], skipinitialspace=True), [])
        parts = [part.rpartition("=") for part in fields if part.strip()]
        if odd := next((ours for _, mark, ours in parts if not mark), ""):
            raise InvalidValueError(
                f'columns must say own title = ours, as in "Objekt=name, Maß B=width_cm", got {odd.strip()!r:.60}'
            )
        text = {own: ours for own, _, ours in parts}
    found = {str(own).strip(): str(ours).strip() for own, ours in text.items()}
    for own, ours in found.items():
        if not own or (ours and _column(own, ours, "en") is None):
            raise InvalidValueError(
                f"columns: {own!r:.60} cannot be {ours!r:.60}; ours are {', '.join((*TEXTS, 'count', 'friction'))}, "
                f"and with a unit, as in width_cm: {', '.join(_MEASURES)}, or an order: height x width x depth cm"
            )
    return found
