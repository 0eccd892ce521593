"""Pictures of ground motions: histories with peaks, response spectra, and comparisons of sets."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.motions import (
    fourier_amplitudes,
    ground_displacement,
    ground_velocity,
    peak_ground_acceleration,
    peak_ground_velocity,
)
from rocking.motions.motion import GroundMotion
from rocking.motions.processing import begins_at
from rocking.motions.pulse import Pulse
from rocking.motions.spectrum import response_spectrum
from rocking.motions.summary import peak_name, support_of
from rocking.plots.labels import Traces, fine_samples, plain, plain_log, traces
from rocking.plots.style import (
    COLORS,
    DASHED,
    DOUBLE,
    GREY,
    INK,
    MARKS,
    PALE,
    SINGLE,
    in_journal_style,
    legend_above,
    legend_below,
    look,
    new_figure,
    stroke,
)  # fmt: skip

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rocking.motions.flatfiles import Flatfile
    from rocking.motions.selection import Selection

_DAMPING = 0.05
_LONGEST_TITLE = 70
_SET_PERIODS = np.geomspace(0.05, 4.0, 60)  # default periods of the spectra of sets [s]


@in_journal_style
def ground_motion_picture(motion: GroundMotion | Pulse, spectrum: bool = True) -> "Figure":
    """Draw a ground motion: acceleration, velocity, displacement and response spectrum.

    Parameters
    ----------
    motion : GroundMotion or Pulse
        The motion, from rest. A pulse is plotted from its formulas.
    spectrum : bool
        If True, also draw the pseudo-acceleration for 5 % damping.

    Returns
    -------
    matplotlib.figure.Figure
        Three stacked panels, and one to the right for the spectrum.

    Examples
    --------
    >>> from rocking.motions.pulses import sine
    >>> len(ground_motion_picture(sine(amplitude=3.0, period=0.8)).axes)
    4
    """
    width, columns = (DOUBLE, 2) if spectrum else (1.4 * SINGLE, 1)
    ratios = [1.5, 1.0][:columns]
    figure, cells = new_figure(width, 4.3, rows=3, columns=columns, sharex="col", width_ratios=ratios)
    title = plain(motion.name)
    if len(title) > _LONGEST_TITLE:
        title = title[: _LONGEST_TITLE - 3] + "..."
    figure.suptitle(title, x=0.01, ha="left", fontsize=9)
    curves = traces(motion)
    _histories(cells[::columns], motion, curves)
    figure.align_ylabels(cells[::columns])
    if spectrum:
        grid: Any = cells[0].get_gridspec()
        for axes in cells[1::2]:
            axes.remove()
        _spectrum(figure.add_subplot(grid[:, 1]), fine_samples(motion), abs(curves.peaks["acceleration"][1]))
    return figure


def _histories(stack: "list[Axes]", motion: GroundMotion | Pulse, curves: Traces) -> None:
    top, middle, bottom = stack
    if isinstance(motion, GroundMotion) and motion.vertical is not None:
        top.plot(motion.time, motion.vertical, color=GREY, linewidth=0.5, label="vertical", zorder=1)
        top.plot([], [], color=INK, linewidth=0.8, label="horizontal")
        legend_above(top, 2)
    support = support_of(motion)
    rows = (
        (top, "acceleration", "m/s$^2$", peak_name(support, "A"), INK),
        (middle, "velocity", "m/s", peak_name(support, "V"), COLORS[0]),
        (bottom, "displacement", "m", peak_name(support, "D"), COLORS[2]),
    )
    for axes, name, unit, short, color in rows:
        time, values = curves.time, getattr(curves, name)
        if name == "acceleration":  # the acceleration is zero before and after the motion
            time, values = np.pad(time, 1, "edge"), np.pad(values, 1)
        axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
        axes.plot(time, values, color=color, linewidth=0.8)
        at, peak = curves.peaks[name]
        axes.plot([at], [peak], marker="o", markersize=4, markerfacecolor="white", color=color, linestyle="none")
        in_g = f" = {abs(peak) / g:.3g} g" if name == "acceleration" else ""
        axes.set_title(f"{short} {abs(peak):.3g} {unit}{in_g} at {at:.4g} s", loc="right", fontsize=7)
        axes.set_ylabel(f"{name}\n[{unit}]")
        axes.margins(x=0.01)
        axes.locator_params(axis="y", nbins=5)
    bottom.set_xlabel("time [s]")


def _spectrum(axes: "Axes", motion: GroundMotion, peak: float) -> None:
    low, peaks = max(0.02, 0.2 * motion.time_step), traces(motion).peaks
    # for slow motions, the periods extend well above the characteristic period
    characteristic_period = 2.0 * math.pi * abs(peaks["velocity"][1]) / (abs(peaks["acceleration"][1]) or math.inf)
    high = max(5.0, 2.0 * characteristic_period, 10.0 * low)
    periods = np.geomspace(low, high, 120)
    values = response_spectrum(motion, periods, _DAMPING).pseudo_acceleration / g
    name = peak_name(support_of(motion))
    axes.axhline(peak / g, color=GREY, linewidth=0.8, linestyle=DASHED, label=f"{name} {peak / g:.3g} g")
    axes.plot(periods, values, color=COLORS[1], label=f"PSA, {100.0 * _DAMPING:g} % damping")
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    axes.set_ylim(0.0, 1.08 * max(float(values.max()), peak / g) or 1.0)
    ticks = [tick for tick in (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if low <= tick <= high]
    if len(ticks) > 2:
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
    axes.grid(color=PALE, linewidth=0.5)
    axes.set_xlabel("period T [s]")
    axes.set_ylabel("pseudo-spectral acceleration PSA [g]", color=INK)
    legend_above(axes, 2)


@in_journal_style
def processing_picture(before: GroundMotion, after: GroundMotion) -> "Figure":
    """Draw a record before and after its processing: histories, Fourier amplitudes (smoothed) and response spectra.

    Parameters
    ----------
    before, after : GroundMotion
        The record as read (grey), and after its processing steps.

    Returns
    -------
    matplotlib.figure.Figure
        Three stacked panels, and two to the right.

    Examples
    --------
    >>> from rocking.motions import demeaned
    >>> motion = GroundMotion(1.0 + np.sin(np.linspace(0.0, 60.0, 600)), 0.01)
    >>> len(processing_picture(motion, demeaned(motion)).axes)
    5
    """
    figure, cells = new_figure(DOUBLE, 4.6, rows=3, columns=2, sharex="col", width_ratios=[1.5, 1.0])
    figure.suptitle(plain(after.name)[:_LONGEST_TITLE], x=0.01, ha="left", fontsize=9)
    grid: Any = cells[0].get_gridspec()
    for axes in cells[1::2]:
        axes.remove()
    right_grid = grid[:, 1].subgridspec(2, 1)
    fourier, spectrum = (figure.add_subplot(right_grid[k]) for k in range(2))
    labels = ("acceleration [m/s$^2$]", "velocity [m/s]", "displacement [m]")
    for motion, color, stage in ((before, GREY, "before"), (after, INK, "after")):
        rows = (motion.acceleration, ground_velocity(motion), ground_displacement(motion))
        for axes, values, name in zip(cells[::2], rows, labels, strict=True):
            axes.plot(motion.time + begins_at(motion), values, linewidth=0.7, color=color, label=stage)
            axes.set_ylabel(name)
        frequencies = np.geomspace(2.0 / motion.duration, 0.49 / motion.time_step, 120)
        fourier.plot(*fourier_amplitudes(motion, frequencies), linewidth=0.9, color=color)
        response = response_spectrum(motion, _SET_PERIODS, _DAMPING)
        spectrum.plot(response.periods, response.pseudo_acceleration, linewidth=0.9, color=color)
    cells[4].set_xlabel("time [s]")
    fourier.set(xlabel="frequency [Hz]", ylabel="Fourier amplitude [m/s]", xscale="log", yscale="log")
    spectrum.set(xlabel="period [s]", ylabel=f"PSA, {100.0 * _DAMPING:g} % damping [m/s$^2$]", xscale="log")
    legend_above(cells[0], 2)
    figure.align_ylabels(cells[::2])
    return figure


@in_journal_style
def selection_picture(selection: "Selection") -> "Figure":
    """Draw the spectra of records scaled to a target, their mean and the target.

    Parameters
    ----------
    selection : Selection
        Result of `rocking.motions.selected`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.

    Examples
    --------
    >>> from rocking.motions import selected
    >>> from rocking.motions.components import Components
    >>> wave = GroundMotion(np.sin(np.linspace(0.0, 60.0, 600)), 0.01, name="wave")
    >>> selection = selected([Components(wave, None, None)], "eurocode8:ag=2m/s2", periods=(0.3, 2.0), most=100.0)
    >>> len(selection_picture(selection).axes[0].lines)
    3
    """
    figure, (axes,) = new_figure(1.4 * SINGLE, 2.9)
    periods = selection.periods
    axes.plot(periods, selection.spectra.T / g, color=GREY, linewidth=0.4)
    axes.plot(periods, selection.mean / g, color=INK, linewidth=1.4, label=f"mean of {len(selection.records)}")
    target_style: dict[str, Any] = {"color": COLORS[0], "linestyle": DASHED, "label": plain(selection.target.name)}
    axes.plot(periods, selection.target(periods) / g, **target_style)
    axes.set(xlabel="period [s]", ylabel="spectral acceleration [g]")
    for which in "xy":
        plain_log(axes, which)
    legend_above(axes, 1)
    return figure


@in_journal_style
def spectra_picture(flatfile: "Flatfile") -> "Figure":
    """Draw the spectra of many records, with their median and the band of the middle 68 %.

    Parameters
    ----------
    flatfile : Flatfile
        Result of `rocking.motions.flatfile`, with RotD50 of two components or the spectrum of a single component.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.

    Examples
    --------
    >>> from rocking.motions import flatfile
    >>> from rocking.motions.components import Components
    >>> wave = GroundMotion(np.sin(np.linspace(0.0, 60.0, 600)), 0.01, name="wave")
    >>> len(spectra_picture(flatfile([Components(wave, None, None)], [0.1, 0.5, 2.0])).axes)
    1
    """
    figure, (axes,) = new_figure(1.4 * SINGLE, 2.9)
    both, single = flatfile.spectra["sa_rotd50"], flatfile.spectra["sa_x"]
    values = np.where(np.isfinite(both), both, single) / g
    values = values[np.isfinite(values).all(axis=1)]
    low, middle, high = np.quantile(values, [0.16, 0.5, 0.84], axis=0)
    axes.plot(flatfile.periods, values.T, color=GREY, linewidth=0.3)
    axes.fill_between(flatfile.periods, low, high, color=COLORS[0], alpha=0.2, linewidth=0)
    axes.plot(flatfile.periods, middle, color=INK, linewidth=1.4, label=f"median of {len(values)}")
    axes.set(xlabel="period [s]", ylabel="spectral acceleration [g]")
    for which in "xy":
        plain_log(axes, which)
    legend_above(axes, 1)
    return figure


@in_journal_style
def record_set_picture(sets: Mapping[str, Any], periods: Any = _SET_PERIODS) -> "Figure":
    """Draw sets of motions: peak velocity over peak acceleration, and their spectra.

    Left: one point per motion. Right: median of the pseudo-spectral acceleration with 5 % damping of every set, and
    band of the middle 68 % of the motions.

    Parameters
    ----------
    sets : mapping of str to MotionSet or sequence of GroundMotion
        Up to six sets by name. A set has two or more motions.
    periods : array_like
        Periods of the spectra [s].

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, two columns wide.

    Raises
    ------
    InvalidValueError
        If there is no set, or a set has fewer than two records.

    Examples
    --------
    >>> from rocking.studies import SyntheticSet
    >>> figure = record_set_picture({"far": SyntheticSet("point-source", 3, seed=1)}, [0.1, 0.5, 1.0])
    >>> figure.axes[1].get_xlabel()
    'period [s]'
    """
    if not 1 <= len(sets) <= len(MARKS):
        raise InvalidValueError(parameter="sets", allowed=f"1 to {len(MARKS)}", value=len(sets))
    spectrum_periods = checks.positive_array("periods", periods, "s")
    figure, (left, right) = new_figure(DOUBLE, 2.9, columns=2)
    for number, (name, motions) in enumerate(sets.items()):
        records = [motions[k] for k in range(len(motions))]
        if len(records) < 2 or not all(isinstance(record, GroundMotion) for record in records):
            raise InvalidValueError(
                "set {name!r:.60} must have two ground motions or more, got {value}", parameter="sets", name=name,
                value=records,
            )  # fmt: skip
        pga = [peak_ground_acceleration(record) for record in records]
        pgv = [peak_ground_velocity(record) for record in records]
        mark: dict[str, Any] = {"marker": MARKS[number], "markersize": 3.0, "alpha": 0.7, "markeredgewidth": 0}
        left.plot(pga, pgv, linestyle="none", color=look(number)["color"], **mark)
        values = np.array([response_spectrum(record, spectrum_periods).pseudo_acceleration for record in records])
        low, middle, high = np.quantile(values, [0.16, 0.5, 0.84], axis=0)
        right.fill_between(spectrum_periods, low, high, color=look(number)["color"], alpha=0.15, linewidth=0)
        right.plot(spectrum_periods, middle, linewidth=1.2, **look(number))
    left.set(xlabel="peak ground acceleration [m/s$^2$]", ylabel="peak ground velocity [m/s]")
    right.set(xlabel="period [s]", ylabel="spectral acceleration, 5 % [m/s$^2$]")
    for panel in (left, right):
        for which in "xy":
            plain_log(panel, which)
    handles = [
        stroke(f"{plain(name)}: {len(sets[name])}", marker=MARKS[number], markersize=3.0, **look(number))
        for number, name in enumerate(sets)
    ]
    legend_below(figure, handles, 3, fontsize=7, handlelength=3.6)
    return figure
