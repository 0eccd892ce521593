"""What the league table says, in words made from its numbers."""

from collections.abc import Sequence

from rocking.evidence.league import LeagueRow

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
        _against_housner(ked, housner),
        _against_free(ked, free),
        _in_loss(ked, housner, free),
        _slender(ked, housner),
        _best(rows),
        _unresolved(rows, ked),
    )


def _against_housner(ked: LeagueRow, housner: LeagueRow) -> str:
    winner = "closer" if ked.rmse < housner.rmse else "not closer"
    return (
        f"In r, KED is {winner} to the measurements than Housner: RMSE {ked.rmse:.4f} against {housner.rmse:.4f} "
        f"({housner.by_band['h/b <= 3']:.3f} against {ked.by_band['h/b <= 3']:.3f} up to slenderness 3, where "
        "Housner fails)."
    )


def _against_free(ked: LeagueRow, free: Sequence[LeagueRow]) -> str:
    better = [row for row in free if row.rmse < ked.rmse]
    best = min(free, key=lambda row: row.rmse)
    if best is ked:
        return "Among the models without a fitted parameter, KED is the closest."
    low, high = best.ahead_of_ked
    sure = "beyond doubt" if high < 0.0 else "though the bootstrap interval reaches zero"
    return (
        f"Among the models without a fitted parameter KED loses to {len(better)}: "
        f"{', '.join(row.name for row in better)}. "
        f"The closest is {best.name}, RMSE {best.rmse:.4f}, {ked.rmse - best.rmse:.4f} below KED "
        f"(95 % interval {-high:+.4f} to {-low:+.4f}, {sure}; BIC lower by {ked.bic - best.bic:.0f})."
    )


def _in_loss(ked: LeagueRow, housner: LeagueRow, free: Sequence[LeagueRow]) -> str:
    rank = sorted(row.log_loss_rmse for row in free).index(ked.log_loss_rmse) + 1
    worse = "worse" if ked.log_loss_rmse > housner.log_loss_rmse else "better"
    return (
        f"In relative error of the energy loss, which is what overturning depends on, KED is {worse} than Housner: "
        f"{ked.log_loss_rmse:.3f} against {housner.log_loss_rmse:.3f} (rank {rank} of {len(free)}); "
        f"in absolute error of the loss it is {'better' if ked.loss_rmse < housner.loss_rmse else 'worse'}: "
        f"{ked.loss_rmse:.4f} against {housner.loss_rmse:.4f}."
    )


def _slender(ked: LeagueRow, housner: LeagueRow) -> str:
    band = "h/b > 6"
    losing = ked.by_band[band] > housner.by_band[band]
    return (
        f"Above slenderness 6 KED {'loses to' if losing else 'beats'} Housner: RMSE {ked.by_band[band]:.4f} against "
        f"{housner.by_band[band]:.4f}. Its bias is {ked.bias:+.4f}: measured impacts cost more than it says."
    )


def _best(rows: Sequence[LeagueRow]) -> str:
    best = min(rows, key=lambda row: row.bic_rounding)
    return (
        f"With fitted parameters the lowest BIC is that of {best.name} ({best.fitted or 'nothing fitted'}): RMSE "
        f"{best.rmse:.4f}, leave-one-out {best.leave_one_out:.4f}, leave-one-data-set-out {best.leave_group_out:.4f}."
    )


def _unresolved(rows: Sequence[LeagueRow], ked: LeagueRow) -> str:
    best = min(row.bic_rounding for row in rows)
    close = [row.name for row in rows if row.bic_rounding - best < _UNRESOLVED]
    return (
        f"What these data cannot resolve: {', '.join(close)} lie within {_UNRESOLVED:g} in BIC of each other. Two "
        "sources, repeated tests of the same blocks and one tape-covered interface are little evidence: what a model "
        "does outside slenderness 1.5 to 9.75, or for other shapes, is theory."
    )
