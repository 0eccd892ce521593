"""Pictures of cloud analyses (rotations over the measure, regression, overturning), and comparisons of measures."""

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
_LEAST = 1e-4  # smaller p-values are plotted at this value
_ABOVE: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "fontsize": 6.5, "borderaxespad": 0.2}


@in_journal_style
def cloud_picture(analysis: CloudAnalysis) -> "Figure":
    r"""Draw a cloud analysis.

    Above: peak rotation of motions with clear rocking and without overturning, over the measure. The regression line of
    the logarithms has a band of one standard deviation (the efficiency of the measure). Ticks at the top are motions
    with overturning, ticks at the bottom motions with slight or no uplift. Below: the contributions to the total
    probability, which add up to one.

    Parameters
    ----------
    analysis : CloudAnalysis
        Cloud analysis.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over the measure, one column wide.

    Raises
    ------
    InvalidValueError
        If the argument has another type, if fewer than three motions cause rocking, or if 0 or all cause overturning.

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
        raise InvalidValueError("the analysis has no curve of overturning: {reason}", reason=fit.verdict)
    figure, (upper, lower) = new_figure(SINGLE, 4.0, rows=2, sharex=True, height_ratios=[1.5, 1.0])
    levels = analysis.motion_levels
    acted = (analysis.responses.overturned == 1.0) | clearly_lifted(analysis.responses, analysis.min_rotation)
    upper.set_xlim(levels[acted].min() / 1.5, levels.max() * 1.08)
    _points(upper, analysis)
    _parts(lower, analysis)
    plain_log(lower, "x")
    measure = analysis.subject.measure
    lower.set_xlabel(axis_label(measure.name, measure.unit, linear=analysis.subject.settings.linear))
    line, name = analysis.regression, short_name(measure.name)
    sign = "+" if line.slope >= 0.0 else "-"
    fitted = rf"{line.intercept:.2f} {sign} {abs(line.slope):.2f} $\ln$ {name}"
    title = rf"$\ln(\theta/\alpha)$ = {fitted}, scatter {line.scatter:.2f}"
    upper.set_title(title.replace("= -", "= \u2212"), loc="left", fontsize=7)
    return figure


def _points(axes: "Axes", analysis: CloudAnalysis) -> None:
    levels, responses, line = analysis.motion_levels, analysis.responses, analysis.regression
    rocked = clearly_lifted(responses, analysis.min_rotation)
    fine = np.geomspace(*axes.get_xlim(), 60)
    middle, spread = np.exp(line.at(np.log(fine))), math.exp(line.scatter)
    axes.fill_between(fine, middle / spread, middle * spread, color=_BAND, linewidth=0, zorder=0)
    axes.plot(fine, middle, color=INK, linewidth=1.0, label="regression, one standard deviation")
    peaks = responses.rotation[rocked]
    label = f"rocks, does not overturn: {int(rocked.sum())}"
    axes.plot(levels[rocked], peaks, "o", color=_ROCKS, markersize=2.6, markeredgewidth=0, label=label)
    axes.set_yscale("log")
    axes.set_ylim(0.7 * min(float(peaks.min()), analysis.min_rotation), 2.2 * max(1.0, float(peaks.max())))
    plain_log(axes, "y")
    axes.axhline(1.0, color=GREY, linewidth=0.7, linestyle=DASHED, zorder=0)
    overturned = responses.overturned == 1.0
    barely_lifted = responses.good & ~overturned & ~rocked
    for selected, height, color, label_text in (
        (overturned, 0.97, _FALLS, "overturned"), (barely_lifted, 0.03, GREY, "slight or no uplift"),
    ):  # fmt: skip
        tick: dict[str, Any] = {"color": color, "markersize": 6.0, "transform": axes.get_xaxis_transform(), "zorder": 4}
        count = int(selected.sum())
        axes.plot(levels[selected], np.full(count, height), "|", label=f"{label_text}: {count}", **tick)
    axes.set_ylabel(PEAK)
    layout: dict[str, Any] = {"loc": "outside upper center", "ncols": 2, "fontsize": 6.5, "handlelength": 1.4}
    axes.figure.legend(*axes.get_legend_handles_labels(), **layout)


def _parts(axes: "Axes", analysis: CloudAnalysis) -> None:
    """Draw the contributions to the total probability, at the first limit state."""
    rotations = [state.level for state in analysis.limit_states if analysis.min_rotation < state.level < math.inf]
    rotation = rotations[0] if rotations else 0.5
    fine = np.geomspace(*axes.get_xlim(), 200)
    parts = analysis.parts(fine, rotation)
    label_of = {
        "no rocking": "no rocking", "below": rf"$\theta \leq$ {rotation:g} $\alpha$",
        "exceeded": rf"$\theta >$ {rotation:g} $\alpha$, no overturning", "overturned": "overturned",
    }  # fmt: skip
    colors = (STATES[-1], *STATES[2::-1])
    order = ["overturned", "exceeded", "below", "no rocking"]
    labels = [label_of[name] for name in order]
    axes.stackplot(fine, *(parts[name] for name in order), colors=colors, labels=labels, linewidth=0)
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("probability [-]")
    axes.legend(ncols=4, handlelength=1.0, columnspacing=0.9, **_ABOVE)


@in_journal_style
def measures_picture(comparison: MeasureComparison) -> "Figure":
    """Draw intensity measures, the most efficient at the top.

    Left: efficiency (scatter of the rotation about the regression) and dispersion of the curve of overturning; lower is
    better. Right, with metadata: p-values of the residuals over each column. Below 0.05, the measure is not sufficient
    with respect to the column.

    Parameters
    ----------
    comparison : MeasureComparison
        Result of `compare_measures`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel or two, one column wide.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility import compare_measures, fragility_analysis
    >>> pulses = [rk.pulses.sine(a, t) for a in (2.6, 3.0, 3.4) for t in (0.3, 0.4, 0.5)]
    >>> cloud = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, restitution=0.9, analysis="cloud")
    >>> comparison = compare_measures(cloud, ["pga", "pgv"])
    >>> sorted(label.get_text() for label in measures_picture(comparison).axes[0].get_yticklabels())
    ['PGA', 'PGV']
    """
    checks.of_kind("comparison", comparison, MeasureComparison, "of compare_measures")
    columns = list(comparison.scores[0].sufficiency)
    height = 1.25 + 0.19 * len(comparison.scores)
    figure, axes = new_figure(
        SINGLE, height, columns=2 if columns else 1, sharey=True, width_ratios=[1.15, 1.0] if columns else None
    )
    for panel in axes:
        for row in range(len(comparison.scores)):
            panel.axhline(row, color=PALE, linewidth=0.5, zorder=0)
        panel.tick_params(axis="y", length=0)
    _efficiency(axes[0], comparison)
    axes[0].set_yticks(range(len(comparison.scores)), [short_name(score.im) for score in comparison.scores])
    axes[0].set_ylim(len(comparison.scores) - 0.5, -0.5)
    if columns:
        _sufficiency(axes[1], comparison, columns)
    return figure


def _efficiency(axes: "Axes", comparison: MeasureComparison) -> None:
    rows = range(len(comparison.scores))
    efficiency = [score.efficiency for score in comparison.scores]
    dispersion = [score.overturning_dispersion for score in comparison.scores]
    hollow: dict[str, Any] = {"color": "#D96C00", "markerfacecolor": "white", "markersize": 4.0}
    axes.plot(efficiency, rows, "o", color=INK, markersize=4.0, label=r"efficiency, $\ln\,\theta$")
    axes.plot(dispersion, rows, "D", label=r"$\beta$ of overturning", **hollow)
    axes.set_xlim(0.0, 1.1 * max(value for value in efficiency + dispersion if math.isfinite(value)))
    axes.set_xlabel("dispersion [-]")
    axes.legend(handletextpad=0.2, **_ABOVE)


def _sufficiency(axes: "Axes", comparison: MeasureComparison, columns: list[str]) -> None:
    for index, name in enumerate(columns):
        values = [max(score.sufficiency[name], _LEAST) for score in comparison.scores]
        mark: dict[str, Any] = {
            "marker": MARKS[index % 5],
            "markersize": 3.6,
            "color": _COLORS[index % 5],
            "label": plain(name),
        }
        axes.plot(values, range(len(comparison.scores)), linestyle="none", **mark)
    axes.axvline(0.05, color=GREY, linewidth=0.8, linestyle=DASHED)
    axes.set_xlim(0.7 * _LEAST, 1.4)
    plain_log(axes, "x")
    axes.set_xticks([_LEAST, 0.05, 1.0], [rf"$\leq${_LEAST:g}", "0.05", "1"])
    axes.set_xlabel("p of sufficiency [-]")
    axes.legend(handletextpad=0.2, **_ABOVE)
