"""How the choice of a restitution changes a study: maps beside one another, spectra and fragility over one another."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import percent
from rocking.errors import InvalidValueError
from rocking.plots.overturning_map import CLASSES, classes_of, draw_map
from rocking.plots.study_words import PEAK, axis_label, geometric, look, plain, plain_log
from rocking.plots.style import DOUBLE, INK, SINGLE, in_journal_style, new_figure
from rocking.studies.sensitivity.comparison import Sensitivity

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GAINED, LOST, SAME, UNKNOWN = "#CC79A7", "#0072B2", "#F2F2F2", "#000000"
"""Overturns with the choice only, with the baseline only, the same verdict, one of the two not computed."""

_PANEL = 2.35
_MOST = 6


@in_journal_style
def sensitivity_picture(found: Sensitivity, *, unit: tuple[str, float] | None = None) -> "Figure":
    """Draw a comparison of restitutions.

    Maps stand beside one another, the baseline first; below each other one is the map of the verdicts that differ,
    with their number. Of spectra and of fragility each choice has its curve.

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
    if not isinstance(found, Sensitivity):
        raise InvalidValueError(f"found must be a Sensitivity, got {found!r:.60}")
    if not 2 <= len(found.labels) <= _MOST:
        raise InvalidValueError(f"a picture holds 2 to {_MOST} choices, got {len(found.labels)}")
    if found.states:
        return _of_fragility(found, unit)
    base = found.datasets[found.baseline]
    if "mode" in base and base["mode"].ndim == 2:
        return _of_maps(found)
    if {"slenderness_angle", "period"} <= set(base.sizes):
        return _of_spectra(found)
    raise InvalidValueError(f"there is a picture of maps, spectra and fragility, not of {dict(base.sizes)}")


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
    from matplotlib.colors import ListedColormap

    made = found.differences("verdict").sel(restitution=label)
    base = found.datasets[found.baseline]
    draw_map(axes, base, np.ones(made.shape, dtype=np.int64))
    y, x = made.dims
    colors = ListedColormap([LOST, SAME, GAINED, UNKNOWN])
    axes.pcolormesh(
        base[x].values, base[y].values, made.values, cmap=colors, vmin=-1.5, vmax=2.5, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    flips = found.flips_between(found.baseline, label)
    words = f"{flips.count:,} of {flips.compared:,} flip ({percent(flips.share)})"
    axes.set_title(words, loc="left", fontsize=7)


def _map_legend(hidden: "Axes", kinds: dict[str, Any]) -> None:
    """Explain the colours where the baseline has no map of differences."""
    from matplotlib.patches import Patch

    present = sorted({kind for each in kinds.values() for kind in np.unique(each).tolist()})
    handles = [
        Patch(facecolor=CLASSES[k][1], edgecolor=INK, linewidth=0.5, label=_short(CLASSES[k][0])) for k in present
    ]
    handles += [
        Patch(facecolor=GAINED, label="flips to overturned"),
        Patch(facecolor=LOST, label="flips to standing"),
    ]
    hidden.set_visible(True)
    hidden.axis("off")
    hidden.legend(handles=handles, loc="center left", fontsize=6.5, handlelength=1.2, borderaxespad=0.0)


def _short(words: str) -> str:
    return words.replace("rocks, ", "").replace("overturns after 2 or more impacts", "overturns after 2 or more")


def _of_spectra(found: Sensitivity) -> "Figure":
    from rocking.plots.rocking_spectrum import fractiles

    base = found.datasets[found.baseline]
    angles = base["slenderness_angle"].values.tolist()
    figure, axes = new_figure(SINGLE, 0.9 + 1.25 * len(angles), rows=len(angles), sharex=True)
    for place, (panel, alpha) in enumerate(zip(axes, angles, strict=True)):
        for number, label in enumerate(found.labels):
            period, middle = base["period"].values, fractiles(found.datasets[label], place)[1]
            panel.plot(period, middle, label=plain(label), linewidth=1.0, **look(number))
        panel.set_ylim(bottom=0.0)
        panel.set_title(rf"$\alpha$ = {alpha:.3g} rad; {_flipped(found, place)}", loc="left", fontsize=7)
    figure.supylabel(PEAK if base.sizes["motion"] == 1 else f"median {PEAK}", fontsize=8)
    axes[-1].set_xlabel(r"$2\pi\,/\,p$ [s]")
    if geometric(np.asarray(base["period"].values)):
        plain_log(axes[-1], "x")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _flipped(found: Sensitivity, place: int) -> str:
    """Return how many verdicts of one slenderness flip with each choice."""
    made: xr.DataArray = found.differences("verdict").isel(slenderness_angle=place)
    counts = (np.abs(made) == 1).sum([name for name in made.dims if name != "restitution"])
    total = made[0].size
    return "flips " + ", ".join(f"{int(n):,}" for n in counts.values) + f" of {total:,}"


def _of_fragility(found: Sensitivity, unit: tuple[str, float] | None) -> "Figure":
    from rocking.plots.fragility_words import symbol

    states = found.states
    figure, axes = new_figure(SINGLE, 1.1 + 1.55 * len(states), rows=len(states), sharex=True)
    results = [found.results[label] for label in found.labels]
    levels = np.asarray(results[0].levels)
    fine = np.linspace(levels[0], levels[-1], 160)
    for panel, state in zip(axes, states, strict=True):
        for number, (label, result) in enumerate(zip(found.labels, results, strict=True)):
            fit = result.fits[state]
            words = plain(label) if panel is axes[0] else None
            if fit.exists:
                panel.plot(fine, fit.probability(fine), linewidth=1.0, **look(number))
            share = result.counts[state] / np.maximum(result.trials, 1)
            panel.plot(levels, share, "osv^D<"[number], markersize=2.6, color=look(number)["color"], alpha=0.8)
            panel.plot([], [], marker="osv^D<"[number], markersize=2.6, label=words, **look(number))
        panel.set_ylim(-0.03, 1.03)
        panel.set_title(f"{symbol(state)}: {_medians(found, state, unit)}", loc="left", fontsize=7)
    figure.supylabel("probability [-]", fontsize=8)
    measure = results[0].subject.measure
    axes[-1].set_xlabel(axis_label(measure.name, measure.unit, linear=results[0].subject.settings.linear))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _medians(found: Sensitivity, state: str, unit: tuple[str, float] | None) -> str:
    """Return the medians of all choices in words, in the order of the legend."""
    medians = [found.results[label].fits[state].median for label in found.labels]
    name, size = unit or (found.results[found.baseline].subject.measure.unit, 1.0)
    words = ", ".join("none" if value is None else f"{value / size:.3g}" for value in medians)
    return f"medians {words} {name}".removesuffix(" -").replace("m/s2", "m/s$^2$")
