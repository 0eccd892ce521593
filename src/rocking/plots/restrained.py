"""Pictures of a body with restraints: response, forces and hysteresis of restraints, pushover."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.plots.style import COLORS, DOUBLE, INK, PALE, headline, in_journal_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.bodies.restrained import Restrained
    from rocking.conventions import FloatArray
    from rocking.dynamics.restrained.pushover import Pushover
    from rocking.dynamics.restrained.response import RestrainedResponse


@in_journal_style
def restrained_picture(response: "RestrainedResponse") -> "Figure":
    """Draw a response with restraints: ground acceleration, rotation, forces of restraints, energy.

    Parameters
    ----------
    response : RestrainedResponse
        Result of `simulate` or `free_rocking` for a body with restraints.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels over one time axis.

    Examples
    --------
    >>> import rocking as rk
    >>> wall = rk.Restrained(rk.Block(width=1.0, height=6.0), rk.Tendon(x=0.5, stiffness=1e6))
    >>> len(restrained_picture(rk.free_rocking(wall, rotation=0.02, restitution=0.9, duration=2.0)).axes)
    4
    """
    figure, axes = new_figure(DOUBLE, 6.5, rows=4, sharex=True, height_ratios=[0.7, 1.5, 1.3, 1.1])
    headline(figure, response.summary)
    time = response.time
    axes[0].plot(time, response.ground_acceleration, color=INK, linewidth=0.7)
    axes[0].set_ylabel("ground\nacceleration\n[m/s$^2$]")
    axes[1].plot(time, np.degrees(response.rotation), color=COLORS[0], linewidth=1.0)
    axes[1].set_ylabel("rotation\n[degrees]")
    for k, restraint in enumerate(response.body.restraints):
        colour = COLORS[k % len(COLORS)]
        axes[2].plot(time, 1e-3 * response.restraint_force[:, k], color=colour, linewidth=0.9, label=restraint.name)
        axes[3].plot(time, 1e-3 * response.restraint_work[:, k], color=colour, linewidth=0.9)
    if response.body.restraints:
        legend_above(axes[2], 4)
    axes[2].set_ylabel("force\n[kN]")
    axes[3].plot(
        time, 1e-3 * response.forces.energy_lost, color=INK, linewidth=0.9, linestyle="dashed", label="impacts"
    )
    axes[3].set_ylabel("work on\nrestraints\n[kJ]")
    legend_above(axes[3], 1)
    for panel in axes:
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
        panel.locator_params(axis="y", nbins=5)
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    return figure


@in_journal_style
def loops_picture(response: "RestrainedResponse") -> "Figure":
    """Draw the moment against the rotation, and the force of each restraint against its elongation.

    Parameters
    ----------
    response : RestrainedResponse
        Result of `simulate` or `free_rocking` for a body with restraints.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels: moment on the foundation about the middle of the base, and force over elongation.

    Examples
    --------
    >>> import rocking as rk
    >>> wall = rk.Restrained(rk.Block(width=1.0, height=6.0), rk.Tendon(x=0.5, stiffness=1e6))
    >>> len(loops_picture(rk.free_rocking(wall, rotation=0.02, restitution=0.9, duration=2.0)).axes)
    2
    """
    figure, axes = new_figure(DOUBLE, 3.2, columns=2)
    moment = 1e-3 * response.forces.overturning_moment
    axes[0].plot(np.degrees(response.rotation), moment, color=INK, linewidth=0.7)
    axes[0].set_ylabel("overturning moment [kN m]")
    _forces(axes, response.body, response.elongation, response.restraint_force)
    return figure


@in_journal_style
def pushover_picture(pushover: "Pushover") -> "Figure":
    """Draw a pushover: moment over rotation, and force over elongation of the restraints.

    Parameters
    ----------
    pushover : Pushover
        Result of `pushover`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels.

    Examples
    --------
    >>> import rocking as rk
    >>> wall = rk.Restrained(rk.Block(width=1.0, height=6.0), rk.Tendon(x=0.5, stiffness=1e6))
    >>> len(pushover_picture(rk.pushover(wall, [0.0, 0.02, 0.0])).axes)
    2
    """
    figure, axes = new_figure(DOUBLE, 3.2, columns=2)
    axes[0].plot(np.degrees(pushover.rotation), 1e-3 * pushover.restoring_moment, color=INK, linewidth=1.0)
    axes[0].set_ylabel("restoring moment [kN m]")
    _forces(axes, pushover.body, pushover.elongation, pushover.force)
    return figure


def _forces(axes: Any, body: "Restrained", elongation: "FloatArray", force: "FloatArray") -> None:
    """Draw the force of each restraint over its elongation in the second panel, and label both panels."""
    axes[0].set_xlabel("rotation [degrees]")
    for k, restraint in enumerate(body.restraints):
        axes[1].plot(
            1e3 * elongation[:, k], 1e-3 * force[:, k], color=COLORS[k % len(COLORS)], linewidth=0.9,
            label=restraint.name,
        )  # fmt: skip
    if body.restraints:
        legend_above(axes[1], 2)
    axes[1].set_xlabel("elongation [mm]")
    axes[1].set_ylabel("force [kN]")
