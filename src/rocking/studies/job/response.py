"""The document of one response: what `rocking simulate FILE.toml` reads."""

import os
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.dynamics.response import Motion
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.formats.reader import read_motion
from rocking.motions.pulses import pulse
from rocking.studies.job.inputs import Inputs
from rocking.studies.job.parts import body_of
from rocking.studies.job.reading import located, read_text, validated
from rocking.studies.job.response_question import ResponseQuestion
from rocking.studies.job.restitutions import choices_of
from rocking.studies.record_set import SyntheticSet

if TYPE_CHECKING:
    from rocking.bodies import Body
    from rocking.studies.job.response_tables import Document, OneMotionTable, ResponseTables

__all__ = ["ResponseJob", "ResponseQuestion", "is_response", "made_motion", "question_from"]


@dataclass(frozen=True)
class ResponseJob:
    """A file that describes one response, read with all files that it names."""

    document: "Document"  # its tables
    question: ResponseQuestion  # body, motion, restitutions and settings
    inputs: Inputs  # the files that were read, with their hashes

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
        from rocking.studies.job.response_tables import Document

        document = validated(Document, text)
        inputs = Inputs(Path(folder))
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


def is_response(path: Path) -> bool:
    """Return whether a file describes a response rather than a body: it has a table [response].

    Returns false for everything that cannot be read as TOML; never raises.
    """
    if path.suffix.lower() != ".toml":
        return False
    try:
        return "response" in tomllib.loads(read_text(path))
    except (InvalidValueError, ValueError, RecursionError):
        return False


def _motion(table: "OneMotionTable", inputs: Inputs) -> Motion:
    if table.record is None:
        return made_motion(table)
    path = inputs.file(table.record)
    return read_motion(path, table.format, table.units, table.time_step, table.component, table.vertical)
