"""Languages: messages with their facts, numbers and counts as each writes them."""

import pytest

from rocking.errors import InvalidValueError
from rocking.language import Language, language, page_words
from rocking.messages import Amount, Message, Parameter, Range


def test_numbers_and_counts():
    """A decimal comma where it is written so, none in whole numbers and names; one and many."""
    assert Language("de")("{low:.1f} to {high:.1f}", low=0.25, high=1.5) == "0,2 bis 1,5"
    assert Language("it")("{low:.1f} to {high:.1f}", low=0.25, high=1.5) == "da 0,2 a 1,5"
    assert Language("en")("{low:.1f} to {high:.1f}", low=0.25, high=1.5) == "0.2 to 1.5"
    one, many = "{source}: {count} object assessed at {level}", "{source}: {count} objects assessed at {level}"
    say = language("de")
    assert say(one, many, source="a.csv", count=1, level="x") == "a.csv: 1 Objekt beurteilt bei x"
    assert say(one, many, source="a.csv", count=1000, level="x") == "a.csv: 1000 Objekte beurteilt bei x"
    assert str(Message(one, {"source": "a.csv", "count": 2, "level": "x"}, many)) == "a.csv: 2 objects assessed at x"


def test_a_text_without_translation_is_itself():
    """Of a language without a catalogue all is English, and it can be said which was asked for; braces stay."""
    say = language("fr")
    assert (say.code, say.requested) == ("en", "fr")
    assert say("red") == "red"
    assert language("de")("nobody's {sentence}") == "nobody's {sentence}"
    assert language("de")("") == ""


def test_the_context_tells_two_meanings_apart():
    """The end of a range, and a consequence."""
    assert language("de")(Message("low", context="consequence")) == "gering"
    assert language("de")("low") == "unten"
    assert language("en")(Message("low", context="consequence")) == "low"


def test_facts_are_translated_where_they_are_messages():
    """Names of parameters, ranges, amounts and messages inside; texts of users stay."""
    say = language("de")
    level = Message("PGA {value:.4g} g", {"value": 0.3})
    records = Message(
        "{count} record, each scaled to {level}",
        {"count": 2, "level": level},
        "{count} records, each scaled to {level}",
    )
    assert say(records) == "2 Aufzeichnungen, jede skaliert auf PGA 0,3 g"
    facts = {
        "parameter": Parameter("base_width", "base_width"),
        "allowed": Range(0.001, 100.0, "m"),
        "value": Amount(0.5),
    }
    text = "{parameter} must be {allowed}, got {value}"
    assert say(Message(text, facts)) == "Breite der Standfläche muss im Bereich [0,001; 100] m sein, ist aber 0,5"
    assert say("{file}: the file is empty", file="a.csv") == "a.csv: die Datei ist leer"
    assert str(Message(text, facts)) == "base_width must be in [0.001, 100] m, got 0.5"


def test_an_error_is_one_message():
    """Places, fault and hint, as the error itself says them in English."""
    error = InvalidValueError(parameter="height", allowed=Range(0.0, 1.0, "m"), value=2.5, hint="check the unit").at(
        "a.csv", 3
    )
    assert str(error.sentence) == str(error) == "a.csv, line 3: height must be in [0, 1] m, got 2.5; check the unit"
    assert (
        language("de")(error.sentence)
        == "a.csv, line 3: Höhe muss im Bereich [0; 1] m sein, ist aber 2,5; prüfen Sie die Einheit"
    )


def test_the_page_reads_the_catalogue():
    """English texts by their translations, forms by a count in order; none in English and in other languages."""
    assert page_words("de")["Body"] == "Körper"
    assert page_words("it")["the one record"] == ["l'unica registrazione", "{count} registrazioni"]
    assert page_words("zh")["the one record"] == ["{count} 条记录"]
    assert page_words("en") == page_words("fr") == {}


def test_a_fact_that_lacks_is_noticed():
    """A message is never shown with an empty place."""
    with pytest.raises(KeyError):
        language("de")("{low:.1f} to {high:.1f}", low=0.25)
