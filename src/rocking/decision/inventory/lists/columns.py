"""Meaning of the columns of a list, from a header of one or more rows in the language of most titles."""

# ruff: noqa: RUF001 - signs and words of other alphabets are intended

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
from rocking.decision.inventory import objects
from rocking.decision.inventory.lists.sheets import Cell, text_of
from rocking.errors import InvalidValueError

WORDS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("header_words.toml").read_text("utf-8"))
"""Words of lists in eight languages: headers by column, and words in cells."""

SIZES = (*objects.SIZES, "length", "diameter")
LENGTHS = (*SIZES, "base", *objects.LENGTHS[3:5], "base_diameter", "pedestal", objects.LENGTHS[5])
"""Fields of columns with lengths."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

FACTORS = LENGTH_UNITS | WEIGHTS
TEXTS = ("name", "note", "body_file", "units", "shape", "consequence", "photo", "number")
"""Columns with text cells."""

MEASURED = {*SIZES, "size", "body_file"}
"""Columns with the size of an object."""

_MEASURES = (*LENGTHS, "weight")
_WITH_UNIT = {*_MEASURES, "size"}
_FIELDS = {"weight": ("mass",), "base": ("base_width", "base_depth"), "base_diameter": ("base_width", "base_depth")}
# keys: quantities in the title of a group and in the title of its column
_IN_GROUP = {
    ("base", "width"): "base_width", ("base", "depth"): "base_depth", ("base", "length"): "base_depth",
    ("base", "diameter"): "base_diameter", ("base", "height"): "", ("width", "base"): "base_width",
    ("depth", "base"): "base_depth", ("diameter", "base"): "base_diameter", ("height", "base"): "",
    ("centre_of_mass_height", "height"): "centre_of_mass_height", ("pedestal", "diameter"): "pedestal",
    **{("pedestal", side): "" for side in SIZES if side != "diameter"},
}  # fmt: skip


@lru_cache(maxsize=1 << 16)
def plain(text: str) -> str:
    """Return a text as lower-case words without accents, separated by blanks.

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
    """Return the words of a comma-separated text, with both spellings of umlauts."""
    both = (text, text.replace("ä", "ae").replace("ö", "oe").replace("ü", "ue"))
    spelled = {plain(word) for spelling in both for word in spelling.split(",")}
    return spelled | {word.replace("ß", "ss") for word in spelled if not word.startswith("maß")}  # "Masse" is weight


_HEADERS = {
    language: {word: field for field, text in fields.items() for word in words_of(text)}
    for language, fields in WORDS["headers"].items()
}
_TOKENS = {
    code: {token for word in fields for token in word.split() if len(token) > 2} for code, fields in _HEADERS.items()
}
UNITS = {word: unit for unit, text in WORDS["units"].items() for word in words_of(text)}
_MEASURED = {
    word for fields in _HEADERS.values() for word, field in fields.items() if field in _MEASURES and len(word) > 1
}
_TELLING = words_of(WORDS["telling"]) | {token for word in _MEASURED for token in word.split() if len(token) > 3}
_WITHIN = tuple(word for word in _TELLING if len(word) > 4 and word.isalpha())
_FILLERS = frozenset(words_of(WORDS["fillers"]))
_OTHERS, _WITHOUT = words_of(WORDS["others"]), words_of(WORDS["without"])
_BEGINNINGS = tuple(word for word in _OTHERS if len(word) > 4)  # these match words such as Sockelmaße, Rahmengröße
_INSTEAD = {word: stem for stem, text in WORDS["instead"].items() for word in words_of(text)}
_PHRASES: dict[str, set[str]] = {}  # phrases of all languages
for _words in _HEADERS.values():
    for _word, _field in _words.items():
        _PHRASES.setdefault(_word, set()).add(_field)
_TRANSLATED = re.compile(r"[/|\n\u2013\u2014]| - ")


@dataclass(frozen=True)
class InventoryColumn:
    """Meaning of a column."""

    stem: str  # quantity in the title
    fields: tuple[str, ...]  # fields of `InventoryObject`, in the order of the sizes in the cells
    factor: float | None  # SI factor of the numbers; None if the cells or another column contain the units
    title: str  # title of the column in the file


@dataclass(frozen=True)
class Header:
    """Meaning of the titles of a list."""

    columns: tuple[InventoryColumn | None, ...]  # meaning of the columns, None for an ignored column
    language: str
    titles: tuple[str, ...]  # titles of all columns

    def stem(self, index: int) -> str:
        """Return the quantity of a column; empty for an ignored column or beyond the last column."""
        column = self.columns[index] if index < len(self.columns) else None
        return column.stem if column else ""

    def text(self, cells: Sequence[Cell], stem: str) -> str:
        """Return the text of a row in the column of a quantity; empty without such a column."""
        return next((text_of(cell) for k, cell in enumerate(cells) if self.stem(k) == stem), "")

    @property
    def fields(self) -> set[str]:
        """Quantities and fields of the columns."""
        columns = [column for column in self.columns if column]
        return {column.stem for column in columns} | {field for column in columns for field in column.fields}

    @property
    def missing(self) -> list[str]:
        """Missing columns that a list needs."""
        fields = self.fields
        missing = [] if {"name", "number"} & fields else ["name"]
        if "body_file" in fields or {"diameter", "height"} <= fields or ("size" in fields and "height" not in fields):
            return missing
        required = ("width", "height") if {"width", "shape"} <= fields else objects.SIZES
        return missing + [field for field in required if field not in fields]


def _bare(tokens: Sequence[str]) -> tuple[list[str], str]:
    """Return the words of a title without its unit, which is the last word, and the unit."""
    kept = list(tokens)
    while kept and kept[-1] in _FILLERS - UNITS.keys():
        kept.pop()
    unit = UNITS[kept.pop()] if kept and kept[-1] in UNITS else ""  # not "foot width"
    return kept, unit


def _stem_in(tokens: list[str], fields: Mapping[str, str]) -> tuple[str, str]:
    """Return the quantity of a title in one language, and its unit."""
    if stem_of_title := fields.get(" ".join(tokens)):
        return stem_of_title, ""
    kept, unit = _bare(tokens)
    bare = [word for word in kept if word not in _FILLERS]
    stem = fields.get(" ".join(kept)) or fields.get(" ".join(bare), "")
    return (stem, unit) if stem in _WITH_UNIT or not unit else ("", "")


def _stem(title: str, language: str) -> tuple[str, str]:
    """Return the quantity of a title in one or two languages, and its unit; empty if unknown."""
    tokens = plain(title).split()
    tables = (_HEADERS[language], _HEADERS["en"], *_HEADERS.values())
    match = next((match for fields in tables if (match := _stem_in(tokens, fields))[0]), ("", ""))
    if match[0] or (match := _translated(title))[0]:
        return match
    if any(word.startswith("inv") for word in tokens) and all(
        word.startswith("inv") or len(word) < 4 for word in tokens
    ):
        return "number", ""  # such as N. d'inv., Inv.-Nr. alt
    bare = re.sub(r"\([^()]*\)|\[[^\[\]]*\]", " ", title)
    stem = _stem(bare, language)[0] if plain(bare) != plain(title) else ""
    return ("", "") if stem in _WITH_UNIT else (stem, "")  # brackets can contain a component of the object


def stem_of(title: str, language: str) -> str:
    """Return the quantity of a title, or an empty text."""
    return _Level.of(title, language).stem


def _translated(title: str) -> tuple[str, str]:
    """Return the quantity of a title in several languages, and its unit, such as ``Breite / Larghezza (cm)``."""
    tokens, unit = _bare(plain(title).split())
    fields = _phrased(tokens)
    if not fields:
        pieces = [plain(piece).split() for piece in _TRANSLATED.split(title)]
        known_fields = [piece_fields for piece in pieces if (piece_fields := _phrased(piece))]
        unknown = [word for piece in pieces if not _phrased(piece) for word in piece]
        if known_fields and not any(word in _OTHERS or word in _TELLING for word in unknown):
            fields = set.intersection(*known_fields)
    if len(fields) != 1:
        return "", ""
    (stem,) = fields
    return (stem, unit) if stem in _WITH_UNIT or not unit else ("", "")


def _phrased(tokens: Sequence[str]) -> set[str]:
    """Return the fields of words that are a sequence of phrases in any language; all phrases have one field."""
    ends: list[set[str]] = [{""}, *(set() for _ in tokens)]
    for k, word in enumerate(tokens):
        if word in _FILLERS or (
            word in UNITS and word not in _TELLING and "" not in ends[k]
        ):  # a unit comes after its quantity
            ends[k + 1] |= ends[k]
        for j in range(k + 1, min(k + 5, len(tokens)) + 1):
            ends[j] |= {
                field for field in _PHRASES.get(" ".join(tokens[k:j]), ()) if "" in ends[k] or field in ends[k]
            }  # fmt: skip
    return ends[-1] - {""}


def order_of(title: str, language: str = "en") -> tuple[str, ...]:
    """Return the order of the sizes in a title.

    >>> order_of("Maße (HxBxT) in cm"), order_of("height*width*depth"), order_of("Maße")
    (('height', 'width', 'depth'), ('height', 'width', 'depth'), ())
    """
    pieces = plain(re.sub(r"[×✕*/]|(?<=\b\w)\s?[-\u2013]\s?(?=\w\b)", " x ", title)).split()
    joined = re.compile(r"[a-zø](?:x[a-zø]){1,2}")
    tokens = [
        token for word in pieces for token in (" x ".join(word[::2]).split() if joined.fullmatch(word) else [word])
    ]
    best: list[str] = []
    run: list[str] = []
    for k, token in enumerate(tokens):
        side = side_of(token, language)
        if side and (not run or (k > 1 and tokens[k - 1] == "x")):
            run.append("width" if side == "length" in run else side)  # two lengths: longer L, shorter l
        elif token != "x":
            run = [side] if side else []
        best = max(best, list(run), key=len)
    return tuple(best) if 2 <= len(best) <= 3 and len(set(best)) == len(best) else ()


def side_of(token: str, language: str = "en") -> str:
    """Return the size for a letter or word; empty if it means no size."""
    if token == "ø":
        return "diameter"
    quantity = _HEADERS[language].get(token) or WORDS["sides"].get(token) or _stem(token, language)[0]
    return quantity if quantity in SIZES else ""


Titles = Sequence[str | Sequence[str]]
"""Titles of each column: one title, or one title per row of the header, groups of columns first."""


def levels_of(title: str | Sequence[str]) -> tuple[str, ...]:
    """Return the different titles of a column, each on one line."""
    levels = [" ".join(level.split(" ")).strip() for level in ((title,) if isinstance(title, str) else title)]
    return tuple(dict.fromkeys(filter(None, levels)))


def title_of(title: str | Sequence[str]) -> str:
    """Return the full title of a column.

    >>> title_of(("Maße (cm)", "Breite")), title_of(("Maße", "B", "[cm]"))
    ('Maße (cm): Breite', 'Maße: B [cm]')
    """
    joined = "".join(f"{' ' if plain(level) in UNITS else ': '}{level}" for level in levels_of(title))
    return " ".join(joined.removeprefix(": ").split())


def header_of(titles: Titles, mapped: Mapping[str, str] | None = None) -> Header:
    """Return the meaning of the titles of a list in the best matching language; `mapped` are meanings from the user.

    >>> header = header_of(["Objekt", "Höhe (cm)", ("Maße (cm)", "Breite"), ("Maße (cm)", "Tiefe")])
    >>> header.language, [column.fields[0] for column in header.columns]
    ('de', ['name', 'height', 'width', 'depth'])
    """
    language = _language_of(titles)
    named, targets = [title_of(title) for title in titles], _targets(titles, mapped or {})
    columns = [
        _column(name, levels_of(title), language) if target is None else _column(name, (target,), language)
        for title, name, target in zip(titles, named, targets, strict=True)
    ]
    known_fields = {field for column in columns if column for field in column.fields}
    for field in {"number", "name"} - known_fields:
        free = [k for k, column in enumerate(columns) if column is None and targets[k] is None]
        substitutes = (
            k for k in free if field in {_INSTEAD.get(plain(level)) for level in (named[k], *levels_of(titles[k]))}
        )
        if (index := next(substitutes, None)) is not None:
            columns[index] = InventoryColumn(field, (field,), 1.0, named[index])
    columns = _sided(_in_order(titles, columns))
    stems = [column.stem if column else "" for column in columns]
    for k, column in enumerate(columns):
        if column and column.stem not in _MEASURES and column.stem in stems[:k]:
            columns[k] = None  # only the first of several columns is used
    return Header(tuple(columns), language, tuple(named))


def _in_order(titles: Titles, columns: list[InventoryColumn | None]) -> list[InventoryColumn | None]:
    """Return columns with sides from a common title, such as ``Maße (B x T x H)`` above three columns."""
    levels, sided = [levels_of(title) for title in titles], list(columns)
    for first, column in enumerate(columns):
        if column is None or column.stem != "size" or levels[first] in levels[:first]:
            continue
        members = [k for k, other_levels in enumerate(levels) if other_levels == levels[first]]
        if len(members) == len(column.fields):
            for k, side in zip(members, column.fields, strict=True):
                sided[k] = replace(column, stem=side, fields=(side,))
    return sided


def _sided(columns: list[InventoryColumn | None]) -> list[InventoryColumn | None]:
    """Return columns with lengths assigned to the missing sides."""
    known_fields = {field for column in columns if column for field in column.fields}
    free = [side for side in ("width", "depth") if side not in known_fields]
    for k, column in enumerate(columns):
        if column and "length" in column.fields and free:
            side = free.pop(0)
            columns[k] = replace(column, fields=tuple(side if f == "length" else f for f in column.fields))
    return columns


def names_of(titles: Titles) -> list[tuple[str, ...]]:
    """Return the names of each column for users: its full title, and its lowest title if unique.

    >>> names_of([("Base (cm)", "Width"), ("Size (cm)", "Width"), ("Size (cm)", "Height")])
    [('base cm width',), ('size cm width',), ('size cm height', 'height')]
    """
    lowest = [plain((levels_of(title) or ("",))[-1]) for title in titles]
    return [
        (plain(title_of(title)), *([last] if lowest.count(last) == 1 else []))
        for title, last in zip(titles, lowest, strict=True)
    ]


def _targets(titles: Titles, mapped: Mapping[str, str]) -> list[str | None]:
    """Return the user's meaning of each column, or None."""
    targets = {plain(title): target for title, target in mapped.items()}
    return [next((targets[name] for name in names if name in targets), None) for names in names_of(titles)]


def _language_of(titles: Titles) -> str:
    """Return the language of most titles; for equal numbers, the first language."""
    pieces = list(dict.fromkeys(
        (position, piece)
        for title in titles for level in levels_of(title)
        for position, piece in enumerate(filter(None, map(str.strip, re.split(r"[/|()\[\]\n\u2013\u2014]| - ", level))))
    ))  # fmt: skip

    tokens_by_position = [(position, plain(piece).split()) for position, piece in pieces]

    def votes(code: str) -> tuple[int, int, int]:
        positions = [position for position, piece in tokens_by_position if _stem_in(piece, _HEADERS[code])[0]]
        return (
            len(positions),
            -sum(positions),
            sum(token in _TOKENS[code] for _, piece in tokens_by_position for token in piece),
        )

    return str(max(_HEADERS, key=votes))


@dataclass(frozen=True)
class _Level:
    """One title of a column."""

    stem: str
    unit: str
    order: tuple[str, ...]
    tokens: tuple[str, ...]  # words of the title without its unit

    @classmethod
    @lru_cache(maxsize=4096)
    def of(cls, title: str, language: str) -> "_Level":
        stem, unit = _stem(title, language)
        order = order_of(title, language)
        title_words, last = _bare(plain(title).split())
        if order:
            stem = "size"
            unit = unit or next(
                (UNITS[word] for word in reversed(plain(title).split()) if word in UNITS and len(word) > 1), ""
            )
        stated = not title_words or set(title_words) <= _FILLERS  # the title is only a unit
        return cls(stem, unit or (last if stated and not stem else ""), order, tuple(title_words))

    @property
    def is_neutral(self) -> bool:
        """True if the title does not describe the column, such as a unit or a word for the object itself."""
        return not self.stem and (set(self.tokens) <= _FILLERS or bool(_WITHOUT.intersection(self.tokens)))

    @property
    def is_other(self) -> bool:
        """True if the title belongs to something other than the object."""
        other = any(word in _OTHERS or word.startswith(_BEGINNINGS) for word in self.tokens)
        return not self.stem and other and not _WITHOUT.intersection(self.tokens)

    @property
    def is_doubtful(self) -> bool:
        """True if the title resembles a size but is unknown."""
        return not self.stem and bool(_TELLING.intersection(self.tokens)) and not _WITHOUT.intersection(self.tokens)


def _column(title: str, texts: Sequence[str], language: str) -> InventoryColumn | None:
    """Return the meaning of a column from its title and the title of its group; None if unknown."""
    levels = [_Level.of(text, language) for text in texts]
    last = levels[-1] if levels else None
    if last and len(levels) > 1 and UNITS.get(plain(texts[-1])) in _units_of(levels[-2].stem):
        levels[-1] = last = replace(last, stem="", unit=UNITS[plain(texts[-1])], order=(), tokens=())
    stem = ""
    for level in levels:
        is_unit = stem == "count" and " ".join(level.tokens) in _INSTEAD  # such as Q.tà, n.
        stem = stem if level.is_neutral or is_unit else _IN_GROUP.get((stem, level.stem), level.stem)
    words_by_level = [level.tokens for level in levels if level.tokens]
    orders = (words_by_level, words_by_level[::-1]) if len(words_by_level) > 1 else ()
    both = next(filter(None, (_joined(order, language) for order in orders)), "")
    stem = both or stem
    if not stem:
        return None
    if stem not in _WITH_UNIT:
        return InventoryColumn(stem, (stem,), 1.0, title)
    if not both and stem != "weight" and any(level.is_other or level.is_doubtful for level in levels):
        return None
    own = next(level for level in reversed(levels) if level.stem or both)
    if own.unit and own.unit not in _units_of(stem):
        return None
    unit = next((level.unit for level in reversed(levels) if level.unit in _units_of(stem)), "")
    order = next((level.order for level in reversed(levels) if level.order), ())
    fields = order if stem == "size" else _FIELDS.get(stem, (stem,))
    return InventoryColumn(stem, fields, FACTORS[unit] if unit else None, title)


def _units_of(stem: str) -> Collection[str]:
    """Return the allowed units of a quantity."""
    return WEIGHTS if stem == "weight" else LENGTH_UNITS if stem in {*LENGTHS, "size"} else ()


def _joined(titles: Sequence[Sequence[str]], language: str) -> str:
    """Return the joint quantity of the titles of a group and its column, such as ``Basis`` above ``Breite``."""
    tokens = [word for title in titles for word in title]
    tables = (_HEADERS[language], _HEADERS["en"], *_HEADERS.values())
    phrase = " ".join(tokens)
    return next((fields[phrase] for fields in tables if phrase in fields), "")


def check_header(header: Header, titles: Titles, source: str, dismissed: Collection[str] = ()) -> None:
    """Raise an error for a field in two columns, and for an unknown column that resembles a size."""
    fields = [field for column in header.columns if column and column.stem != "size" for field in column.fields]
    for field in fields:
        if fields.count(field) > 1:
            raise InvalidValueError(
                "two columns contain the {field}", field=field.replace("_", " "), hint="Remove one."
            ).at(source)
    if "length" in fields:
        length = next(column.title for column in header.columns if column and "length" in column.fields)
        raise InvalidValueError(
            "unknown column {column!r:.60} resembles a size, in addition to width and depth", column=length,
            hint=_remedy(length),
        ).at(source)  # fmt: skip
    ignored = {plain(title) for title in dismissed}
    for title, column in zip(titles, header.columns, strict=True):
        levels = levels_of(title)
        if column is not None or ignored.intersection(map(plain, (title_of(title), *levels[-1:]))):
            continue
        if len(levels) == 1 or not any(_Level.of(level, header.language).is_other for level in levels[:-1]):
            _refuse_measure(title_of(title), source, header.language)


def _remedy(title: str) -> str:
    return f'Rename the column, or add --map-columns "{title:.60}=NAME_mm". An empty NAME_mm ignores the column.'


_PEDESTAL, _HEIGHT = re.compile("sockel|pedestal|plinth|piedistallo|zoccolo|peana"), re.compile("hoe?he|height|alt")


def _refuse_measure(title: str, source: str, language: str) -> None:
    plain_title = plain(title)
    stem, _, unit = plain_title.rpartition(" ")
    if {_stem(title, language)[0], _stem(stem, language)[0]} & {"number", "note", "name", "weight", "size", "pedestal"}:
        return  # the column does not affect the result, or repeats other columns
    if _PEDESTAL.search(plain_title) and _HEIGHT.search(plain_title):
        return  # height of a support; the report lists the column as ignored
    close = difflib.get_close_matches(stem if stem and unit in UNITS else plain_title, _MEASURED, n=1, cutoff=0.8)
    tokens = plain_title.split()
    is_measure = _TELLING.intersection(tokens) or any(word in token for word in _WITHIN for token in tokens)
    if not ((stem and unit in UNITS) or close or is_measure):
        return
    if (quantity := _stem(stem, language)[0]) in LENGTHS:
        units = ", ".join(f"{quantity}_{unit}" for unit in LENGTH_UNITS)
        raise InvalidValueError("column {column!r:.60} must state its unit: {units}", column=title, units=units).at(
            source
        )
    own = (stem or plain_title).replace(" ", "_")
    near = difflib.get_close_matches(own, _MEASURES, n=1, cutoff=0.8)
    near = near or difflib.get_close_matches(own, _MEASURES, n=3, cutoff=0.5) or list(_MEASURES)
    names = ", ".join(f"{name}_{'kg' if name == 'weight' else 'cm'}" for name in near)
    raise InvalidValueError(
        "unknown column {column!r:.60} resembles a size (similar: {names}). {remedy}", column=title, names=names,
        remedy=_remedy(title),
    ).at(source)  # fmt: skip


def mapping_of(text: str | Mapping[str, str] | None) -> dict[str, str]:
    """Return the user's map of titles to titles of this package; an empty value ignores the column.

    Titles with a comma are quoted.

    >>> mapping_of("Objekt=name, Maß B=width_cm, Rahmenbreite=")
    {'Objekt': 'name', 'Maß B': 'width_cm', 'Rahmenbreite': ''}
    >>> mapping_of('"Tiefe, innen"=, "Höhe, gesamt"=height_cm')
    {'Tiefe, innen': '', 'Höhe, gesamt': 'height_cm'}
    """
    if text is None:
        return {}
    if not isinstance(text, Mapping):
        fields = next(csv.reader([" ".join(text.split())], skipinitialspace=True), [])
        pairs = [field.rpartition("=") for field in fields if field.strip()]
        if odd := next((ours for _, mark, ours in pairs if not mark), ""):
            raise InvalidValueError(
                '{parameter} must have the form "own title=name", as in "Objekt=name, Maß B=width_cm", got {value}',
                parameter="map_columns", value=odd.strip(),
            )  # fmt: skip
        text = {own: ours for own, _, ours in pairs}
    mapped = {str(own).strip(): str(ours).strip() for own, ours in text.items()}
    for own, ours in mapped.items():
        if not own or (ours and _column(own, (ours,), "en") is None):
            raise InvalidValueError(
                "{parameter}: {own!r:.60} cannot be {value}. Allowed are {texts}, or with a unit, as in width_cm: "
                "{measures}, or an order: height x width x depth cm", parameter="map_columns", own=own, value=ours,
                texts=", ".join((*TEXTS, "count", "friction")), measures=", ".join(_MEASURES),
            )  # fmt: skip
    return mapped
