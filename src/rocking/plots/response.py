"""Picture of a response (ground motion, rotation, velocity, energy, friction demand), and its curves."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.response import Response
from rocking.motions.motion import GroundMotion
from rocking.outcome import Outcome
from rocking.plots.style import DASHED, DOUBLE, GREY, INK, PALE, headline, in_journal_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROTATION, _VELOCITY, _IMPACT, _FALL = "#0070B2", "#009960", "#D96C00", "#AC8191"
_KINETIC, _POTENTIAL, _LOST, _WORK = "#AC5B2B", "#0070B2", "#D96C00", "#222222"
_BEYOND = 2.2  # largest plotted rotation of an overturning body, in slenderness angles
_SMALL = 0.2  # for smaller fractions of the slenderness angle, the panel omits the lines at +-1
_LONGEST_LINE = 118  # characters that fit into one line of the small print
_INSIDE = np.linspace(0.0, 1.0, 5)
_REST = 0.06  # plotted time after the last event, as a fraction of the time before


@in_journal_style
def response_picture(response: Response, friction: float = 0.5) -> "Figure":
    """Draw a response: ground acceleration, rotation, angular velocity, energy, friction.

    Parameters
    ----------
    response : Response
        Result of `simulate` or `free_rocking`.
    friction : float
        Coefficient of friction between body and ground, compared with the friction demand [-].

    Returns
    -------
    matplotlib.figure.Figure
        Five panels over one time axis.

    Examples
    --------
    >>> import rocking as rk
    >>> pulse = rk.pulses.sine(amplitude=3.0, period=0.8)
    >>> len(response_picture(rk.simulate(rk.Block(width=0.5, height=2.0), pulse)).axes)
    5
    """
    friction = checks.positive("friction", friction)
    ratios = [0.75, 1.7, 0.9, 1.2, 0.8]
    figure, axes = new_figure(DOUBLE, 7.0, rows=5, sharex=True, height_ratios=ratios)
    headline(figure, response.summary)
    axes[0].set_title("\n".join(_small_print(response)), loc="left", fontsize=7.5, color=INK)
    time, rotation, velocity = motion_curves(response)
    _ground(axes[0], response)
    _rotation(axes[1], response, time, over_slenderness(response, rotation))
    _velocity(axes[2], response, time, velocity)
    _energy(axes[3], response)
    _friction(axes[4], response, friction)
    for panel in axes:
        panel.locator_params(axis="y", nbins=5)
        if not np.isnan(response.overturning_time):
            panel.axvline(response.overturning_time, color=_FALL, linewidth=0.9, linestyle=DASHED, zorder=1)
    axes[0].set_xlim(0.0, shown_until(response))
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    return figure


def _small_print(response: Response) -> list[str]:
    motion = response.motion
    ground = "free rocking, the ground at rest" if motion is None else " ".join(motion.name.split())
    if response.scale != 1.0:
        ground = f"{response.scale:g} times {ground}"
    lines = [ground, f"restitution: {response.parameters.label};  engine: {response.engine}"]
    short = [line if len(line) <= _LONGEST_LINE else line[: _LONGEST_LINE - 3] + "..." for line in lines]
    return [line.replace("$", r"\$") for line in short]


def _ground(axes: "Axes", response: Response) -> None:
    time, values = ground_curve(response)
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    axes.plot(time, values, color=INK, linewidth=0.7)
    if not values.any():
        axes.set_ylim(-1.0, 1.0)
    axes.set_ylabel("ground\nacceleration\n[m/s$^2$]")


def _rotation(axes: "Axes", response: Response, time: FloatArray, values: FloatArray) -> None:
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    axes.plot(time, values, color=_ROTATION, linewidth=1.0, zorder=3)
    times = response.impacts["time"]
    if times.size:
        axes.plot(
            times, np.zeros(times.size), marker="o", markersize=3.2, markerfacecolor="white", color=_IMPACT,
            linestyle="none", zorder=4, label=f"impacts ({times.size})",
        )  # fmt: skip
    peak = float(np.abs(values).max(initial=0.0))
    if 0.0 < peak < _SMALL:
        axes.set_ylim(-1.25 * peak, 1.25 * peak)
        axes.set_title(r"the slenderness angle, $\pm$1, lies far outside this panel", loc="right", fontsize=7)
    else:
        for level in (-1.0, 1.0):
            axes.axhline(level, color=GREY, linewidth=0.8, linestyle=DASHED, zorder=1)
        most = _BEYOND if response.outcome is Outcome.OVERTURNED else np.inf
        low, high = max(float(values.min(initial=-1.0)), -most), min(float(values.max(initial=1.0)), most)
        axes.set_ylim(1.15 * low, 1.15 * high)
    if response.outcome is Outcome.OVERTURNED:
        axes.plot([], [], color=_FALL, linewidth=0.9, linestyle=DASHED, label="overturning certain")
    if times.size or response.outcome is Outcome.OVERTURNED:
        legend_above(axes, 2)
    axes.set_ylabel("rotation /\nslenderness\nangle [-]")


def _velocity(axes: "Axes", response: Response, time: FloatArray, velocity: FloatArray) -> None:
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    axes.plot(time, velocity, color=_VELOCITY, linewidth=0.9)
    _limits(axes, response, time, [velocity])
    axes.set_ylabel("angular\nvelocity\n[rad/s]")


def _energy(axes: "Axes", response: Response) -> None:
    energy = response.energy
    rows = (
        ("kinetic", energy.kinetic, _KINETIC, "-"),
        ("potential", energy.potential, _POTENTIAL, "--"),
        ("lost at impacts", energy.lost, _LOST, "-."),
        ("work of the ground", energy.work, _WORK, ":"),
    )
    unit, factor = _unit(response, [values for _, values, _, _ in rows])
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    for label, values, color, line in rows:
        axes.plot(energy.time, factor * values, color=color, linestyle=line, linewidth=0.9, label=label)
    _limits(axes, response, energy.time, [factor * values for _, values, _, _ in rows])
    legend_above(axes, 4)
    axes.set_ylabel(f"energy\n[{unit}]")


def _unit(response: Response, histories: list[FloatArray]) -> tuple[str, float]:
    is_before_overturning = ~(response.energy.time > response.overturning_time)
    largest = max(float(np.abs(values[is_before_overturning]).max()) for values in histories)
    for unit, factor in (("MJ", 1e-6), ("kJ", 1e-3)):
        if largest * factor >= 1.0:
            return unit, factor
    return "J", 1.0


def _friction(axes: "Axes", response: Response, friction: float) -> None:
    contact = response.contact
    is_before_overturning = ~(contact.time > response.overturning_time)
    in_contact = is_before_overturning & (contact.vertical > 0.0)
    demand = np.full(contact.time.size, np.nan)
    demand[in_contact] = np.abs(contact.horizontal[in_contact]) / contact.vertical[in_contact]
    axes.plot(contact.time, demand, color=INK, linewidth=0.8, label="demand between impacts")
    largest = np.nanmax(demand, initial=friction)
    if response.impacts.size:
        axes.axhline(contact.friction_of_impacts, color=_IMPACT, linewidth=0.9, linestyle="-.", label="at impacts")
        largest = max(largest, contact.friction_of_impacts)
    axes.axhline(friction, color=GREY, linewidth=0.9, linestyle=DASHED, label=f"friction {friction:g}")
    axes.set_ylim(0.0, 1.15 * min(largest, 4.0 * friction + contact.friction_of_impacts))
    if response.lost_contact:
        axes.set_title("the contact force becomes tensile", loc="right", fontsize=7, color=_IMPACT)
    legend_above(axes, 3)
    axes.set_ylabel("friction\ndemand [-]")


def _limits(axes: "Axes", response: Response, time: FloatArray, values: list[FloatArray]) -> None:
    """Fit a panel to the values before overturning."""
    is_before_overturning = ~(time > response.overturning_time)
    low = min(float(history[is_before_overturning].min(initial=0.0)) for history in values)
    high = max(float(history[is_before_overturning].max(initial=0.0)) for history in values)
    margin = 0.12 * (high - low) or 1.0
    axes.set_ylim(low - margin, high + margin)


def motion_curves(response: Response) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times [s], rotations [rad] and velocities [rad/s]. Times of impacts appear twice, for vertical jumps."""
    dense_output = response.dense_output
    rotation, velocity = dense_output.evaluated(_INSIDE)
    time = dense_output.start[:, None] + _INSIDE * dense_output.length[:, None]
    return time.ravel(), rotation.ravel(), velocity.ravel()


def velocity_at(response: Response, time: Any) -> FloatArray:
    """Return the angular velocity [rad/s] at times [s] within a response.

    At an impact, the velocity after the impact.
    """
    dense_output = response.dense_output
    t = np.clip(np.asarray(time, dtype=np.float64), 0.0, dense_output.end[-1])
    k = np.clip(np.searchsorted(dense_output.start, t, side="right") - 1, 0, dense_output.start.size - 1)
    x = (t - dense_output.start[k]) / dense_output.length[k]
    slopes = dense_output.quintics()[k][..., 1:] * np.arange(1, 6)
    return np.asarray((slopes * x[..., None] ** np.arange(5)).sum(axis=-1) / dense_output.length[k])


def over_slenderness(response: Response, rotation: FloatArray) -> FloatArray:
    """Return rotations [rad] / slenderness angle of their side [-]. Above 1, the centre of mass is beyond the foot."""
    parameters = response.parameters
    return rotation / np.where(rotation > 0.0, parameters.right.slenderness_angle, parameters.left.slenderness_angle)


def shown_until(response: Response) -> float:
    """Return the end of the plotted time: after the motion and the last event [s]."""
    end = float(response.time[-1]) or float(response.dense_output.end[-1])  # the end may be before the second sample
    motion = float(response.time[-1]) if response.motion is None else response.motion.duration
    if response.outcome is Outcome.OVERTURNED or not response.trajectory.events:
        return min(end, motion) if response.outcome is Outcome.NO_UPLIFT else end
    last = max(event.time for event in response.trajectory.events)
    if np.any(response.rotation[response.time > last] != 0.0):
        return end
    return min(end, (1.0 + _REST) * max(last, 0.0 if response.motion is None else motion))


def ground_curve(response: Response) -> tuple[FloatArray, FloatArray]:
    """Return times [s] and horizontal accelerations [m/s2] of the ground, with vertical jumps at the ends."""
    segments = response.segments
    parts = np.arange(1 if isinstance(response.motion, GroundMotion) else 3)
    tau = np.append(parts / parts.size, 1.0)
    powers = tau[None, :] ** np.arange(segments.degree + 1)[:, None]
    time = (np.arange(segments.count)[:, None] + tau) * segments.step
    values = response.scale * (segments.horizontal @ powers)
    return np.append(0.0, time), np.append(0.0, values)


def ground_displacement_at(response: Response, time: FloatArray) -> FloatArray:
    """Return the horizontal displacement of the ground [m] at times [s], from rest. The integration is exact."""
    segments = response.segments
    h, order = segments.step, np.arange(segments.degree + 1)
    c = response.scale * segments.horizontal
    velocity_steps = h * (c / (order + 1)).sum(axis=1)
    velocity = np.concatenate([[0.0], np.cumsum(velocity_steps)])
    displacement_steps = h * velocity[:-1] + h * h * (c / ((order + 1) * (order + 2))).sum(axis=1)
    displacement = np.concatenate([[0.0], np.cumsum(displacement_steps)])
    k = np.clip((time / h).astype(np.int64), 0, segments.count - 1)
    tau = time / h - k
    within_step = (c[k] / ((order + 1) * (order + 2)) * tau[:, None] ** (order + 2)).sum(axis=1)
    return np.asarray(displacement[k] + h * velocity[k] * tau + h * h * within_step)
