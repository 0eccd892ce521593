"""Common labels, texts and scales of axes, and curves of a motion with exact peaks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.integrals import ground_displacement, ground_velocity, quadratic_roots
from rocking.motions.intensity import MEASURES
from rocking.motions.motion import SHORTEST_STEP, GroundMotion
from rocking.motions.pulse import Pulse
from rocking.plots.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

SYMBOLS = {
    "frequency_ratio": r"$\omega_p\,/\,p$ [-]",
    "amplitude_ratio": r"$a_p\,/\,(g\,\tan\,\alpha)$ [-]",
    "scale": "factor on the motion [-]",
    "period": "period of the pulse [s]",
    "duration": "duration of the motion [s]",
    "semi_diagonal": "semi-diagonal R [m]",
    "slenderness_ratio": "slenderness h/b [-]",
    "slenderness_angle": r"slenderness angle $\alpha$ [rad]",
    "width": "width [m]",
    "height": "height [m]",
    "restitution": "coefficient of restitution r [-]",
    "initial_rotation": r"initial rotation $\theta_0$ [rad]",
    "initial_angular_velocity": r"initial angular velocity $\dot{\theta}_0$ [rad/s]",
}
"""Labels of axes, by name."""

TYPESET = {
    "/(g tan alpha)": r"$\,/\,(g\,\tan\,\alpha)$",
    "/PGA": " / PGA",
    "D5-95": "$D_{5-95}$",
    "D5-75": "$D_{5-75}$",
}
"""Typeset form of parts of the symbols of measures."""

_UNITS = {"1": "-", "m/s2": "m/s$^2$", "": "-"}

PEAK = r"peak rotation $\theta\,/\,\alpha$ [-]"


def axis_label(name: str, unit: str = "1", *, linear: bool = False) -> str:
    """Return the label of an axis or a measure, with symbol and unit."""
    label, measure = SYMBOLS.get(name, short_name(name)), MEASURES.get(name)
    if name not in SYMBOLS:
        unit = unit if measure is None else measure.unit
        # for a ratio, the symbol is clearer
        label = label if measure is None or "/" in label else measure.description
        label = f"{label} [{_UNITS.get(unit, unit)}]"
    return label.replace(r"\tan\,\alpha", r"\alpha") if linear else label


def short_name(name: str) -> str:
    """Return the short name of a measure."""
    if name in MEASURES:
        symbol = MEASURES[name].symbol or plain(name)
        for text, typeset in TYPESET.items():
            symbol = symbol.replace(text, typeset)
        return symbol
    return f"Sa({name[3:-1]} s)" if name.startswith("sa(") else plain(name)


def plain(text: object) -> str:
    r"""Return a text on one line. Dollar signs are escaped, so that no formula starts."""
    return " ".join(str(text).split()).replace("$", r"\$")


def wrapped(text: str, width: int, max_lines: int = 4) -> str:
    r"""Return a text in lines, truncated after the last line."""
    return "\n".join(wrap(text, width, max_lines=max_lines, placeholder=" ..."))


def geometric(values: FloatArray) -> bool:
    """Return True if numbers increase by equal ratios rather than by equal steps. They need a logarithmic axis."""
    if values.size < 3 or values[0] <= 0.0:
        return False
    ratios, steps = np.diff(np.log(values)), np.diff(values)
    return bool(np.ptp(ratios) / ratios.mean() < np.ptp(steps) / steps.mean())


def plain_log(axes: "Axes", which: str) -> None:
    """Make an axis logarithmic, with plain numbers at a few ticks."""
    from matplotlib.ticker import LogLocator

    getattr(axes, f"set_{which}scale")("log")
    axis = axes.xaxis if which == "x" else axes.yaxis
    low, high = axis.get_view_interval()
    steps: tuple[float, ...] = (1.0, 2.0, 5.0) if high / low < 300.0 else (1.0,)
    if high / low < 4.0:
        steps = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)
    axis.set_major_locator(LogLocator(subs=steps))
    plain_numbers(axis)


def plain_numbers(axis: "Axis") -> None:
    """Write plain numbers at the major ticks of an axis, and no numbers at the minor ticks."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def note(axes: "Axes", text: str, width: int = 62) -> None:
    """Write one or two small lines above a panel."""
    axes.set_title(wrapped(text, width).replace("m/s2", "m/s$^2$"), loc="left", fontsize=7, color=INK)


def shown_in(axes: "Axes", which: str, unit: str, size: float) -> None:
    """Label an axis in another unit, with round numbers in this unit."""
    from matplotlib.ticker import FuncFormatter, Locator

    axis = axes.xaxis if which == "x" else axes.yaxis
    drawn = axis.get_major_locator()

    class _Round(Locator):
        def tick_values(self, vmin: float, vmax: float) -> list[float]:
            return [size * tick for tick in drawn.tick_values(vmin / size, vmax / size)]

        def __call__(self) -> list[float]:
            return self.tick_values(*axis.get_view_interval())

    axis.set_major_locator(_Round())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:.6g}"))
    head, _, _ = axis.get_label_text().rpartition("[")
    if head:
        axis.set_label_text(f"{head}[{unit}]")


_ENOUGH = 2000  # points of a smooth curve

_PER_PERIOD = 1000
"""Steps in the shortest period of a pulse. The error of linear interpolation of a sine is 5e-6."""

_MOST = 400_000

Peak = tuple[float, float]  # time [s] and signed value


@dataclass(frozen=True, eq=False)
class Traces:
    """Acceleration, velocity and displacement at many instants, and their peaks."""

    time: FloatArray  # instants from the first sample to the last, or over a pulse [s]
    acceleration: FloatArray  # acceleration of the ground [m/s2]
    velocity: FloatArray  # velocity of the ground, from rest [m/s]
    displacement: FloatArray  # displacement of the ground, from zero [m]
    # times and signed values of the peaks by name, exact even between the instants
    peaks: Mapping[str, Peak]


def traces(motion: GroundMotion | Pulse) -> Traces:
    """Return the curves of a motion for plots, with exact peaks."""
    if isinstance(motion, GroundMotion):
        return _of_samples(motion)
    time = np.linspace(0.0, motion.duration, _steps(motion) + 1)
    curves = {
        "acceleration": motion.acceleration,
        "velocity": motion.velocity,
        "displacement": motion.displacement,
    }
    peaks = {name: _zoomed(curve, time) for name, curve in curves.items()}
    acceleration, velocity, displacement = (np.asarray(curve(time)) for curve in curves.values())
    return Traces(time, acceleration, velocity, displacement, peaks)


def fine_samples(motion: GroundMotion | Pulse) -> GroundMotion:
    """Return a motion as samples. A record is unchanged; a pulse has steps fine enough for linear interpolation."""
    # the samples begin and end with the pulse, which preserves jumps at its ends
    if isinstance(motion, GroundMotion):
        return motion
    steps = _steps(motion)
    values = motion.acceleration(np.linspace(0.0, motion.duration, steps + 1))
    provenance_text = f"{motion!r} cut into {steps} steps"
    return GroundMotion(values, motion.duration / steps, name=motion.name, provenance=(provenance_text,))


def _steps(pulse: Pulse) -> int:
    periods = max(1.0, pulse.fastest * pulse.duration / (2.0 * np.pi))
    step_count = int(max(min(_PER_PERIOD * periods, _MOST), 20.0 * periods))
    return max(1, min(step_count, int(0.999 * pulse.duration / SHORTEST_STEP)))


def _zoomed(curve: Callable[[Any], FloatArray], time: FloatArray) -> Peak:
    # every round reduces the interval of time by a factor of 100 or more; the error of the value is quadratic
    for _ in range(4):
        values = np.asarray(curve(time))
        k = int(np.abs(values).argmax())
        best = float(time[k]), float(values[k])
        time = np.linspace(time[max(k - 1, 0)], time[min(k + 1, time.size - 1)], 401)
    return best


def _of_samples(motion: GroundMotion) -> Traces:
    a, v, u, h = motion.acceleration, ground_velocity(motion), ground_displacement(motion), motion.time_step
    substeps = max(1, -(-_ENOUGH // len(motion)))
    tau = np.arange(substeps) / substeps
    velocity, displacement = _inside(motion, v, u, tau[:, None])
    acceleration = a[:-1] + tau[:, None] * np.diff(a)
    start = np.arange(len(motion) - 1)
    columns = ((tau[:, None] + start) * h, acceleration, velocity, displacement)
    ends = (motion.duration, a[-1], v[-1], u[-1])
    time, acceleration, v_fine, u_fine = (
        np.append(values.T.ravel(), end) for values, end in zip(columns, ends, strict=True)
    )
    # the velocity is extreme at zeros of the acceleration, and the displacement at zeros of the velocity
    turns = (a[:-1] < 0.0) != (a[1:] < 0.0)
    turn = np.where(turns, a[:-1] / np.where(turns, a[:-1] - a[1:], 1.0), 0.0)
    speeds = _inside(motion, v, u, turn)[0]
    roots = quadratic_roots(0.5 * h * np.diff(a), h * a[:-1], v[:-1])
    rests = [np.where((root > 0.0) & (root < 1.0), root, 0.0) for root in roots]
    peaks = {
        "acceleration": _largest(motion.time, a),
        "velocity": _largest(np.append(_times(motion, turn), motion.duration), np.append(speeds, v[-1])),
        "displacement": _largest(
            np.concatenate([motion.time, *(_times(motion, tau) for tau in rests)]),
            np.concatenate([u, *(_inside(motion, v, u, tau)[1] for tau in rests)]),
        ),
    }
    return Traces(time, acceleration, v_fine, u_fine, peaks)


def _inside(motion: GroundMotion, v: FloatArray, u: FloatArray, tau: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return velocity and displacement within the steps, at a fraction `tau` of the step."""
    a, rise, h = motion.acceleration[:-1], np.diff(motion.acceleration), motion.time_step
    speed = v[:-1] + h * tau * (a + 0.5 * rise * tau)
    return speed, u[:-1] + h * tau * (v[:-1] + h * tau * (0.5 * a + rise * tau / 6.0))


def _times(motion: GroundMotion, tau: FloatArray) -> FloatArray:
    return np.asarray((np.arange(tau.size) + tau) * motion.time_step, dtype=np.float64)


def _largest(times: FloatArray, values: FloatArray) -> Peak:
    k = int(np.abs(values).argmax())
    return float(times[k]), float(values[k])
