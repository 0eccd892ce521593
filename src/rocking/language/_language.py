"""A language: sentences by key, numbers as it writes them."""

import re
import string
import tomllib
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

LANGUAGES = {"en": ".", "de": ",", "it": ","}
"""Languages that there are words in, by their ISO 639-1 codes, with their decimal marks."""

_NUMBER = re.compile(r"-?\d+\.\d+(?:e[+-]?\d+)?")
_FIELD = re.compile(r"\\\{(\w+)\\\}")


class Language(string.Formatter):
    """The words of one language.

    Parameters
    ----------
    code : str
        As in ISO 639-1, such as ``de``; English where there are no words in it.

    Examples
    --------
    >>> Language("de")("interval", low=0.5, high=2.0)
    '0,5 bis 2,0'
    """

    def __init__(self, code: str) -> None:
        self.asked, self.code = code, code if code in LANGUAGES else "en"
        self.mark, self.entries = LANGUAGES[self.code], catalogue(self.code)

    def __call__(self, key: str, /, **values: Any) -> str:
        """Return a sentence.

        Parameters
        ----------
        key : str
            Its name; of one that counts, the form that fits ``count``.
        **values
            What stands for its placeholders; floats get the decimal mark of the language.

        Returns
        -------
        str
            The sentence.

        Raises
        ------
        KeyError
            If there is none.
        """
        if key not in self.entries:
            key = f"{key}.{'one' if values.get('count') == 1 else 'many'}"
        return self.vformat(self.entries[key], (), values)

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return a value as the language writes it.

        Parameters
        ----------
        value : object
            Number or text.
        format_spec : str
            As for `format`.

        Returns
        -------
        str
            The text.
        """
        text = format(value, format_spec)
        return text.replace(".", self.mark) if isinstance(value, float) else text

    def number(self, text: str) -> str:
        """Return a number in words of its own with the decimal mark of the language.

        Parameters
        ----------
        text : str
            Such as ``0.25``.

        Returns
        -------
        str
            Such as ``0,25``.
        """
        return text.replace(".", self.mark)

    def translated(self, text: str) -> str:
        """Return a sentence that was made in English, where it is among the phrases that are known.

        Parameters
        ----------
        text : str
            The sentence.

        Returns
        -------
        str
            The same in this language, or as it is.

        Examples
        --------
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
    """Return a language.

    Parameters
    ----------
    code : str
        As in ISO 639-1.

    Returns
    -------
    Language
        Its words; those of English where there are none, which then is said in reports.
    """
    return Language(code)


@lru_cache(maxsize=8)
def catalogue(code: str) -> dict[str, str]:
    """Return the sentences of a language by their names."""
    text = Path(__file__).with_name(f"{code}.toml").read_text(encoding="utf-8")
    return dict(_flat(tomllib.loads(text)))


def _flat(table: Mapping[str, Any], before: str = "") -> Sequence[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    for key, value in table.items():
        found += _flat(value, f"{before}{key}.") if isinstance(value, dict) else [(f"{before}{key}", value)]
    return found


@lru_cache(maxsize=1)
def _phrases() -> list[tuple[str, re.Pattern[str]]]:
    """Return what English phrases look like with anything in their places."""
    return [
        (key, re.compile(_FIELD.sub(r"(?P<\1>.+?)", re.escape(text)), re.DOTALL))
        for key, text in catalogue("en").items() if key.startswith("phrase.")
    ]  # fmt: skip
