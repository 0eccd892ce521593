"""Every claim of the paper's sections 3 and 4, with a verdict and the number behind it."""

from rocking.evidence import claims_of_conclusions, claims_of_errors, claims_of_values
from rocking.evidence.claim import FAILS, HOLDS, IN_PART, UNRESOLVED, UNTESTABLE, Claim

__all__ = ["FAILS", "HOLDS", "IN_PART", "UNRESOLVED", "UNTESTABLE", "Claim", "claims"]

_ROOMS = (claims_of_values, claims_of_errors, claims_of_conclusions)


def claims() -> tuple[Claim, ...]:
    """Judge every claim.

    Returns
    -------
    tuple of Claim
        In the paper's order.

    Examples
    --------
    >>> sorted({claim.verdict for claim in claims()})
    ['does not hold', 'holds', 'holds in part', 'not resolved', 'not testable']
    """
    return tuple(judge() for room in _ROOMS for judge in room.JUDGES)
