"""What was typed after `rocking simulate`, and what it says of body and motion."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from rocking.cli import simulate_document
from rocking.cli.body_options import body_from
from rocking.cli.shared_options import units_of
from rocking.cli.simulate_question import Question, body_and_motion, motion_asked, question_of
from rocking.cli.solid_options import is_solid, refuse, spelt
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS

_SIZE = ("width", "height", "depth", "density", "angle", "semi_diagonal", "unit")
_RECORD = ("format", "units", "time_step", "component", "vertical", "vertical_file")
_MESH = ("up", "fill_holes", "base_tolerance")
_SPACE = ("motion_y", "motion_z", "component_y", "component_z")


@dataclass(frozen=True, slots=True)
class SimulateOptions:
    """The options of one call."""

    values: dict[str, Any]  # parameter of the command to its value
    typed: frozenset[str]  # parameters that were typed, so that their values are no defaults
    document: Path | None  # the file that says everything, if the first word is one

    @classmethod
    def of(cls, context: typer.Context) -> "SimulateOptions":
        """Return what was typed."""
        document = simulate_document.path_of(context)
        typed = frozenset(name for name in context.params if simulate_document.typed(context, name))
        unit, units = units_of(context.params["units"], LENGTH_UNITS, ACCELERATION_UNITS)
        return cls({**context.params, "unit": unit, "units": units}, typed, document)

    @property
    def solid(self) -> str | None:
        """The first word, if it is the file of a body in space."""
        word = self.values["body"]
        return word if self.document is None and is_solid(word) else None

    @property
    def units(self) -> tuple[str, str]:
        """Units of lengths and of accelerations, SI where none was typed."""
        return self.values["unit"] or "m", self.values["units"] or "m/s2"

    def some(self, names: tuple[str, ...]) -> dict[str, Any]:
        """Return some options."""
        return {name: self.values[name] for name in names}

    def only_typed(self, names: tuple[str, ...]) -> dict[str, Any]:
        """Return those of some options that were typed, as they are spelt, to refuse them."""
        return spelt(self.some(tuple(name for name in names if name in self.typed)))

    def question(self) -> Question:
        """Return the question about a plane body.

        Returns Body, motion or first rotation, friction, and how to compute.
        """
        refuse("a plane body is no mesh and has one horizontal motion", self.only_typed((*_MESH, *_SPACE)))
        values, size, free = self.values, self.some(_SIZE), self.values["free"]
        sized = any(size[name] is not None for name in ("width", "height", "angle", "semi_diagonal"))
        file, word = body_and_motion(
            values["body"], values["record"], values["motion"], sized=sized, free=free is not None
        )
        how = self.some(("scale", "gravity", "engine", "linear", "friction"))
        subject = body_from(file, **size)
        return question_of(subject, motion_asked(word, self.some(_RECORD), how["scale"]), free, **how)
