"""All models against all measurements, the league, and the calibrated default."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.evidence._league import LeagueRow
from rocking.evidence.calibration import CALIBRATED_RANGE, Calibration
from rocking.evidence.measurements import GROUPS, DataSet, datasets
from rocking.plots.curves import curve, points, slenderness_axis
from rocking.plots.style import DOUBLE, GREY, GROUP_STYLE, INK, PALE, in_journal_style, model_styles, new_figure
from rocking.restitution import model

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOW, _HIGH = 1.2, 10.5


@in_journal_style
def models_and_measurements(calibration: Calibration) -> "Figure":
    """Draw every model with all 39 measurements: r, and the energy loss, which tells slender bodies apart.

    Parameters
    ----------
    calibration : Calibration
        The calibrated default, drawn as a band.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels.
    """
    figure, (left, right) = new_figure(DOUBLE, 3.3, columns=2)
    band(left, calibration)
    for name in model_styles():
        curve(left, name, _LOW, _HIGH)
    for group in GROUPS:
        points(left, datasets()[group], group)
    slenderness_axis(left)
    left.set_ylabel("coefficient of restitution r [-]")
    left.set_ylim(0.45, 1.01)
    left.legend(loc="lower right", ncols=2, columnspacing=0.9, handlelength=2.6)
    _losses(right)
    return figure


@in_journal_style
def league_figure(rows: Sequence[LeagueRow]) -> "Figure":
    """Draw the error of every model with its bootstrap interval.

    Parameters
    ----------
    rows : sequence of LeagueRow
        The league, best first.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels: error of r, and by slenderness band.
    """
    figure, (left, right) = new_figure(DOUBLE, 0.9 + 0.19 * len(rows), columns=2, sharey=True)
    place = np.arange(len(rows))[::-1]
    for y, row in zip(place.tolist(), rows, strict=True):
        color = model_styles()[row.name]["color"] if row.name in ("ked", "housner") else INK
        left.plot([row.rmse_low, row.rmse_high], [y, y], color=color, linewidth=1.0)
        left.plot([row.rmse], [y], marker="o", color=color, markerfacecolor="white" if row.parameters else color)
    left.set_yticks(place, [f"{row.name}  {row.fitted}".strip() for row in rows])
    left.set_xlabel("RMSE of r, 39 measurements;\n95 % bootstrap interval; open: fitted [-]")
    left.set_xlim(left=0.0)
    markers = ("v", "o", "^")
    for marker, band_name in zip(markers, rows[0].by_band, strict=True):
        values = [row.by_band[band_name] for row in rows]
        right.plot(values, place, linestyle="none", marker=marker, color=INK, markerfacecolor="white", label=band_name)
    right.set_xscale("log")
    right.set_xlabel("RMSE of r by slenderness [-]")
    right.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, columnspacing=0.6, handletextpad=0.1)
    for axes in (left, right):
        axes.grid(axis="y", color=PALE, linewidth=0.5)
        axes.tick_params(axis="y", length=0)
    return figure


@in_journal_style
def calibration_figure(calibration: Calibration) -> "Figure":
    """Draw the posterior of eta and k, and the predictive band.

    Parameters
    ----------
    calibration : Calibration
        The calibrated default.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels.
    """
    figure, (left, right) = new_figure(DOUBLE, 3.0, columns=2, width_ratios=[1.0, 1.5])
    eta, k = calibration.marginals["eta"][0], calibration.marginals["k"][0]
    joint = calibration.joint / calibration.joint.max()
    left.contourf(eta, k, joint.T, levels=[0.01, 0.05, 0.15, 0.4, 0.7, 1.0], cmap="Blues")
    facts = calibration.summary
    left.plot([facts["eta"]["mean"]], [facts["k"]["mean"]], marker="+", color=INK, markersize=8)
    left.set_xlabel("interface factor η [-]")
    left.set_ylabel("impulse position k [-]")
    left.set_title("posterior, relative to its peak", loc="left")
    left.set_xlim(0.974, 0.996)
    left.set_ylim(0.42, 0.70)
    band(right, calibration)
    for group in GROUPS:
        points(right, datasets()[group], group)
    low, high = CALIBRATED_RANGE
    for edge in (low, high):
        right.axvline(edge, color=GREY, linewidth=0.6, linestyle=(0, (1, 2)))
    slenderness_axis(right)
    right.set_ylabel("coefficient of restitution r [-]")
    right.set_ylim(0.45, 1.01)
    right.legend(loc="lower right")
    return figure


def band(axes: "Axes", calibration: Calibration, low: float = _LOW, high: float = _HIGH) -> None:
    """Draw the calibrated default with its 95 % interval.

    low, high: range of h/b [-].
    """
    ratio = np.linspace(low, high, 80)
    prediction = calibration.predict(ratio)
    axes.fill_between(
        ratio, prediction.low, prediction.high, color=PALE, linewidth=0.0, zorder=0, label="calibrated, 95 %"
    )
    axes.plot(ratio, prediction.coefficient, color=GREY, linewidth=0.9, zorder=1)


def _losses(axes: "Axes") -> None:
    ratio = np.linspace(_LOW, _HIGH, 400)
    for name, look in model_styles().items():
        axes.plot(ratio, 1.0 - model(name).of_slenderness(ratio) ** 2, **{**look, "label": None})
    for group in GROUPS:
        _loss_points(axes, datasets()[group], group)
    axes.set_yscale("log")
    slenderness_axis(axes)
    axes.set_ylabel("energy loss $1 - r^2$ [-]")


def _loss_points(axes: "Axes", data: DataSet, group: str) -> None:
    loss = 1.0 - data.coefficient**2
    reach = np.array([loss - (1.0 - data.high**2), (1.0 - data.low**2) - loss])
    axes.errorbar(
        data.slenderness,
        loss,
        yerr=reach,
        linestyle="none",
        color=INK,
        markerfacecolor="white",
        markeredgewidth=0.7,
        elinewidth=0.6,
        marker=GROUP_STYLE[group]["marker"],
    )
