"""A claim of the paper and its verdict; what every judge of a claim needs."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.evidence.measurements import DataSet, datasets
from rocking.restitution import Housner, Ked

HOLDS, IN_PART, FAILS, UNTESTABLE = "holds", "holds in part", "does not hold", "not testable"


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of the paper and what the published measurements say about it.

    Parameters
    ----------
    section : str
        Section of the paper.
    quote : str
        The claim, in the paper's words or close to them.
    verdict : str
        ``"holds"``, ``"holds in part"``, ``"does not hold"`` or ``"not testable"``.
    evidence : str
        The numbers.
    test : str
        How it was tested.
    """

    section: str
    quote: str
    verdict: str
    evidence: str
    test: str


def truth(name: str) -> tuple[DataSet, FloatArray, FloatArray]:
    """Return a data set with the true coefficients of both models.

    Parameters
    ----------
    name : str
        Name of the data set.

    Returns
    -------
    data : DataSet
        The measurements.
    housner, ked : ndarray
        Coefficients of the models [-].
    """
    data = datasets()[name]
    return data, Housner().of_slenderness(data.slenderness), Ked().of_slenderness(data.slenderness)


def verdict_of(holds: bool) -> str:
    """Return the verdict on a claim that holds or does not.

    Parameters
    ----------
    holds : bool
        Whether it holds.

    Returns
    -------
    str
        ``"holds"`` or ``"does not hold"``.
    """
    return HOLDS if holds else FAILS
