"""What the columns of a list contain: by the words of its header, of one or more rows, in the language of most."""

# ruff: noqa: RUF001 - signs and words of other alphabets are meant

import csv
import difflib
import re
import tomllib
import unicodedata
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError
from rocking.studies.inventory import objects

WORDS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("header_words.toml").read_text("utf-8"))
"""Words of lists in eight languages: of headers, by what the column holds, and of cells."""

SIZES = (*objects.SIZES, "length", "diameter")
LENGTHS = (*SIZES, "base", *objects.LENGTHS[3:5], "base_diameter", "pedestal", objects.LENGTHS[5])
"""What a column of lengths may hold."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

FACTORS = LENGTH_UNITS | WEIGHTS
TEXTS = ("name", "note", "body_file", "units", "shape", "consequence", "photo", "number")
"""Columns whose cells are no numbers."""

_MEASURES = (*LENGTHS, "weight")
_FIELDS = {"weight": ("mass",), "base": ("base_width", "base_depth"), "base_diameter": ("base_width", "base_depth")}
# of a group of columns and a column in it
_IN_GROUP = {
    ("base", "width"): "base_width", ("base", "depth"): "base_depth", ("base", "length"): "base_depth",
    ("base", "diameter"): "base_diameter", ("base", "height"): "", ("width", "base"): "base_width",
    ("depth", "base"): "base_depth", ("diameter", "base"): "base_diameter", ("height", "base"): "",
    ("centre_of_mass_height", "height"): "centre_of_mass_height", ("pedestal", "diameter"): "pedestal",
    **{("pedestal", side): "" for side in SIZES if side != "diameter"},
}  # fmt: skip


@lru_cache(maxsize=1 << 16)
def plain(text: str) -> str:
    """Return words alone: small letters without accents, parted by blanks.

    >>> plain("  Höhe (cm)"), plain("Ø-Base_mm"), plain("YÜKSEKLİK")
    ('hohe cm', 'ø base mm', 'yukseklik')
    """
    small = (
        text.lower()
        .replace("⌀", "ø")
        .replace("ı", "i")
        .replace("ς", "σ")
        .replace("œ", "oe")
        .replace("center", "centre")
    )
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
_TOKENS = {
    code: {token for word in fields for token in word.split() if len(token) > 2} for code, fields in _HEADERS.items()
}
UNITS = {word: unit for unit, text in WORDS["units"].items() for word in words_of(text)}
_MEASURED = {
    word for words in _HEADERS.values() for word, field in words.items() if field in _MEASURES and len(word) > 1
}
_TELLING = words_of(WORDS["telling"]) | {token for word in _MEASURED for token in word.split() if len(token) > 3}
_WITHIN = tuple(word for word in _TELLING if len(word) > 4 and word.isalpha())
_FILLERS = frozenset(words_of(WORDS["fillers"]))
_OTHERS, _WITHOUT = words_of(WORDS["others"]), words_of(WORDS["without"])
_BEGINNINGS = tuple(word for word in _OTHERS if len(word) > 4)  # Sockelmaße, Rahmengröße
_INSTEAD = {word: stem for stem, text in WORDS["instead"].items() for word in words_of(text)}
_PHRASES: dict[str, set[str]] = {}  # of all languages
for _words in _HEADERS.values():
    for _word, _field in _words.items():
        _PHRASES.setdefault(_word, set()).add(_field)
_TRANSLATED = re.compile(r"[/|\n\u2013\u2014]| - ")


@dataclass(frozen=True)
class InventoryColumn:
    """What a column holds."""

    stem: str  # what its title names
    fields: tuple[str, ...]  # fields of `InventoryObject` that it gives, in the order of the parts of its cells
    factor: float | None  # what turns its numbers into SI units; None where the cells or a column of units say it
    title: str  # its name in the file


@dataclass(frozen=True)
class Header:
    """What the titles of a list mean."""

    columns: tuple[InventoryColumn | None, ...]  # None for one that is not read
    language: str
    titles: tuple[str, ...]  # of all columns

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
        wanted = ("width", "height") if {"width", "shape"} <= known else objects.SIZES
        return missing + [each for each in wanted if each not in known]


def _bare(words: Sequence[str]) -> tuple[list[str], str]:
    """Return the words of a title without its unit, which is the last of them, and the unit."""
    kept = list(words)
    while kept and kept[-1] in _FILLERS - UNITS.keys():
        kept.pop()
    unit = UNITS[kept.pop()] if kept and kept[-1] in UNITS else ""  # at the end: a foot width is no width in feet
    return kept, unit


def _stem_in(words: list[str], fields: Mapping[str, str]) -> tuple[str, str]:
    """Return what words of a title name in one language, and its unit."""
    if whole := fields.get(" ".join(words)):
        return whole, ""
    kept, unit = _bare(words)
    bare = [word for word in kept if word not in _FILLERS]
    stem = fields.get(" ".join(kept)) or fields.get(" ".join(bare), "")
    return (stem, unit) if stem in {*_MEASURES, "size"} or not unit else ("", "")


def _stem(title: str, language: str) -> tuple[str, str]:
    """Return what a title names, in a language or any other or two of them, and its unit; nothing of an unknown one."""
    words = plain(title).split()
    tables = (_HEADERS[language], _HEADERS["en"], *_HEADERS.values())
    found = next((found for fields in tables if (found := _stem_in(words, fields))[0]), ("", ""))
    if found[0] or (found := _translated(title))[0]:
        return found
    if any(word.startswith("inv") for word in words) and all(word.startswith("inv") or len(word) < 4 for word in words):
        return "number", ""  # N. d'inv., Inv.-Nr. alt
    bare = re.sub(r"\([^()]*\)|\[[^\[\]]*\]", " ", title)
    stem = _stem(bare, language)[0] if plain(bare) != plain(title) else ""
    return ("", "") if stem in {*_MEASURES, "size"} else (stem, "")  # brackets may say of which part a measure is


def stem_of(title: str, language: str) -> str:
    """Return what a title names, or nothing."""
    return _Level.of(title, language).stem


def _translated(title: str) -> tuple[str, str]:
    """Return what a title in more than one language names, and its unit, as of ``Breite / Larghezza (cm)``."""
    words, unit = _bare(plain(title).split())
    fields = _phrased(words)
    if not fields:
        parts = [plain(part).split() for part in _TRANSLATED.split(title)]
        known = [part_fields for part in parts if (part_fields := _phrased(part))]
        unknown = [word for part in parts if not _phrased(part) for word in part]
        if known and not any(word in _OTHERS or word in _TELLING for word in unknown):
            fields = set.intersection(*known)
    if len(fields) != 1:
        return "", ""
    (stem,) = fields
    return (stem, unit) if stem in {*_MEASURES, "size"} or not unit else ("", "")


def _phrased(words: Sequence[str]) -> set[str]:
    """Return which fields words name that are phrases of any language one after another, all of the same field."""
    ends: list[set[str]] = [{""}, *(set() for _ in words)]
    for k, word in enumerate(words):
        if word in _FILLERS or (
            word in UNITS and word not in _TELLING and "" not in ends[k]
        ):  # a unit follows what it is of
            ends[k + 1] |= ends[k]
        for j in range(k + 1, min(k + 5, len(words)) + 1):
            ends[j] |= {
                field for field in _PHRASES.get(" ".join(words[k:j]), ()) if "" in ends[k] or field in ends[k]
            }  # fmt: skip
    return ends[-1] - {""}


def order_of(title: str, language: str = "en") -> tuple[str, ...]:
    """Return the order of the parts of a measure that a title states.

    >>> order_of("Maße (HxBxT) in cm"), order_of("height*width*depth"), order_of("Maße")
    (('height', 'width', 'depth'), ('height', 'width', 'depth'), ())
    """
    words = plain(re.sub(r"[×✕*/]|(?<=\b\w)\s?[-\u2013]\s?(?=\w\b)", " x ", title)).split()
    joined = re.compile(r"[a-zø](?:x[a-zø]){1,2}")
    tokens = [
        token for word in words for token in (" x ".join(word[::2]).split() if joined.fullmatch(word) else [word])
    ]
    best: list[str] = []
    run: list[str] = []
    for k, token in enumerate(tokens):
        side = side_of(token, language)
        if side and (not run or (k > 1 and tokens[k - 1] == "x")):
            run.append("width" if side == "length" in run else side)  # a longer and a shorter one: L x l
        elif token != "x":
            run = [side] if side else []
        best = max(best, list(run), key=len)
    return tuple(best) if 2 <= len(best) <= 3 and len(set(best)) == len(best) else ()


def side_of(token: str, language: str = "en") -> str:
    """Return which measure a letter or word stands for."""
    if token == "ø":
        return "diameter"
    found = _HEADERS[language].get(token) or WORDS["sides"].get(token) or _stem(token, language)[0]
    return found if found in SIZES else ""


Titles = Sequence[str | Sequence[str]]
"""What stands above each column: a title, or a title for each row of the header, groups of columns first."""


def levels_of(title: str | Sequence[str]) -> tuple[str, ...]:
    """Return the titles of a column, each on one line and once."""
    levels = [" ".join(each.split(" ")).strip() for each in ((title,) if isinstance(title, str) else title)]
    return tuple(dict.fromkeys(each for each in levels if each))


def title_of(title: str | Sequence[str]) -> str:
    """Return what a column is called.

    >>> title_of(("Maße (cm)", "Breite")), title_of(("Maße", "B", "[cm]"))
    ('Maße (cm): Breite', 'Maße: B [cm]')
    """
    parted = "".join(f"{' ' if plain(each) in UNITS else ': '}{each}" for each in levels_of(title))
    return " ".join(parted.removeprefix(": ").split())


def header_of(titles: Titles, mapped: Mapping[str, str] | None = None) -> Header:
    """Return what the titles of a list mean, in the language that knows most; mapped: what the user says of some.

    >>> found = header_of(["Objekt", "Höhe (cm)", ("Maße (cm)", "Breite"), ("Maße (cm)", "Tiefe")])
    >>> found.language, [each.fields[0] for each in found.columns]
    ('de', ['name', 'height', 'width', 'depth'])
    """
    language = _language_of(titles)
    named, targets = [title_of(title) for title in titles], _targets(titles, mapped or {})
    columns = [
        _column(name, levels_of(title), language) if target is None else _column(name, (target,), language)
        for title, name, target in zip(titles, named, targets, strict=True)
    ]
    known = {field for each in columns if each for field in each.fields}
    for field in {"number", "name"} - known:
        free = [k for k, each in enumerate(columns) if each is None and targets[k] is None]
        instead = (
            k for k in free if field in {_INSTEAD.get(plain(each)) for each in (named[k], *levels_of(titles[k]))}
        )
        if (place := next(instead, None)) is not None:
            columns[place] = InventoryColumn(field, (field,), 1.0, named[place])
    columns = _sided(_in_order(titles, columns))
    stems = [each.stem if each else "" for each in columns]
    for k, each in enumerate(columns):
        if each and each.stem not in _MEASURES and each.stem in stems[:k]:
            columns[k] = None  # the first of several is taken
    return Header(tuple(columns), language, tuple(named))


def _in_order(titles: Titles, columns: list[InventoryColumn | None]) -> list[InventoryColumn | None]:
    """Return columns below one title of their order, as ``Maße (B x T x H)`` above three of them, each as its side."""
    levels, found = [levels_of(title) for title in titles], list(columns)
    for first, column in enumerate(columns):
        if column is None or column.stem != "size" or levels[first] in levels[:first]:
            continue
        places = [k for k, each in enumerate(levels) if each == levels[first]]
        if len(places) == len(column.fields):
            for k, side in zip(places, column.fields, strict=True):
                found[k] = replace(column, stem=side, fields=(side,))
    return found


def _sided(columns: list[InventoryColumn | None]) -> list[InventoryColumn | None]:
    """Return columns with each length as the side that is not given."""
    known = {field for each in columns if each for field in each.fields}
    free = [way for way in ("width", "depth") if way not in known]
    for k, each in enumerate(columns):
        if each and "length" in each.fields and free:
            side = free.pop(0)
            columns[k] = replace(each, fields=tuple(side if f == "length" else f for f in each.fields))
    return columns


def names_of(titles: Titles) -> list[tuple[str, ...]]:
    """Return the names by which a user may state each column: its whole title, and its lowest if no other has that.

    >>> names_of([("Base (cm)", "Width"), ("Size (cm)", "Width"), ("Size (cm)", "Height")])
    [('base cm width',), ('size cm width',), ('size cm height', 'height')]
    """
    lowest = [plain((levels_of(title) or ("",))[-1]) for title in titles]
    return [
        (plain(title_of(title)), *([last] if lowest.count(last) == 1 else []))
        for title, last in zip(titles, lowest, strict=True)
    ]


def _targets(titles: Titles, mapped: Mapping[str, str]) -> list[str | None]:
    """Return what the user states of each column."""
    targets = {plain(title): target for title, target in mapped.items()}
    return [next((targets[name] for name in names if name in targets), None) for names in names_of(titles)]


def _language_of(titles: Titles) -> str:
    """Return the language of most titles, as they are written; of equals that which stands first."""
    parts = list(dict.fromkeys(
        (place, part)
        for title in titles for level in levels_of(title)
        for place, part in enumerate(filter(None, map(str.strip, re.split(r"[/|()\[\]\n\u2013\u2014]| - ", level))))
    ))  # fmt: skip

    words = [(place, plain(part).split()) for place, part in parts]

    def votes(code: str) -> tuple[int, int, int]:
        places = [place for place, part in words if _stem_in(part, _HEADERS[code])[0]]
        return len(places), -sum(places), sum(token in _TOKENS[code] for _, part in words for token in part)

    return str(max(_HEADERS, key=votes))


@dataclass(frozen=True)
class _Level:
    """One title of a column."""

    stem: str
    unit: str
    order: tuple[str, ...]
    words: tuple[str, ...]  # without its unit

    @classmethod
    @lru_cache(maxsize=4096)
    def of(cls, title: str, language: str) -> "_Level":
        stem, unit = _stem(title, language)
        order = order_of(title, language)
        words, last = _bare(plain(title).split())
        if order:
            stem = "size"
            unit = unit or next(
                (UNITS[word] for word in reversed(plain(title).split()) if word in UNITS and len(word) > 1), ""
            )
        stated = not words or set(words) <= _FILLERS  # nothing but a unit
        return cls(stem, unit or (last if stated and not stem else ""), order, tuple(words))

    @property
    def is_neutral(self) -> bool:
        """Whether it says nothing of what the column holds, as a unit, or that it is of the object itself."""
        return not self.stem and (set(self.words) <= _FILLERS or bool(_WITHOUT.intersection(self.words)))

    @property
    def is_other(self) -> bool:
        """Whether it is of something that is not the object."""
        other = any(word in _OTHERS or word.startswith(_BEGINNINGS) for word in self.words)
        return not self.stem and other and not _WITHOUT.intersection(self.words)

    @property
    def is_doubtful(self) -> bool:
        """Whether it looks like a measure and is not understood."""
        return not self.stem and bool(_TELLING.intersection(self.words)) and not _WITHOUT.intersection(self.words)


def _column(title: str, texts: Sequence[str], language: str) -> InventoryColumn | None:
    """Return what a column is by its titles, of a group and of its own; None of one that is not understood."""
    levels = [_Level.of(text, language) for text in texts]
    last = levels[-1] if levels else None
    if last and len(levels) > 1 and UNITS.get(plain(texts[-1])) in _units_of(levels[-2].stem):
        levels[-1] = last = replace(last, stem="", unit=UNITS[plain(texts[-1])], order=(), words=())
    stem = ""
    for each in levels:
        is_unit = stem == "count" and " ".join(each.words) in _INSTEAD  # Q.tà, n.
        stem = stem if each.is_neutral or is_unit else _IN_GROUP.get((stem, each.stem), each.stem)
    words = [each.words for each in levels if each.words]
    both = next((found for order in (words, words[::-1]) if len(words) > 1 and (found := _joined(order, language))), "")
    stem = both or stem
    if not stem:
        return None
    if stem not in {*_MEASURES, "size"}:
        return InventoryColumn(stem, (stem,), 1.0, title)
    if not both and stem != "weight" and any(each.is_other or each.is_doubtful for each in levels):
        return None
    own = next(each for each in reversed(levels) if each.stem or both)
    if own.unit and own.unit not in _units_of(stem):
        return None
    unit = next((each.unit for each in reversed(levels) if each.unit in _units_of(stem)), "")
    order = next((each.order for each in reversed(levels) if each.order), ())
    fields = order if stem == "size" else _FIELDS.get(stem, (stem,))
    return InventoryColumn(stem, fields, FACTORS[unit] if unit else None, title)


def _units_of(stem: str) -> Collection[str]:
    """Return the units that a measure may have."""
    return WEIGHTS if stem == "weight" else LENGTH_UNITS if stem in {*LENGTHS, "size"} else ()


def _joined(titles: Sequence[Sequence[str]], language: str) -> str:
    """Return what the titles of a group and of its column name together, as of ``Basis`` above ``Breite``."""
    words = [word for title in titles for word in title]
    tables = (_HEADERS[language], _HEADERS["en"], *_HEADERS.values())
    return next((fields[whole] for fields in tables if (whole := " ".join(words)) in fields), "")


def check_header(header: Header, titles: Titles, source: str, dismissed: Collection[str] = ()) -> None:
    """Refuse a field that two columns give, and an unknown column that looks like a measure: it might decide."""
    fields = [field for each in header.columns if each and each.stem != "size" for field in each.fields]
    for each in fields:
        if fields.count(each) > 1:
            raise InvalidValueError("two columns give the {field}", field=each.replace("_", " "), hint="leave one").at(
                source
            )
    if "length" in fields:
        length = next(each.title for each in header.columns if each and "length" in each.fields)
        raise InvalidValueError(
            "column {column!r:.60} is not known but looks like a measure, beside width and depth", column=length,
            hint=_remedy(length),
        ).at(source)  # fmt: skip
    passed = {plain(title) for title in dismissed}
    for title, column in zip(titles, header.columns, strict=True):
        levels = levels_of(title)
        if column is not None or passed.intersection(map(plain, (title_of(title), *levels[-1:]))):
            continue
        if len(levels) == 1 or not any(_Level.of(each, header.language).is_other for each in levels[:-1]):
            _refuse_measure(title_of(title), source, header.language)


def _remedy(title: str) -> str:
    return f'rename the column, or add --map-columns "{title:.60}=NAME_mm"; nothing after "=" ignores the column'


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
        raise InvalidValueError("column {column!r:.60} must name its unit: {units}", column=title, units=units).at(
            source
        )
    own = (stem or words).replace(" ", "_")
    near = difflib.get_close_matches(own, _MEASURES, n=1, cutoff=0.8)
    near = near or difflib.get_close_matches(own, _MEASURES, n=3, cutoff=0.5) or list(_MEASURES)
    names = ", ".join(f"{each}_{'kg' if each == 'weight' else 'cm'}" for each in near)
    raise InvalidValueError(
        "column {column!r:.60} is not known but looks like a measure; {names}? {remedy}", column=title, names=names,
        remedy=_remedy(title),
    ).at(source)  # fmt: skip


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
                '{parameter} must say own title = ours, as in "Objekt=name, Maß B=width_cm", got {value}',
                parameter="map_columns", value=odd.strip(),
            )  # fmt: skip
        text = {own: ours for own, _, ours in parts}
    found = {str(own).strip(): str(ours).strip() for own, ours in text.items()}
    for own, ours in found.items():
        if not own or (ours and _column(own, (ours,), "en") is None):
            raise InvalidValueError(
                "{parameter}: {own!r:.60} cannot be {value}; ours are {texts}, and with a unit, as in width_cm: "
                "{measures}, or an order: height x width x depth cm", parameter="map_columns", own=own, value=ours,
                texts=", ".join((*TEXTS, "count", "friction")), measures=", ".join(_MEASURES),
            )  # fmt: skip
    return found
