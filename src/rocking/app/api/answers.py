"""One question under all its restitutions: responses, why some have none, and what they say together."""

from dataclasses import dataclass
from typing import Any

from rocking.app.api.curves import fall_series, response_series
from rocking.app.problems import TooLarge
from rocking.app.question import Question
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.report.facts.body import body_facts, outline_facts
from rocking.report.facts.response import moved_facts, response_facts
from rocking.report.facts.verdict import Verdict

MOST_SAMPLES = 500_000
"""Samples of a response whose forces and energy are computed here."""

MOST_TOGETHER = 3_000_000
"""Samples of all responses of one question, those after an overturning among them: they are computed as well."""


@dataclass(frozen=True, slots=True)
class ResponseAnswers:
    """What every restitution makes of one question."""

    question: Question
    found: dict[str, Response | str]  # by label: the response, or why there is none

    @classmethod
    def of(cls, question: Question) -> "ResponseAnswers":
        """Compute the responses.

        Returns at least one of them is there.
        """
        found: dict[str, Response | str] = {}
        samples = 0
        for label, choice in question.choices.items():
            found[label] = tried = _tried(question, choice)
            samples += tried.segments.count if isinstance(tried, Response) else 0
            _refuse_long(samples, len(found), len(question.choices))
        reasons = [reason for reason in found.values() if isinstance(reason, str)]
        if len(reasons) == len(found):
            raise InvalidValueError(reasons[0])
        return cls(question, found)

    @property
    def responses(self) -> dict[str, Response]:
        """The responses that are there, by label."""
        return {label: one for label, one in self.found.items() if isinstance(one, Response)}

    def facts(self, points: int, name: str | None = None, window: tuple[float, float] | None = None) -> dict[str, Any]:
        """Return the answer of the API.

        window: the part of the time that is drawn [s].
        """
        asked, verdict = self.question, Verdict.of(self.responses)
        return {
            "answers": [
                {"label": label, "error": one}
                if isinstance(one, str)
                else answer_facts(label, one, asked, points, window)
                for label, one in self.found.items()
            ],
            "verdict": {"decides": verdict.decides, "sentence": verdict.sentence},
            "body": {"name": name, **body_facts(asked.body, asked.settings.gravity), **outline_facts(asked.body)},
            "motion": moved_facts(asked.motion, asked.scale),
        }


def answer_facts(
    label: str, response: Response, question: Question, points: int, window: tuple[float, float] | None = None
) -> dict[str, Any]:
    """Return one response as the API tells it.

    window: the part of the time that is drawn [s]. Returns what `rocking.report.facts.response.response_facts` says,
    with ``label``, ``series`` and ``fall``.
    """
    facts = response_facts(response, question.friction)
    series = response_series(response, points, window)
    return {"label": label, **facts, "series": series, "fall": fall_series(response)}


def _refuse_long(samples: int, done: int, asked: int) -> None:
    if samples > MOST_TOGETHER:
        raise TooLarge(
            f"{done} of {asked} responses together take {samples} steps, more than the {MOST_TOGETHER} that are "
            "computed at once; fewer restitutions, a motion with longer steps, or the command line"
        )


def _tried(question: Question, restitution: Any) -> Response | str:
    try:
        response = question.answered_with(restitution)
    except InvalidValueError as error:
        return str(error)
    if response.outcome is Outcome.FAILED:
        return f"there is no response: {response.status.value}"
    if response.time.size > MOST_SAMPLES:
        return (
            f"the response has {response.time.size} samples, more than the {MOST_SAMPLES} that are shown here; "
            "a motion with longer steps, a smaller body, or the command line"
        )
    return response
