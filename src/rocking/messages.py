"""Messages: English texts with named fields, and the facts for these fields."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Self


class Fact:
    """A fact of a message. Each interface writes a fact in its own form; `str` gives the form of Python."""


@dataclass(frozen=True)
class Parameter(Fact):
    """A parameter by its path in the input.

    >>> str(Parameter("body.block.width", "width"))
    'width'
    """

    path: str
    shown: str  # last part of the path, for the sentence

    @property
    def name(self) -> str:
        """Last element of the path."""
        return self.path.rpartition(".")[2]

    def __str__(self) -> str:
        return self.shown


@dataclass(frozen=True)
class Option(Fact):
    """A parameter that the reader shall add, with its value.

    >>> str(Option("motion.units", "g")), str(Option("motion.component")), str(Option("identify.trend", True))
    ('units="g"', 'component=', 'trend=True')
    """

    path: str
    value: Any = None  # None: any value

    @property
    def name(self) -> str:
        """Last element of the path."""
        return self.path.rpartition(".")[2]

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.name}="
        return f'{self.name}="{self.value}"' if isinstance(self.value, str) else f"{self.name}={self.value}"


@dataclass(frozen=True)
class Amount(Fact):
    """A number with its unit.

    >>> str(Amount(0.25, "m")), str(Amount(3.0))
    ('0.25 m', '3')
    """

    value: float
    unit: str = ""
    digits: str = "g"  # format of the number

    def __str__(self) -> str:
        return f"{self.value:{self.digits}}{f' {self.unit}' if self.unit else ''}"


@dataclass(frozen=True)
class Range(Fact):
    """The allowed values of a number.

    >>> (
    ...     str(Range(0.0, math.inf, "m", low_open=True)),
    ...     str(Range(0.0, 1.0)),
    ...     str(Range(0.0, 0.5 * math.pi, "rad", high_open=True)),
    ... )
    ('> 0 m', 'in [0, 1]', 'in [0, pi/2) rad')
    """

    low: float
    high: float
    unit: str = ""
    low_open: bool = False
    high_open: bool = False

    def __contains__(self, value: float) -> bool:
        low = value > self.low if self.low_open else value >= self.low
        return low and (value < self.high if self.high_open else value <= self.high)

    @property
    def bounded(self) -> bool:
        """True if both limits are finite."""
        return math.isfinite(self.low) and math.isfinite(self.high)

    def limits(self, separator: str = ", ") -> str:
        """Return both limits in brackets, or the finite limit with its comparison sign."""
        unit = f" {self.unit}" if self.unit else ""
        if self.high == math.inf:
            return f"{'>' if self.low_open else '>='} {self.low:g}{unit}"
        if self.low == -math.inf:
            return f"{'<' if self.high_open else '<='} {self.high:g}{unit}"
        brackets = "(" if self.low_open else "[", ")" if self.high_open else "]"
        high = "pi/2" if self.high == 0.5 * math.pi else f"{self.high:g}"
        return f"{brackets[0]}{self.low:g}{separator}{high}{brackets[1]}{unit}"

    def __str__(self) -> str:
        return f"in {self.limits()}" if self.bounded else self.limits()


@dataclass(frozen=True)
class Place:
    """Location of an invalid value: a table of the input, a key in it, a file, or a processing step.

    >>> str(Place("a.txt", "file", 3)), str(Place("map.x"))
    ('a.txt, line 3', 'map.x')
    """

    name: str
    kind: Literal["table", "key", "file", "step"] = "table"
    number: int = 0  # number of a line or a step, from 1; 0 for none

    def __str__(self) -> str:
        line = f"line {self.number}" if self.kind == "file" and self.number else ""
        return ", ".join(filter(None, (self.name, line)))


@dataclass(frozen=True)
class Index(Fact):
    """The index of a region, a hole or a point. It starts at 0 in Python and files, and at 1 in the web page.

    >>> str(Index(2))
    '2'
    """

    number: int  # from zero

    def __str__(self) -> str:
        return str(self.number)


@dataclass(frozen=True)
class WrittenFile(Fact):
    """A file that a command has written."""

    name: str

    def __str__(self) -> str:
        return self.name


Spelling = Callable[[Fact], str]


def by_key(fact: Fact) -> str:
    """Return the text of a fact for all interfaces. An option is written as a key of the input file.

    >>> by_key(Option("motion.units", "g"))
    'motion.units = g'
    """
    if not isinstance(fact, Option):
        return str(fact)
    return fact.path if fact.value is None else f"{fact.path} = {fact.value}"


class Message(str):
    """An English sentence, with its template and the facts for the fields of the template.

    >>> units = Message(
    ...     "{file} does not state its unit; give {option}", {"file": "a.txt", "option": Option("units", "g")}
    ... )
    >>> str(units), units.spelt(lambda option: f"--{option.name} {option.value}")
    ('a.txt does not state its unit; give units="g"', 'a.txt does not state its unit; give --units g')
    """

    text: str  # the English text, the key of its translations
    facts: Mapping[str, Any]
    many: str  # the plural: the text if the fact `count` is not 1; empty if there is none
    context: str  # distinguishes equal texts with different translations

    def __new__(cls, text: str, facts: Mapping[str, Any] | None = None, many: str = "", context: str = "") -> Self:
        """Return a message. `facts` contains the facts by field name."""
        facts = facts or {}
        message = super().__new__(cls, _filled(text, facts, many, str))
        message.text, message.facts, message.many, message.context = text, facts, many, context
        return message

    def __getnewargs__(self) -> tuple[Any, ...]:
        return self.text, self.facts, self.many, self.context

    def data(self) -> dict[str, Any]:
        """Return text and facts as plain values; `kind` is the class name of a fact."""
        more = {name: text for name, text in (("many", self.many), ("context", self.context)) if text}
        return {"text": self.text, "facts": {name: _data(fact) for name, fact in self.facts.items()}, **more}

    def spelt(self, spelling: Spelling) -> str:
        """Return the sentence. `spelling` converts its facts to text."""
        return _filled(self.text, self.facts, self.many, spelling)

    def clause(self) -> "Clause":
        """Return the message without its final full stop, for the beginning of a longer sentence."""
        return Clause(self.text, self.facts, self.many, self.context)

    def of(self, facts: Mapping[str, Any]) -> "Message":
        """Return the message with other facts."""
        return Message(self.text, facts, self.many, self.context)

    @classmethod
    def followed(cls, sentence: str, addition: str) -> str:
        """Return a sentence and an addition, separated by a semicolon. Without addition, return the sentence."""
        return cls("{sentence}; {more}", {"sentence": sentence, "more": addition}) if addition else sentence

    @classmethod
    def joined(cls, sentences: Iterable[str]) -> str:
        """Return sentences as one text, separated by spaces."""
        first, *others = filter(None, sentences)
        for sentence in others:
            first = cls("{first} {second}", {"first": first, "second": sentence})
        return first


class Clause(Message):
    """A message without its final full stop.

    >>> Message("Unknown unit {unit}.", {"unit": "kN"}).clause()
    'Unknown unit kN'
    """

    def __new__(cls, text: str, facts: Mapping[str, Any] | None = None, many: str = "", context: str = "") -> Self:
        """Return a clause, with the arguments of `Message`."""
        clause = str.__new__(cls, _filled(text, facts or {}, many, str).removesuffix("."))
        clause.text, clause.facts, clause.many, clause.context = text, facts or {}, many, context
        return clause

    def spelt(self, spelling: Spelling) -> str:
        return super().spelt(spelling).removesuffix(".")


def listed(texts: Iterable[str]) -> str:
    """Return texts separated by semicolons, without empty texts and without full stops in front of semicolons.

    >>> listed(["read from site.at2.", "", "scaled by 2."])
    'read from site.at2; scaled by 2.'
    """
    *first, last = [*filter(None, map(str, texts))] or [""]
    return "; ".join([*(text.rstrip(".") for text in first), last])


def plain_texts(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values for files. Messages are replaced by plain text.

    >>> type(plain_texts({"motion": Message("sine pulse")})["motion"])
    <class 'str'>
    """
    return {name: str(value) if isinstance(value, str) else value for name, value in values.items()}


def as_message(text: str) -> Message:
    """Convert a text to a message. A message is returned unchanged."""
    return text if isinstance(text, Message) else Message(text)


def messages_of(value: Any) -> dict[str, dict[str, Any]]:
    """Return all messages inside a value that have facts, as plain values by sentence."""
    if isinstance(value, Message):
        return {str(value): value.data()} if value.facts else {}
    if isinstance(value, Mapping):
        value = value.values()
    elif not isinstance(value, (list, tuple)):
        return {}
    return {sentence: data for item in value for sentence, data in messages_of(item).items()}


def _filled(text: str, facts: Mapping[str, Any], many: str, spelling: Spelling) -> str:
    if not facts:
        return text
    form = many if many and facts["count"] != 1 else text
    return form.format_map({name: _spelt(fact, spelling) for name, fact in facts.items()})


def _spelt(fact: Any, spelling: Spelling) -> Any:
    if isinstance(fact, Fact):
        return spelling(fact)
    if isinstance(fact, Message):
        return fact.spelt(spelling)
    if fact and isinstance(fact, tuple) and all(isinstance(item, (Fact, Message, str)) for item in fact):
        return "; ".join(str(_spelt(item, spelling)) for item in fact)
    return fact


def _data(fact: Any) -> Any:
    if isinstance(fact, Message):
        return {"kind": "message", **fact.data()}
    if isinstance(fact, tuple):
        return [_data(item) for item in fact]
    if isinstance(fact, Fact):
        values = {name: None if isinstance(v, float) and not math.isfinite(v) else v for name, v in vars(fact).items()}
        return {"kind": type(fact).__name__.lower(), **values}
    return fact if isinstance(fact, int) or (isinstance(fact, float) and math.isfinite(fact)) else str(fact)
