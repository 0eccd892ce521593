"""Pictures of identifications: measurement, fit, and coefficient of restitution compared with models."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FEET, opposite
from rocking.identification import Identification, ImpactTimes
from rocking.plots.labels import plain
from rocking.plots.style import (
    COLORS,
    DOUBLE,
    GREY,
    INK,
    PALE,
    in_journal_style,
    legend_below,
    model_styles,
    new_figure,
    patch,
    stroke,
)
from rocking.spec.identification import IdentifiedTrials

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOOKS = {"left": (COLORS[1], "<"), "right": (COLORS[0], ">")}
_UNITS = {"rotation": "rad", "angular_velocity": "rad/s"}
_MOST_NAMES, _GAP = 30, 5.0
_R = "coefficient of restitution r [-]"


@in_journal_style
def identification_picture(identification: Identification) -> "Figure":
    """Draw the measurement and its fit, residuals, coefficients of the impacts, and restitution models.

    Parameters
    ----------
    identification : Identification
        Result of `rocking.identification.identify`. For a refused identification, only the measurement is plotted.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.identification import ImpactTimes, identify
    >>> times = [0.0, 1.2158, 2.2432, 3.1403, 3.9387, 4.6583, 5.3126, 5.9119, 6.4634]
    >>> identification = identify(ImpactTimes(times), rk.Block(width=1.0, height=4.0))
    >>> [panel.get_xlabel() for panel in identification_picture(identification).axes]
    ['', 'coefficient of restitution r [-]', 'time [s]', 'impact']
    """
    checks.of_kind("identification", identification, Identification, "an Identification")
    figure, axes = new_figure(DOUBLE, 4.6, rows=2, columns=2, width_ratios=(1.3, 1.0))
    axes[0].sharex(axes[2])
    axes[0].tick_params(labelbottom=False)
    axes[0].set_title(plain(identification.source) or "measured", loc="left", fontsize=7.5)
    if isinstance(identification.measurement, ImpactTimes):
        _heard(axes[0], identification, identification.measurement)
    else:
        _turned(axes[0], identification)
    for impact in identification.impacts:
        axes[0].axvline(impact.time, color=_LOOKS[impact.foot][0], linewidth=0.6)
    _residuals(axes[2], identification)
    for axis, label in zip(axes[1:], (_R, "time [s]", "impact"), strict=True):
        axis.set_xlabel(label)
    if identification.refused:
        axes[1].set_title("refused: no coefficient", loc="left", fontsize=7.5)
        for axis in (axes[1], axes[3]):  # readers could mistake empty scales for results
            axis.set_axis_off()
    else:
        _posterior(axes[1], identification)
        _impacts(axes[3], identification)
    handles: list[Any] = [
        stroke(f"landing {foot}", color=c, marker=m, linestyle="-") for foot, (c, m) in _LOOKS.items()
    ]
    handles += [stroke("detection without impact", color=GREY, marker="x", linestyle="")]
    handles += [stroke("fitted", color=INK), patch(PALE, "95 % interval")]
    legend_below(figure, handles, 5)
    return figure


def _heard(axes: "Axes", identification: Identification, measurement: ImpactTimes) -> None:
    """Draw the sound, if any, and detections that are not impacts. The caller draws the lines of impacts."""
    axes.set_ylim(0.0, 1.1)
    axes.set_yticks([])
    axes.set_ylabel("impacts heard" if measurement.loudness is None else "loudness [-]")
    if measurement.loudness is not None:
        axes.fill_between(*measurement.loudness.T, color=GREY, linewidth=0.0)
        axes.set_xlim(0.0, float(measurement.loudness[-1, 0]))
    if identification.impacts:  # only the times of the first and the last impact are known
        ends = zip(
            identification.residual_times[[0, -1]], (identification.impacts[0], identification.impacts[-1]), strict=True
        )
        for time, neighbour in ends:
            axes.axvline(time, color=_LOOKS[opposite(neighbour.foot)][0], linewidth=0.6)
    other_times = np.setdiff1d(measurement.times, identification.residual_times)
    axes.plot(other_times, np.full(other_times.size, 1.04), "x", color=GREY)


def _turned(axes: "Axes", identification: Identification) -> None:
    name = _quantity(identification)
    time, values = identification.measurement.time, getattr(identification.measurement, name)  # type: ignore[union-attr]
    axes.plot(time, values, ".", color=GREY, markersize=2.0)
    # the first of two quantities is plotted
    count = int(np.argmax(np.append(np.diff(identification.residual_times) < 0.0, True))) + 1
    fit_times = identification.residual_times[:count]
    fit = np.interp(fit_times, time, values) - identification.residuals[:count]
    fit[np.append(np.diff(fit_times) > _GAP * np.median(np.diff(fit_times)), False)] = (
        np.nan
    )  # omitted samples are not plotted
    axes.plot(fit_times, fit, color=INK, linewidth=0.8)
    axes.set_ylabel(f"{name.replace('_', ' ')} [{_UNITS[name]}]")


def _quantity(identification: Identification) -> str:
    """Return the plotted quantity of a series, the first of two quantities."""
    return next(name for name in _UNITS if getattr(identification.measurement, name) is not None)


def _residuals(axes: "Axes", identification: Identification) -> None:
    from_sound = isinstance(identification.measurement, ImpactTimes)
    unit = "s" if from_sound else _UNITS[_quantity(identification)]
    noise = 1.96e3 * identification.noise.value
    axes.axhspan(-noise, noise, color=PALE, linewidth=0.0)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.plot(
        identification.residual_times,
        1e3 * identification.residuals,
        "o" if from_sound else ".",
        color=GREY,
        markersize=2.5,
    )
    axes.set_ylabel(f"residual [m{unit}]")


def _posterior(axes: "Axes", identification: Identification) -> None:
    """Draw the density of the mean coefficient, the intervals of both sides, and one row per model."""
    r, q = identification.mean, identification.quantiles
    density = np.diff(q).min() / np.diff(q)
    axes.axvspan(r.low, r.high, color=PALE, linewidth=0.0)
    axes.fill_between(0.5 * (q[1:] + q[:-1]), 0.5, 0.5 - 1.4 * density, color=INK, alpha=0.6, linewidth=0.0)
    axes.axvline(r.value, color=INK, linewidth=0.6)
    axes.plot(r.value, 0, "o", color=INK)
    names = ["measured"]
    for foot in FEET:
        color, mark = _LOOKS[foot]
        side = identification.coefficients[foot]
        axes.plot([side.low, side.high], [len(names)] * 2, color=color)
        axes.plot(side.value, len(names), mark, color=color)
        names.append(f"landing {foot}")
    styles = model_styles()
    for model in identification.models:
        color = styles[model.model]["color"] if model.model in styles else GREY
        axes.plot(model.coefficient, len(names), "D", color=color)
        names.append(model.model)
    axes.set_yticks(range(len(names)), names, fontsize=6)
    axes.set_ylim(len(names) - 0.5, -1.1)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.tick_params(axis="y", length=0)
    axes.set_title(f"r = {r}", loc="left", fontsize=7.5)


def _impacts(axes: "Axes", identification: Identification) -> None:
    axes.axhspan(identification.mean.low, identification.mean.high, color=PALE, linewidth=0.0)
    axes.axhline(identification.mean.value, color=INK, linewidth=0.6)
    for impact in identification.impacts:
        color, mark = _LOOKS[impact.foot]
        axes.plot([impact.number] * 2, [impact.coefficient.low, impact.coefficient.high], color=color, linewidth=0.8)
        axes.plot(impact.number, impact.coefficient.value, mark, color=color, markersize=3.5)
    axes.set_ylabel("r of each impact [-]")
    axes.set_title(identification.scatter_text, loc="left", fontsize=7.5)


@in_journal_style
def trials_picture(trials: IdentifiedTrials) -> "Figure":
    """Draw the coefficient of every trial of a folder with its interval, and the mean of all trials.

    Parameters
    ----------
    trials : IdentifiedTrials
        Result of the identification of a folder.

    Returns
    -------
    matplotlib.figure.Figure
        One panel. Trials without a coefficient have a cross at the left edge.

    Raises
    ------
    InvalidValueError
        If the argument has another type.
    """
    checks.of_kind("trials", trials, IdentifiedTrials, "trials of a folder")
    count = len(trials.rows)
    figure, (axes,) = new_figure(0.7 * DOUBLE, 1.2 + min(5.0, 0.16 * count))
    mean = trials.mean
    if mean is not None:
        axes.axvspan(mean.low, mean.high, color=PALE, linewidth=0.0)
        axes.set_title(f"r = {mean}, mean of {trials.good} trials", loc="left", fontsize=7.5)
    for k, row in enumerate(trials.rows):
        if row["refused"]:
            axes.plot(0.01, k, "x", color=GREY, transform=axes.get_yaxis_transform())
            continue
        axes.plot([row["coefficient_low"], row["coefficient_high"]], [k, k], color=COLORS[0], linewidth=0.8)
        axes.plot(row["coefficient"], k, "o", color=COLORS[0], markersize=2.5)
    axes.set_ylim(count - 0.5, -0.5)
    axes.set_xlabel(_R)
    if count <= _MOST_NAMES:
        axes.set_yticks(range(count), [plain(row["trial"]) for row in trials.rows], fontsize=6)
    else:
        axes.set_ylabel("trial")
    return figure
