"""Catalogues: every language has every message with the same named places; what is compiled says what is written."""

import ast
import io
import re
import runpy
import string
from gettext import GNUTranslations
from pathlib import Path

import pytest
import typer

from rocking.cli.application import application

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
    catalogue["record {number}"].string = "{1}"
    assert faults(catalogue, template) == {(None, "Body"), (None, "record {number}")}


def commands_of(group, words="rocking"):
    """Yield each command and group of commands by its words."""
    for name, command in getattr(group, "commands", {}).items():
        yield from (*commands_of(command, f"{words} {name}"), f"{words} {name}")


COMMANDS = "|".join(sorted(commands_of(typer.main.get_command(application())), key=len, reverse=True))
NAMES = rf"`[^`]+`|(?<![\w-])--[a-z][a-z-]+|\b(?:{COMMANDS})\b|\b[a-z]\w*(?:\.[a-z]\w*)+|\b[a-z]+(?:_[a-z]+)+"
"""Names within backticks, options, commands, keys with dots or underscores."""
KEYBOARD = {"ctrl", "esc"}


def other_names(catalogue, is_chinese):
    """Return the names that a translation or its message lacks; in Chinese also each Latin word not in the message."""
    found = set()
    for message in filter(lambda message: message.id, catalogue):
        originals, texts = (re.sub(r"\{.*?\}", " ", " ".join(forms(text))) for text in (message.id, message.string))
        found |= {*re.findall(NAMES, originals, re.ASCII)} ^ {*re.findall(NAMES, texts, re.ASCII)}
        if is_chinese:
            known, words = ({*re.findall("[a-z_]{2,}", text.lower())} for text in (originals, texts))
            found |= {word for word in words - known - KEYBOARD if f"{word}s" not in known}
    return found


@pytest.mark.parametrize("code", CATALOGUES)
def test_translations_have_the_names_of_their_messages(code):
    """Commands, options and keys are the same in every language; negative control: five names that are not."""
    catalogue = SCRIPT["read"](SCRIPT["FOLDER"] / f"{code}.po", code)
    assert other_names(catalogue, code == "zh") == set()
    catalogue["Body"].string = "`cor` --shake response.free start_height free"
    new = {"`cor`", "--shake", "response.free", "start_height"}
    assert other_names(catalogue, is_chinese=False) == new
    assert {"free", "cor"} <= other_names(catalogue, is_chinese=True)
    text = "format of the record file from rocking record formats"
    catalogue[text].string = "rocking formats"
    assert other_names(catalogue, is_chinese=False) == {*new, "rocking record formats"}


def test_the_template_is_current():
    """Each message of the sources is in the template, and none is in it that no source states: make messages."""
    template = SCRIPT["keys"](SCRIPT["read"](SCRIPT["TEMPLATE"]))
    messages, _ = SCRIPT["extracted"]()
    assert len(messages) > 400
    assert messages - template == set()
    assert SCRIPT["unused"]() == set()


def test_messages_are_found_in_modules_and_scripts():
    """Message and say, with plural and context, either way of a choice; t with one text or two; texts between tags."""
    module = (
        'Message("a {x}", {"x": 1}, "many {x}"); Message("b", context="c")\nself.say("d" if x else "e"); say(f"{x}")'
    )
    found = set(SCRIPT["messages_of"](ast.parse(module)))
    assert found == {("a {x}", "many {x}", ""), ("b", "", "c"), ("d", "", ""), ("e", "", "")}
    script = (
        't("a \\u201cb\\u201d", { x }); t(["{count} c", "{count} d"], { count }); t(f)'
        'html`<p>Some  text ${t("e")} more</p>`'
    )
    found = set(SCRIPT["messages_of_script"](script))
    assert found == {("a \u201cb\u201d", "", ""), ("{count} c", "{count} d", ""), ("e", "", "")}
    assert {"Some text", "more"} <= {text.strip() for text in SCRIPT["literals_of_script"](script)}


UNTRANSLATED = {"CSV", "GIF", "question.toml"}
"""Texts of templates that are the same in every language: names of formats, a file."""


def without_message(scripts):
    """Return the texts of templates that are no message, of scripts by their names."""
    known = {part for text, many, _ in SCRIPT["keys"](SCRIPT["read"](SCRIPT["TEMPLATE"])) for part in (text, many)}
    return {
        (name, text) for name, script in scripts.items() for text in SCRIPT["texts_of_templates"](script)
        if re.search(r"[^\W\d_]{2,}", text) and text not in known | UNTRANSLATED
    }  # fmt: skip


def test_every_text_of_a_template_is_a_message():
    """Texts and labels, also of templates in templates; that of the API is English. Negative control: two are none."""
    page = SCRIPT["PAGE"]
    paths = [path for path in page.rglob("*.js") if "vendor" not in path.parts and path.name != "api-docs.js"]
    scripts = {path.name: path.read_text("utf-8") for path in paths}
    assert sum(len(set(SCRIPT["texts_of_templates"](script))) for script in scripts.values()) > 300
    assert without_message(scripts) == set()
    odd = 'html`<p title="An odd title">${a && html`<b>Body</b> ${"}`"} An odd\n text`}</p>`'
    assert without_message({"odd.js": odd}) == {("odd.js", "An odd title"), ("odd.js", "An odd text")}


@pytest.mark.parametrize("code", CATALOGUES)
def test_every_message_is_translated(code):
    """No message is empty, and none of more than three words is left in English but names of authors."""
    assert SCRIPT["untranslated"](CATALOGUES[code]) == []
    same = [message.id for message in CATALOGUES[code] if message.id and message.id == message.string]
    assert [
        text for text in same if len(re.findall(r"[^\W\d_]{2,}", re.sub(r"\{.*?\}", "", text))) > 3 and "(" not in text
    ] == []


@pytest.mark.parametrize("code", CATALOGUES)
def test_compiled_catalogues_are_current(code):
    """The compiled catalogue says what its source says: make messages."""
    kept = GNUTranslations(io.BytesIO((SCRIPT["FOLDER"] / f"{code}.mo").read_bytes()))._catalog
    assert kept == GNUTranslations(io.BytesIO(SCRIPT["compiled"](CATALOGUES[code])))._catalog


def test_the_page_takes_no_sentence_apart():
    """Nothing watches what appears, and no expression is made of the catalogue: texts are looked up exactly."""
    scripts = {
        path.name: path.read_text("utf-8") for path in SCRIPT["PAGE"].rglob("*.js") if "vendor" not in path.parts
    }
    assert "catalogue.get(" in scripts["words.js"]
    assert [name for name, text in scripts.items() if "MutationObserver" in text] == []
    assert [name for name, text in scripts.items() if "new RegExp" in text] == ["response-words.js"]  # names of models
