"""Whether the choice of the restitution model decides how a body ends, in one sentence."""

from collections.abc import Mapping
from dataclasses import dataclass

from rocking.dynamics.response import Response
from rocking.outcome import Outcome

_WORDS = {Outcome.OVERTURNED: "overturns", Outcome.ROCKED: "stays standing", Outcome.NO_UPLIFT: "is never lifted"}


@dataclass(frozen=True, slots=True)
class ModelAgreement:
    """What the models say together."""

    decides: bool  # whether they end differently
    sentence: str  # the same in words

    @classmethod
    def of(cls, found: Mapping[str, Response]) -> "ModelAgreement":
        """Compare responses."""
        groups: dict[str, list[str]] = {}
        for name, one in found.items():
            groups.setdefault(_WORDS[one.outcome], []).append(name)
        rocking = ", ".join(name for name, one in found.items() if one.still_rocking)
        pulled = ", ".join(name for name, one in found.items() if one.lost_contact)
        doubts = f" Still rocking when the computation ends: with {rocking}." if rocking else ""
        doubts += f" The ground would have to pull, and the verdict assumes contact: with {pulled}." if pulled else ""
        if len(groups) > 1:
            parts = ", ".join(f"{word} with {', '.join(names)}" for word, names in groups.items())
            return cls(True, f"The model decides: the body {parts}.{doubts}")
        (word,) = groups
        return cls(False, f"With every one of these models the body {word}.{doubts}")
