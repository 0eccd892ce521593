"""Picture of the response of a body on an isolated base."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.plots.style import DOUBLE, INK, PALE, headline, in_journal_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.dynamics.isolated.response import IsolatedResponse


@in_journal_style
def isolated_picture(response: "IsolatedResponse") -> "Figure":
    """Draw a response on an isolated base: rotation, displacement of the base, energy.

    Parameters
    ----------
    response : IsolatedResponse
        Result of `simulate` or `free_rocking` for a body on an isolated base.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels over one time axis.

    Examples
    --------
    >>> import rocking as rk
    >>> bust = rk.Isolated(rk.Block(width=0.5, height=2.0, mass=1000.0), 500.0, period=2.0)
    >>> len(isolated_picture(rk.free_rocking(bust, rotation=0.05, restitution=0.9, duration=2.0)).axes)
    3
    """
    figure, axes = new_figure(DOUBLE, 5.5, rows=3, sharex=True)
    headline(figure, response.summary)
    time = response.time
    axes[0].plot(time, np.degrees(response.rotation), color=INK, linewidth=1.0)
    axes[0].set_ylabel("rotation\n[degrees]")
    axes[1].plot(time, 1e3 * response.base_displacement, color="#D96C00", linewidth=1.0)
    axes[1].set_ylabel("displacement\nof the base\n[mm]")
    samples = response.trajectory.samples
    for name, label, style in (("dissipated", "isolators", "-"), ("lost", "impacts", "--")):
        axes[2].plot(time, 1e-3 * samples[name][: time.size], color=INK, linewidth=0.9, linestyle=style, label=label)
    axes[2].set_ylabel("energy lost\n[kJ]")
    legend_above(axes[2], 2)
    for panel in axes:
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
        panel.locator_params(axis="y", nbins=5)
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    return figure
