"""What is foreseen of a body: the probability under each motion, and what decides it."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import percent
from rocking.errors import InvalidValueError
from rocking.plots.labels import plain
from rocking.plots.style import COLORS, DOUBLE, GREY, PALE, in_journal_style, legend_below, new_figure, patch, stroke
from rocking.prediction.forecast import Prediction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_NAMES = 12


@in_journal_style
def prediction_picture(found: Prediction) -> "Figure":
    """Draw the probability of overturning under each motion, and the share of each input in it.

    Parameters
    ----------
    found : Prediction
        As of `rocking.prediction.predict`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: the motions from the most dangerous down with their intervals, and the shares.

    Raises
    ------
    InvalidValueError
        If it is no prediction.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.prediction import predict
    >>> found = predict(rk.Block(width=0.5, height=2.0), rk.pulses.sine(5.0, 0.8), count=16)
    >>> [panel.get_xlabel() for panel in prediction_picture(found).axes]
    ['probability [-]', 'share of the variance of overturning [-]']
    """
    known: object = found
    if not isinstance(known, Prediction):
        raise InvalidValueError(f"found must be a Prediction, got {found!r:.60}")
    figure, axes = new_figure(DOUBLE, 3.2, columns=2)
    _motions(axes[0], found)
    _shares(axes[1], found)
    handles = [
        stroke("overturns, with its 95 % interval", color=COLORS[0], marker="o", linestyle="-", markersize=3.0),
        stroke("rocks", color=GREY, marker="|", linestyle="", markersize=6.0),
        patch(PALE, "overturns, all motions, 95 %"),
        patch(COLORS[0], "alone"), patch(COLORS[5], "together with the others"),
    ]  # fmt: skip
    legend_below(figure, handles, 5)
    return figure


def _motions(axes: "Axes", found: Prediction) -> None:
    chance = found.chances["overturning"]
    order = np.argsort(-np.nan_to_num(chance.per_motion), kind="stable")
    rows, each = np.arange(order.size), chance.per_motion[order]
    axes.axvspan(chance.low, chance.high, color=PALE, linewidth=0.0)
    reach = [each - chance.per_motion_low[order], chance.per_motion_high[order] - each]
    axes.errorbar(each, rows, xerr=np.maximum(reach, 0.0), fmt="o", color=COLORS[0], markersize=3.0, linewidth=0.8)
    axes.plot(found.chances["uplift"].per_motion[order], rows, "|", color=GREY, markersize=6.0)
    axes.set_ylim(order.size - 0.5, -0.5)
    axes.set_xlim(-0.02, 1.02)
    axes.set_xlabel("probability [-]")
    if order.size <= _MOST_NAMES:
        names = [found.motions[k] for k in order]
        axes.set_yticks(rows, [plain(name if len(name) <= 34 else f"{name[:31]}...") for name in names])
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{order.size} motions, the most dangerous first")
    axes.set_title(f"overturns with {percent(round(chance.value, 3))}", loc="left", fontsize=7.5)


def _shares(axes: "Axes", found: Prediction) -> None:
    axes.set_xlabel("share of the variance of overturning [-]")
    named = sorted(found.shares.items(), key=lambda pair: -pair[1].total)
    for row, (_, share) in enumerate(named):
        for offset, value, low, high, color in (
            (-0.18, share.first, share.first_low, share.first_high, COLORS[0]),
            (0.18, share.total, share.total_low, share.total_high, COLORS[5]),
        ):
            axes.barh(row + offset, max(value, 0.0), 0.34, color=color)
            axes.plot([max(low, 0.0), max(high, 0.0)], [row + offset] * 2, color="black", linewidth=0.8)
    axes.set_yticks(range(len(named)), ["motion" if name == "case" else name for name, _ in named])
    axes.set_xlim(0.0, 1.02)
    if named:
        axes.set_ylim(len(named) - 0.5, -0.5)
    axes.set_title("what decides it", loc="left", fontsize=7.5)
