"""Pictures of measurements and models: all models, ranking of models, calibration, contact bed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.evidence._league import LeagueRow
from rocking.evidence.bed_fit import Explanation, bed_coefficients
from rocking.evidence.calibration import CALIBRATED_RANGE, Calibration
from rocking.evidence.hierarchy import calibrate_hierarchy
from rocking.evidence.measurements import GROUPS, DataSet, all_measurements, datasets
from rocking.plots.style import DOUBLE, GREY, INK, PALE, in_journal_style, model_styles, new_figure
from rocking.restitution import model
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

R, SLENDERNESS = "coefficient of restitution r [-]", "slenderness ratio h/b [-]"

GROUP_STYLE: dict[str, dict[str, Any]] = {
    "table1": {"marker": "s", "label": "Kalliontzis 2016"},
    "S": {"marker": "v", "label": "Čeh 2018, block S"},
    "M": {"marker": "o", "label": "Čeh 2018, block M"},
    "L": {"marker": "^", "label": "Čeh 2018, block L"},
}

HOLLOW: dict[str, Any] = {"linestyle": "none", "color": INK, "markerfacecolor": "white"}

_LOW, _HIGH = 1.2, 10.5


def draw_model(axes: "Axes", name: str, low: float = _LOW, high: float = _HIGH) -> None:
    """Draw a model's coefficient over a range of slenderness [-]."""
    ratio = np.linspace(low, high, 400)
    axes.plot(ratio, model(name).of_slenderness(ratio), **model_styles()[name])


def draw_measurements(axes: "Axes", every: DataSet, *, loss: bool = False) -> None:
    """Draw measured coefficients or energy losses over slenderness, with intervals that represent rounding."""
    for group in dict.fromkeys(every.group):
        data = every.rows([name == group for name in every.group])
        style = GROUP_STYLE.get(group, {"marker": "D", "label": group})
        look = {"marker": style["marker"]} if loss else style
        low, value, high = data.low, data.coefficient, data.high
        if loss:
            low, value, high = 1.0 - high**2, 1.0 - value**2, 1.0 - low**2
        bar: dict[str, Any] = {"yerr": np.array([value - low, high - value]), "markeredgewidth": 0.7}
        axes.errorbar(data.slenderness, value, elinewidth=0.6, **bar, **HOLLOW, **look)
    axes.set(xlabel=SLENDERNESS, ylabel="energy loss $1 - r^2$ [-]" if loss else R)


def draw_calibrated(
    axes: "Axes", calibration: Calibration | None = None, low: float = _LOW, high: float = _HIGH
) -> None:
    """Draw the calibrated default over a range of slenderness [-], with its 95 % interval."""
    ratio = np.linspace(low, high, 80)
    prediction = (calibration or calibrate_hierarchy()).predict(ratio)
    look: dict[str, Any] = {"color": PALE, "linewidth": 0.0, "zorder": 0, "label": "calibrated, 95 %"}
    axes.fill_between(ratio, prediction.low, prediction.high, **look)
    axes.plot(ratio, prediction.coefficient, color=GREY, linewidth=0.9, zorder=1)


@in_journal_style
def models_and_measurements(calibration: Calibration, data: DataSet) -> "Figure":
    """Draw all models and measurements: r, and the energy loss, in which slender bodies are easier to distinguish."""
    figure, (left, right) = new_figure(DOUBLE, 3.3, columns=2)
    draw_calibrated(left, calibration)
    for name in model_styles():
        draw_model(left, name)
    draw_measurements(left, data)
    left.set_ylim(0.45, 1.01)
    left.legend(loc="lower right", ncols=2, columnspacing=0.9, handlelength=2.6)
    ratio = np.linspace(_LOW, _HIGH, 400)
    for name, look in model_styles().items():
        right.plot(ratio, 1.0 - model(name).of_slenderness(ratio) ** 2, **{**look, "label": None})
    draw_measurements(right, data, loss=True)
    right.set_yscale("log")
    return figure


@in_journal_style
def league_figure(rows: Sequence[LeagueRow], count: int) -> "Figure":
    """Draw the errors of the models with bootstrap intervals, and by slenderness band. The best model is first."""
    figure, (left, right) = new_figure(DOUBLE, 0.9 + 0.19 * len(rows), columns=2, sharey=True)
    rows_y = np.arange(len(rows))[::-1]
    for y, row in zip(rows_y.tolist(), rows, strict=True):
        color = model_styles()[row.name]["color"] if row.name in ("ked", "housner") else INK
        left.plot([row.rmse_low, row.rmse_high], [y, y], color=color, linewidth=1.0)
        left.plot([row.rmse], [y], marker="o", color=color, markerfacecolor="white" if row.parameters else color)
    left.set_yticks(rows_y, [f"{row.name}  {row.fitted}".strip() for row in rows])
    left.set_xlabel(f"RMSE of r, {count} measurements;\n95 % bootstrap interval; open: fitted [-]")
    left.set_xlim(left=0.0)
    for marker, band in zip(("v", "o", "^"), rows[0].by_band, strict=True):
        right.plot([row.by_band[band] for row in rows], rows_y, marker=marker, label=band, **HOLLOW)
    right.set_xscale("log")
    right.set_xlabel("RMSE of r,\nby slenderness [-]")
    right.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, columnspacing=0.6, handletextpad=0.1)
    for axes in (left, right):
        axes.grid(axis="y", color=PALE, linewidth=0.5)
        axes.tick_params(axis="y", length=0)
    return figure


@in_journal_style
def calibration_figure(calibration: Calibration, data: DataSet) -> "Figure":
    """Draw the posterior of eta and k, and the predictive band."""
    figure, (left, right) = new_figure(DOUBLE, 3.0, columns=2, width_ratios=[1.0, 1.5])
    eta, k = calibration.marginals["eta"][0], calibration.marginals["k"][0]
    joint = calibration.joint / calibration.joint.max()
    left.contourf(eta, k, joint.T, levels=[0.01, 0.05, 0.15, 0.4, 0.7, 1.0], cmap="Blues")
    summary = calibration.summary
    left.plot([summary["eta"]["mean"]], [summary["k"]["mean"]], marker="+", color=INK, markersize=8)
    left.set(xlabel="interface factor η [-]", ylabel="impulse position k [-]", xlim=(0.974, 0.996), ylim=(0.42, 0.70))
    left.set_title("posterior, relative to its peak", loc="left")
    draw_calibrated(right, calibration)
    draw_measurements(right, data)
    for edge in CALIBRATED_RANGE:
        right.axvline(edge, color=GREY, linewidth=0.6, linestyle=(0, (1, 2)))
    right.set_ylim(0.45, 1.01)
    right.legend(loc="lower right")
    return figure


@in_journal_style
def bed_dependence_figure() -> "Figure":
    """Draw r of the contact bed over slenderness by number of points, and at h/b = 2 over hardness and damping."""
    figure, (left, middle, right) = new_figure(DOUBLE, 2.8, columns=3)
    ratios, two = np.linspace(1.0, 10.0, 91), np.array([2.0])
    hardness, damping = np.geomspace(*HARDNESS, 61), np.geomspace(0.5, DAMPING[1], 41)
    for line, points in zip(("--", (0, (6, 2)), "-.", ":", "-"), POINTS, strict=True):
        style: dict[str, Any] = {"color": INK, "linestyle": line, "label": f"{points} points"}
        left.plot(ratios, bed_coefficients(ratios, points, 1.0, 100.0), **style)
        middle.plot(hardness, [bed_coefficients(two, points, 1.0, value)[0] for value in hardness], **style)
        right.plot(damping, [bed_coefficients(two, points, value, 100.0)[0] for value in damping], **style)
    for group in GROUPS:
        data = datasets()[group]
        left.plot(data.slenderness, data.coefficient, **{**HOLLOW, "color": GREY}, marker=GROUP_STYLE[group]["marker"])
    left.set(xlabel=SLENDERNESS, ylabel=R)
    left.legend(loc="lower right")
    middle.set_xscale("log")
    middle.set_xlabel("hardness, at h/b = 2, damping 1 [-]")
    right.set_xlabel("damping ratio, at h/b = 2 [-]")
    return figure


@in_journal_style
def explanations_figure(explanation: Explanation) -> "Figure":
    """Draw the BIC relative to the best model, and the left-out score relative to one bed with two standard errors."""
    ranked = explanation.ranked
    figure, (left, right) = new_figure(DOUBLE, 0.9 + 0.2 * len(ranked), columns=2, sharey=True)
    rows_y = np.arange(len(ranked))[::-1]
    left.barh(rows_y, [item.behind for item in ranked], color=PALE, edgecolor=INK, linewidth=0.6)
    left.set_yticks(rows_y, [item.name for item in ranked])
    left.set_xlabel("BIC minus the best [-]")
    for y, item in zip(rows_y.tolist(), ranked, strict=True):
        right.plot([item.gain - 2.0 * item.gain_error, item.gain + 2.0 * item.gain_error], [y, y], color=INK)
        right.plot([item.gain], [y], marker="o", color=INK)
    right.axvline(0.0, color=GREY, linewidth=0.6)
    right.set_xlabel("left-out score minus one bed [-]")
    return figure


@in_journal_style
def residuals_figure(explanation: Explanation) -> "Figure":
    """Draw the residuals of one bed and of the best explanation over slenderness."""
    figure, (left, right) = new_figure(DOUBLE, 2.8, columns=2, sharey=True)
    data = all_measurements()
    for axes, item in ((left, explanation.plain), (right, explanation.ranked[0])):
        axes.axhline(0.0, color=GREY, linewidth=0.6)
        residual = item.fit.predicted - data.coefficient
        for group in GROUPS:
            rows = np.array([name == group for name in data.group])
            axes.plot(data.slenderness[rows], residual[rows], **HOLLOW, **GROUP_STYLE[group])
        axes.set_title(item.name, loc="left")
        axes.set_xlabel(SLENDERNESS)
    left.set_ylabel("bed minus experiment, r [-]")
    left.legend(loc="lower right")
    return figure
