"""Languages of reports and of the application: gettext catalogues of the English messages, and number formats."""

import gettext
import string
from functools import lru_cache
from pathlib import Path
from typing import Any

from rocking.messages import Amount, Clause, Fact, Message, Parameter, Range

LANGUAGES = {"en": ".", "de": ",", "it": ",", "zh": "."}
"""Languages of reports by their ISO 639-1 codes, with their decimal marks."""


class Language(string.Formatter):
    """The messages of a language by its code; English without a catalogue.

    >>> Language("de")("{low:.1f} to {high:.1f}", low=0.5, high=2.0)
    '0,5 bis 2,0'
    """

    def __init__(self, code: str) -> None:
        self.requested, self.code = code, code if code in LANGUAGES else "en"
        self.mark, self.catalogue = LANGUAGES[self.code], _catalogue(self.code)

    def __call__(self, text: str | Message, many: str = "", /, **facts: Any) -> str:
        """Return a message with its facts; `many` is the text for a fact `count` other than 1."""
        message = text if isinstance(text, Message) else Message(text, facts, many)
        if message.many:
            translated = self.ngettext(message.text, message.many, message.facts["count"])
        else:
            translated = self.gettext(message.text, message.context)
        return self.vformat(translated, (), message.facts) if message.facts else translated

    def gettext(self, text: str, context: str = "") -> str:
        """Return the translation of a text; the text itself without a translation."""
        if context:
            return self.catalogue.pgettext(context, text)
        return self.catalogue.gettext(text) if text else ""

    def ngettext(self, singular: str, plural: str, count: int) -> str:
        """Return the translation of the form for a count."""
        return self.catalogue.ngettext(singular, plural, count)

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return a fact in the format of the language."""
        if isinstance(value, Message):
            text = self(value)
            return text.removesuffix(".").removesuffix("。") if isinstance(value, Clause) else text
        if isinstance(value, tuple):
            return "; ".join(self.format_field(fact, "") for fact in value)
        if isinstance(value, Fact):
            return self._fact(value)
        text = format(value, format_spec)
        return self.number(text) if isinstance(value, float) else text

    def _fact(self, fact: Fact) -> str:
        if isinstance(fact, Parameter):
            return self.gettext(fact.shown.replace("_", " "))
        if isinstance(fact, Range):
            limits = self.number(fact.limits(", " if self.mark == "." else "; "))
            return self("in {limits}", limits=limits) if fact.bounded else limits
        return self.number(str(fact)) if isinstance(fact, Amount) else str(fact)

    def number(self, text: str) -> str:
        """Return a number with the decimal mark of the language."""
        return text.replace(".", self.mark)


@lru_cache(maxsize=8)
def language(code: str) -> Language:
    """Return a language."""
    return Language(code)


@lru_cache(maxsize=8)
def page_words(code: str) -> dict[str, str | list[str]]:
    """Return the translations by English text, and a list of forms for a text with a count; empty for English."""
    messages: dict[str, str | list[str]] = {}
    for key, text in vars(_catalogue(code)).get("_catalog", {}).items():
        if isinstance(key, tuple):  # the key contains the English text and the number of the form
            forms = messages.setdefault(key[0], [])
            assert isinstance(forms, list)
            forms.append(text)
        elif key:
            messages[key] = text
    return messages


def _catalogue(code: str) -> gettext.NullTranslations:
    path = Path(__file__).with_name(f"{code}.mo")
    if not path.exists():
        return gettext.NullTranslations()
    with path.open("rb") as file:
        return gettext.GNUTranslations(file)
