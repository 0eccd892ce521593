"""Pictures of rocking spectra: peak rotation against the size of blocks, one curve per slenderness, and overturning."""

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
def rocking_spectrum_picture(results: "xr.Dataset") -> "Figure":
    r"""Draw rocking spectra: the curves of one motion, or the median and the 16 % to 84 % band of several motions.

    A strip below the curves shows overturning over size, as bars for one motion or as the fraction of several motions.
    A curve has a gap where the block overturns, or where half of the motions overturn the block.

    Parameters
    ----------
    results : xarray.Dataset
        Result of `rocking_spectrum`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over 2 pi / p, with the semi-diagonal above; one column wide.

    Raises
    ------
    InvalidValueError
        If the dataset contains no spectra.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies._rocking_spectrum import rocking_spectrum
    >>> results = rocking_spectrum(rk.pulses.sine(amplitude=4.0, period=0.8), [0.2, 0.3], [2.0, 4.0, 8.0], 0.9)
    >>> rocking_spectrum_picture(results).axes[1].get_xlabel()
    '$2\\pi\\,/\\,p$ [s]'
    """
    if not hasattr(results, "data_vars") or set(results.sizes) < {"motion", "slenderness_angle", "period"}:
        raise InvalidValueError(parameter="results", allowed="of rocking_spectrum", value=results)
    figure, (upper, lower) = new_figure(SINGLE, 3.4, rows=2, sharex=True, height_ratios=[3.2, 1.0])
    for index, alpha in enumerate(results["slenderness_angle"].values.tolist()):
        _curve(upper, results, index, float(alpha))
    upper.set_ylabel(PEAK)
    # the highest point of the curves and of the finite parts of the bands
    curves = [curve for index in range(results.sizes["slenderness_angle"]) for curve in fractiles(results, index)]
    highest = max([0.05, *(float(np.nanmax(curve)) for curve in curves if np.isfinite(curve).any())])
    upper.set_ylim(0.0, 1.08 * highest)
    upper.legend(loc="upper right", title=r"$\alpha$ [rad]", title_fontsize=7, handlelength=2.4)
    _overturning(lower, results)
    lower.set_xlabel(r"$2\pi\,/\,p$ [s]")
    _sizes(upper, results)
    figure.suptitle(_words(results), x=0.01, ha="left", fontsize=7)
    return figure


def _words(results: "xr.Dataset") -> str:
    names = results["motion"].values.tolist()
    motions_text = plain(names[0]) if len(names) == 1 else f"{len(names)} motions: median, and 16 % to 84 %"
    scale = float(results.attrs.get("scale", 1.0))
    factor = "" if scale == 1.0 else f"{scale:g} times "
    return f"{factor}{motions_text}; restitution {plain(results.attrs.get('restitution', ''))}"


def _curve(axes: "Axes", results: "xr.Dataset", index: int, alpha: float) -> None:
    period = np.asarray(results["period"].values)
    low, middle, high = fractiles(results, index)
    label = f"{alpha:.3g}"
    if results.sizes["motion"] > 1:
        # the band extends beyond the panel if the 84 % quantile overturned
        high = np.where(np.isfinite(low) & np.isnan(high), _BEYOND, high)
        axes.fill_between(period, low, high, color=look(index)["color"], alpha=0.15, linewidth=0)
    axes.plot(period, middle, label=label, linewidth=1.0, **look(index))
    finite = np.pad(np.isfinite(middle), 1)
    isolated = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    axes.plot(period[isolated], middle[isolated], linestyle="none", marker=".", color=look(index)["color"])


def fractiles(results: "xr.Dataset", index: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return quantiles (16 %, 50 %, 84 %) of the peak rotation by period [-]. NaN means overturning or no result."""
    selected = results.isel(slenderness_angle=index)
    mode = np.asarray(selected["mode"].values)
    peak = np.where(mode >= 0, math.inf, np.asarray(selected["peak_ratio"].values))
    low, middle, high = quantiles(np.where(mode == -3, np.nan, peak), (0.16, 0.5, 0.84))
    return tuple(np.where(np.isfinite(curve), curve, np.nan) for curve in (low, middle, high))  # type: ignore[return-value]


def _overturning(axes: "Axes", results: "xr.Dataset") -> None:
    """Draw overturning: bars for one motion, fractions for several."""
    period = np.asarray(results["period"].values)
    mode = np.asarray(results["mode"].values)
    angles = results["slenderness_angle"].values
    if results.sizes["motion"] == 1:
        edges = np.concatenate([period[:1], np.sqrt(period[1:] * period[:-1]), period[-1:]])
        bars = np.column_stack([edges[:-1], np.diff(edges)])
        for index in range(angles.size):
            axes.axhline(index, color=PALE, linewidth=0.6, zorder=0)
            spans = bars[mode[0, index] >= 0].tolist()
            axes.broken_barh(spans, (index - 0.3, 0.6), facecolor=look(index)["color"], linewidth=0)
        axes.set_ylim(angles.size - 0.4, -0.6)
        axes.set_yticks(range(angles.size), [f"{alpha:.3g}" for alpha in angles])
        axes.set_ylabel("overturns,\n" + r"$\alpha$ [rad]")
        return
    with np.errstate(invalid="ignore"):  # sizes without a result have no fraction
        fractions = (mode >= 0).sum(axis=0) / (mode != -3).sum(axis=0)
    for index, fraction in enumerate(fractions):
        axes.plot(period, fraction, linewidth=1.0, **look(index))
    axes.set_ylim(-0.03, 1.03)
    axes.set_ylabel("fraction over-\nturned [-]")


def _sizes(axes: "Axes", results: "xr.Dataset") -> None:
    """Set the limits of the period axis, and add an upper axis with the semi-diagonal."""
    period = np.asarray(results["period"].values)
    if period.size > 1:
        axes.set_xlim(period[0], period[-1])
    gravity = float(results.attrs.get("setting_gravity", conventions.g))
    per = 0.75 * gravity / (4.0 * math.pi**2)
    pair = (lambda t: per * np.square(t), lambda size: np.sqrt(np.maximum(size, 0.0) / per))
    if geometric(period):
        plain_log(axes, "x")  # must come before the upper axis, which copies this scale
    above = axes.secondary_xaxis("top", functions=pair)
    above.set_xlabel("semi-diagonal R [m]")
    if geometric(period):
        from matplotlib.ticker import LogLocator

        above.xaxis.set_major_locator(LogLocator(subs=(1.0,) if period[-1] / period[0] > 8.0 else (1.0, 2.0, 5.0)))
        plain_numbers(above.xaxis)
