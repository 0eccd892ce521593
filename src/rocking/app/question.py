"""From the document of a user's choices to what is computed: body, motion, restitutions, settings."""

from functools import lru_cache
from typing import TYPE_CHECKING

from rocking.app.schemas.inputs import check_contact
from rocking.bodies import Body
from rocking.bodies.formats.source import blamed
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError, RockingError
from rocking.spec.construction import body_of, motion_of
from rocking.spec.response import ResponseProblem, problem_of

if TYPE_CHECKING:
    from rocking.app.records import RecordStore
    from rocking.app.schemas.inputs import BodyInput, Inputs, MotionInput

__all__ = ["Question", "body_from", "motion_from", "question_of"]

_LIGHTEST = 1e-200
"""Products of smaller masses and moments leave the range of numbers that have all their digits."""

Question = ResponseProblem
"""Body, motion, restitutions and settings, made and checked; `answered_with` gives the response."""


def question_of(inputs: "Inputs", records: "RecordStore") -> Question:
    """Return what a user asked, with everything read that it needs."""
    motion = None if inputs.motion is None else motion_from(inputs.motion, records)
    return problem_of(inputs, body_from(inputs.body), motion)


def body_from(given: "BodyInput") -> Body:
    """Return a body; one that was asked for lately is not made again."""
    return _body(_Hashed(given))


def motion_from(given: "MotionInput", records: "RecordStore") -> Motion:
    """Return a motion, not scaled.

    Returns the motion; one that was asked for lately is not read or made again.
    """
    if given.record is None:
        with blamed("motion"):
            return _made(given)
    return records.motion(given.record, given.format, given.units, given.time_step, given.component, given.vertical)


class _Hashed:
    """A body in a request, as the key of a cache."""

    def __init__(self, given: "BodyInput") -> None:
        self.given = given
        self.text = given.model_dump_json(exclude_none=True, exclude_unset=True)

    def __hash__(self) -> int:
        return hash(self.text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Hashed) and other.text == self.text


@lru_cache(maxsize=32)
def _body(key: _Hashed) -> Body:
    with blamed("body"):
        try:
            return _check_inertia(check_contact(body_of(key.given.table(), None)))
        except InvalidValueError as error:
            kind = type(error.__cause__) if isinstance(error.__cause__, RockingError) else InvalidValueError
            raise kind(str(error)) from error


def _check_inertia(body: Body) -> Body:
    mass, inertia = body.mass, body.moment_of_inertia
    if min(mass, inertia or mass) < _LIGHTEST:
        raise InvalidValueError(
            f"mass {mass:.3g} kg and moment of inertia {inertia:.3g} kg m2 must be > {_LIGHTEST:g}, below which digits "
            "are lost; is a density or a mass in a wrong unit?"
        )
    return body


def _made(given: "MotionInput") -> Motion:
    if given.synthetic is None:
        return motion_of(given)
    return _synthetic(given.synthetic, given.seed, given.member, given.pga, given.pgv, given.time_step)


@lru_cache(maxsize=16)
def _synthetic(
    family: str,
    seed: int | None,
    member: int | None,
    pga: float | None,
    pgv: float | None,
    time_step: float | None,
) -> Motion:
    from rocking.spec.document import OneMotionTable

    return motion_of(OneMotionTable(synthetic=family, seed=seed, member=member, pga=pga, pgv=pgv, time_step=time_step))
