"""Cloud analyses: rotations over the measure, the line through them, what overturned; and which measure serves best."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.plots.fragility import STATES
from rocking.plots.labels import PEAK, axis_label, plain, plain_log, short_name
from rocking.plots.style import DASHED, GREY, INK, MARKS, PALE, SINGLE, in_journal_style, new_figure
from rocking.studies.fragility.cloud_analysis import CloudAnalysis, clearly_lifted
from rocking.studies.fragility.measure_comparison import MeasureComparison

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROCKS, _FALLS, _BAND = "#0070B2", "#A8420A", "#D6E6F2"

_COLORS = ("#009960", "#AC8191", "#008FE6", "#AC5B2B", "#0070B2")
_LEAST = 1e-4  # smaller p-values are drawn here
_ABOVE: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "fontsize": 6.5, "borderaxespad": 0.2}


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
    >>> from rocking.studies.fragility import fragility_analysis
    >>> pulses = [rk.pulses.sine(a, 0.6) for a in (2.0, 2.6, 2.8, 3.2, 3.0, 6.0, 2.9, 8.0)]
    >>> cloud = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, analysis="cloud")
    >>> cloud_picture(cloud).axes[1].get_xlabel()
    'peak ground acceleration [m/s$^2$]'
    """
    checks.of_kind("analysis", analysis, CloudAnalysis, "of a cloud")
    if not (fit := analysis.fit_of("overturning")).exists:
        raise InvalidValueError("there is no curve of overturning to draw: {reason}", reason=fit.verdict)
    figure, (upper, lower) = new_figure(SINGLE, 4.0, rows=2, sharex=True, height_ratios=[1.5, 1.0])
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
    label = f"rocks, stays standing: {int(rocked.sum())}"
    axes.plot(levels[rocked], shown, "o", color=_ROCKS, markersize=2.6, markeredgewidth=0, label=label)
    axes.set_yscale("log")
    axes.set_ylim(0.7 * min(float(shown.min()), analysis.least), 2.2 * max(1.0, float(shown.max())))
    plain_log(axes, "y")
    axes.axhline(1.0, color=GREY, linewidth=0.7, linestyle=DASHED, zorder=0)
    over = responses.overturned == 1.0
    small = responses.good & ~over & ~rocked
    for chosen, height, color, words in (
        (over, 0.97, _FALLS, "overturned"), (small, 0.03, GREY, "barely lifted, or not"),
    ):  # fmt: skip
        tick: dict[str, Any] = {"color": color, "markersize": 6.0, "transform": axes.get_xaxis_transform(), "zorder": 4}
        count = int(chosen.sum())
        axes.plot(levels[chosen], np.full(count, height), "|", label=f"{words}: {count}", **tick)
    axes.set_ylabel(PEAK)
    place: dict[str, Any] = {"loc": "outside upper center", "ncols": 2, "fontsize": 6.5, "handlelength": 1.4}
    axes.figure.legend(*axes.get_legend_handles_labels(), **place)


def _parts(axes: "Axes", analysis: CloudAnalysis) -> None:
    """Draw what the total probability is made of, at the first rotation that counts as a state."""
    rotations = [state.level for state in analysis.limit_states if analysis.least < state.level < math.inf]
    rotation = rotations[0] if rotations else 0.5
    fine = np.geomspace(*axes.get_xlim(), 200)
    parts = analysis.parts(fine, rotation)
    words = {
        "no rocking": "no rocking", "below": rf"$\theta \leq$ {rotation:g} $\alpha$",
        "exceeded": rf"$\theta >$ {rotation:g} $\alpha$, stands", "overturned": "overturned",
    }  # fmt: skip
    colors = (STATES[-1], *STATES[2::-1])
    order = ["overturned", "exceeded", "below", "no rocking"]
    labels = [words[name] for name in order]
    axes.stackplot(fine, *(parts[name] for name in order), colors=colors, labels=labels, linewidth=0)
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("probability [-]")
    axes.legend(ncols=4, handlelength=1.0, columnspacing=0.9, **_ABOVE)


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
    >>> from rocking.studies.fragility import compare_measures, fragility_analysis
    >>> pulses = [rk.pulses.sine(a, t) for a in (2.6, 3.0, 3.4) for t in (0.3, 0.4, 0.5)]
    >>> cloud = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, restitution=0.9, analysis="cloud")
    >>> found = compare_measures(cloud, ["pga", "pgv"])
    >>> sorted(label.get_text() for label in measures_picture(found).axes[0].get_yticklabels())
    ['PGA', 'PGV']
    """
    checks.of_kind("found", found, MeasureComparison, "of compare_measures")
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
    axes[0].set_yticks(range(len(found.scores)), [short_name(score.im) for score in found.scores])
    axes[0].set_ylim(len(found.scores) - 0.5, -0.5)
    if columns:
        _sufficiency(axes[1], found, columns)
    return figure


def _efficiency(axes: "Axes", found: MeasureComparison) -> None:
    rows = range(len(found.scores))
    efficiency = [score.efficiency for score in found.scores]
    dispersion = [score.overturning_dispersion for score in found.scores]
    hollow: dict[str, Any] = {"color": "#D96C00", "markerfacecolor": "white", "markersize": 4.0}
    axes.plot(efficiency, rows, "o", color=INK, markersize=4.0, label=r"efficiency, $\ln\,\theta$")
    axes.plot(dispersion, rows, "D", label=r"$\beta$ of overturning", **hollow)
    axes.set_xlim(0.0, 1.1 * max(value for value in efficiency + dispersion if math.isfinite(value)))
    axes.set_xlabel("dispersion [-]")
    axes.legend(handletextpad=0.2, **_ABOVE)


def _sufficiency(axes: "Axes", found: MeasureComparison, columns: list[str]) -> None:
    for place, name in enumerate(columns):
        values = [max(score.sufficiency[name], _LEAST) for score in found.scores]
        mark: dict[str, Any] = {
            "marker": MARKS[place % 5],
            "markersize": 3.6,
            "color": _COLORS[place % 5],
            "label": plain(name),
        }
        axes.plot(values, range(len(found.scores)), linestyle="none", **mark)
    axes.axvline(0.05, color=GREY, linewidth=0.8, linestyle=DASHED)
    axes.set_xlim(0.7 * _LEAST, 1.4)
    plain_log(axes, "x")
    axes.set_xticks([_LEAST, 0.05, 1.0], [rf"$\leq${_LEAST:g}", "0.05", "1"])
    axes.set_xlabel("p of sufficiency [-]")
    axes.legend(handletextpad=0.2, **_ABOVE)
