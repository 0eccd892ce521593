"""How the choice of a restitution changes a study: maps and their difference, spectra, fragility curves."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import percent
from rocking.errors import InvalidValueError
from rocking.plots.fragility import fitted, symbol
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
"""Overturns with the choice only, with the baseline only, the same verdict, one of the two not computed."""

_BOTH = "#BDBDBD"
_CHANGE = "PuOr_r"  # purple to orange, white between: told apart by every eye, and unlike the colours of flips
_PANEL = 2.35
_MOST = 6


@in_journal_style
def sensitivity_picture(found: Sensitivity, *, unit: tuple[str, float] | None = None) -> "Figure":
    """Draw a comparison of restitutions.

    Maps stand beside one another, the baseline first; below each other one is the map of the verdicts that differ,
    with their number. Of spectra and of fragility each choice has its curve; those of fragility have their 95 % bands,
    and over them stand the medians and their ratios to that of the baseline, from the same motions.

    Parameters
    ----------
    found : Sensitivity
        As of `map_sensitivity`, `spectrum_sensitivity`, `fragility_sensitivity` or `sensitivity`; of 6 choices at
        most.
    unit : tuple of str and float, optional
        In which medians of a fragility are told, and its size [unit of the measure]; otherwise that of the measure.

    Returns
    -------
    matplotlib.figure.Figure
        One column wide, or two for maps of more than two choices.

    Raises
    ------
    InvalidValueError
        If it is no comparison, there are too many choices, or the study has no picture.

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
    checks.of_kind("found", found, Sensitivity, "a Sensitivity")
    if not 2 <= len(found.labels) <= _MOST:
        raise InvalidValueError(
            "a picture holds 2 to {limit} choices, got {count}", limit=_MOST, count=len(found.labels)
        )
    if found.states:
        return _of_fragility(found, unit)
    base = found.datasets[found.baseline]
    if "mode" in base and base["mode"].ndim == 2:
        return _of_maps(found)
    if {"slenderness_angle", "period"} <= set(base.sizes):
        return _of_spectra(found)
    raise InvalidValueError("there is a picture of maps, spectra and fragility, not of {sizes}", sizes=dict(base.sizes))


def _of_maps(found: Sensitivity) -> "Figure":
    count = len(found.labels)
    width = SINGLE if count == 2 else DOUBLE
    figure, axes = new_figure(width, _PANEL * 2.0 + 0.25, rows=2, columns=count, sharex=True, sharey=True)
    kinds = {label: classes_of(found.datasets[label]) for label in found.labels}
    for place, label in enumerate(found.labels):
        upper, lower = axes[place], axes[count + place]
        draw_map(upper, found.datasets[label], kinds[label])
        upper.set_title(plain(label), loc="left", fontsize=7.5)
        if place:
            _flips(lower, found, label)
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


def _flips(axes: "Axes", found: Sensitivity, label: str) -> None:
    """Draw where the verdict differs from that of the baseline."""
    verdict, base = found.differences("verdict").sel(restitution=label), found.datasets[found.baseline]
    draw_map(axes, base, np.ones(verdict.shape, dtype=np.int64))
    y, x = (base[name].values for name in verdict.dims)
    axes.pcolormesh(x, y, verdict.values, **_flip_colors(SAME))
    flips = found.flips_between(found.baseline, label)
    apart = "\n" if len(found.labels) > 4 else " "
    words = f"{flips.count:,} of {flips.compared:,} flip{apart}({percent(flips.share)})"
    axes.set_title(words, loc="left", fontsize=7)


def _flip_colors(same: str) -> dict[str, Any]:
    from matplotlib.colors import ListedColormap

    colors = ListedColormap([LOST, same, GAINED, UNKNOWN])
    return {"cmap": colors, "vmin": -1.5, "vmax": 2.5, "shading": "nearest", "rasterized": True}


def _map_legend(hidden: "Axes", kinds: dict[str, Any]) -> None:
    """Explain the colours where the baseline has no map of differences."""
    handles = class_patches(kinds.values())
    for each in handles:
        words = str(each.get_label()).replace("rocks, ", "")
        each.set_label(words.replace("overturns after 2 or more impacts", "overturns after 2 or more"))
    handles += [patch(GAINED, "flips to overturned"), patch(LOST, "flips to standing")]
    hidden.set_visible(True)
    hidden.axis("off")
    hidden.legend(handles=handles, loc="center left", fontsize=6.5, handlelength=1.2, borderaxespad=0.0)


def _of_spectra(found: Sensitivity) -> "Figure":
    base = found.datasets[found.baseline]
    angles = base["slenderness_angle"].values.tolist()
    figure, axes = new_figure(SINGLE, 0.9 + 1.25 * len(angles), rows=len(angles), sharex=True)
    for place, (panel, alpha) in enumerate(zip(axes, angles, strict=True)):
        for number, label in enumerate(found.labels):
            period, middle = base["period"].values, fractiles(found.datasets[label], place)[1]
            panel.plot(period, middle, label=plain(label), linewidth=1.0, **look(number))
        panel.set_ylim(bottom=0.0)
        verdict: xr.DataArray = found.differences("verdict").isel(slenderness_angle=place)
        counts = (np.abs(verdict) == 1).sum([name for name in verdict.dims if name != "restitution"])
        flips = ", ".join(f"{int(n):,}" for n in counts.values)
        words = rf"$\alpha$ = {alpha:.3g} rad; flips {flips} of {verdict[0].size:,}"
        panel.set_title(words, loc="left", fontsize=7)
    figure.supylabel(PEAK if base.sizes["motion"] == 1 else f"median {PEAK}", fontsize=8)
    axes[-1].set_xlabel(r"$2\pi\,/\,p$ [s]")
    if geometric(np.asarray(base["period"].values)):
        plain_log(axes[-1], "x")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _of_fragility(found: Sensitivity, unit: tuple[str, float] | None) -> "Figure":
    states = found.states
    figure, axes = new_figure(SINGLE, 1.1 + 1.55 * len(states), rows=len(states), sharex=True)
    results = [found.results[label] for label in found.labels]
    levels, measure = np.asarray(results[0].levels), results[0].subject.measure
    name, size = unit or (measure.unit, 1.0)
    fine = np.linspace(levels[0], levels[-1], 160)
    for panel, state in zip(axes, states, strict=True):
        for number, (label, result) in enumerate(zip(found.labels, results, strict=True)):
            fit = result.fits[state]
            words = plain(label) if panel is axes[0] else None
            if fit.exists:
                fitted(panel, fit, fine, number, 0.95)
            share = result.counts[state] / np.maximum(result.trials, 1)
            panel.plot(levels, share, MARKS[number], markersize=2.6, color=look(number)["color"], alpha=0.8)
            panel.plot([], [], marker=MARKS[number], markersize=2.6, label=words, **look(number))
        panel.set_ylim(-0.03, 1.03)
        # in the order of the legend
        medians = [result.fits[state].median for result in results]
        words = ", ".join("none" if value is None else f"{value / size:.3g}" for value in medians)
        title = f"medians {words} {name}".removesuffix(" -").replace("m/s2", "m/s$^2$")
        panel.set_title(f"{symbol(state)}: {title}{_ratios(found, state)}", loc="left", fontsize=7)
    figure.supylabel("probability [-]", fontsize=8)
    axes[-1].set_xlabel(axis_label(measure.name, measure.unit, linear=results[0].subject.settings.linear))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _ratios(found: Sensitivity, state: str) -> str:
    """Return a line of the ratios of medians to that of the baseline; nothing where no choice has one."""
    key = f"{state}: median ratio"
    rows = [row for row in found.summary() if row["choice"] != found.baseline]
    if not any(key in row for row in rows):
        return ""
    told = []
    for row in rows:
        ends = [row[f"{key} {end}"] for end in ("low", "high") if f"{key} {end}" in row]
        interval = " ({:.3g} to {:.3g})".format(*ends) if ends else ""
        told.append(f"{row[key]:.3g}{interval}" if key in row else "none")
    return f"\nratios of medians {', '.join(told)}"


@in_journal_style
def difference_map_picture(found: Sensitivity, choice: str | None = None) -> "Figure":
    r"""Draw the maps of the baseline and of another restitution, and their difference beside them.

    In the map of differences the colour says by how much the peak rotation over alpha is larger with the choice where
    the body stands with both, and two more colours where the verdict flips.

    Parameters
    ----------
    found : Sensitivity
        As of `map_sensitivity`.
    choice : str, optional
        The restitution that is compared with the baseline; the first after it if not given.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If it is no comparison of maps, or has no such choice.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.sensitivity import map_sensitivity
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    >>> figure = difference_map_picture(map_sensitivity(block, pulse, *axes, ["housner", "ked"]))
    >>> [panel.get_title(loc="left") for panel in figure.axes[:3]]
    ['a  housner', 'b  ked', 'c  ked less housner, 0 of 16 verdicts flip']
    """
    known: object = found
    if not isinstance(known, Sensitivity) or found.datasets[found.baseline].get("mode", np.empty(0)).ndim != 2:
        raise InvalidValueError(parameter="found", allowed="a Sensitivity of maps", value=found)
    others = found.labels[1:]
    choice = others[0] if choice is None and others else choice
    if choice not in others:
        raise InvalidValueError(parameter="choice", allowed=f"one of {', '.join(others)}", value=choice)
    figure, axes = new_figure(DOUBLE, 3.0, columns=3, sharex=True, sharey=True)
    kinds = {label: classes_of(found.datasets[label]) for label in (found.baseline, choice)}
    for letter, panel, (label, each) in zip("ab", axes, kinds.items(), strict=False):
        draw_map(panel, found.datasets[label], each)
        panel.set_title(f"{letter}  {plain(label)}", loc="left", fontsize=7.5)
    scale = _differences(axes[2], found, choice)
    bar = figure.colorbar(scale, ax=axes[2], pad=0.02, aspect=30)
    bar.set_label(r"change of peak rotation $\theta\,/\,\alpha$ [-]", fontsize=7)
    bar.outline.set_linewidth(0.6)
    for panel in axes:
        panel.label_outer()
    handles, edge = class_patches(kinds.values()), {"edgecolor": INK, "linewidth": 0.5}
    verdict = found.differences("verdict").sel(restitution=choice)
    flips = ((1, GAINED, "overturns with the choice only"), (-1, LOST, "overturns with the baseline only"))
    handles += [patch(color, words, **edge) for sign, color, words in flips if (verdict == sign).any()]
    legend_below(figure, [*handles, patch(_BOTH, "overturns with both (c)", **edge)], 4)
    return figure


def _differences(axes: "Axes", found: Sensitivity, choice: str) -> Any:
    """Draw the change of the peaks, and flips over it; return what the colours mean."""
    base, verdict = found.datasets[found.baseline], found.differences("verdict").sel(restitution=choice).values
    change = found.differences("peak_ratio").sel(restitution=choice)
    draw_map(axes, base, np.ones(verdict.shape, dtype=np.int64))
    axes.set_facecolor(_BOTH)
    axes.collections[-1].set_visible(False)
    y, x = (base[name].values for name in change.dims)
    stands = np.where(verdict == 0, change.values, np.nan)
    most = float(np.nanmax(np.abs(stands), initial=0.01))
    scale = axes.pcolormesh(x, y, stands, cmap=_CHANGE, vmin=-most, vmax=most, shading="nearest", rasterized=True)
    axes.pcolormesh(x, y, np.where(verdict == 0, np.nan, verdict), **_flip_colors("white"))
    flips = found.flips_between(found.baseline, choice)
    words = f"{choice} less {found.baseline}, {flips.count:,} of {flips.compared:,} verdicts flip"
    axes.set_title(f"c  {plain(words)}", loc="left", fontsize=7)
    return scale
