"""How far a body is from overturning under each motion, and how code methods compare with that."""

from typing import TYPE_CHECKING

import numpy as np

from rocking import checks
from rocking.assessment import BodyAssessment
from rocking.plots.labels import plain, plain_log
from rocking.plots.style import COLORS, DASHED, DOUBLE, GREY, PALE, in_journal_style, legend_below, new_figure, stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_NAMES = 14


@in_journal_style
def assessment_picture(found: BodyAssessment) -> "Figure":
    """Draw the least factor on each motion that overturns a body, and what code methods allow over it.

    Parameters
    ----------
    found : BodyAssessment
        As of `rocking.assess`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: motions from the most dangerous down, and code methods.

    Raises
    ------
    InvalidValueError
        If it is no assessment.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.assess(rk.Block(width=0.5, height=2.0), rk.pulses.sine(5.0, 0.8), [0.9], count=16)
    >>> [panel.get_xlabel() for panel in assessment_picture(found).axes]
    ['factor on the motion [-]', 'allowed over overturning factor [-]']
    """
    checks.of_kind("found", found, BodyAssessment, "a BodyAssessment")
    figure, axes = new_figure(DOUBLE, 3.2, columns=2)
    least = np.array([np.fmin.reduce(each.least) for each in found.models.values()])
    least = np.where(np.isnan(least), np.inf, least)
    _margins(axes[0], found, least)
    _methods(axes[1], found, least.min(axis=0))
    handles = [
        stroke("lifts", color=GREY, marker="|", linestyle="", markersize=6.0),
        stroke("overturns: least to most of the models", color=COLORS[0], marker="o", linestyle="-", markersize=3.0),
        stroke("each motion", color=COLORS[5], marker="o", linestyle="", markersize=3.0),
        stroke("as recorded; as it happens", color="black", linestyle=DASHED),
    ]
    legend_below(figure, handles, 4)
    return figure


def _margins(axes: "Axes", found: BodyAssessment, least: np.ndarray) -> None:
    order = np.argsort(least.min(axis=0), kind="stable")
    axes.axvline(1.0, color="black", linestyle=DASHED, linewidth=0.8)
    for row, k in enumerate(order.tolist()):
        values = least[:, k][np.isfinite(least[:, k])]
        axes.plot(found.lifts[k], row, "|", color=GREY, markersize=6.0)
        if values.size:
            axes.plot([values.min(), values.max()], [row, row], color=COLORS[0], linewidth=1.0)
            axes.plot(values.min(), row, "o", color=COLORS[0], markersize=3.0)
    axes.set_ylim(order.size - 0.5, -0.5)
    axes.set_xlabel("factor on the motion [-]")
    if order.size <= _MOST_NAMES:
        names = (found.motions[k].name for k in order)
        short = [plain(name if len(name) <= 34 else f"{name[:21]}...{name[-10:]}") for name in names]
        axes.set_yticks(range(order.size), short)
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{found.several}, the most dangerous first")
    plain_log(axes, "x")


def _methods(axes: "Axes", found: BodyAssessment, least: np.ndarray) -> None:
    axes.axvline(1.0, color="black", linestyle=DASHED, linewidth=0.8)
    ends = [1.0]
    for row, capacity in enumerate(found.capacities.values()):
        ratio = capacity / least
        ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
        axes.plot(ratio, np.full(ratio.size, row), "o", color=COLORS[5], markersize=3.0)
        ends += ratio.tolist()
    axes.axvspan(1.0, 1.5 * max(ends), color=PALE, linewidth=0.0, zorder=0)
    axes.set_xlim(min(ends) / 1.5, 1.5 * max(ends))
    axes.set_yticks(range(len(found.capacities)), list(found.capacities))
    axes.set_ylim(len(found.capacities) - 0.5, -0.5)
    axes.set_xlabel("allowed over overturning factor [-]")
    axes.set_title("shaded: unsafe", loc="right", fontsize=7.0)
    plain_log(axes, "x")
