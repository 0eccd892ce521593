"""What the pictures of fragility say: symbols of states, and verdicts."""

from typing import Any


def symbol(state: str) -> str:
    r"""Return the name of a state with its symbols.

    >>> symbol("rotation > 0.5 alpha")
    '$\\theta > 0.5\\,\\alpha$'
    """
    if not state.startswith("rotation > "):
        return "rocks" if state == "rocking" else state
    return rf"$\theta > {state.split()[2]}\,\alpha$"


def caption(analysis: Any) -> str:
    """Return what must be said below the picture: the verdicts of states whose outcomes fix no likeliest curve."""
    odd = {name: fit for name, fit in analysis.fits.items() if fit.separation.name != "OVERLAP"}
    told: dict[str, list[str]] = {}
    for name, fit in odd.items():
        # what the likelihood does not know is said where the intervals are
        words = fit.verdict.split(" Outcomes of one cluster")[0].split(" Intervals are")[0]
        told.setdefault(words, []).append(symbol(name))
    return " ".join(f"{', '.join(names)}: {verdict}" for verdict, names in told.items())
