"""Terms for probabilities: the calibrated likelihood scale of the IPCC."""

from typing import NamedTuple

from rocking.messages import Message


class LikelihoodTerm(NamedTuple):
    """A term and its range of probability [-]."""

    text: str
    low: float
    high: float


TERMS = (
    LikelihoodTerm("virtually certain", 0.99, 1.0),
    LikelihoodTerm("exceptionally unlikely", 0.0, 0.01),
    LikelihoodTerm("very likely", 0.9, 1.0),
    LikelihoodTerm("very unlikely", 0.0, 0.1),
    LikelihoodTerm("about as likely as not", 0.33, 0.66),
    LikelihoodTerm("unlikely", 0.0, 0.33),
    LikelihoodTerm("likely", 0.66, 1.0),
)
"""Terms of the scale, the narrowest first."""

SOURCE = (
    "IPCC calibrated likelihood scale: Mastrandrea et al. (2010), Guidance Note for Lead Authors of the IPCC Fifth "
    "Assessment Report on Consistent Treatment of Uncertainties, Table 1"
)


def likelihood(low: float, high: float) -> str:
    """Return the likelihood term of a probability from its interval [-].

    The result is the narrowest term whose range contains the interval. Thus few histories never give a strong term.
    If no range contains the interval, the result names the terms of both ends.

    >>> likelihood(0.0, 0.21), likelihood(0.0, 0.005), likelihood(0.3, 0.5)
    ('unlikely', 'exceptionally unlikely', 'unlikely to about as likely as not')
    """
    term = next((term for term in TERMS if term.low <= low and high <= term.high), None)
    if term is not None:
        return Message(term.text)
    return Message("{low} to {high}", {"low": Message(_broad(low)), "high": Message(_broad(high))})


def _broad(probability: float) -> str:
    return "unlikely" if probability <= 0.33 else "about as likely as not" if probability < 0.66 else "likely"


def scale_words() -> str:
    """Return the scale as one sentence for printing with a result.

    >>> scale_words()[:17]
    'Likelihood terms:'
    """
    ordered = sorted(TERMS, key=lambda term: (-term.high, -term.low))
    first, *others = (
        Message(
            "{term} {low:g} to {high:g} %",
            {"term": Message(term.text), "low": 100.0 * term.low, "high": 100.0 * term.high},
        )
        for term in ordered
    )
    for other in others:
        first = Message("{first}, {second}", {"first": first, "second": other})
    facts = {"terms": first, "source": SOURCE}
    return Message(
        "Likelihood terms: {terms}. The range of each stated term contains the 95 % interval of the "
        "probability. {source}.",
        facts,
    )
