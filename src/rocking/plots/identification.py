"""What a measurement says of the coefficient of restitution: what was heard or seen, the fit, the models beside it."""

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
def identification_picture(found: Identification) -> "Figure":
    """Draw what was measured with its fit, what is left over, what each impact took, and the models of restitution.

    Parameters
    ----------
    found : Identification
        As of `rocking.identification.identify`; of one that was refused there is what was measured alone.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If it is no identification.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.identification import ImpactTimes, identify
    >>> times = [0.0, 1.2158, 2.2432, 3.1403, 3.9387, 4.6583, 5.3126, 5.9119, 6.4634]
    >>> found = identify(ImpactTimes(times), rk.Block(width=1.0, height=4.0))
    >>> [panel.get_xlabel() for panel in identification_picture(found).axes]
    ['', 'coefficient of restitution r [-]', 'time [s]', 'impact']
    """
    checks.of_kind("found", found, Identification, "an Identification")
    figure, axes = new_figure(DOUBLE, 4.6, rows=2, columns=2, width_ratios=(1.3, 1.0))
    axes[0].sharex(axes[2])
    axes[0].tick_params(labelbottom=False)
    axes[0].set_title(plain(found.source) or "measured", loc="left", fontsize=7.5)
    if isinstance(found.measurement, ImpactTimes):
        _heard(axes[0], found, found.measurement)
    else:
        _turned(axes[0], found)
    for each in found.impacts:
        axes[0].axvline(each.time, color=_LOOKS[each.foot][0], linewidth=0.6)
    _residuals(axes[2], found)
    for axis, words in zip(axes[1:], (_R, "time [s]", "impact"), strict=True):
        axis.set_xlabel(words)
    if found.refused:
        axes[1].set_title("refused: no coefficient", loc="left", fontsize=7.5)
        for axis in (axes[1], axes[3]):  # scales of nothing would be read as results
            axis.set_axis_off()
    else:
        _posterior(axes[1], found)
        _impacts(axes[3], found)
    handles: list[Any] = [stroke(f"lands {foot}", color=c, marker=m, linestyle="-") for foot, (c, m) in _LOOKS.items()]
    handles += [stroke("measured, and no impact", color=GREY, marker="x", linestyle="")]
    handles += [stroke("fitted", color=INK), patch(PALE, "95 % interval")]
    legend_below(figure, handles, 5)
    return figure


def _heard(axes: "Axes", found: Identification, measurement: ImpactTimes) -> None:
    """Draw a sound where there is one, and what is no impact; lines of impacts are drawn by the caller."""
    axes.set_ylim(0.0, 1.1)
    axes.set_yticks([])
    axes.set_ylabel("impacts heard" if measurement.loudness is None else "loudness [-]")
    if measurement.loudness is not None:
        axes.fill_between(*measurement.loudness.T, color=GREY, linewidth=0.0)
        axes.set_xlim(0.0, float(measurement.loudness[-1, 0]))
    if found.impacts:  # of the first and the last nothing is known but when they were
        ends = zip(found.residual_times[[0, -1]], (found.impacts[0], found.impacts[-1]), strict=True)
        for time, neighbour in ends:
            axes.axvline(time, color=_LOOKS[opposite(neighbour.foot)][0], linewidth=0.6)
    other = np.setdiff1d(measurement.times, found.residual_times)
    axes.plot(other, np.full(other.size, 1.04), "x", color=GREY)


def _turned(axes: "Axes", found: Identification) -> None:
    name = _quantity(found)
    time, values = found.measurement.time, getattr(found.measurement, name)  # type: ignore[union-attr]
    axes.plot(time, values, ".", color=GREY, markersize=2.0)
    # of two quantities, that which is drawn comes first
    count = int(np.argmax(np.append(np.diff(found.residual_times) < 0.0, True))) + 1
    at = found.residual_times[:count]
    fit = np.interp(at, time, values) - found.residuals[:count]
    fit[np.append(np.diff(at) > _GAP * np.median(np.diff(at)), False)] = np.nan  # what was left out is not drawn
    axes.plot(at, fit, color=INK, linewidth=0.8)
    axes.set_ylabel(f"{name.replace('_', ' ')} [{_UNITS[name]}]")


def _quantity(found: Identification) -> str:
    """Return which quantity of a series is drawn, the first of both where there are both."""
    return next(each for each in _UNITS if getattr(found.measurement, each) is not None)


def _residuals(axes: "Axes", found: Identification) -> None:
    heard = isinstance(found.measurement, ImpactTimes)
    unit = "s" if heard else _UNITS[_quantity(found)]
    noise = 1.96e3 * found.noise.value
    axes.axhspan(-noise, noise, color=PALE, linewidth=0.0)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.plot(found.residual_times, 1e3 * found.residuals, "o" if heard else ".", color=GREY, markersize=2.5)
    axes.set_ylabel(f"left over [m{unit}]")


def _posterior(axes: "Axes", found: Identification) -> None:
    """Draw the density of the mean coefficient, the interval of each side, and a row for each model."""
    r, q = found.mean, found.quantiles
    density = np.diff(q).min() / np.diff(q)
    axes.axvspan(r.low, r.high, color=PALE, linewidth=0.0)
    axes.fill_between(0.5 * (q[1:] + q[:-1]), 0.5, 0.5 - 1.4 * density, color=INK, alpha=0.6, linewidth=0.0)
    axes.axvline(r.value, color=INK, linewidth=0.6)
    axes.plot(r.value, 0, "o", color=INK)
    names = ["measured"]
    for foot in FEET:
        color, mark = _LOOKS[foot]
        side = found.coefficients[foot]
        axes.plot([side.low, side.high], [len(names)] * 2, color=color)
        axes.plot(side.value, len(names), mark, color=color)
        names.append(f"landing {foot}")
    styles = model_styles()
    for each in found.models:
        color = styles[each.model]["color"] if each.model in styles else GREY
        axes.plot(each.coefficient, len(names), "D", color=color)
        names.append(each.model)
    axes.set_yticks(range(len(names)), names, fontsize=6)
    axes.set_ylim(len(names) - 0.5, -1.1)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.tick_params(axis="y", length=0)
    axes.set_title(f"r = {r}", loc="left", fontsize=7.5)


def _impacts(axes: "Axes", found: Identification) -> None:
    axes.axhspan(found.mean.low, found.mean.high, color=PALE, linewidth=0.0)
    axes.axhline(found.mean.value, color=INK, linewidth=0.6)
    for each in found.impacts:
        color, mark = _LOOKS[each.foot]
        axes.plot([each.number] * 2, [each.coefficient.low, each.coefficient.high], color=color, linewidth=0.8)
        axes.plot(each.number, each.coefficient.value, mark, color=color, markersize=3.5)
    axes.set_ylabel("r of each impact [-]")
    axes.set_title(found.scatter_text, loc="left", fontsize=7.5)


@in_journal_style
def trials_picture(found: IdentifiedTrials) -> "Figure":
    """Draw the coefficient of every trial of a folder with its interval, and the mean of all.

    Parameters
    ----------
    found : IdentifiedTrials
        As of `rocking.spec.identification`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel; trials without a coefficient have a cross at its edge.

    Raises
    ------
    InvalidValueError
        If it is none.
    """
    checks.of_kind("found", found, IdentifiedTrials, "trials of a folder")
    count = len(found.rows)
    figure, (axes,) = new_figure(0.7 * DOUBLE, 1.2 + min(5.0, 0.16 * count))
    mean = found.mean
    if mean is not None:
        axes.axvspan(mean.low, mean.high, color=PALE, linewidth=0.0)
        axes.set_title(f"r = {mean}, mean of {found.good} trials", loc="left", fontsize=7.5)
    for k, row in enumerate(found.rows):
        if row["refused"]:
            axes.plot(0.01, k, "x", color=GREY, transform=axes.get_yaxis_transform())
            continue
        axes.plot([row["coefficient_low"], row["coefficient_high"]], [k, k], color=COLORS[0], linewidth=0.8)
        axes.plot(row["coefficient"], k, "o", color=COLORS[0], markersize=2.5)
    axes.set_ylim(count - 0.5, -0.5)
    axes.set_xlabel(_R)
    if count <= _MOST_NAMES:
        axes.set_yticks(range(count), [plain(row["trial"]) for row in found.rows], fontsize=6)
    else:
        axes.set_ylabel("trial")
    return figure
