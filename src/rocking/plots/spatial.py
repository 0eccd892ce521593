"""Picture of a 3D response: path of the top in plan, contact, tilt and its azimuth over time."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.frictional.ground import frame
from rocking.dynamics.frictional.response import HullResponse
from rocking.dynamics.rolling.response import SpatialResponse
from rocking.outcome import ContactMode, Outcome
from rocking.plots.style import DASHED, DOUBLE, GREY, INK, PALE, headline, in_journal_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = {
    ContactMode.REST: PALE,
    ContactMode.EDGE: "#0070B2",
    ContactMode.VERTEX: "#AC5B2B",
    ContactMode.ROLLING: "#009960",
}
_SLIDES = "#AC8191"
_ON = {"face": PALE, "edge": "#0070B2", "vertex": "#AC5B2B", "flight": "#008FE6"}
_IMPACT, _TOP = "#D96C00", "#0070B2"
_SMALL = 1e-3  # for smaller fractions of the largest tilt, the azimuth has no meaning


@in_journal_style
def spatial_picture(response: SpatialResponse | HullResponse) -> "Figure":
    """Draw a 3D response.

    Parameters
    ----------
    response : SpatialResponse or HullResponse
        Result of `simulate` or `free_rocking` for a 3D body, without or with friction.

    Returns
    -------
    matplotlib.figure.Figure
        Path of the top, or of the centre of mass, in plan; tilt, azimuth of the tilt and contact over time.

    Examples
    --------
    >>> from rocking.dynamics import SpatialBody, SpatialStart, free_rocking
    >>> response = free_rocking(SpatialBody.box(1.0, 1.0, 4.0), start=SpatialStart(0.1, 0.3), duration=2.0)
    >>> len(spatial_picture(response).axes)
    4
    """
    if isinstance(response, HullResponse):
        return _on_the_hull(response)
    body, states = response.body, response.at([0.0])
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    corners = body.radius * circle if body.round else body.vertices
    outline = np.array([states.point(corner)[0, :2] for corner in corners])
    regimes = [(start, end, contact.name.lower(), _COLOURS[contact]) for start, end, contact, _ in response.intervals]
    reach = float(np.degrees(np.arctan2(body.reach, body.centre[2])))
    return _picture(response, outline, (response.top, "path of the top"), regimes, reach)


def _on_the_hull(response: HullResponse) -> "Figure":
    body, start = response.body, response.trajectory.states[0]
    turned = np.array(frame(start.attitude))
    base = body.hull.corners(response.trajectory.initial_facet)
    outline = np.array([turned @ body.points[i] for i in base])[:, :2]
    regimes = []
    for first, last, touching, sliding in response.intervals:
        name = ("flight", "vertex", "edge", "face")[min(len(touching), 3)]
        regimes.append((first, last, "slides" if sliding else name, _SLIDES if sliding else _ON[name]))
    return _picture(response, outline, (response.centre, "path of the centre"), regimes, None)


def _picture(
    response: SpatialResponse | HullResponse,
    outline: FloatArray,
    path: tuple[FloatArray, str],
    regimes: list[tuple[float, float, str, str]],
    reach: float | None,
) -> "Figure":
    figure, panels = new_figure(DOUBLE, 4.6)
    panels[0].remove()
    grid = figure.add_gridspec(3, 2, width_ratios=[1.0, 1.35], height_ratios=[1.6, 1.2, 0.35])
    plan = figure.add_subplot(grid[:, 0])
    tilt = figure.add_subplot(grid[0, 1])
    direction = figure.add_subplot(grid[1, 1], sharex=tilt)
    contact = figure.add_subplot(grid[2, 1], sharex=tilt)
    headline(figure, response.summary)
    _plan(plan, outline, *path)
    _tilt(tilt, response, reach)
    _direction(direction, response)
    _contact(contact, regimes, float(response.time[-1]))
    tilt.set_xlim(0.0, max(float(response.time[-1]), 1e-9))
    for panel in (tilt, direction):
        panel.tick_params(labelbottom=False)
    figure.align_ylabels([tilt, direction, contact])
    return figure


def _plan(axes: "Axes", outline: FloatArray, path: FloatArray, path_label: str) -> None:
    axes.fill(outline[:, 0], outline[:, 1], facecolor="none", edgecolor=GREY, linewidth=0.8, label="base at the start")
    axes.plot(path[:, 0], path[:, 1], color=_TOP, linewidth=0.8, label=path_label)
    axes.plot(path[:1, 0], path[:1, 1], marker="o", markersize=3.5, color=INK, linestyle="none", label="start")
    axes.plot(path[-1:, 0], path[-1:, 1], marker="s", markersize=3.5, color=_IMPACT, linestyle="none", label="end")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    legend_above(axes, 2)


def _tilt(axes: "Axes", response: SpatialResponse | HullResponse, reach: float | None) -> None:
    axes.plot(response.time, np.degrees(response.tilt), color=INK, linewidth=0.9)
    times = response.impacts["time"]
    times = times[times <= response.time[-1]]
    if times.size:
        heights = np.degrees(np.interp(times, response.time, response.tilt))
        axes.plot(
            times, heights, marker="o", markersize=2.6, markerfacecolor="white", color=_IMPACT, linestyle="none",
            label=f"impacts ({times.size})",
        )  # fmt: skip
    if reach is not None and (response.outcome is Outcome.OVERTURNED or np.degrees(response.tilt).max() > 0.3 * reach):
        axes.axhline(reach, color=GREY, linewidth=0.8, linestyle=DASHED, label="smallest slenderness angle")
    axes.set_ylim(bottom=0.0)
    if axes.get_legend_handles_labels()[0]:
        legend_above(axes, 2)
    axes.set_ylabel("tilt\n[degrees]")


def _direction(axes: "Axes", response: SpatialResponse | HullResponse) -> None:
    leans = response.tilt > _SMALL * response.tilt.max(initial=0.0)
    azimuth = np.degrees(response.azimuth[leans])
    axes.plot(response.time[leans], azimuth, color=_TOP, marker=".", markersize=1.6, linestyle="none")
    axes.set_ylim(-190.0, 190.0)
    axes.set_yticks([-180, -90, 0, 90, 180])
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.set_ylabel("azimuth of tilt\n[degrees]")


def _contact(axes: "Axes", regimes: list[tuple[float, float, str, str]], until: float) -> None:
    seen: set[str] = set()
    for start, end, name, colour in regimes:
        last = min(end, until)
        if last <= start:
            continue
        label = None if name in seen else name
        seen.add(name)
        axes.barh(0.0, last - start, left=start, height=0.8, color=colour, linewidth=0.0, label=label)
    axes.set(yticks=[], ylim=(-0.5, 0.5), xlabel="time [s]", ylabel="contact")
    legend_above(axes, 5)
