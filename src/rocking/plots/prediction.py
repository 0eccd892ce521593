"""What is foreseen of a body, what decides it, whether it was right, and how far the body is from overturning."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.assessment import BodyAssessment
from rocking.conventions import percent
from rocking.plots.labels import plain, plain_log
from rocking.plots.style import (
    COLORS,
    DASHED,
    DOUBLE,
    GREY,
    INK,
    PALE,
    in_journal_style,
    legend_below,
    new_figure,
    patch,
    stroke,
)
from rocking.prediction import Prediction, Validation

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_NAMES = 12
_LOOKS = {"prediction": (COLORS[0], "o"), "logistic": (COLORS[1], "s")}
_MEASURES = {"brier": "Brier", "logarithmic": "logarithmic"}


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
        The motions from the most dangerous down with their intervals; beside them the contributions of inputs to the
        variance, where there are any.

    Raises
    ------
    InvalidValueError
        If it is no prediction.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.predict(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.3, 0.8), count=16)
    >>> [panel.get_xlabel() for panel in prediction_picture(found).axes]
    ['probability [-]', 'contribution to the variance of overturning [-]']
    """
    checks.of_kind("found", found, Prediction, "a Prediction")
    both = not found.decides
    figure, axes = new_figure(DOUBLE, 3.2, columns=2) if both else new_figure(DOUBLE, 3.2)
    _motions(axes[0], found)
    if both:
        _shares(axes[1], found)
    handles = [
        stroke("overturns, with its 95 % interval", color=COLORS[0], marker="o", linestyle="-", markersize=3.0),
        stroke("rocks", color=GREY, marker="|", linestyle="", markersize=6.0),
        patch(PALE, "overturns, all motions, 95 %"),
        *([patch(COLORS[0], "alone"), patch(COLORS[5], "together with the others")] if both else []),
    ]  # fmt: skip
    legend_below(figure, handles, len(handles))
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
        names = [found.motions[k].name for k in order]
        axes.set_yticks(rows, [plain(name if len(name) <= 34 else f"{name[:31]}...") for name in names])
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{order.size} motions, the most dangerous first")
    ends = f"{percent(round(chance.low, 3))} to {percent(round(chance.high, 3))}"
    axes.set_title(f"probability of overturning {percent(round(chance.value, 3))} ({ends})", loc="left", fontsize=7.5)


def _shares(axes: "Axes", found: Prediction) -> None:
    axes.set_xlabel("contribution to the variance of overturning [-]")
    named = sorted(found.contributions.items(), key=lambda pair: -pair[1].total)
    for row, (_, share) in enumerate(named):
        for offset, value, low, high, color in (
            (-0.18, share.first, share.first_low, share.first_high, COLORS[0]),
            (0.18, share.total, share.total_low, share.total_high, COLORS[5]),
        ):
            axes.barh(row + offset, max(value, 0.0), 0.34, color=color)
            axes.plot([max(low, 0.0), max(high, 0.0)], [row + offset] * 2, color="black", linewidth=0.8)
    axes.set_yticks(range(len(named)), ["motion" if name == "case" else name for name, _ in named])
    axes.set_xlim(0.0, 1.02)
    axes.set_ylim(len(named) - 0.5, -0.5)
    axes.set_title("contributions to the variance", loc="left", fontsize=7.5)


@in_journal_style
def reliability_picture(found: Validation) -> "Figure":
    """Draw the reliability diagram, and by how much the prediction is better than plain curves.

    Parameters
    ----------
    found : Validation
        As of `rocking.prediction.score`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: what happened over what was said, with the number of outcomes in each step; and
        the paired differences of scores with their intervals.

    Raises
    ------
    InvalidValueError
        If it is no validation.

    Examples
    --------
    >>> from rocking.prediction import score
    >>> pga = [1.0, 2.0, 3.0, 4.0]
    >>> found = score([0.1, 0.4, 0.7, 0.9], [0, 0, 1, 1], ["a", "a", "b", "b"], pga=pga, pgv=pga)
    >>> [panel.get_xlabel() for panel in reliability_picture(found).axes]
    ['probability that was given [-]', 'score is better by [-, nat]']
    """
    checks.of_kind("found", found, Validation, "a Validation")
    figure, axes = new_figure(DOUBLE, 3.4, columns=2)
    _reliability(axes[0], found)
    _differences(axes[1], found)
    handles = [
        stroke(
            f"{name}, with 95 % intervals", color=_LOOKS[name][0], marker=_LOOKS[name][1], linestyle="-", markersize=3.5
        )
        for name in _LOOKS
        if name in found.forecasts
    ]
    handles.append(stroke("right as often as it says", color=GREY, linestyle=DASHED))
    legend_below(figure, handles, 3)
    return figure


def _reliability(axes: "Axes", found: Validation) -> None:
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linestyle=DASHED, linewidth=0.8)
    for name, offset in (("logistic", 0.008), ("prediction", -0.008)):
        if name not in found.forecasts:
            continue
        color, mark = _LOOKS[name]
        steps = found.forecasts[name].reliability()
        said, seen, low, high = np.array([(s.predicted, s.observed, s.low, s.high) for s in steps]).T
        reach = np.maximum([seen - low, high - seen], 0.0)
        axes.errorbar(
            said + offset, seen, yerr=reach, fmt=mark, color=color, markersize=3.5, linewidth=0.8,
            alpha=1.0 if name == "prediction" else 0.6,
        )  # fmt: skip
        if name == "prediction":
            for k, step in enumerate(steps):  # on two lines, since neighbours may be close
                axes.annotate(
                    str(step.count), (step.predicted, 1.03), (0, 2 + 6 * (k % 2)), textcoords="offset points",
                    ha="center", fontsize=5.5, color=color,
                )  # fmt: skip
    axes.set_xlim(-0.03, 1.03)
    axes.set_ylim(-0.03, 1.03)
    axes.set_aspect("equal")
    axes.set_xlabel("probability that was given [-]")
    axes.set_ylabel("share that happened [-]")
    axes.set_title(f"{found.event}: {found.count} outcomes, {found.clusters} motions", loc="left", fontsize=7.5, pad=16)


def _differences(axes: "Axes", found: Validation) -> None:
    rows = [
        (f"{_MEASURES[measure]},\nagainst the {name}", each)
        for name, scores in found.differences.items()
        for measure, each in scores.items()
    ]
    axes.axvline(0.0, color=GREY, linewidth=0.8)
    for k, (_, each) in enumerate(rows):
        color = COLORS[0] if found.enough and each.resolved else GREY
        ends = np.array([each.low, each.value, each.high])
        if np.isfinite(ends).all():
            axes.plot(ends[[0, 2]], [k, k], color=color, linewidth=1.0)
        axes.plot(each.value, k, "o", color=color, markersize=4.0)
    axes.set_yticks(range(len(rows)), [label for label, _ in rows])
    axes.set_ylim(max(len(rows), 1) - 0.5, -0.5)
    axes.set_xlabel("score is better by [-, nat]")
    words = {"not resolved": "not resolved", "mixed": "better by one score, worse by another"}
    axes.set_title(words.get(found.finding, f"the prediction is {found.finding}"), loc="left", fontsize=7.5, pad=16)
    axes.grid(axis="x", color=PALE, linewidth=0.5)


_MOST_PARTS = 14


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
    least = np.array([np.fmin.reduce(each.min_factors_by_polarity) for each in found.models.values()])
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
        axes.plot(found.uplift_factors[k], row, "|", color=GREY, markersize=6.0)
        if values.size:
            axes.plot([values.min(), values.max()], [row, row], color=COLORS[0], linewidth=1.0)
            axes.plot(values.min(), row, "o", color=COLORS[0], markersize=3.0)
    axes.set_ylim(order.size - 0.5, -0.5)
    axes.set_xlabel("factor on the motion [-]")
    if order.size <= _MOST_PARTS:
        names = (found.motions[k].name for k in order)
        short = [plain(name if len(name) <= 34 else f"{name[:21]}...{name[-10:]}") for name in names]
        axes.set_yticks(range(order.size), short)
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{found.motion_count}, the most dangerous first")
    plain_log(axes, "x")


def _methods(axes: "Axes", found: BodyAssessment, least: np.ndarray) -> None:
    axes.axvline(1.0, color="black", linestyle=DASHED, linewidth=0.8)
    ends = [1.0]
    for row, (name, capacity) in enumerate(found.capacities.items()):
        ratio = capacity / least
        ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
        axes.plot(ratio, np.full(ratio.size, row), "o", color=COLORS[5], markersize=3.0)
        if not ratio.size:
            reason = "no factor overturns" if np.isfinite(capacity).any() else found.exclusion(name)
            layout: dict[str, Any] = {"transform": axes.get_yaxis_transform(), "ha": "left", "va": "center"}
            box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.8}
            axes.text(0.02, row, reason, fontsize=6.5, color=INK, bbox=box, **layout)
        ends += ratio.tolist()
    axes.axvspan(1.0, 1.5 * max(ends), color=PALE, linewidth=0.0, zorder=0)
    axes.set_xlim(min(ends) / 1.5, 1.5 * max(ends))
    axes.set_yticks(range(len(found.capacities)), list(found.capacities))
    axes.set_ylim(len(found.capacities) - 0.5, -0.5)
    axes.set_xlabel("allowed over overturning factor [-]")
    axes.set_title("shaded: unsafe", loc="right", fontsize=7.0)
    plain_log(axes, "x")
