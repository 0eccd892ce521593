"""Incremental curves: how the rotation of each motion grows with its level, where it falls, where it stands again."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.plots.labels import PEAK, axis_label, geometric, plain_log
from rocking.plots.style import DASHED, GREY, INK, SINGLE, in_journal_style, legend_below, new_figure, stroke
from rocking.studies.fragility._incremental_dynamic_analysis import IncrementalDynamicAnalysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_CROSS, _FALLEN, _AGAIN = "#7A2E00", "#DDB7A0", "#0072B2"
_FRACTION: dict[str, Any] = {"color": INK, "linewidth": 1.2}
_PASSED: dict[str, Any] = {"color": _CROSS, "linewidth": 1.0, "linestyle": "--"}
WIDE = 0.01  # survivals of less width over their level are not counted: in them the body balances on its corner [-]
_OVER = 1.06  # larger rotations of bodies that stood all the same are drawn here
_FIRST, _LAST = 1.12, 1.72  # where the lanes of the motions begin and end, on the axis of rotation


@in_journal_style
def incremental_dynamic_analysis_picture(analysis: IncrementalDynamicAnalysis) -> "Figure":
    """Draw an incremental analysis, the measure upwards as is usual.

    Left: a grey curve for each motion up to where it first overturns the body; the levels above at which the body
    stands all the same (resurrection) are blue, joined where they are neighbours. Beside the curves each motion that
    overturns it has a lane, by first crossing: brown where it overturns the body, blue where that stands again.
    Right: the fraction of the motions that overturn it at each level, and the share whose first crossing has been
    passed.

    Parameters
    ----------
    analysis : IncrementalDynamicAnalysis
        As of `incremental_dynamic_analysis`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, one column wide.

    Raises
    ------
    InvalidValueError
        If it is no incremental analysis.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility._incremental_dynamic_analysis import incremental_dynamic_analysis
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.5, 0.7)]
    >>> found = incremental_dynamic_analysis(rk.Block(width=0.4, height=1.6), pulses, [3.0, 6.0, 9.0], restitution=0.9)
    >>> len(incremental_dynamic_analysis_picture(found).axes)
    2
    """
    checks.of_kind("analysis", analysis, IncrementalDynamicAnalysis, "incremental")
    figure, (left, right) = new_figure(SINGLE, 3.6, columns=2, sharey=True, width_ratios=[2.5, 1.0])
    for curve in analysis.curves:
        _curve(left, analysis.levels, curve)
    _crossings(left, analysis)
    known = np.sort(analysis.first_crossings[analysis.complete])
    if known.size:
        passed = np.searchsorted(known, analysis.levels, side="right") / known.size
        right.plot(passed, analysis.levels, **_PASSED)
    right.plot(analysis.fractions, analysis.levels, **_FRACTION)
    right.set(xlim=(-0.03, 1.03), xlabel="share\noverturned [-]")
    right.set_xticks([0.0, 0.5, 1.0], ["0", "0.5", "1"])
    measure = analysis.subject.measure
    left.set_ylabel(axis_label(measure.name, measure.unit, linear=analysis.subject.settings.linear))
    left.set_xlabel(PEAK, x=0.55 / (_LAST + 0.06))
    left.set(xlim=(-0.03, _LAST + 0.03), xticks=[0.0, 0.5, 1.0])
    left.axvline(1.0, color=GREY, linewidth=0.6, linestyle=DASHED, zorder=0)
    below: dict[str, Any] = {"transform": left.get_xaxis_transform(), "ha": "center", "va": "top", "fontsize": 7}
    left.text(0.5 * (_FIRST + _LAST), -0.045, "by motion", **below)
    low, high = float(analysis.levels[0]), float(analysis.levels[-1])
    left.set_ylim(low - 0.03 * (high - low), high + 0.03 * (high - low) or 1.1 * high)
    if geometric(analysis.levels) and high / low > 3.0:
        left.set_ylim(low / 1.04, 1.04 * high)
        plain_log(left, "y")
    _legend(figure, analysis)
    return figure


def _curve(axes: "Axes", levels: FloatArray, curve: FloatArray) -> None:
    """Draw one motion: grey up to its first overturning, blue where it stands again."""
    over = np.isinf(curve)
    first = int(np.argmax(over)) if over.any() else curve.size
    shown = np.where(np.isfinite(curve), np.minimum(curve, _OVER), math.nan)
    axes.plot(shown[:first], levels[:first], color=GREY, linewidth=0.6, alpha=0.8, zorder=1)
    if np.isfinite(curve[first:]).any():
        axes.plot(shown[first:], levels[first:], color=_AGAIN, linewidth=1.0, zorder=3, marker="o", markersize=1.6)


def _crossings(axes: "Axes", analysis: IncrementalDynamicAnalysis) -> None:
    """Give every motion that overturns the body a lane, and mark its first crossing there."""
    starts = analysis.first_crossings
    order = [k for k in np.argsort(starts).tolist() if math.isfinite(starts[k])]
    places = np.linspace(_FIRST, _LAST, 2 * len(order) + 1)[1::2]
    lane = dict(zip(order, places.tolist(), strict=True))
    width = min(3.0, max(0.4, 36.0 / max(1, len(order))))
    top = float(analysis.levels[-1])
    falls = [(lane[i.motion], i.start, min(i.end, top)) for i in analysis.intervals if i.motion in lane]
    stands = [(lane[motion], low, high) for motion, low, high in analysis.survivals if high - low > WIDE * low]
    for segments, color in ((falls, _FALLEN), (stands, _AGAIN)):
        x, low, high = np.array(segments).T if segments else np.empty((3, 0))
        axes.vlines(x, low, high, color=color, linewidth=width, zorder=2)
    axes.plot(places, starts[order], linestyle="none", marker="x", markersize=2.6, color=_CROSS, zorder=4)


def _legend(figure: "Figure", analysis: IncrementalDynamicAnalysis) -> None:
    count, again = int(analysis.complete.sum()), len(analysis.resurrected(WIDE))
    lane: dict[str, Any] = {"color": _FALLEN, "linewidth": 2.5, "markersize": 3.5, "markeredgecolor": _CROSS}
    ring: dict[str, Any] = {"color": _AGAIN, "linewidth": 1.0, "markersize": 3.0, "markerfacecolor": "white"}
    words = f"stands again: {again} motion{'s' * (again != 1)}"
    rows = [
        stroke(f"{count} motion{'s' * (count != 1)}", color=GREY, linewidth=0.8),
        stroke("overturns, x: first", marker="x", **lane),
        *([stroke(words, marker="o", **ring)] if again else []),
        stroke("fraction at the level", **_FRACTION),
        stroke("first crossing passed", **_PASSED),
    ]
    legend_below(figure, rows, 2, handlelength=1.8)
