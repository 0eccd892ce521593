"""One body, one motion or first rotation, some restitutions: the question of a response, and its file."""

import os
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.conventions import DEFAULT_FRICTION
from rocking.dynamics import free_rocking, simulate
from rocking.dynamics.response import Motion, Response
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.motions.formats.reader import read_motion
from rocking.motions.pulses import pulse
from rocking.spec.parts import body_of, choices_of
from rocking.spec.reading import InputFiles, located, read_text, validated
from rocking.studies.motion_sets import SyntheticSet

if TYPE_CHECKING:
    from rocking.spec.document import OneMotionTable, ResponseDocument, ResponseTables


@dataclass(frozen=True, slots=True)
class ResponseQuestion:
    """Everything that a response depends on."""

    body: Body
    motion: Motion | None  # the motion, not scaled; None for free rocking
    # restitutions by label, as `simulate` takes them
    choices: dict[str, Any] = field(default_factory=lambda: {"ked": "ked"})
    settings: Settings = field(default_factory=Settings)  # how to integrate
    engine: str = "auto"  # which engine
    friction: float = DEFAULT_FRICTION  # coefficient of friction between body and ground [-]
    free: float | None = None  # first rotation over the slenderness angle of the side it leans to, for free rocking [-]
    scale: float = 1.0  # factor on the motion [-]

    def __post_init__(self) -> None:
        """Check what the engines do not check."""
        plausibility.warn(plausibility.of_friction(checks.positive("friction", self.friction)))
        if self.free is not None:
            checks.number("free", self.free)
        if (self.motion is None) != (self.free is not None):
            raise InvalidValueError("give either a motion or a first rotation (free), got both or neither")

    @property
    def rotation(self) -> float:
        """Rotation at the start, positive to the right [rad]."""
        if self.free is None:
            return 0.0
        side = self.body.side("right" if self.free > 0.0 else "left", self.settings.gravity)
        return self.free * side.slenderness_angle

    def answered_with(self, restitution: Any) -> Response:
        """Return the response with one restitution."""
        how = {**self.settings.stated, "engine": self.engine}
        with warnings.catch_warnings():  # whoever shows the response shows its doubts
            warnings.simplefilter("ignore", PureRockingWarning)
            if self.motion is None:
                response: Response = free_rocking(self.body, self.rotation, restitution, **how)
            else:
                response = simulate(self.body, self.motion, restitution, scale=self.scale, **how)
            return response


@dataclass(frozen=True)
class ResponseJob:
    """A file that describes one response, read with all files that it names."""

    document: "ResponseDocument"  # its tables
    question: ResponseQuestion  # body, motion, restitutions and settings
    inputs: InputFiles  # the files that were read, with their hashes

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "ResponseJob":
        """Read a file.

        path: TOML with the tables [response], [body], [motion], [restitution] and [settings].
        """
        where = Path(path)
        with located(str(where)):
            return cls.of_text(read_text(where), where.parent)

    @classmethod
    def of_text(cls, text: str, folder: str | os.PathLike[str]) -> "ResponseJob":
        r"""Read the text of such a file.

        >>> text = '[response]\nfree = 0.5\n[body]\nunits = "m"\nwidth = 1\nheight = 4'
        >>> job = ResponseJob.of_text(text, ".")
        >>> job.question.free, list(job.question.choices)
        (0.5, ['ked'])
        """
        from rocking.spec.document import ResponseDocument

        document = validated(ResponseDocument, text)
        inputs = InputFiles(Path(folder))
        with located("body"):
            body = body_of(document.body, inputs)
        motion = None
        if document.motion is not None:
            with located("motion"):
                motion = _motion(document.motion, inputs)
        return cls(document, question_from(document, body, motion), inputs)


def question_from(
    tables: "ResponseTables", body: "Body", motion: Motion | None, scale: float | None = None
) -> ResponseQuestion:
    """Return the question that tables ask about a body and a motion that have been made.

    scale: factor on the motion; what the tables say of their motion if not given [-].
    """
    with located("settings"):
        told = tables.settings.model_dump(exclude={"engine"}, exclude_none=True)
        settings = Settings(**told)
    table = getattr(tables, "motion", None)
    return ResponseQuestion(
        body,
        motion,
        choices_of(tables.restitution, 0, [body]),
        settings,
        engine=tables.settings.engine,
        friction=tables.response.friction,
        free=tables.response.free,
        scale=scale if scale is not None else 1.0 if table is None else table.scale,
    )


def made_motion(table: "OneMotionTable") -> Motion:
    """Return a motion that needs no file: a pulse, or one of a synthetic family.

    Returns not scaled by `scale`; scaled to `pga` or `pgv`.
    """
    if table.pulse is not None:
        return pulse(table.pulse)
    if table.synthetic is None:
        raise InvalidValueError("a record is a file; only pulses and synthetic motions are made")
    member = table.member or 0
    made = SyntheticSet(
        table.synthetic, member + 1, table.seed or 0, pga=table.pga, pgv=table.pgv, time_step=table.time_step
    )
    return made[member]


def _motion(table: "OneMotionTable", inputs: InputFiles) -> Motion:
    if table.record is None:
        return made_motion(table)
    path = inputs.file(table.record)
    return read_motion(path, table.format, table.units, table.time_step, table.component, table.vertical)
