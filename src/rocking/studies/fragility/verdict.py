"""What can be claimed from the outcomes, in plain words."""

from rocking.studies.fragility.counts import Counts
from rocking.studies.fragility.separation import Separation

LEVEL = 0.95
"""Confidence level of the bounds that a verdict states [-]."""


def bound_without_failure(trials: float, level: float = LEVEL) -> float:
    """Return the largest probability of failure that trials without any failure leave possible.

    trials: number of trials, none of which failed [-]; level: confidence level [-]. Returns One-sided Clopper-Pearson
    bound, near 3 / trials for 95 % [-].

    >>> round(bound_without_failure(40), 4)
    0.0722
    """
    return float(1.0 - (1.0 - level) ** (1.0 / trials))  # Eq. 227


def verdict_of(counts: Counts, separation: Separation, curve: tuple[float, float] | None, rise: float | None) -> str:
    """Return what the outcomes allow to be said.

    curve: median [unit of the levels] and dispersion [-], where a curve was fitted; rise: likelihood ratio of the curve
    against a line that does not depend on the level, as a chi-square of one degree of freedom; None for a penalised fit
    [-]. Returns one or two sentences, followed by what the likelihood does not know.
    """
    parts = [_finding(counts, separation, curve, penalised=rise is None)]
    if rise is not None and rise < 3.841:
        parts.append("Chance alone explains the growth with the level (5 % test): intervals may be open.")
    if curve is not None and counts.is_clustered:
        parts.append(_clustered(counts))
    return " ".join(parts)


def _clustered(counts: Counts) -> str:
    if counts.scarcity:
        return (
            f"Intervals are those of the likelihood and may be much too narrow: they take the outcomes of one cluster"
            f" for independent; the bootstrap of whole clusters has too few of them ({counts.scarcity})."
        )
    how = "draws a capacity for each" if counts.draws_capacities else "draws whole clusters"
    return (
        f"Outcomes of one cluster are not independent: intervals are from the bootstrap, which {how};"
        " likelihood intervals would be too narrow."
    )


def _finding(counts: Counts, separation: Separation, curve: tuple[float, float] | None, *, penalised: bool) -> str:
    levels, sentence = counts.levels, separation.value[0].upper() + separation.value[1:]
    size = f"{counts.observations} outcomes at {levels.size} {'level' if levels.size == 1 else 'levels'}"
    shown = "" if curve is None else f"median {curve[0]:.4g}, dispersion {curve[1]:.3g}"
    if separation is Separation.OVERLAP and curve is None:
        return f"{size} give no curve: the likeliest rises so little, if at all, that it has no median."
    if separation is Separation.OVERLAP:
        what = (
            "penalised likelihood has its highest maximum found" if penalised else "likelihood is proven to be largest"
        )
        return f"{size} give {shown}, where the {what}."
    if separation.step:
        low, high = levels[counts.survivals > 0.0][-1], levels[counts.failures > 0.0][0]
        where = f"between {low:g} and {high:g}" if high > low else f"at {low:g}"
        return (
            f"{sentence}. {size} have no likeliest curve: the likelihood grows towards a step {where},"
            " with dispersion 0."
            + (f" The penalised likelihood gives {shown}: a convention, not a finding." if curve else "")
        )
    if separation in {Separation.NONE_FAILED, Separation.ALL_FAILED}:
        return f"{sentence}. {_bound(counts, separation)} No curve is fitted."
    return f"{sentence}. No curve is fitted to {size}."


def _bound(counts: Counts, separation: Separation) -> str:
    none = separation is Separation.NONE_FAILED
    place = -1 if none else 0
    trials, share = counts.trials[place], bound_without_failure(float(counts.trials[place]))
    what, text = ("failed", f"below {share:.3g}") if none else ("survived", f"above {1.0 - share:.3g}")
    return (
        f"At {counts.levels[place]:g} none of {trials:g} {what}: there the probability of failure is {text}"
        f" (confidence {LEVEL:.0%})."
    )
