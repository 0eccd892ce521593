"""Pictures of amplitude intervals with overturning: one motion with peak rotation, or many motions in lanes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray, IntArray, g
from rocking.dynamics.mechanics import study_settings
from rocking.dynamics.parameters import sides_of
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.outcome import UNCOUNTED
from rocking.plots.labels import PEAK, note, plain, plain_log
from rocking.plots.overturning_map import CLASSES, FELL, FIRST, LATER, SECOND
from rocking.plots.style import (
    DASHED,
    DOUBLE,
    GREY,
    INK,
    SINGLE,
    in_journal_style,
    legend_below,
    new_figure,
    patch,
    stroke,
)  # fmt: skip
from rocking.studies.minimum_acceleration import Transitions
from rocking.studies.question import Question

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PGA = "peak ground acceleration [g]"
_HEIGHT = 2.9
_ROOM, _LEAST = 1.35, 0.045
"""Plotted range over the last crossing, and width fraction below which an interval has no name."""

_MOST_POINTS = 100_000

_LANE, _MARGIN = 0.17, 1.25
_MOST_LANES, _MOST_PANELS = 60, 4
_FALLS, _STANDS = "#E0812F", "#E4EFF8"


@dataclass(frozen=True)
class _AmplitudeRun:
    """An interval of amplitudes with one class of overturning, with the modes of its samples [m/s2, -]."""

    low: float
    high: float
    kind: int
    modes: IntArray

    @property
    def words(self) -> str:
        if self.kind == LATER and np.unique(self.modes).size == 1:
            return f"overturns after {self.modes[0]} impacts"
        return CLASSES[self.kind][0]


@in_journal_style
def transitions_picture(
    transitions: Transitions,
    body: Body,
    motion: Motion,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    points: int = 800,
    gravity: float = conventions.g,
    **settings: Any,
) -> "Figure":
    """Draw the peak rotation over the amplitude, and shade intervals with overturning.

    Parameters
    ----------
    transitions : Transitions
        Result of `minimum_overturning_acceleration` with the same body, motion, restitution and settings.
    body : Body
        The body.
    motion : GroundMotion or Pulse
        The motion.
    restitution : as for `simulate`
        The restitution.
    points : int
        Number of amplitudes of the curve, geometrically spaced [-].
    gravity : float
        Acceleration of gravity [m/s2].
    **settings
        ``threads``, ``engine`` and fields of `Settings`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide.

    Raises
    ------
    InvalidValueError
        If `transitions` has another type, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.minimum_acceleration import minimum_overturning_acceleration
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.8)
    >>> transitions = minimum_overturning_acceleration(block, pulse, 0.85)
    >>> transitions_picture(transitions, block, pulse, 0.85).axes[0].get_xlabel()
    'peak ground acceleration [g]'
    """
    if not isinstance(transitions, Transitions):
        raise InvalidValueError(
            "{parameter} must be a result of minimum_overturning_acceleration, got {kind}", parameter="transitions",
            kind=type(transitions).__name__,
        )  # fmt: skip
    count = int(checks.within("points", points, 2, _MOST_POINTS))
    threads, engine = settings.pop("threads", None), settings.pop("engine", "auto")
    question = Question(body, motion, restitution, study_settings(body, settings, gravity), threads, engine)
    amplitudes = _places(transitions, count)
    peaks, modes = _curve(question, amplitudes)
    figure, (axes,) = new_figure(SINGLE, _HEIGHT)
    _shade(axes, transitions, amplitudes, modes)
    standing = np.isin(modes, (-2, -1))
    axes.plot(amplitudes / g, np.where(standing, peaks, np.nan), color=INK, linewidth=0.9, zorder=4)
    axes.axhline(1.0, color=GREY, linewidth=0.8, linestyle=DASHED, zorder=1)
    _finish(axes, transitions, amplitudes, peaks[standing])
    note(axes, f"{plain(motion.name)}, scaled; restitution {plain(question.parameters.label)}")
    return figure


def _shown_until(transitions: Transitions) -> float:
    """Return the largest plotted amplitude [m/s2]."""
    if not len(transitions):
        return transitions.max_pga
    return min(transitions.max_pga, _ROOM * float(transitions.acceleration[-1]))


def _places(transitions: Transitions, count: int) -> FloatArray:
    """Return amplitudes [m/s2]. They are denser near crossings, where the curve is steep."""
    last = _shown_until(transitions)
    offsets = np.concatenate([-np.geomspace(1e-7, 0.03, 25), np.geomspace(1e-7, 0.03, 25)])
    around = (transitions.acceleration[:, None] * (1.0 + offsets)).ravel()
    amplitudes = np.concatenate([np.geomspace(transitions.min_pga, last, count), around])
    return np.unique(amplitudes[(amplitudes >= transitions.min_pga) & (amplitudes <= last)])


def _curve(question: Question, amplitudes: FloatArray) -> tuple[FloatArray, IntArray]:
    sides = {name: np.repeat(value, amplitudes.size) for name, value in sides_of([question.parameters]).items()}
    # equal random numbers at all amplitudes, as in the search
    keys = np.zeros(amplitudes.size, dtype=np.int64)
    results, _ = question.run({**sides, "scale": amplitudes / question.motion.peak}, np.ones(amplitudes.size), keys)
    return results["peak_ratio"], results["mode"]


def _shade(axes: "Axes", transitions: Transitions, amplitudes: FloatArray, modes: IntArray) -> None:
    """Shade the overturning intervals in the colours of maps, and name their modes."""
    last = _shown_until(transitions)
    widest: dict[str, _AmplitudeRun] = {}
    runs = [
        run for low, high in transitions.overturning_intervals for run in _runs(amplitudes, modes, low, min(high, last))
    ]
    for run in sorted(runs, key=lambda run: run.high / run.low):
        # position above the dashed line of alpha
        axes.axvspan(run.low / g, run.high / g, color=CLASSES[run.kind][1], linewidth=0.0, zorder=2)
        if np.log(run.high / run.low) > _LEAST * np.log(last / transitions.min_pga):
            widest[run.words] = run
    for run in widest.values():
        _name(axes, run)
    unnamed = {run.kind for run in runs} - {run.kind for run in widest.values()}
    if unnamed:
        handles = [patch(CLASSES[kind][1], CLASSES[kind][0]) for kind in sorted(unnamed)]
        legend_below(axes.figure, handles, 2)  # type: ignore[arg-type]


def _runs(amplitudes: FloatArray, modes: IntArray, low: float, high: float) -> list[_AmplitudeRun]:
    """Return the runs of one class within an interval. A change is plotted halfway between two samples."""
    inside = (amplitudes > low) & (amplitudes < high) & (modes >= 0)
    if not inside.any():
        return []
    amplitudes, modes = amplitudes[inside], modes[inside]
    kinds = np.select([modes == 0, modes == 1, modes == UNCOUNTED], [FIRST, SECOND, FELL], default=LATER)
    changes = np.flatnonzero(np.diff(kinds))
    ends = [low, *(0.5 * (amplitudes[changes] + amplitudes[changes + 1])).tolist(), high]
    parts = np.split(modes, changes + 1)
    firsts = kinds[np.append(0, changes + 1)].tolist()
    return [_AmplitudeRun(ends[k], ends[k + 1], kind, parts[k]) for k, kind in enumerate(firsts)]


def _name(axes: "Axes", run: _AmplitudeRun) -> None:
    axes.text(
        np.sqrt(run.low * run.high) / g, 0.5, run.words, transform=axes.get_xaxis_transform(), rotation=90, ha="center",
        va="center", fontsize=7, color="white" if run.kind == FIRST else INK, zorder=5,
    )  # fmt: skip


def _finish(axes: "Axes", transitions: Transitions, amplitudes: FloatArray, peaks: FloatArray) -> None:
    from matplotlib.ticker import LogLocator

    largest = float(np.nanmax(peaks, initial=1.0))
    axes.set_ylim(0.0, 1.06 * min(largest, 2.0))
    axes.set_xlim(transitions.min_pga / g, float(amplitudes[-1]) / g)
    plain_log(axes, "x")
    if amplitudes[-1] < 20.0 * transitions.min_pga:
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 4.0, 6.0, 8.0)))
    axes.set(xlabel=PGA, ylabel=PEAK)
    axes.spines[["top", "right"]].set_visible(True)


@in_journal_style
def transitions_of_many_picture(
    transitions: Mapping[str, Sequence[Transitions]],
    names: Sequence[str],
    *,
    lane_title: str = "motion",
    until: float | None = None,
) -> "Figure":
    """Draw all intervals of amplitudes with overturning, one lane per motion, one panel per restitution.

    Lanes are sorted by the smallest overturning acceleration of the first panel, which is marked. Between two intervals
    of a lane, the body does not overturn, although the motion is stronger.

    Parameters
    ----------
    transitions : mapping of str to sequence of Transitions
        Results of all motions, by restitution.
    names : sequence of str
        Names of the motions, or short marks.
    lane_title : str
        Title of the axis of lanes.
    until : float, optional
        Largest plotted acceleration; default: 1.35 times the last crossing [m/s2].

    Returns
    -------
    matplotlib.figure.Figure
        One column wide for one panel, otherwise two.

    Raises
    ------
    InvalidValueError
        If there are no lanes or too many lanes, or if their number differs from the number of names.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies import minimum_overturning_acceleration
    >>> block = rk.Block(width=0.5, height=2.0)
    >>> pulses = [rk.pulses.sine(3.0, period) for period in (0.6, 0.8)]
    >>> transitions = {"0.85": [minimum_overturning_acceleration(block, pulse, 0.85) for pulse in pulses]}
    >>> transitions_of_many_picture(transitions, ["0.6 s", "0.8 s"], lane_title="period").axes[0].get_xlabel()
    'peak ground acceleration [g]'
    """
    lanes = [*transitions.values()]
    if not 1 <= len(lanes) <= _MOST_PANELS or not 1 <= len(names) <= _MOST_LANES:
        raise InvalidValueError(
            "a picture can have 1 to {panels} restitutions and 1 to {limit} lanes, got {lanes} and {restitutions}",
            panels=_MOST_PANELS, limit=_MOST_LANES, lanes=len(lanes), restitutions=len(names),
        )  # fmt: skip
    for lane in lanes:
        if len(lane) != len(names) or not all(isinstance(item, Transitions) for item in lane):
            raise InvalidValueError(
                "{parameter} must have {count} Transitions for each restitution, got {value}", parameter="transitions",
                count=len(names), value=lane,
            )  # fmt: skip
    order = np.argsort([item.acceleration[0] if len(item) else np.inf for item in lanes[0]], kind="stable").tolist()
    width = SINGLE if len(lanes) == 1 else DOUBLE
    figure, axes = new_figure(width, _MARGIN + _LANE * len(names), columns=len(lanes), sharex=True, sharey=True)
    ends = _ends([item for lane in lanes for item in lane])
    if until is not None:
        ends = ends[0], checks.within("until", until, ends[0] * g, 1e6, open_low=True) / g
    for panel, (label, lane) in zip(axes, transitions.items(), strict=True):
        _lanes(panel, [lane[k] for k in order], ends)
        panel.set_title(plain(label), loc="left", fontsize=7.5)
        panel.set_xlabel(PGA)
        panel.tick_params(axis="y", length=0)
    axes[0].set_yticks(range(len(names)), [plain(names[k]) for k in order])
    axes[0].set_ylabel(lane_title)
    axes[0].set_ylim(len(names) - 0.5, -0.5)
    axes[0].set_xlim(*ends)
    for panel in axes:
        plain_log(panel, "x")
    handles = [
        patch(_STANDS, "does not overturn", edgecolor=INK, linewidth=0.4),
        patch(_FALLS, "overturns"),
        stroke("smallest overturning acceleration", linestyle="none", marker="|", color=INK, markeredgewidth=1.2),
    ]
    legend_below(figure, handles, 3)
    return figure


def _ends(transitions: Sequence[Transitions]) -> tuple[float, float]:
    """Return the plotted range [g]."""
    low = min(item.min_pga for item in transitions)
    last = [1.35 * item.acceleration[-1] for item in transitions if len(item)]
    return low / g, max([2.0 * low, *last]) / g


def _lanes(axes: "Axes", transitions: Sequence[Transitions], ends: tuple[float, float]) -> None:
    for row, item in enumerate(transitions):
        lane, shown = (row - 0.36, 0.72), [(item.min_pga / g, max(ends[1] - item.min_pga / g, 0.0))]
        axes.broken_barh(shown, lane, color=_STANDS, linewidth=0)
        intervals = [(low / g, (high - low) / g) for low, high in item.overturning_intervals]
        axes.broken_barh(intervals, lane, color=_FALLS, linewidth=0, zorder=2)
        if item.minimum is not None:
            axes.plot(item.minimum / g, row, "|", color=INK, markersize=6.5, markeredgewidth=1.2, zorder=3)
