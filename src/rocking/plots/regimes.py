"""Pictures of regimes: Shenton's map, and a planar response with coloured regimes."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.dynamics.plane_frictional.response import ContactResponse
from rocking.dynamics.plane_frictional.shenton import friction_demand, regime_map
from rocking.errors import InvalidValueError
from rocking.outcome import Regime
from rocking.plots.style import (
    DOUBLE,
    GREY,
    INK,
    PALE,
    SINGLE,
    headline,
    in_journal_style,
    legend_above,
    new_figure,
    patch,
)  # fmt: skip

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {
    Regime.REST: "#ffffff",
    Regime.SLIDE: "#F0E442",
    Regime.ROCK: "#9BCDEB",
    Regime.SLIDE_ROCK: "#8FD6BE",
    Regime.FLIGHT: "#E8BAD3",
}
"""One pale colour per regime, after Okabe and Ito."""

_LINE, _IMPACT = "#0070B2", "#D96C00"


@in_journal_style
def regime_map_picture(body: Body, largest: float = 1.5, cells: int = 40) -> "Figure":
    """Draw the initial regime of a body at rest under a sudden ground acceleration, with the closed-form boundaries.

    Parameters
    ----------
    body : Body
        The body.
    largest : float
        Largest acceleration / gravity, and equal largest coefficient of friction [-].
    cells : int
        Number of cells along each axis, from 2 to 400.

    Returns
    -------
    matplotlib.figure.Figure
        Cells are computed by complementarity, and lines by Shenton's closed forms.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or there is no rocking below the largest acceleration.

    Examples
    --------
    >>> import rocking as rk
    >>> len(regime_map_picture(rk.Block(width=1.0, height=4.0), cells=4).axes)
    1
    """
    largest = checks.within("largest", largest, 0.0, 100.0, open_low=True)
    cells = checks.whole("cells", cells, 2, 400)
    slender = body.side("left").half_width / body.side("left").centre_height
    if not slender < largest:
        raise InvalidValueError(
            parameter="largest", allowed=f"above b / h = {slender:g}, the limit of uplift", value=largest
        )
    figure, (axes,) = new_figure(SINGLE, 0.95 * SINGLE)
    middles = (np.arange(cells) + 0.5) * largest / cells
    _cells(axes, regime_map(body, middles, middles), largest)
    line: dict[str, Any] = {"color": INK, "linewidth": 1.0}
    axes.plot([0.0, slender, slender], [0.0, slender, largest], **line)
    axes.plot([slender, largest], [slender, slender], **line)
    pushes = np.linspace(slender * (1.0 + 1e-12), largest, 200)
    axes.plot(pushes, [friction_demand(body, push) for push in pushes.tolist()], **line)
    axes.set(xlim=(0.0, largest), ylim=(0.0, largest))
    axes.set(xlabel="ground acceleration over gravity [-]", ylabel="coefficient of friction [-]")
    axes.set_title("cells: complementarity;  lines: closed form", loc="left", fontsize=7)
    return figure


def _name(regime: Regime) -> str:
    return regime.name.lower().replace("_", " and ")


def _cells(axes: "Axes", codes: np.ndarray, largest: float) -> None:
    from matplotlib.colors import ListedColormap

    colours = ListedColormap([COLOURS[regime] for regime in Regime])
    axes.imshow(
        codes, origin="lower", extent=(0.0, largest, 0.0, largest), cmap=colours, vmin=-0.5, vmax=len(Regime) - 0.5,
        aspect="auto", interpolation="nearest",
    )  # fmt: skip
    step = largest / len(codes)
    for regime in Regime:
        rows, places = np.nonzero(codes == regime.code)
        if rows.size > 0.04 * codes.size:
            middle = np.array([np.median(places), np.median(rows)])
            near = np.argmin((places - middle[0]) ** 2 + (rows - middle[1]) ** 2)
            x, y = (places[near] + 0.5) * step, (rows[near] + 0.5) * step
            upright = 90.0 if np.ptp(places) < 0.35 * len(codes) < np.ptp(rows) else 0.0
            axes.text(x, y, _name(regime), ha="center", va="center", fontsize=7, color=INK, rotation=upright)


@in_journal_style
def regimes_picture(response: ContactResponse) -> "Figure":
    """Draw a planar response over its regimes: rotation, position of the centre of mass, energy.

    Parameters
    ----------
    response : ContactResponse
        Result of `simulate` for a plane body with friction.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels over one time axis, with regimes as coloured bands.

    Examples
    --------
    >>> import rocking as rk
    >>> pulse = rk.pulses.sine(amplitude=4.0, period=0.8)
    >>> len(regimes_picture(rk.simulate(rk.Block(width=1.0, height=2.0), pulse, None, friction=0.3)).axes)
    4
    """
    figure, axes = new_figure(DOUBLE, 5.2, rows=4, sharex=True, height_ratios=[1.5, 1.0, 0.8, 1.2])
    headline(figure, response.summary)
    panels = (
        (np.degrees(response.rotation), "rotation\n[degrees]"),
        (response.displacement, "displacement\nof centre [m]"),
        (response.rise, "rise of\ncentre [m]"),
    )
    for panel, (values, label) in zip(axes, panels, strict=False):
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=1)
        panel.plot(response.time, values, color=_LINE, linewidth=0.9, zorder=3)
        panel.set_ylabel(label)
    times = response.impacts["time"]
    turned = np.degrees(response.at(times)[:, 2])
    axes[0].plot(times, turned, "o", markersize=2.6, markerfacecolor="white", color=_IMPACT, zorder=4)
    _energy(axes[3], response)
    _bands(axes, response)
    axes[0].set_xlim(0.0, max(float(response.time[-1]), response.segments.step))
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    return figure


def _energy(axes: "Axes", response: ContactResponse) -> None:
    energy = response.energy
    rows = (
        ("kinetic and potential", energy.kinetic + energy.potential, INK, "-"),
        ("work of the ground", energy.work, GREY, ":"),
        ("lost in impacts", energy.lost_in_impacts, _IMPACT, "-."),
        ("lost in friction", energy.lost_in_friction, "#009960", "--"),
    )
    for label, values, colour, line in rows:
        axes.plot(energy.time, values, color=colour, linestyle=line, linewidth=0.9, label=label, zorder=3)
    axes.set_ylabel("energy [J]")
    legend_above(axes, 4)


def _bands(axes: list["Axes"], response: ContactResponse) -> None:
    regimes = response.regimes
    for regime in Regime:
        mine = regimes[regimes["regime"] == regime.name]
        for panel in axes:
            spans = list(zip(mine["start"], mine["end"] - mine["start"], strict=True))
            panel.broken_barh(
                spans, (0.0, 1.0), transform=panel.get_xaxis_transform(), color=COLOURS[regime], linewidth=0.0, zorder=0
            )
    seen = [regime for regime in Regime if regime.name in set(regimes["regime"])]
    legend_above(axes[0], 5, handles=[patch(COLOURS[r], _name(r), edgecolor=GREY, linewidth=0.4) for r in seen])
