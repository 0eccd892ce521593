"""Pictures of the impact laboratory: what the emergent coefficient depends on, and what explains the measurements."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.bed_physics import bed_coefficients
from rocking.evidence.explanation import Explanation
from rocking.evidence.measurements import GROUPS, all_measurements, datasets
from rocking.plots.style import DOUBLE, GREY, GROUP_STYLE, INK, PALE, in_journal_style, new_figure
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINES = ("--", (0, (6, 2)), "-.", ":", "-")


@in_journal_style
def bed_dependence_figure() -> "Figure":
    """Draw r of the contact bed against slenderness by points, and at h/b = 2 against hardness and damping."""
    figure, (left, middle, right) = new_figure(DOUBLE, 2.8, columns=3)
    ratios, two = np.linspace(1.0, 10.0, 91), np.array([2.0])
    hardness, damping = np.geomspace(*HARDNESS, 61), np.geomspace(0.5, DAMPING[1], 41)
    for line, points in zip(_LINES, POINTS, strict=True):
        style: dict[str, Any] = {"color": INK, "linestyle": line, "label": f"{points} points"}
        left.plot(ratios, bed_coefficients(ratios, points, 1.0, 100.0), **style)
        middle.plot(hardness, [bed_coefficients(two, points, 1.0, value)[0] for value in hardness], **style)
        right.plot(damping, [bed_coefficients(two, points, value, 100.0)[0] for value in damping], **style)
    for group in GROUPS:
        data = datasets()[group]
        left.plot(data.slenderness, data.coefficient, color=GREY, linestyle="none", **_hollow(group))
    left.set_xlabel("slenderness ratio h/b [-]")
    left.set_ylabel("coefficient of restitution r [-]")
    left.legend(loc="lower right")
    middle.set_xscale("log")
    middle.set_xlabel("hardness, at h/b = 2, damping 1 [-]")
    right.set_xlabel("damping ratio, at h/b = 2 [-]")
    return figure


@in_journal_style
def explanations_figure(found: Explanation) -> "Figure":
    """Draw how the explanations fare: BIC above the best, and the left-out score above that of one bed.

    Lines reach two standard errors to either side.
    """
    figure, (left, right) = new_figure(DOUBLE, 0.9 + 0.2 * len(found.ranked), columns=2, sharey=True)
    place = np.arange(len(found.ranked))[::-1]
    left.barh(place, [each.behind for each in found.ranked], color=PALE, edgecolor=INK, linewidth=0.6)
    left.set_yticks(place, [each.name for each in found.ranked])
    left.set_xlabel("BIC above the best [-]")
    for y, each in zip(place.tolist(), found.ranked, strict=True):
        right.plot([each.gain - 2.0 * each.gain_error, each.gain + 2.0 * each.gain_error], [y, y], color=INK)
        right.plot([each.gain], [y], marker="o", color=INK)
    right.axvline(0.0, color=GREY, linewidth=0.6)
    right.set_xlabel("left-out score above one bed [-]")
    return figure


@in_journal_style
def residuals_figure(found: Explanation) -> "Figure":
    """Draw what one bed and the best explanation leave over, against slenderness."""
    figure, (left, right) = new_figure(DOUBLE, 2.8, columns=2, sharey=True)
    for axes, each in ((left, found.plain), (right, found.ranked[0])):
        _residuals(axes, each.fit.predicted)
        axes.set_title(each.name, loc="left")
        axes.set_xlabel("slenderness ratio h/b [-]")
    left.set_ylabel("bed minus experiment, r [-]")
    left.legend(loc="lower right")
    return figure


def _residuals(axes: "Axes", predicted: FloatArray) -> None:
    data = all_measurements()
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for group in GROUPS:
        rows = np.array([name == group for name in data.group])
        label = str(GROUP_STYLE[group]["label"])
        over = predicted[rows] - data.coefficient[rows]
        axes.plot(data.slenderness[rows], over, color=INK, linestyle="none", label=label, **_hollow(group))


def _hollow(group: str) -> dict[str, Any]:
    return {"marker": str(GROUP_STYLE[group]["marker"]), "markerfacecolor": "white"}
