"""A claim of the paper and its verdict; what every judge of a claim needs."""

from collections.abc import Callable
from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.evidence.comparison import Difference
from rocking.evidence.measurements import DataSet, datasets
from rocking.restitution import Housner, Ked

Judge = Callable[[], tuple[str, str]]  # returns a verdict, and the numbers
JUDGES: list[tuple[str, str, str, Judge]] = []  # section, quote and test of every claim, and who judges it

HOLDS, IN_PART, FAILS, UNTESTABLE = "holds", "holds in part", "does not hold", "not testable"
UNRESOLVED = "not resolved"


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of the paper and what the published measurements say about it."""

    section: str  # of the paper
    quote: str  # the claim, in the paper's words or close to them
    verdict: str  # "holds", "holds in part", "does not hold", "not resolved" or "not testable"
    evidence: str  # the numbers
    test: str  # how it was tested


def claim(section: str, quote: str, test: str) -> Callable[[Judge], Judge]:
    """Let a function judge a claim of the paper."""

    def register(judge: Judge) -> Judge:
        JUDGES.append((section, quote, test, judge))
        return judge

    return register


def truth(name: str) -> tuple[DataSet, FloatArray, FloatArray]:
    """Return a data set with the true coefficients of Housner's model and of KED [-]."""
    data = datasets()[name]
    return data, Housner().of_slenderness(data.slenderness), Ked().of_slenderness(data.slenderness)


def verdict_of(holds: bool) -> str:
    """Return the verdict on a claim that holds or does not."""
    return HOLDS if holds else FAILS


def all_or_open(*differences: Difference) -> str:
    """Return the verdict on a claim that several differences are all positive: it fails if one is negative."""
    return resolved(min(each.sign for each in differences))


def resolved(sign: int) -> str:
    """Return the verdict on a claim that one thing is larger than another, by the sign of what is resolved."""
    return {1: HOLDS, -1: FAILS, 0: UNRESOLVED}[sign]
