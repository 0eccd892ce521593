"""Measures of intensity compared: how efficient each is, and what it leaves out."""

import math
from typing import TYPE_CHECKING

from rocking.errors import InvalidValueError
from rocking.plots.study_words import plain, plain_log, short_name
from rocking.plots.style import GREY, INK, PALE, SINGLE, in_journal_style, new_figure
from rocking.studies.fragility.measure_comparison import MeasureComparison

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKS, _COLORS = "osv^D", ("#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#0072B2")
_LEAST = 1e-4
"""Smaller p-values are drawn here."""


@in_journal_style
def measures_picture(found: MeasureComparison) -> "Figure":
    """Draw measures of intensity, the most efficient on top.

    Left: efficiency (scatter of the rotation about its line) and dispersion of the curve of overturning; the less, the
    better. Right, if there were metadata: p-values of the residuals over each column; below 0.05 the measure leaves
    out what the column knows.

    Parameters
    ----------
    found : MeasureComparison
        As of `compare_measures`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel or two, one column wide.

    Raises
    ------
    InvalidValueError
        If it is no comparison.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility.cloud_analysis import cloud
    >>> from rocking.studies.fragility.measure_comparison import compare_measures
    >>> pulses = [rk.pulses.sine(a, t) for a in (2.6, 3.0, 3.4) for t in (0.3, 0.4, 0.5)]
    >>> found = compare_measures(cloud(rk.Block(width=0.4, height=1.6), pulses, restitution=0.9), ["pga", "pgv"])
    >>> sorted(label.get_text() for label in measures_picture(found).axes[0].get_yticklabels())
    ['PGA', 'PGV']
    """
    if not isinstance(found, MeasureComparison):
        raise InvalidValueError(f"found must be of compare_measures, got {found!r:.60}")
    columns = list(found.scores[0].sufficiency)
    height = 1.25 + 0.19 * len(found.scores)
    figure, axes = new_figure(
        SINGLE, height, columns=2 if columns else 1, sharey=True, width_ratios=[1.15, 1.0] if columns else None
    )
    for panel in axes:
        for row in range(len(found.scores)):
            panel.axhline(row, color=PALE, linewidth=0.5, zorder=0)
        panel.tick_params(axis="y", length=0)
    _efficiency(axes[0], found)
    axes[0].set_yticks(range(len(found.scores)), [short_name(score.measure) for score in found.scores])
    axes[0].set_ylim(len(found.scores) - 0.5, -0.5)
    if columns:
        _sufficiency(axes[1], found, columns)
    return figure


def _efficiency(axes: "Axes", found: MeasureComparison) -> None:
    rows = range(len(found.scores))
    axes.plot(
        [s.efficiency for s in found.scores], rows, "o", color=INK, markersize=4.0, label=r"efficiency, $\ln\,\theta$"
    )
    axes.plot(
        [s.overturning_dispersion for s in found.scores], rows, "D", color="#D55E00", markerfacecolor="white",
        markersize=4.0, label=r"$\beta$ of overturning",
    )  # fmt: skip
    values = [v for s in found.scores for v in (s.efficiency, s.overturning_dispersion) if math.isfinite(v)]
    axes.set_xlim(0.0, 1.1 * max(values))
    axes.set_xlabel("dispersion [-]")
    axes.legend(
        loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=1, fontsize=6.5, handletextpad=0.2, borderaxespad=0.2
    )


def _sufficiency(axes: "Axes", found: MeasureComparison, columns: list[str]) -> None:
    for place, name in enumerate(columns):
        values = [max(score.sufficiency[name], _LEAST) for score in found.scores]
        axes.plot(
            values, range(len(found.scores)), linestyle="none", marker=_MARKS[place % 5], markersize=3.6,
            color=_COLORS[place % 5], label=plain(name),
        )  # fmt: skip
    axes.axvline(0.05, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)))
    axes.set_xlim(0.7 * _LEAST, 1.4)
    plain_log(axes, "x")
    axes.set_xticks([_LEAST, 0.05, 1.0], [rf"$\leq${_LEAST:g}", "0.05", "1"])
    axes.set_xlabel("p of sufficiency [-]")
    axes.legend(
        loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=1, fontsize=6.5, handletextpad=0.2, borderaxespad=0.2
    )
