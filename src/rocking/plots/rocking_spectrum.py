"""Rocking spectra: peak rotation over the size of blocks, a curve for each slenderness, and what overturns."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rocking import conventions
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.plots.labels import PEAK, geometric, plain, plain_log, plain_numbers
from rocking.plots.style import PALE, SINGLE, in_journal_style, look, new_figure
from rocking.statistics.quantiles import quantiles

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BEYOND = 1e3


@in_journal_style
def rocking_spectrum_picture(found: "xr.Dataset") -> "Figure":
    r"""Draw rocking spectra: of one motion its curves, of several the median and the 16 % to 84 % band.

    Below the curves a strip shows the sizes at which a block overturns: as bars for one motion, as the share of the
    motions for several. A curve has a gap where the block, or half of the motions, overturned.

    Parameters
    ----------
    found : xarray.Dataset
        As of `rocking_spectrum`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over 2 pi / p, with the semi-diagonal above; one column wide.

    Raises
    ------
    InvalidValueError
        If these are no spectra.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies._rocking_spectrum import rocking_spectrum
    >>> found = rocking_spectrum(rk.pulses.sine(amplitude=4.0, period=0.8), [0.2, 0.3], [2.0, 4.0, 8.0], 0.9)
    >>> rocking_spectrum_picture(found).axes[1].get_xlabel()
    '$2\\pi\\,/\\,p$ [s]'
    """
    if not hasattr(found, "data_vars") or set(found.sizes) < {"motion", "slenderness_angle", "period"}:
        raise InvalidValueError(parameter="found", allowed="of rocking_spectrum", value=found)
    figure, (upper, lower) = new_figure(SINGLE, 3.4, rows=2, sharex=True, height_ratios=[3.2, 1.0])
    for place, alpha in enumerate(found["slenderness_angle"].values.tolist()):
        _curve(upper, found, place, float(alpha))
    upper.set_ylabel(PEAK)
    # the highest point of the curves and of what is known of the bands
    parts = [part for place in range(found.sizes["slenderness_angle"]) for part in fractiles(found, place)]
    highest = max([0.05, *(float(np.nanmax(part)) for part in parts if np.isfinite(part).any())])
    upper.set_ylim(0.0, 1.08 * highest)
    upper.legend(loc="upper right", title=r"$\alpha$ [rad]", title_fontsize=7, handlelength=2.4)
    _overturning(lower, found)
    lower.set_xlabel(r"$2\pi\,/\,p$ [s]")
    _sizes(upper, found)
    figure.suptitle(_words(found), x=0.01, ha="left", fontsize=7)
    return figure


def _words(found: "xr.Dataset") -> str:
    names = found["motion"].values.tolist()
    what = plain(names[0]) if len(names) == 1 else f"{len(names)} motions: median, and 16 % to 84 %"
    scale = float(found.attrs.get("scale", 1.0))
    factor = "" if scale == 1.0 else f"{scale:g} times "
    return f"{factor}{what}; restitution {plain(found.attrs.get('restitution', ''))}"


def _curve(axes: "Axes", found: "xr.Dataset", place: int, alpha: float) -> None:
    period = np.asarray(found["period"].values)
    low, middle, high = fractiles(found, place)
    label = f"{alpha:.3g}"
    if found.sizes["motion"] > 1:
        # where 84 % overturned the band goes on beyond the panel
        high = np.where(np.isfinite(low) & np.isnan(high), _BEYOND, high)
        axes.fill_between(period, low, high, color=look(place)["color"], alpha=0.15, linewidth=0)
    axes.plot(period, middle, label=label, linewidth=1.0, **look(place))
    known = np.pad(np.isfinite(middle), 1)
    alone = known[1:-1] & ~known[:-2] & ~known[2:]
    axes.plot(period[alone], middle[alone], linestyle="none", marker=".", color=look(place)["color"])


def fractiles(found: "xr.Dataset", place: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return 16 %, 50 % and 84 % of the peak rotation by period [-]; NaN where that overturned or is unknown."""
    part = found.isel(slenderness_angle=place)
    mode = np.asarray(part["mode"].values)
    peak = np.where(mode >= 0, math.inf, np.asarray(part["peak_ratio"].values))
    low, middle, high = quantiles(np.where(mode == -3, np.nan, peak), (0.16, 0.5, 0.84))
    return tuple(np.where(np.isfinite(part), part, np.nan) for part in (low, middle, high))  # type: ignore[return-value]


def _overturning(axes: "Axes", found: "xr.Dataset") -> None:
    """Draw what overturns: bars for one motion, shares for several."""
    period = np.asarray(found["period"].values)
    mode = np.asarray(found["mode"].values)
    angles = found["slenderness_angle"].values
    if found.sizes["motion"] == 1:
        edges = np.concatenate([period[:1], np.sqrt(period[1:] * period[:-1]), period[-1:]])
        bars = np.column_stack([edges[:-1], np.diff(edges)])
        for place in range(angles.size):
            axes.axhline(place, color=PALE, linewidth=0.6, zorder=0)
            spans = bars[mode[0, place] >= 0].tolist()
            axes.broken_barh(spans, (place - 0.3, 0.6), facecolor=look(place)["color"], linewidth=0)
        axes.set_ylim(angles.size - 0.4, -0.6)
        axes.set_yticks(range(angles.size), [f"{alpha:.3g}" for alpha in angles])
        axes.set_ylabel("overturns,\n" + r"$\alpha$ [rad]")
        return
    with np.errstate(invalid="ignore"):  # where nothing could be computed there is no share
        shares = (mode >= 0).sum(axis=0) / (mode != -3).sum(axis=0)
    for place, share in enumerate(shares):
        axes.plot(period, share, linewidth=1.0, **look(place))
    axes.set_ylim(-0.03, 1.03)
    axes.set_ylabel("share over-\nturned [-]")


def _sizes(axes: "Axes", found: "xr.Dataset") -> None:
    """Scale the axes, and show the semi-diagonal above."""
    period = np.asarray(found["period"].values)
    if period.size > 1:
        axes.set_xlim(period[0], period[-1])
    gravity = float(found.attrs.get("setting_gravity", conventions.g))
    per = 0.75 * gravity / (4.0 * math.pi**2)
    pair = (lambda t: per * np.square(t), lambda size: np.sqrt(np.maximum(size, 0.0) / per))
    if geometric(period):
        plain_log(axes, "x")  # before the axis above is made, which takes its scale from here
    above = axes.secondary_xaxis("top", functions=pair)
    above.set_xlabel("semi-diagonal R [m]")
    if geometric(period):
        from matplotlib.ticker import LogLocator

        above.xaxis.set_major_locator(LogLocator(subs=(1.0,) if period[-1] / period[0] > 8.0 else (1.0, 2.0, 5.0)))
        plain_numbers(above.xaxis)
