"""Catalogues: every language has every message with the same named places; what is compiled says what is written."""

import io
import runpy
import string
from gettext import GNUTranslations
from pathlib import Path

import pytest

pytest.importorskip("babel", reason="Babel compiles the catalogues: pip install babel")
SCRIPT = runpy.run_path(str(Path(__file__).parents[3] / "packaging/messages.py"))
CATALOGUES = SCRIPT["catalogues"]()


def forms(text):
    """Return the forms of a message, one or by a count."""
    return text if isinstance(text, tuple) else (text,)


def places(text):
    """Return the places of a text with the formats of their numbers."""
    return sorted((name, form) for _, name, form, _ in string.Formatter().parse(text) if name is not None)


def faults(catalogue, template):
    """Return the messages that a catalogue lacks, has in excess, or translates with other places."""
    keys = {(message.context, message.id) for message in catalogue if message.id}
    different = keys ^ {(message.context, message.id) for message in template if message.id}
    return different | {
        (message.context, message.id)
        for message in catalogue
        if message.id
        and any(places(text) != places(forms(message.id)[-1]) for text in forms(message.string)[-1:] if text)
    }


@pytest.mark.parametrize("code", CATALOGUES)
def test_every_language_has_every_message(code):
    """The same messages, the same places in the same formats; negative control: one lacks, one has another place."""
    template = SCRIPT["read"](SCRIPT["TEMPLATE"])
    catalogue = SCRIPT["read"](SCRIPT["FOLDER"] / f"{code}.po", code)
    assert faults(catalogue, template) == set()
    catalogue.delete("Body")
    catalogue["{0} motions"].string = "{1}"
    assert faults(catalogue, template) == {(None, "Body"), (None, "{0} motions")}


@pytest.mark.parametrize("code", ["de", "it"])
def test_every_message_is_translated(code):
    """No message is empty, and none of more than three words is left in English but names of authors."""
    for message in CATALOGUES[code]:
        assert all(forms(message.string)), message.id
    same = [message.id for message in CATALOGUES[code] if len(message.id) > 3 and message.id == message.string]
    assert [text for text in same if len(text.split()) > 3 and "(" not in text] == []


@pytest.mark.parametrize("code", CATALOGUES)
def test_compiled_catalogues_are_current(code):
    """The compiled catalogue says what its source says: make messages."""
    kept = GNUTranslations(io.BytesIO((SCRIPT["FOLDER"] / f"{code}.mo").read_bytes()))._catalog
    assert kept == GNUTranslations(io.BytesIO(SCRIPT["compiled"](CATALOGUES[code])))._catalog
