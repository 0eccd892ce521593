"""Sentences that are made from facts: an English text with named fields, and the facts that fill them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Parameter:
    """A parameter that a message refers to, and the value that it should have; each door spells it in its own way.

    >>> str(Parameter("motion.units", "g")), str(Parameter("motion.component"))
    ('units="g"', 'component=')
    """

    path: str  # its place in a question, such as body.block.width
    value: Any = None  # the value to state; None for a value that the reader chooses

    @property
    def name(self) -> str:
        """The last part of the path."""
        return self.path.rpartition(".")[2]

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.name}="
        return f'{self.name}="{self.value}"' if isinstance(self.value, str) else f"{self.name}={self.value}"


Spelling = Callable[[Parameter], str]


@dataclass(frozen=True)
class Message:
    """An English text with named fields, and what stands in them.

    >>> units = Message(
    ...     "{file} does not state its unit; give {option}", {"file": "a.txt", "option": Parameter("units", "g")}
    ... )
    >>> str(units), units.spelt(lambda parameter: f"--{parameter.name} {parameter.value}")
    ('a.txt does not state its unit; give units="g"', 'a.txt does not state its unit; give --units g')
    """

    text: str  # the English text; its translations are found by it
    arguments: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        return self.spelt(str)

    def spelt(self, spelling: Spelling) -> str:
        """Return the sentence with its parameters as a door spells them."""
        if not self.arguments:
            return self.text
        return self.text.format_map(
            {name: spelling(value) if isinstance(value, Parameter) else value for name, value in self.arguments.items()}
        )
