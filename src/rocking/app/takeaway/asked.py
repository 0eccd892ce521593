"""What a request for a file asks about: the inputs, and what is made of them when it is needed."""

from dataclasses import dataclass, replace
from functools import cached_property

from rocking.app.api.response import ResponseAnswers
from rocking.app.errors import Refused
from rocking.app.question import Question, body_from, motion_from, question_of
from rocking.app.records import RecordStore
from rocking.app.schemas.inputs import Inputs
from rocking.app.takeaway.inputs_file import fingerprint
from rocking.app.takeaway.plain_text import plain_line
from rocking.bodies import Body
from rocking.conventions import Foot, g
from rocking.dynamics.response import Motion, Response
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.reports.body_facts import ImpactAnswer


@dataclass(frozen=True)
class Evaluation:
    """Inputs, and what is computed from them, each once and only when somebody needs it."""

    inputs: Inputs  # what the user chose
    records: RecordStore  # uploaded records
    onto: str = "both"  # foot on which the body lands, for coefficients

    @property
    def name(self) -> str:
        """What the user calls the body; perhaps empty."""
        return plain_line(self.inputs.body.name or "", 100)

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
            raise Refused("no motion was chosen: the ground is at rest", needs=["motion"])
        made = _named_plainly(motion_from(chosen, self.records))
        return made if chosen.scale == 1.0 else made.scaled(chosen.scale)

    @cached_property
    def question(self) -> Question:
        """Body, motion, restitutions and settings."""
        if self.inputs.motion is None and self.inputs.response.free is None:
            raise Refused("what moves the body? Choose a motion, or free rocking", needs=["motion"])
        made = question_of(self.inputs, self.records)
        if made.motion is not None:
            made = replace(made, motion=_named_plainly(made.motion))
        return made

    @cached_property
    def answers(self) -> ResponseAnswers:
        """One response for every restitution, or why there is none."""
        return ResponseAnswers.of(self.question)

    @cached_property
    def responses(self) -> dict[str, Response]:
        """The responses that are there, by label; at least one."""
        return self.answers.responses

    @property
    def refused(self) -> dict[str, str]:
        """By label: why a restitution has no response for this body."""
        return {label: why for label, why in self.answers.found.items() if isinstance(why, str)}

    def chosen(self, index: int | None) -> Response:
        """Return one response by its place."""
        if index is None:
            return next(iter(self.responses.values()))
        found = list(self.answers.found.values())
        if not 0 <= index < len(found):
            raise InvalidValueError(f"restitution must be 0 to {len(found) - 1}, got {index}")
        one = found[index]
        if isinstance(one, str):
            raise InvalidValueError(one)
        return one

    def words(self, what: str, index: int | None) -> str:
        """Return what a file of one response is called: with its restitution, where there are several."""
        chosen = self.inputs.restitution
        if len(chosen.models or ()) + len(chosen.values or ()) < 2:
            return f"{self.name or 'rocking'} {what}"
        label = plain_line(self.chosen(index).parameters.label, 60)
        return f"{self.name or 'rocking'} {what} {label}"

    @cached_property
    def impact(self) -> ImpactAnswer:
        """Coefficients under every model."""
        return ImpactAnswer.of(self.body, None, onto=self.onto, eta=1.0, gravity=self.gravity, identities=False)

    @property
    def foot(self) -> Foot:
        """The foot whose coefficients are drawn."""
        return next(reversed(self.impact.tables))

    @property
    def about(self) -> dict[str, str]:
        """Provenance of a file."""
        from importlib.metadata import version

        return {
            "software": f"rocking {version('rocking')}",
            "body": self.name,
            "inputs SHA-256": fingerprint(self.inputs),
        }


def _named_plainly(motion: Motion) -> Motion:
    """Return a motion whose name and provenance, which a file may have given it, can stand in any other file."""
    if not isinstance(motion, GroundMotion):
        return motion
    name, told = plain_line(motion.name), tuple(plain_line(line, 500) for line in motion.provenance)
    return motion if (name, told) == (motion.name, motion.provenance) else replace(motion, name=name, provenance=told)
