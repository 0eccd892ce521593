"""Languages: every one has every sentence with the same placeholders; numbers and counts as each writes them."""

import re
import string
from pathlib import Path

import pytest

import rocking.language
from rocking.language import LANGUAGES, Language, catalogue, language

OTHERS = [code for code in LANGUAGES if code != "en"]


def fields(text):
    """Placeholders of a sentence with their formats."""
    return sorted((name, form) for _, name, form, _ in string.Formatter().parse(text) if name)


def faults(entries):
    """What a catalogue lacks, has beside the English one, or has with other placeholders."""
    english = catalogue("en")
    same = english.keys() & entries.keys()
    return sorted(english.keys() ^ entries.keys()) + [k for k in same if fields(english[k]) != fields(entries[k])]


@pytest.mark.parametrize("code", OTHERS)
def test_every_language_has_every_sentence(code):
    """The same names, the same placeholders in the same formats."""
    assert faults(catalogue(code)) == []


@pytest.mark.parametrize("code", OTHERS)
def test_a_sentence_that_is_missing_or_says_another_number_is_noticed(code):
    """Negative control: one entry deleted, one with a placeholder less, one with another format."""
    whole = catalogue(code)
    without = {name: text for name, text in whole.items() if name != "advice.green"}
    assert faults(without) == ["advice.green"]
    assert faults(whole | {"fate.fell.many": whole["fate.fell.many"].replace("{overturned}", "")}) == ["fate.fell.many"]
    assert faults(whole | {"interval": whole["interval"].replace(".1f", ".0f", 1)}) == ["interval"]


@pytest.mark.parametrize("code", OTHERS)
def test_no_sentence_was_left_in_english(code):
    """What is longer than three words differs from the English; authors and their works stay as they are."""
    english, other = catalogue("en"), catalogue(code)
    assert [k for k in english if len(english[k].split()) > 3 and english[k] == other[k]] == []


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_sentence_is_asked_for(code):
    """No entry that nothing in the source names: by its whole name, or by what stands before a name that is made."""
    source = "\n".join(path.read_text("utf-8") for path in Path(rocking.language.__file__).parents[1].rglob("*.py"))
    asked = {*re.findall(r"[\"']([a-z_]+(?:\.[a-z_]+)*)[\"']", source)}
    made = {text.partition("{")[0] for text in re.findall(r"f\"([a-z.]+\.\{[^\"]*)\"", source)}
    lost = [
        name for name in catalogue(code)
        if not {name, re.sub(r"\.(one|many)$", "", name)} & asked
        and not name.startswith((*made, "phrase."))
    ]  # fmt: skip
    assert lost == []


def test_numbers_and_counts():
    """A decimal comma where it is written so, none in whole numbers and names; one and many."""
    assert Language("de")("interval", low=0.25, high=1.5) == "0,2 bis 1,5"
    assert Language("it")("interval", low=0.25, high=1.5) == "da 0,2 a 1,5"
    assert Language("en")("interval", low=0.25, high=1.5) == "0.2 to 1.5"
    say = language("de")
    assert say("report.subtitle", source="a.csv", count=1, level="x") == "a.csv: 1 Objekt beurteilt bei x"
    assert say("report.subtitle", source="a.csv", count=1000, level="x") == "a.csv: 1000 Objekte beurteilt bei x"
    with pytest.raises(KeyError):
        say("no such sentence")


def test_other_languages_fall_back_to_english():
    """Of a language without words the sentences are English, and it can be said which was asked for."""
    say = language("zh")
    assert (say.code, say.asked) == ("en", "zh")
    assert say("light.red") == "red"


def test_phrases_are_found_again():
    """Sentences made elsewhere in English are translated with what stands in them; others stay as they are."""
    say = language("de")
    assert say.translated("2 records, each scaled to PGA 0.3 g") == "2 Aufzeichnungen, jede skaliert auf PGA 0,3 g"
    assert say.translated("something else") == "something else"
    assert language("en").translated("2 records, as recorded") == "2 records, as recorded"
