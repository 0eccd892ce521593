"""Whether a body rocks at all is certain once PGA is known: a check of the histories, not a curve."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.states import LimitState, Responses
from rocking.studies.fragility.subject import Subject


@dataclass(frozen=True)
class UpliftCheck:
    """Whether the histories rocked exactly where rocking is known beforehand.

    A body with equal sides under horizontal motions rocks if and only if PGA exceeds g tan(alpha): that is no matter of
    probability, and no curve is fitted to it.
    """

    # level of the measure that lifts the body [unit of the measure]; None if no level of this measure decides
    threshold: float | None
    checked: int  # histories that were compared; those within 1e-9 of the threshold are not
    contradictions: int  # histories that rocked below it or did not above it

    @property
    def verdict(self) -> str:
        """The result in words."""
        if self.threshold is None:
            return "no level of this measure alone decides whether the body rocks"
        return (
            f"rocking is certain above {self.threshold:.6g} and impossible below: "
            f"{self.contradictions} of {self.checked} histories contradict it"
        )


def uplift_check(subject: Subject, levels: FloatArray, responses: Responses) -> UpliftCheck:
    """Compare which histories rocked with the threshold of uplift.

    levels: level of the measure of each history [its unit].
    """
    threshold = subject.uplift_threshold
    if threshold is None:
        return UpliftCheck(None, 0, 0)
    clear = responses.good & (np.abs(levels / threshold - 1.0) > 1e-9)
    rocked = responses.exceed(LimitState("rocking", 0.0))
    return UpliftCheck(threshold, int(clear.sum()), int((clear & (rocked != (levels > threshold))).sum()))
