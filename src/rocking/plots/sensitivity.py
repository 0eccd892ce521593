"""Pictures of the effect of the restitution on studies: maps and differences, spectra, fragility curves."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import percent
from rocking.errors import InvalidValueError
from rocking.plots.fragility import draw_fit, symbol
from rocking.plots.labels import PEAK, axis_label, geometric, plain, plain_log
from rocking.plots.overturning_map import class_patches, classes_of, draw_map
from rocking.plots.rocking_spectrum import fractiles
from rocking.plots.style import DOUBLE, INK, MARKS, SINGLE, in_journal_style, legend_below, look, new_figure, patch
from rocking.studies.sensitivity.comparison import Sensitivity

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GAINED, LOST, SAME, UNKNOWN = "#AC8191", "#0070B2", "#F2F2F2", "#000000"
"""Colours: overturns only with the choice, overturns only with the baseline, equal outcomes, not computed with both."""

_BOTH = "#BDBDBD"
_CHANGE = "PuOr_r"  # purple, white, orange: distinct for all types of colour vision, not used for changes
_PANEL = 2.35
_MOST = 6


@in_journal_style
def sensitivity_picture(sensitivity: Sensitivity, *, unit: tuple[str, float] | None = None) -> "Figure":
    """Draw a comparison of restitutions.

    Maps are in columns, with the baseline first. Below each other map, a second map shows the cells with a
    different outcome from the baseline, and their number. Spectra and fragility have one curve per restitution.
    Fragility curves have 95 % bands; the titles contain the medians and their ratios to the median of the baseline,
    from the same motions.

    Parameters
    ----------
    sensitivity : Sensitivity
        Result of `map_sensitivity`, `spectrum_sensitivity`, `fragility_sensitivity` or `sensitivity`, with at most 6
        choices.
    unit : tuple of str and float, optional
        Unit of the medians of a fragility, and the size of this unit [unit of the measure]. Default: unit of the
        measure.

    Returns
    -------
    matplotlib.figure.Figure
        One column wide, or two for maps of more than two choices.

    Raises
    ------
    InvalidValueError
        If the argument has another type, there are too many choices, or the study has no picture.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.sensitivity import map_sensitivity
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    >>> figure = sensitivity_picture(map_sensitivity(block, pulse, *axes, ["housner", "ked"]))
    >>> [panel.get_title(loc="left") for panel in figure.axes[:2]]
    ['housner', 'ked']
    """
    checks.of_kind("sensitivity", sensitivity, Sensitivity, "a Sensitivity")
    if not 2 <= len(sensitivity.labels) <= _MOST:
        raise InvalidValueError(
            "a picture can have 2 to {limit} choices, got {count}", limit=_MOST, count=len(sensitivity.labels)
        )
    if sensitivity.states:
        return _of_fragility(sensitivity, unit)
    base = sensitivity.datasets[sensitivity.baseline]
    if "mode" in base and base["mode"].ndim == 2:
        return _of_maps(sensitivity)
    if {"slenderness_angle", "period"} <= set(base.sizes):
        return _of_spectra(sensitivity)
    raise InvalidValueError("pictures exist for maps, spectra and fragility, not for {sizes}", sizes=dict(base.sizes))


def _of_maps(sensitivity: Sensitivity) -> "Figure":
    count = len(sensitivity.labels)
    width = SINGLE if count == 2 else DOUBLE
    figure, axes = new_figure(width, _PANEL * 2.0 + 0.25, rows=2, columns=count, sharex=True, sharey=True)
    kinds = {label: classes_of(sensitivity.datasets[label]) for label in sensitivity.labels}
    for column, label in enumerate(sensitivity.labels):
        upper, lower = axes[column], axes[count + column]
        draw_map(upper, sensitivity.datasets[label], kinds[label])
        upper.set_title(plain(label), loc="left", fontsize=7.5)
        if column:
            _flips(lower, sensitivity, label)
        else:
            lower.set_visible(False)
    for panel in axes:
        panel.label_outer()
    axes[0].tick_params(labelbottom=True)
    axes[0].set_xlabel(axes[count + 1].get_xlabel())
    axes[count + 1].tick_params(labelleft=True)
    axes[count + 1].set_ylabel(axes[0].get_ylabel())
    _map_legend(axes[count], kinds)
    return figure


def _flips(axes: "Axes", sensitivity: Sensitivity, label: str) -> None:
    """Draw the map of outcomes that differ from the baseline."""
    verdict, base = (
        sensitivity.differences("verdict").sel(restitution=label),
        sensitivity.datasets[sensitivity.baseline],
    )
    draw_map(axes, base, np.ones(verdict.shape, dtype=np.int64))
    y, x = (base[name].values for name in verdict.dims)
    axes.pcolormesh(x, y, verdict.values, **_flip_colors(SAME))
    flips = sensitivity.flips_between(sensitivity.baseline, label)
    separator = "\n" if len(sensitivity.labels) > 4 else " "
    title = f"{flips.count:,} of {flips.compared:,} change{separator}({percent(flips.fraction)})"
    axes.set_title(title, loc="left", fontsize=7)


def _flip_colors(same: str) -> dict[str, Any]:
    from matplotlib.colors import ListedColormap

    colors = ListedColormap([LOST, same, GAINED, UNKNOWN])
    return {"cmap": colors, "vmin": -1.5, "vmax": 2.5, "shading": "nearest", "rasterized": True}


def _map_legend(hidden: "Axes", kinds: dict[str, Any]) -> None:
    """Draw the legend in the empty panel below the baseline."""
    handles = class_patches(kinds.values())
    for handle in handles:
        label = str(handle.get_label()).replace("rocks, ", "")
        handle.set_label(label.replace("overturns after 2 or more impacts", "overturns after 2 or more"))
    handles += [patch(GAINED, "changes to overturned"), patch(LOST, "changes to not overturned")]
    hidden.set_visible(True)
    hidden.axis("off")
    hidden.legend(handles=handles, loc="center left", fontsize=6.5, handlelength=1.2, borderaxespad=0.0)


def _of_spectra(sensitivity: Sensitivity) -> "Figure":
    base = sensitivity.datasets[sensitivity.baseline]
    angles = base["slenderness_angle"].values.tolist()
    figure, axes = new_figure(SINGLE, 0.9 + 1.25 * len(angles), rows=len(angles), sharex=True)
    for row, (panel, alpha) in enumerate(zip(axes, angles, strict=True)):
        for number, label in enumerate(sensitivity.labels):
            period, middle = base["period"].values, fractiles(sensitivity.datasets[label], row)[1]
            panel.plot(period, middle, label=plain(label), linewidth=1.0, **look(number))
        panel.set_ylim(bottom=0.0)
        verdict: xr.DataArray = sensitivity.differences("verdict").isel(slenderness_angle=row)
        counts = (np.abs(verdict) == 1).sum([name for name in verdict.dims if name != "restitution"])
        flips = ", ".join(f"{int(n):,}" for n in counts.values)
        title = rf"$\alpha$ = {alpha:.3g} rad; changes {flips} of {verdict[0].size:,}"
        panel.set_title(title, loc="left", fontsize=7)
    figure.supylabel(PEAK if base.sizes["motion"] == 1 else f"median {PEAK}", fontsize=8)
    axes[-1].set_xlabel(r"$2\pi\,/\,p$ [s]")
    if geometric(np.asarray(base["period"].values)):
        plain_log(axes[-1], "x")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _of_fragility(sensitivity: Sensitivity, unit: tuple[str, float] | None) -> "Figure":
    states = sensitivity.states
    figure, axes = new_figure(SINGLE, 1.1 + 1.55 * len(states), rows=len(states), sharex=True)
    results = [sensitivity.results[label] for label in sensitivity.labels]
    levels, measure = np.asarray(results[0].levels), results[0].subject.measure
    name, size = unit or (measure.unit, 1.0)
    fine = np.linspace(levels[0], levels[-1], 160)
    for panel, state in zip(axes, states, strict=True):
        for number, (label, result) in enumerate(zip(sensitivity.labels, results, strict=True)):
            fit = result.fits[state]
            text = plain(label) if panel is axes[0] else None
            if fit.exists:
                draw_fit(panel, fit, fine, number, 0.95)
            fraction = result.counts[state] / np.maximum(result.trials, 1)
            panel.plot(levels, fraction, MARKS[number], markersize=2.6, color=look(number)["color"], alpha=0.8)
            panel.plot([], [], marker=MARKS[number], markersize=2.6, label=text, **look(number))
        panel.set_ylim(-0.03, 1.03)
        # same order as in the legend
        medians = [result.fits[state].median for result in results]
        text = ", ".join("none" if value is None else f"{value / size:.3g}" for value in medians)
        title = f"medians {text} {name}".removesuffix(" -").replace("m/s2", "m/s$^2$")
        panel.set_title(f"{symbol(state)}: {title}{_ratios(sensitivity, state)}", loc="left", fontsize=7)
    figure.supylabel("probability [-]", fontsize=8)
    axes[-1].set_xlabel(axis_label(measure.name, measure.unit, linear=results[0].subject.settings.linear))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _ratios(sensitivity: Sensitivity, state: str) -> str:
    """Return a line with the ratios of medians to the baseline; empty if there is no ratio."""
    key = f"{state}: median ratio"
    rows = [row for row in sensitivity.summary() if row["choice"] != sensitivity.baseline]
    if not any(key in row for row in rows):
        return ""
    ratios = []
    for row in rows:
        ends = [row[f"{key} {end}"] for end in ("low", "high") if f"{key} {end}" in row]
        interval = " ({:.3g} to {:.3g})".format(*ends) if ends else ""
        ratios.append(f"{row[key]:.3g}{interval}" if key in row else "none")
    return f"\nratios of medians {', '.join(ratios)}"


@in_journal_style
def difference_map_picture(sensitivity: Sensitivity, choice: str | None = None) -> "Figure":
    r"""Draw the maps of the baseline and of another restitution, and their difference.

    In the map of differences, the colour shows the change of the peak rotation / alpha, if the body does not
    overturn with both. Two more colours show changes of the outcome.

    Parameters
    ----------
    sensitivity : Sensitivity
        Result of `map_sensitivity`.
    choice : str, optional
        Restitution compared with the baseline; default: the first after the baseline.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If the argument is not a comparison of maps, or the choice is unknown.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.sensitivity import map_sensitivity
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    >>> figure = difference_map_picture(map_sensitivity(block, pulse, *axes, ["housner", "ked"]))
    >>> [panel.get_title(loc="left") for panel in figure.axes[:3]]
    ['a  housner', 'b  ked', 'c  ked minus housner, 0 of 16 outcomes change']
    """
    argument: object = sensitivity
    if (
        not isinstance(argument, Sensitivity)
        or sensitivity.datasets[sensitivity.baseline].get("mode", np.empty(0)).ndim != 2
    ):
        raise InvalidValueError(parameter="sensitivity", allowed="a Sensitivity of maps", value=sensitivity)
    others = sensitivity.labels[1:]
    choice = others[0] if choice is None and others else choice
    if choice not in others:
        raise InvalidValueError(parameter="choice", allowed=f"one of {', '.join(others)}", value=choice)
    figure, axes = new_figure(DOUBLE, 3.0, columns=3, sharex=True, sharey=True)
    kinds = {label: classes_of(sensitivity.datasets[label]) for label in (sensitivity.baseline, choice)}
    for letter, panel, (label, classes) in zip("ab", axes, kinds.items(), strict=False):
        draw_map(panel, sensitivity.datasets[label], classes)
        panel.set_title(f"{letter}  {plain(label)}", loc="left", fontsize=7.5)
    scale = _differences(axes[2], sensitivity, choice)
    bar = figure.colorbar(scale, ax=axes[2], pad=0.02, aspect=30)
    bar.set_label(r"change of peak rotation $\theta\,/\,\alpha$ [-]", fontsize=7)
    bar.outline.set_linewidth(0.6)
    for panel in axes:
        panel.label_outer()
    handles, edge = class_patches(kinds.values()), {"edgecolor": INK, "linewidth": 0.5}
    verdict = sensitivity.differences("verdict").sel(restitution=choice)
    flips = ((1, GAINED, "overturns with the choice only"), (-1, LOST, "overturns with the baseline only"))
    handles += [patch(color, text, **edge) for sign, color, text in flips if (verdict == sign).any()]
    legend_below(figure, [*handles, patch(_BOTH, "overturns with both (c)", **edge)], 4)
    return figure


def _differences(axes: "Axes", sensitivity: Sensitivity, choice: str) -> Any:
    """Draw the change of the peaks, and over it the changes of outcome. Return the colour scale."""
    base, verdict = (
        sensitivity.datasets[sensitivity.baseline],
        sensitivity.differences("verdict").sel(restitution=choice).values,
    )
    change = sensitivity.differences("peak_ratio").sel(restitution=choice)
    draw_map(axes, base, np.ones(verdict.shape, dtype=np.int64))
    axes.set_facecolor(_BOTH)
    axes.collections[-1].set_visible(False)
    y, x = (base[name].values for name in change.dims)
    rocking_change = np.where(verdict == 0, change.values, np.nan)
    largest = float(np.nanmax(np.abs(rocking_change), initial=0.01))
    scale = axes.pcolormesh(
        x, y, rocking_change, cmap=_CHANGE, vmin=-largest, vmax=largest, shading="nearest", rasterized=True
    )
    axes.pcolormesh(x, y, np.where(verdict == 0, np.nan, verdict), **_flip_colors("white"))
    flips = sensitivity.flips_between(sensitivity.baseline, choice)
    title = f"{choice} minus {sensitivity.baseline}, {flips.count:,} of {flips.compared:,} outcomes change"
    axes.set_title(f"c  {plain(title)}", loc="left", fontsize=7)
    return scale
