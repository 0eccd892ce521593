"""Inputs of an export, and results computed on demand."""

from dataclasses import dataclass, replace
from functools import cached_property

from rocking import GroundMotion, Response
from rocking.bodies import Body
from rocking.conventions import Foot, g
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.reports.body_facts import ImpactAnswer
from rocking.spec.response import ResponseProblem
from rocking.version import SOFTWARE
from rocking_workbench.api.response import responses_of
from rocking_workbench.downloads.inputs_file import fingerprint
from rocking_workbench.errors import Refused
from rocking_workbench.inputs import Inputs, body_from, motion_from, problem_from
from rocking_workbench.plain_text import plain_line
from rocking_workbench.records import RecordStore


@dataclass(frozen=True)
class Evaluation:
    """Inputs, and results computed once on demand."""

    inputs: Inputs  # inputs of the user
    records: RecordStore  # uploaded records
    foot: str = "both"  # foot on which the body lands, for coefficients

    @property
    def name(self) -> str:
        """Name of the body; may be empty."""
        return plain_line(self.inputs.body.name or "", 100)

    @property
    def label(self) -> str:
        """First word of file names."""
        return self.name or "rocking"

    @property
    def scale(self) -> float:
        """Factor on the motion [-]."""
        return 1.0 if self.inputs.motion is None else self.inputs.motion.scale

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s2]."""
        return self.inputs.settings.gravity or g

    @cached_property
    def body(self) -> Body:
        """The body."""
        return body_from(self.inputs.body)

    @cached_property
    def motion(self) -> Motion:
        """The motion, scaled."""
        chosen = self.inputs.motion
        if chosen is None:
            raise Refused("no motion is selected", needs=["motion"])
        motion = _named_plainly(motion_from(chosen, self.records))
        return motion if self.scale == 1.0 else motion.scaled(self.scale)

    @cached_property
    def problem(self) -> ResponseProblem:
        """Body, motion, restitutions and settings."""
        if self.inputs.motion is None and self.inputs.response.initial_rotation is None:
            raise Refused("no motion; choose a motion or free rocking", needs=["motion"])
        problem = problem_from(self.inputs, self.records)
        if problem.motion is None or isinstance(problem.motion, dict):
            return problem
        return replace(problem, motion=_named_plainly(problem.motion))

    @cached_property
    def answers(self) -> dict[str, Response | str]:
        """Response or reason for its absence, by restitution label."""
        return responses_of(self.problem)

    @property
    def responses(self) -> dict[str, Response]:
        """Available responses by label, at least one."""
        return {label: response for label, response in self.answers.items() if isinstance(response, Response)}

    @property
    def refused(self) -> dict[str, str]:
        """Reasons for missing responses, by label."""
        return {label: reason for label, reason in self.answers.items() if isinstance(reason, str)}

    def chosen(self, index: int | None) -> Response:
        """Return one response by index."""
        if index is None:
            return next(iter(self.responses.values()))
        answers = list(self.answers.values())
        if not 0 <= index < len(answers):
            raise InvalidValueError(parameter="restitution", allowed=f"0 to {len(answers) - 1}", value=index)
        response = answers[index]
        if isinstance(response, str):
            raise InvalidValueError(response)
        return response

    def file_stem(self, content: str, index: int | None) -> str:
        """Return the file name of one response, with its restitution if there are several."""
        restitution, stem = self.inputs.restitution, f"{self.label} {content}"
        if len(restitution.models or ()) + len(restitution.values or ()) < 2:
            return stem
        return f"{stem} {plain_line(self.chosen(index).parameters.label, 60)}"

    @cached_property
    def impact(self) -> ImpactAnswer:
        """Coefficients under every model."""
        return ImpactAnswer.of(self.body, None, foot=self.foot, gravity=self.gravity, identities=False)

    @property
    def drawn_foot(self) -> Foot:
        """Impact foot of the coefficients in the figure."""
        return next(reversed(self.impact.tables))

    @property
    def about(self) -> dict[str, str]:
        """Provenance of a file."""
        return {"software": SOFTWARE, "body": self.name, "inputs SHA-256": fingerprint(self.inputs)}


def _named_plainly(motion: Motion) -> Motion:
    """Return a motion with name and provenance that are safe in files."""
    if not isinstance(motion, GroundMotion):
        return motion
    name, provenance = plain_line(motion.name), tuple(plain_line(line, 500) for line in motion.provenance)
    if (name, provenance) == (motion.name, motion.provenance):
        return motion
    return replace(motion, name=name, provenance=provenance)
