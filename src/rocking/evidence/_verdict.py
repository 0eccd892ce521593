"""What the league table says, in words made from its numbers, every comparison by the rule of `comparison`."""

from collections.abc import Sequence

import numpy as np

from rocking.evidence._league import LeagueRow
from rocking.evidence.comparison import MEASURES, compare
from rocking.evidence.measurements import all_measurements

_UNRESOLVED = 6.0


def verdict(rows: Sequence[LeagueRow]) -> tuple[str, ...]:
    """Put the league table into words, also where the paper's own model loses.

    Parameters
    ----------
    rows : sequence of LeagueRow
        The league, which must hold ``ked`` and ``housner``.

    Returns
    -------
    tuple of str
        One sentence or two each.
    """
    by_name = {row.name: row for row in rows}
    ked, housner = by_name["ked"], by_name["housner"]
    free = [row for row in rows if not row.parameters]
    return (
        f"Error of r: {_between(ked, housner, 'r')}.",
        _against_free(ked, free),
        *(f"{name.capitalize()}: {_between(ked, housner, name)}." for name in list(MEASURES)[1:]),
        _slender(ked, housner),
        _best(rows),
        _unresolved(rows),
    )


def _between(one: LeagueRow, other: LeagueRow, measure: str, above: float = 0.0) -> str:
    data = all_measurements()
    data = data.rows(np.flatnonzero(data.slenderness > above).tolist())
    first, second = (row.model.of_slenderness(data.slenderness) for row in (one, other))
    return compare(data, first, second, measure).sentence(one.name, other.name)


def _against_free(ked: LeagueRow, free: Sequence[LeagueRow]) -> str:
    data = all_measurements()
    mine = ked.model.of_slenderness(data.slenderness)
    better = [row for row in free if compare(data, row.model.of_slenderness(data.slenderness), mine).sign < 0]
    best = min(free, key=lambda row: row.rmse)
    names = ", ".join(row.name for row in better) or "none"
    if best is ked:
        return "Among the models without a fitted parameter, KED has the smallest error."
    return (
        f"Models without a fitted parameter that are closer than KED: {names}. The smallest error is that of "
        f"{best.name}: {_between(best, ked, 'r')}."
    )


def _slender(ked: LeagueRow, housner: LeagueRow) -> str:
    return (
        f"Above slenderness 6: {_between(ked, housner, 'r', 6.0)}. The bias of KED over all rows is {ked.bias:+.4f} "
        "(model minus measurement)."
    )


def _best(rows: Sequence[LeagueRow]) -> str:
    best = min(rows, key=lambda row: row.bic)
    return (
        f"With fitted parameters the lowest BIC is that of {best.name} ({best.fitted or 'nothing fitted'}): RMSE "
        f"{best.rmse:.4f}, leave-one-out {best.leave_one_out:.4f}, leave-one-data-set-out {best.leave_group_out:.4f}."
    )


def _unresolved(rows: Sequence[LeagueRow]) -> str:
    best = min(row.bic for row in rows)
    close = [row.name for row in rows if row.bic - best < _UNRESOLVED]
    return (
        f"What these data cannot resolve: {', '.join(close)} lie within {_UNRESOLVED:g} in BIC of each other. Two "
        "sources, repeated tests of the same blocks and one tape-covered interface are little evidence: what a model "
        "does outside slenderness 1.5 to 9.75, or for other shapes, is theory."
    )
