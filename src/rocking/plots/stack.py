"""Picture of the response of a stack."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.plots.style import DOUBLE, INK, PALE, headline, in_journal_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.dynamics.stack.response import StackResponse

_MOST_NAMED = 6


@in_journal_style
def stack_picture(response: "StackResponse") -> "Figure":
    """Draw the response of a stack: ground acceleration, rotations, openings, displacements along joints.

    Parameters
    ----------
    response : StackResponse
        Result of `simulate` or `free_rocking` for a stack.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels over one time axis, four if a joint slides.

    Examples
    --------
    >>> import rocking as rk
    >>> stack = rk.Stack([rk.Block(width=1.0, height=2.0), rk.Block(width=0.6, height=2.0)])
    >>> len(stack_picture(rk.free_rocking(stack, rotation=(0.0, 0.05), duration=0.5)).axes)
    3
    """
    import matplotlib as mpl

    slides = bool(response.joint_displacement.any())
    heights = [0.7, 1.4, 1.2, 1.0][: 3 + slides]
    figure, axes = new_figure(DOUBLE, 5.2 + 1.3 * slides, rows=len(heights), sharex=True, height_ratios=heights)
    headline(figure, response.summary)
    time, count = response.time, response.rotation.shape[1]
    axes[0].plot(time, response.ground_acceleration, color=INK, linewidth=0.7)
    axes[0].set_ylabel("ground\nacceleration\n[m/s$^2$]")
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, count))
    panels = (
        (axes[1], np.degrees(response.rotation), "rotation\n[degrees]", "body"),
        (axes[2], np.degrees(response.opening), "opening of\njoint\n[degrees]", "joint"),
        (axes[-1], 1e3 * response.joint_displacement, "joint\ndisplacement\n[mm]", "joint"),
    )[: 2 + slides]
    for panel, values, label, item in panels:
        for k in range(count):
            panel.plot(time, values[:, k], color=colours[k], linewidth=0.9, label=f"{item} {k + 1}")
        panel.set_ylabel(label)
    if count <= _MOST_NAMED:
        legend_above(axes[1], count)
        legend_above(axes[2], count)
    for panel in axes:
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
        panel.locator_params(axis="y", nbins=5)
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    return figure
