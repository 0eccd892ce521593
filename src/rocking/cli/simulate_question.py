"""What `rocking simulate` was asked: a body, a motion or a first rotation, and how to compute."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.cli.inputs import body_from, is_body, is_solid, models_from, motion_from, refuse, spelt
from rocking.cli.options import units_of
from rocking.conventions import ACCELERATION_UNITS, DEFAULT_FRICTION, LENGTH_UNITS, g
from rocking.dynamics.response import Motion, Response
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, RockingError
from rocking.outcome import Outcome
from rocking.spec.response import ResponseProblem

Question = ResponseProblem
"""Everything that a response depends on."""

_SIZE = ("width", "height", "depth", "density", "angle", "semi_diagonal", "unit")
_RECORD = ("format", "units", "time_step", "component", "vertical", "vertical_file")
_MESH = ("up", "fill_holes", "base_tolerance")
_ALONG = ("motion_y", "motion_z", "component_y", "component_z")
_OUTPUTS = {"body", "picture", "animation", "csv", "mat", "netcdf", "as_json"}


def question_of(
    body: Body,
    motion: Motion | None,
    free: float | None,
    *,
    scale: float,
    gravity: float | None,
    engine: str,
    linear: bool,
    friction: float | None,
) -> Question:
    """Put the question together.

    free: first rotation over the slenderness angle of the side it leans to, for free rocking [-]; scale: factor on the
    motion [-]; gravity: acceleration of gravity; the standard one if not given [m/s2]; friction: coefficient of
    friction between body and ground, above zero; assumed if not given [-]. Returns checked as far as the engines do not
    check it.
    """
    pull = g if gravity is None else checks.positive("--gravity", gravity, "m/s2")
    share = None if free is None else _share(body, checks.number("--free", free))
    settings = Settings(gravity=pull, linear=linear)
    mu = DEFAULT_FRICTION if friction is None else checks.positive("--friction", friction)
    return Question(body, motion, {}, settings, engine, assumed_friction=mu, free=share, scale=scale)


def _share(body: Body, free: float) -> float:
    alpha = body.side("right" if free > 0.0 else "left").slenderness_angle
    if abs(free) * alpha >= 0.5 * math.pi:
        raise InvalidValueError(
            f"--free is a share of the slenderness angle, here {math.degrees(alpha):.3g} degrees, and 1 is where the "
            f"body balances; got {free:g}. An angle of {free:g} degrees is --free {math.radians(free) / alpha:.3g}"
        )
    if abs(free) > 1.0:
        plausibility.warn(
            [
                f"let go at {free:g} slenderness angles, beyond where the body balances: it can only fall. An angle of "
                f"{free:g} degrees is --free {math.radians(free) / alpha:.3g}"
            ]
        )
    return free


def body_and_motion(
    body: str | None, record: str | None, motion: str | None, *, sized: bool, free: bool
) -> tuple[Path | None, str | None]:
    """Return which word names the body and which one the motion.

    Returns motion: record file or pulse; None for free rocking.
    """
    if sized and record is None:
        body, record = None, body
    refuse_reversed(body, record)
    if record is not None and motion is not None:
        # a word that is a file beside dimensions is more likely a body
        raise InvalidValueError(f"one motion and one body, please: got {record[:100]!r} and --motion {motion[:100]!r}")
    word = record if record is not None else motion
    if free and word is not None:
        raise InvalidValueError(f"give a motion or --free, not both; got {word[:100]!r}")
    if not free and word is None:
        raise InvalidValueError(
            "what moves the ground? Give a record file, a pulse such as sine:amplitude=3,period=0.8, or --free 0.5"
        )
    return None if body is None else Path(body), word


def refuse_reversed(body: str | None, record: str | None) -> None:
    """Refuse a motion before its body."""
    if body is not None and record is not None and is_body(record) and not is_body(body):
        raise InvalidValueError(f"the body comes first, then the motion: {record[:100]} {body[:100]}, not the reverse")


def motion_asked(word: str | None, told: dict[str, Any], scale: float) -> Motion | None:
    """Return the motion, none for free rocking.

    scale: factor on the motion, refused for free rocking [-].
    """
    if word is not None:
        return motion_from(word, **told)
    given = [f"--{name.replace('_', '-')}" for name, value in told.items() if value is not None]
    given += ["--scale"] if scale != 1.0 else []
    if given:
        raise InvalidValueError(f"--free has no motion, so it takes no {', '.join(given)}")
    return None


def restitution_from(word: str) -> Any:
    """Return a model or a coefficient from one word."""
    try:
        return float(word)
    except ValueError:
        return next(iter(models_from([word]) or []))


@dataclass(frozen=True, slots=True)
class SimulateOptions:
    """The options of one call."""

    values: dict[str, Any]  # parameter of the command to its value
    typed: frozenset[str]  # parameters that were typed, so that their values are no defaults
    document: Path | None  # the file that says everything, if the first word is one

    @classmethod
    def of(cls, context: typer.Context) -> "SimulateOptions":
        """Return what was typed."""
        document = path_of(context)
        by_hand = frozenset(name for name in context.params if typed(context, name))
        unit, units = units_of(context.params["units"], LENGTH_UNITS, ACCELERATION_UNITS)
        return cls({**context.params, "unit": unit, "units": units}, by_hand, document)

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
        refuse("a plane body is no mesh and has one horizontal motion", self.only_typed((*_MESH, *_ALONG)))
        values, size, free = self.values, self.some(_SIZE), self.values["free"]
        sized = any(size[name] is not None for name in ("width", "height", "angle", "semi_diagonal"))
        file, word = body_and_motion(
            values["body"], values["record"], values["motion"], sized=sized, free=free is not None
        )
        how = self.some(("scale", "gravity", "engine", "linear", "friction"))
        subject = body_from(file, **size)
        return question_of(subject, motion_asked(word, self.some(_RECORD), how["scale"]), free, **how)


def path_of(context: typer.Context) -> Path | None:
    """Return the file that says everything, if the command was given one: a TOML file with a table [response].

    Returns none if the first word is something else.
    """
    from rocking.spec.reading import is_response

    word = context.params.get("body")
    if word is None or not is_response(Path(word)):
        return None
    given = [name for name in context.params if name not in _OUTPUTS and typed(context, name)]
    if given:
        names = ", ".join("a second word" if name == "record" else f"--{name.replace('_', '-')}" for name in given)
        raise InvalidValueError(f"{word} has a table [response] and says everything itself, so it takes no {names}")
    return Path(word)


@dataclass(frozen=True, slots=True)
class ResponseComparison:
    """A response, and what the other models of impact make of the same question."""

    response: Response  # with the restitution asked for
    friction: float  # coefficient of friction between body and ground [-]
    others: dict[str, Response | str]  # by model: the response, or why the model has none for this body

    @classmethod
    def of(cls, question: Question, restitution: str) -> "ResponseComparison":
        """Compute the response, and what every model that needs no value makes of the same question."""
        from rocking.evidence._coefficient_table import default_models

        response = _computed(question, restitution_from(restitution))
        rivals = {model.label: model for model in default_models() if model.label != response.parameters.label}
        return cls(
            response, question.assumed_friction, {name: _tried(question, model) for name, model in rivals.items()}
        )

    @classmethod
    def of_choices(cls, question: Question) -> "ResponseComparison":
        """Compute the response with the first restitution of a question, and with all others that it lists."""
        (_, first), *rest = question.restitutions.items()
        response = _computed(question, first)
        return cls(response, question.assumed_friction, {name: _tried(question, choice) for name, choice in rest})


def _computed(question: Question, restitution: Any) -> Response:
    response = question.answer(restitution)
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    return response


def _tried(question: Question, restitution: Any) -> Response | str:
    try:
        return question.answer(restitution)
    except InvalidValueError as error:
        return str(error)


def answer_of(path: Path) -> ResponseComparison:
    """Return the answer to what a file asks.

    Returns the response with the first restitution, and with the others that the file lists.
    """
    from rocking.spec.response import ResponseJob

    return ResponseComparison.of_choices(ResponseJob.read(path).problem)


def typed(context: typer.Context, name: str) -> bool:
    """Return whether an option was typed.

    Returns false where its value is the default.
    """
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"
