"""Words of reports: one file of sentences a language, which say the same with the same numbers, as each writes them."""

import gettext
import re
import string
import tomllib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

LANGUAGES = {"en": ".", "de": ",", "it": ","}
"""Languages that there are words in, by their ISO 639-1 codes, with their decimal marks."""

_NUMBER = re.compile(r"-?\d+\.\d+(?:e[+-]?\d+)?")
_FIELD = re.compile(r"\\\{(\w+)\\\}")


class Language(string.Formatter):
    """The words of one language, by its code; those of English where there are none.

    >>> Language("de")("interval", low=0.5, high=2.0)
    '0,5 bis 2,0'
    """

    def __init__(self, code: str) -> None:
        self.asked, self.code = code, code if code in LANGUAGES else "en"
        self.mark, self.entries = LANGUAGES[self.code], catalogue(self.code)

    def __call__(self, key: str, /, **values: Any) -> str:
        """Return a sentence by its name, or the form of it that fits a count."""
        if key not in self.entries:
            key = f"{key}.{'one' if values.get('count') == 1 else 'many'}"
        return self.vformat(self.entries[key], (), values)

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return a value as the language writes it."""
        text = format(value, format_spec)
        return self.number(text) if isinstance(value, float) else text

    def number(self, text: str) -> str:
        """Return a number with the decimal mark of the language."""
        return text.replace(".", self.mark)

    def translated(self, text: str) -> str:
        """Return a sentence that was made in English, if it is among the phrases; else as it is.

        >>> Language("de").translated("3 records, as recorded")
        '3 Aufzeichnungen, wie aufgezeichnet'
        """
        if self.code == "en":
            return text
        if _NUMBER.fullmatch(text):
            return self.number(text)
        for key, pattern in _phrases():
            if match := pattern.fullmatch(text):
                return self(key, **{name: self.translated(value) for name, value in match.groupdict().items()})
        return text


@lru_cache(maxsize=8)
def language(code: str) -> Language:
    """Return a language."""
    return Language(code)


@lru_cache(maxsize=8)
def catalogue(code: str) -> dict[str, str]:
    """Return the sentences of a language by their names."""
    return dict(_flat(tomllib.loads(Path(__file__).with_name(f"{code}.toml").read_text(encoding="utf-8"))))


@lru_cache(maxsize=8)
def page_words(code: str) -> dict[str, str | list[str]]:
    """Return the messages of the page by their English texts, forms by a count as a list; none in English."""
    path = Path(__file__).with_name(f"{code}.mo")
    if not path.exists():
        return {}
    with path.open("rb") as file:
        catalog = gettext.GNUTranslations(file)._catalog  # type: ignore[attr-defined]  # as Django reads it
    messages: dict[str, str | list[str]] = {}
    for key, text in catalog.items():
        if isinstance(key, tuple):  # the English text, and the number of the form
            forms = messages.setdefault(key[0], [])
            assert isinstance(forms, list)
            forms.append(text)
        elif key:
            messages[key] = text
    return messages


def _flat(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


@lru_cache(maxsize=1)
def _phrases() -> list[tuple[str, re.Pattern[str]]]:
    """Return what English phrases look like with anything in their places."""
    return [
        (key, re.compile(_FIELD.sub(r"(?P<\1>.+?)", re.escape(text)), re.DOTALL))
        for key, text in catalogue("en").items() if key.startswith("phrase.")
    ]  # fmt: skip
