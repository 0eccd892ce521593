"""A cloud analysis: the rotation of every motion over its measure, the line through them, and what overturned."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rocking.errors import InvalidValueError
from rocking.plots.study_words import PEAK, axis_label, plain_log, short_name
from rocking.plots.style import GREY, INK, SINGLE, in_journal_style, new_figure
from rocking.studies.fragility.cloud_analysis import CloudAnalysis, clearly_lifted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 4.0
_ROCKS, _FALLS, _BAND = "#0072B2", "#A8420A", "#D6E6F2"


@in_journal_style
def cloud_picture(analysis: CloudAnalysis) -> "Figure":
    r"""Draw a cloud analysis.

    Above: the peak rotation of every motion that rocked the body, clearly, and left it standing, over the measure; the
    straight line through the logarithms, with a band of one standard deviation (the efficiency of the measure). The
    axis begins below the least level that acts. Ticks at the top are motions that overturned the body, ticks at the
    bottom those that barely lifted it or did not. Below: the parts of the total probability, which add up to one.

    Parameters
    ----------
    analysis : CloudAnalysis
        As of `cloud`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over the measure, one column wide.

    Raises
    ------
    InvalidValueError
        If it is no cloud analysis, fewer than three motions rocked the body, or none or all overturned it.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility.cloud_analysis import cloud
    >>> pulses = [rk.pulses.sine(a, 0.6) for a in (2.0, 2.6, 2.8, 3.2, 3.0, 6.0, 2.9, 8.0)]
    >>> cloud_picture(cloud(rk.Block(width=0.4, height=1.6), pulses)).axes[1].get_xlabel()
    'peak ground acceleration [m/s$^2$]'
    """
    if not isinstance(analysis, CloudAnalysis):
        raise InvalidValueError(f"analysis must be of cloud, got {analysis!r:.60}")
    if not analysis.fits["overturned"].exists:
        raise InvalidValueError(f"there is no curve of overturning to draw: {analysis.fits['overturned'].verdict}")
    figure, (upper, lower) = new_figure(SINGLE, HEIGHT, rows=2, sharex=True, height_ratios=[1.5, 1.0])
    levels = analysis.motion_levels
    acted = (analysis.responses.overturned == 1.0) | clearly_lifted(analysis.responses, analysis.least)
    upper.set_xlim(levels[acted].min() / 1.5, levels.max() * 1.08)
    _points(upper, analysis)
    _parts(lower, analysis)
    plain_log(lower, "x")
    measure = analysis.subject.measure
    lower.set_xlabel(axis_label(measure.name, measure.unit, linear=analysis.subject.settings.linear))
    line, name = analysis.regression, short_name(measure.name)
    sign = "+" if line.slope >= 0.0 else "-"
    fitted = rf"{line.intercept:.2f} {sign} {abs(line.slope):.2f} $\ln$ {name}"
    words = rf"$\ln(\theta/\alpha)$ = {fitted}, scatter {line.scatter:.2f}"
    upper.set_title(words.replace("= -", "= \u2212"), loc="left", fontsize=7)
    return figure


def _points(axes: "Axes", analysis: CloudAnalysis) -> None:
    levels, responses, line = analysis.motion_levels, analysis.responses, analysis.regression
    rocked = clearly_lifted(responses, analysis.least)
    fine = np.geomspace(*axes.get_xlim(), 60)
    middle, spread = np.exp(line.at(np.log(fine))), math.exp(line.scatter)
    axes.fill_between(fine, middle / spread, middle * spread, color=_BAND, linewidth=0, zorder=0)
    axes.plot(fine, middle, color=INK, linewidth=1.0, label="line, and one standard deviation")
    shown = responses.rotation[rocked]
    axes.plot(
        levels[rocked],
        shown,
        "o",
        color=_ROCKS,
        markersize=2.6,
        markeredgewidth=0,
        label=f"rocks, stays standing: {int(rocked.sum())}",
    )
    axes.set_yscale("log")
    axes.set_ylim(0.7 * min(float(shown.min()), analysis.least), 2.2 * max(1.0, float(shown.max())))
    plain_log(axes, "y")
    axes.axhline(1.0, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)), zorder=0)
    over = responses.overturned == 1.0
    small = responses.good & ~over & ~rocked
    for chosen, height, color, words in (
        (over, 0.97, _FALLS, "overturned"), (small, 0.03, GREY, "barely lifted, or not"),
    ):  # fmt: skip
        axes.plot(
            levels[chosen],
            np.full(int(chosen.sum()), height),
            "|",
            color=color,
            markersize=6.0,
            transform=axes.get_xaxis_transform(),
            label=f"{words}: {int(chosen.sum())}",
            zorder=4,
        )
    axes.set_ylabel(PEAK)
    figure = axes.get_figure()
    assert figure is not None  # it has just been made
    figure.legend(
        *axes.get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize=6.5, handlelength=1.4
    )


def _parts(axes: "Axes", analysis: CloudAnalysis) -> None:
    """Draw what the total probability is made of, at the first rotation that counts as a state."""
    rotations = [state.level for state in analysis.states if analysis.least < state.level < math.inf]
    rotation = rotations[0] if rotations else 0.5
    fine = np.geomspace(*axes.get_xlim(), 200)
    parts = analysis.parts(fine, rotation)
    words = {
        "no rocking": "no rocking", "below": rf"$\theta \leq$ {rotation:g} $\alpha$",
        "exceeded": rf"$\theta >$ {rotation:g} $\alpha$, stands", "overturned": "overturned",
    }  # fmt: skip
    colors = ("#E3EDF5", "#7FB2D6", "#E69F00", "#7A2E00")
    order = ["overturned", "exceeded", "below", "no rocking"]
    axes.stackplot(
        fine, *(parts[name] for name in order), colors=colors[::-1], labels=[words[n] for n in order], linewidth=0
    )
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("probability [-]")
    axes.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=4,
        fontsize=6.5,
        handlelength=1.0,
        columnspacing=0.9,
        borderaxespad=0.2,
    )
