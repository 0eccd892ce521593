"""Pictures of predictions, of contributions to the variance, of validations, and of margins to overturning."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import percent
from rocking.decision.assessment import BodyAssessment
from rocking.decision.prediction import Prediction, Validation
from rocking.decision.prediction.forecast import input_label
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

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_NAMES = 12
_LOOKS = {"prediction": (COLORS[0], "o"), "logistic": (COLORS[1], "s")}
_MEASURES = {"brier": "Brier", "logarithmic": "logarithmic"}


@in_journal_style
def prediction_picture(prediction: Prediction) -> "Figure":
    """Draw the probability of overturning under every motion, and contributions of the inputs to its variance.

    Parameters
    ----------
    prediction : Prediction
        Result of `rocking.decision.prediction.predict`.

    Returns
    -------
    matplotlib.figure.Figure
        Motions with their intervals, most dangerous first, and contributions of inputs to the variance, if any.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> prediction = rk.predict(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.4, 0.8), count=32)
    >>> [panel.get_xlabel() for panel in prediction_picture(prediction).axes]
    ['probability [-]', 'contribution to the variance of overturning [-]']
    """
    checks.of_kind("prediction", prediction, Prediction, "a Prediction")
    has_contributions = not prediction.decides
    figure, axes = new_figure(DOUBLE, 3.2, columns=2) if has_contributions else new_figure(DOUBLE, 3.2)
    _motions(axes[0], prediction)
    if has_contributions:
        _shares(axes[1], prediction)
    handles = [
        stroke("overturns, with its 95 % interval", color=COLORS[0], marker="o", linestyle="-", markersize=3.0),
        stroke("rocks", color=GREY, marker="|", linestyle="", markersize=6.0),
        patch(PALE, "overturns, all motions, 95 %"),
        *([patch(COLORS[0], "first order"), patch(COLORS[5], "total")] if has_contributions else []),
    ]  # fmt: skip
    legend_below(figure, handles, len(handles))
    return figure


def _motions(axes: "Axes", prediction: Prediction) -> None:
    chance = prediction.chances["overturning"]
    order = np.argsort(-np.nan_to_num(chance.per_motion), kind="stable")
    rows, probabilities = np.arange(order.size), chance.per_motion[order]
    axes.axvspan(chance.low, chance.high, color=PALE, linewidth=0.0)
    errors = [probabilities - chance.per_motion_low[order], chance.per_motion_high[order] - probabilities]
    axes.errorbar(
        probabilities, rows, xerr=np.maximum(errors, 0.0), fmt="o", color=COLORS[0], markersize=3.0, linewidth=0.8
    )
    axes.plot(prediction.chances["uplift"].per_motion[order], rows, "|", color=GREY, markersize=6.0)
    axes.set_ylim(order.size - 0.5, -0.5)
    axes.set_xlim(-0.02, 1.02)
    axes.set_xlabel("probability [-]")
    if order.size <= _MOST_NAMES:
        names = [prediction.motions[k].name for k in order]
        axes.set_yticks(rows, [plain(name if len(name) <= 34 else f"{name[:31]}...") for name in names])
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{order.size} motions, the most dangerous first")
    ends = f"{percent(round(chance.low, 3))} to {percent(round(chance.high, 3))}"
    axes.set_title(f"probability of overturning {percent(round(chance.value, 3))} ({ends})", loc="left", fontsize=7.5)


def _shares(axes: "Axes", prediction: Prediction) -> None:
    axes.set_xlabel("contribution to the variance of overturning [-]")
    ranked = sorted(prediction.contributions.items(), key=lambda pair: -pair[1].total)
    for row, (_, share) in enumerate(ranked):
        for offset, value, low, high, color in (
            (-0.18, share.first, share.first_low, share.first_high, COLORS[0]),
            (0.18, share.total, share.total_low, share.total_high, COLORS[5]),
        ):
            axes.barh(row + offset, max(value, 0.0), 0.34, color=color)
            axes.plot([max(low, 0.0), max(high, 0.0)], [row + offset] * 2, color="black", linewidth=0.8)
    axes.set_yticks(range(len(ranked)), [input_label(name) for name, _ in ranked])
    axes.set_xlim(0.0, 1.02)
    axes.set_ylim(len(ranked) - 0.5, -0.5)
    axes.set_title("contributions to the variance", loc="left", fontsize=7.5)


@in_journal_style
def reliability_picture(validation: Validation) -> "Figure":
    """Draw the reliability diagram, and differences of scores between prediction and reference curves.

    Parameters
    ----------
    validation : Validation
        Result of `rocking.decision.prediction.score`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: observed fraction over predicted probability, with the number of outcomes per
        bin; and the paired differences of scores with their intervals.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> from rocking.decision.prediction import score
    >>> pga = [1.0, 2.0, 3.0, 4.0]
    >>> validation = score([0.1, 0.4, 0.7, 0.9], [0, 0, 1, 1], ["a", "a", "b", "b"], pga=pga, pgv=pga)
    >>> [panel.get_xlabel() for panel in reliability_picture(validation).axes]
    ['predicted probability [-]', 'improvement of score [-, nat]']
    """
    checks.of_kind("validation", validation, Validation, "a Validation")
    figure, axes = new_figure(DOUBLE, 3.4, columns=2)
    _reliability(axes[0], validation)
    _differences(axes[1], validation)
    handles = [
        stroke(
            f"{name}, with 95 % intervals", color=_LOOKS[name][0], marker=_LOOKS[name][1], linestyle="-", markersize=3.5
        )
        for name in _LOOKS
        if name in validation.forecasts
    ]
    handles.append(stroke("perfect calibration", color=GREY, linestyle=DASHED))
    legend_below(figure, handles, 3)
    return figure


def _reliability(axes: "Axes", validation: Validation) -> None:
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linestyle=DASHED, linewidth=0.8)
    for name, offset in (("logistic", 0.008), ("prediction", -0.008)):
        if name not in validation.forecasts:
            continue
        color, mark = _LOOKS[name]
        steps = validation.forecasts[name].reliability()
        predicted, observed, low, high = np.array([(s.predicted, s.observed, s.low, s.high) for s in steps]).T
        errors = np.maximum([observed - low, high - observed], 0.0)
        axes.errorbar(
            predicted + offset, observed, yerr=errors, fmt=mark, color=color, markersize=3.5, linewidth=0.8,
            alpha=1.0 if name == "prediction" else 0.6,
        )  # fmt: skip
        if name == "prediction":
            for k, step in enumerate(steps):  # in two rows, because neighbours may be close
                axes.annotate(
                    str(step.count), (step.predicted, 1.03), (0, 2 + 6 * (k % 2)), textcoords="offset points",
                    ha="center", fontsize=5.5, color=color,
                )  # fmt: skip
    axes.set_xlim(-0.03, 1.03)
    axes.set_ylim(-0.03, 1.03)
    axes.set_aspect("equal")
    axes.set_xlabel("predicted probability [-]")
    axes.set_ylabel("observed fraction [-]")
    axes.set_title(
        f"{validation.event}: {validation.count} outcomes, {validation.clusters} motions",
        loc="left",
        fontsize=7.5,
        pad=16,
    )


def _differences(axes: "Axes", validation: Validation) -> None:
    rows = [
        (f"{_MEASURES[measure]},\ncompared with {name}", score)
        for name, scores in validation.differences.items()
        for measure, score in scores.items()
    ]
    axes.axvline(0.0, color=GREY, linewidth=0.8)
    for k, (_, score) in enumerate(rows):
        color = COLORS[0] if validation.enough and score.resolved else GREY
        ends = np.array([score.low, score.value, score.high])
        if np.isfinite(ends).all():
            axes.plot(ends[[0, 2]], [k, k], color=color, linewidth=1.0)
        axes.plot(score.value, k, "o", color=color, markersize=4.0)
    axes.set_yticks(range(len(rows)), [label for label, _ in rows])
    axes.set_ylim(max(len(rows), 1) - 0.5, -0.5)
    axes.set_xlabel("improvement of score [-, nat]")
    findings = {"not resolved": "not resolved", "mixed": "better by one score, worse by another"}
    axes.set_title(
        findings.get(validation.finding, f"the prediction is {validation.finding}"), loc="left", fontsize=7.5, pad=16
    )
    axes.grid(axis="x", color=PALE, linewidth=0.5)


_MOST_PARTS = 14


@in_journal_style
def assessment_picture(assessment: BodyAssessment) -> "Figure":
    """Draw the smallest overturning factor of every motion, and the limit factors of code methods relative to it.

    Parameters
    ----------
    assessment : BodyAssessment
        Result of `rocking.assess`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: motions, most dangerous first, and code methods.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> assessment = rk.assess(rk.Block(width=0.5, height=2.0), rk.pulses.sine(5.0, 0.8), [0.9], count=16)
    >>> [panel.get_xlabel() for panel in assessment_picture(assessment).axes]
    ['scale factor on the motion [-]', 'limit factor over overturning factor [-]']
    """
    checks.of_kind("assessment", assessment, BodyAssessment, "a BodyAssessment")
    figure, axes = new_figure(DOUBLE, 3.2, columns=2)
    min_factors = np.array([np.fmin.reduce(margin.min_factors_by_polarity) for margin in assessment.models.values()])
    min_factors = np.where(np.isnan(min_factors), np.inf, min_factors)
    _margins(axes[0], assessment, min_factors)
    _methods(axes[1], assessment, min_factors.min(axis=0))
    handles = [
        stroke("uplift", color=GREY, marker="|", linestyle="", markersize=6.0),
        stroke("overturning: range of the models", color=COLORS[0], marker="o", linestyle="-", markersize=3.0),
        stroke("each motion", color=COLORS[5], marker="o", linestyle="", markersize=3.0),
        stroke("as recorded; exact code method", color="black", linestyle=DASHED),
    ]
    legend_below(figure, handles, 4)
    return figure


def _margins(axes: "Axes", assessment: BodyAssessment, min_factors: np.ndarray) -> None:
    order = np.argsort(min_factors.min(axis=0), kind="stable")
    axes.axvline(1.0, color="black", linestyle=DASHED, linewidth=0.8)
    for row, k in enumerate(order.tolist()):
        values = min_factors[:, k][np.isfinite(min_factors[:, k])]
        axes.plot(assessment.uplift_factors[k], row, "|", color=GREY, markersize=6.0)
        if values.size:
            axes.plot([values.min(), values.max()], [row, row], color=COLORS[0], linewidth=1.0)
            axes.plot(values.min(), row, "o", color=COLORS[0], markersize=3.0)
    axes.set_ylim(order.size - 0.5, -0.5)
    axes.set_xlabel("scale factor on the motion [-]")
    if order.size <= _MOST_PARTS:
        names = (assessment.motions[k].name for k in order)
        short = [plain(name if len(name) <= 34 else f"{name[:21]}...{name[-10:]}") for name in names]
        axes.set_yticks(range(order.size), short)
    else:
        axes.set_yticks([])
        axes.set_ylabel(f"{assessment.motion_count}, the most dangerous first")
    plain_log(axes, "x")


def _methods(axes: "Axes", assessment: BodyAssessment, min_factors: np.ndarray) -> None:
    axes.axvline(1.0, color="black", linestyle=DASHED, linewidth=0.8)
    ends = [1.0]
    for row, (name, capacity) in enumerate(assessment.capacities.items()):
        ratio = capacity / min_factors
        ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
        axes.plot(ratio, np.full(ratio.size, row), "o", color=COLORS[5], markersize=3.0)
        if not ratio.size:
            reason = "no overturning factor" if np.isfinite(capacity).any() else assessment.exclusion(name)
            layout: dict[str, Any] = {"transform": axes.get_yaxis_transform(), "ha": "left", "va": "center"}
            box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.8}
            axes.text(0.02, row, reason, fontsize=6.5, color=INK, bbox=box, **layout)
        ends += ratio.tolist()
    axes.axvspan(1.0, 1.5 * max(ends), color=PALE, linewidth=0.0, zorder=0)
    axes.set_xlim(min(ends) / 1.5, 1.5 * max(ends))
    axes.set_yticks(range(len(assessment.capacities)), list(assessment.capacities))
    axes.set_ylim(len(assessment.capacities) - 0.5, -0.5)
    axes.set_xlabel("limit factor over overturning factor [-]")
    axes.set_title("shaded: unsafe", loc="right", fontsize=7.0)
    plain_log(axes, "x")
