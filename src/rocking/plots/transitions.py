"""Every stretch of amplitudes that overturns a body: of one motion with the peak rotation, of many in lanes."""

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
"""How far beyond the last crossing is shown, and the share of the width below which a stretch is not named."""

_MOST_POINTS = 100_000

_LANE, _MARGIN = 0.17, 1.25
_MOST_LANES, _MOST_PANELS = 60, 4
_FALLS, _STANDS = "#E0812F", "#E4EFF8"


@dataclass(frozen=True)
class _AmplitudeRun:
    """A stretch of amplitudes that overturn in one class, with the modes of its samples [m/s2, -]."""

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
    found: Transitions,
    body: Body,
    motion: Motion,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    points: int = 800,
    gravity: float = conventions.g,
    **settings: Any,
) -> "Figure":
    """Draw the peak rotation over the amplitude, and shade what overturns.

    Parameters
    ----------
    found : Transitions
        As of `minimum_overturning_acceleration` with the same body, motion, restitution and settings.
    body : Body
        The body.
    motion : GroundMotion or Pulse
        The motion.
    restitution : as for `simulate`
        The restitution.
    points : int
        Amplitudes of the curve, in equal ratios [-].
    gravity : float
        Acceleration of gravity [m/s2].
    **settings
        ``threads``, ``engine`` and fields of `Settings`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide; what lies above the last crossing is cut short.

    Raises
    ------
    InvalidValueError
        If `found` is of something else, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.minimum_acceleration import minimum_overturning_acceleration
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.8)
    >>> found = minimum_overturning_acceleration(block, pulse, 0.85)
    >>> transitions_picture(found, block, pulse, 0.85).axes[0].get_xlabel()
    'peak ground acceleration [g]'
    """
    if not isinstance(found, Transitions):
        raise InvalidValueError(
            "{parameter} must be of minimum_overturning_acceleration, got {kind}", parameter="found",
            kind=type(found).__name__,
        )  # fmt: skip
    count = int(checks.within("points", points, 2, _MOST_POINTS))
    threads, engine = settings.pop("threads", None), settings.pop("engine", "auto")
    question = Question(body, motion, restitution, study_settings(body, settings, gravity), threads, engine)
    place = _places(found, count)
    peaks, modes = _curve(question, place)
    figure, (axes,) = new_figure(SINGLE, _HEIGHT)
    _shade(axes, found, place, modes)
    standing = np.isin(modes, (-2, -1))
    axes.plot(place / g, np.where(standing, peaks, np.nan), color=INK, linewidth=0.9, zorder=4)
    axes.axhline(1.0, color=GREY, linewidth=0.8, linestyle=DASHED, zorder=1)
    _finish(axes, found, place, peaks[standing])
    note(axes, f"{plain(motion.name)}, scaled; restitution {plain(question.parameters.label)}")
    return figure


def _shown_until(found: Transitions) -> float:
    """Return the largest amplitude worth showing [m/s2]."""
    if not len(found):
        return found.max_pga
    return min(found.max_pga, _ROOM * float(found.acceleration[-1]))


def _places(found: Transitions, count: int) -> FloatArray:
    """Return amplitudes, closer together towards crossings, where the curve rises steeply [m/s2]."""
    last = _shown_until(found)
    near = np.concatenate([-np.geomspace(1e-7, 0.03, 25), np.geomspace(1e-7, 0.03, 25)])
    around = (found.acceleration[:, None] * (1.0 + near)).ravel()
    both = np.concatenate([np.geomspace(found.min_pga, last, count), around])
    return np.unique(both[(both >= found.min_pga) & (both <= last)])


def _curve(question: Question, place: FloatArray) -> tuple[FloatArray, IntArray]:
    sides = {name: np.repeat(value, place.size) for name, value in sides_of([question.parameters]).items()}
    # the same random numbers at every amplitude, as in the search
    keys = np.zeros(place.size, dtype=np.int64)
    results, _ = question.run({**sides, "scale": place / question.motion.peak}, np.ones(place.size), keys)
    return results["peak_ratio"], results["mode"]


def _shade(axes: "Axes", found: Transitions, place: FloatArray, modes: IntArray) -> None:
    """Shade every overturning interval, in the colours of maps, and say how it overturns."""
    last = _shown_until(found)
    widest: dict[str, _AmplitudeRun] = {}
    runs = [run for low, high in found.overturning_intervals for run in _runs(place, modes, low, min(high, last))]
    for run in sorted(runs, key=lambda run: run.high / run.low):
        # above the dashed line of alpha, which says nothing of what overturns
        axes.axvspan(run.low / g, run.high / g, color=CLASSES[run.kind][1], linewidth=0.0, zorder=2)
        if np.log(run.high / run.low) > _LEAST * np.log(last / found.min_pga):
            widest[run.words] = run
    for run in widest.values():
        _name(axes, run)
    unnamed = {run.kind for run in runs} - {run.kind for run in widest.values()}
    if unnamed:
        handles = [patch(CLASSES[kind][1], CLASSES[kind][0]) for kind in sorted(unnamed)]
        legend_below(axes.figure, handles, 2)  # type: ignore[arg-type]


def _runs(place: FloatArray, modes: IntArray, low: float, high: float) -> list[_AmplitudeRun]:
    """Return the stretches of one class within an interval; between two samples the change is drawn halfway."""
    inside = (place > low) & (place < high) & (modes >= 0)
    if not inside.any():
        return []
    place, modes = place[inside], modes[inside]
    kinds = np.select([modes == 0, modes == 1, modes == UNCOUNTED], [FIRST, SECOND, FELL], default=LATER)
    changes = np.flatnonzero(np.diff(kinds))
    ends = [low, *(0.5 * (place[changes] + place[changes + 1])).tolist(), high]
    parts = np.split(modes, changes + 1)
    firsts = kinds[np.append(0, changes + 1)].tolist()
    return [_AmplitudeRun(ends[k], ends[k + 1], kind, parts[k]) for k, kind in enumerate(firsts)]


def _name(axes: "Axes", run: _AmplitudeRun) -> None:
    axes.text(
        np.sqrt(run.low * run.high) / g, 0.5, run.words, transform=axes.get_xaxis_transform(), rotation=90, ha="center",
        va="center", fontsize=7, color="white" if run.kind == FIRST else INK, zorder=5,
    )  # fmt: skip


def _finish(axes: "Axes", found: Transitions, place: FloatArray, peaks: FloatArray) -> None:
    from matplotlib.ticker import LogLocator

    most = float(np.nanmax(peaks, initial=1.0))
    axes.set_ylim(0.0, 1.06 * min(most, 2.0))
    axes.set_xlim(found.min_pga / g, float(place[-1]) / g)
    plain_log(axes, "x")
    if place[-1] < 20.0 * found.min_pga:
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 4.0, 6.0, 8.0)))
    axes.set(xlabel=PGA, ylabel=PEAK)
    axes.spines[["top", "right"]].set_visible(True)


@in_journal_style
def transitions_of_many_picture(
    found: Mapping[str, Sequence[Transitions]],
    names: Sequence[str],
    *,
    words: str = "motion",
    until: float | None = None,
) -> "Figure":
    """Draw every stretch of amplitudes that overturns a body, a lane for each motion, a panel for each restitution.

    Lanes are in the order of the least acceleration that overturns in the first panel, which is marked; what lies
    between two stretches of a lane is a stronger motion under which the body stands again.

    Parameters
    ----------
    found : mapping of str to sequence of Transitions
        For each restitution what was found for each motion.
    names : sequence of str
        What the motions are called, or short marks of them.
    words : str
        What the lanes are.
    until : float, optional
        Largest acceleration that is shown; a third beyond the last crossing if not given [m/s2].

    Returns
    -------
    matplotlib.figure.Figure
        One column wide for one panel, else two.

    Raises
    ------
    InvalidValueError
        If there is nothing to draw, too much, or the lanes are not as many as the names.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies import minimum_overturning_acceleration
    >>> block = rk.Block(width=0.5, height=2.0)
    >>> pulses = [rk.pulses.sine(3.0, period) for period in (0.6, 0.8)]
    >>> found = {"0.85": [minimum_overturning_acceleration(block, pulse, 0.85) for pulse in pulses]}
    >>> transitions_of_many_picture(found, ["0.6 s", "0.8 s"], words="period").axes[0].get_xlabel()
    'peak ground acceleration [g]'
    """
    lanes = [*found.values()]
    if not 1 <= len(lanes) <= _MOST_PANELS or not 1 <= len(names) <= _MOST_LANES:
        raise InvalidValueError(
            "a picture holds 1 to {panels} restitutions and 1 to {limit} lanes, got {lanes} and {restitutions}",
            panels=_MOST_PANELS, limit=_MOST_LANES, lanes=len(lanes), restitutions=len(names),
        )  # fmt: skip
    for each in lanes:
        if len(each) != len(names) or not all(isinstance(one, Transitions) for one in each):
            raise InvalidValueError(
                "{parameter} must have {count} Transitions for each restitution, got {value}", parameter="found",
                count=len(names), value=each,
            )  # fmt: skip
    order = np.argsort([one.acceleration[0] if len(one) else np.inf for one in lanes[0]], kind="stable").tolist()
    width = SINGLE if len(lanes) == 1 else DOUBLE
    figure, axes = new_figure(width, _MARGIN + _LANE * len(names), columns=len(lanes), sharex=True, sharey=True)
    ends = _ends([one for each in lanes for one in each])
    if until is not None:
        ends = ends[0], checks.within("until", until, ends[0] * g, 1e6, open_low=True) / g
    for panel, (label, each) in zip(axes, found.items(), strict=True):
        _lanes(panel, [each[k] for k in order], ends)
        panel.set_title(plain(label), loc="left", fontsize=7.5)
        panel.set_xlabel(PGA)
        panel.tick_params(axis="y", length=0)
    axes[0].set_yticks(range(len(names)), [plain(names[k]) for k in order])
    axes[0].set_ylabel(words)
    axes[0].set_ylim(len(names) - 0.5, -0.5)
    axes[0].set_xlim(*ends)
    for panel in axes:
        plain_log(panel, "x")
    handles = [
        patch(_STANDS, "stays standing", edgecolor=INK, linewidth=0.4),
        patch(_FALLS, "overturns"),
        stroke("least that overturns", linestyle="none", marker="|", color=INK, markeredgewidth=1.2),
    ]
    legend_below(figure, handles, 3)
    return figure


def _ends(found: Sequence[Transitions]) -> tuple[float, float]:
    """Return how far it is worth showing [g]."""
    low = min(one.min_pga for one in found)
    last = [1.35 * one.acceleration[-1] for one in found if len(one)]
    return low / g, max([2.0 * low, *last]) / g


def _lanes(axes: "Axes", found: Sequence[Transitions], ends: tuple[float, float]) -> None:
    for row, one in enumerate(found):
        lane, shown = (row - 0.36, 0.72), [(one.min_pga / g, max(ends[1] - one.min_pga / g, 0.0))]
        axes.broken_barh(shown, lane, color=_STANDS, linewidth=0)
        stretches = [(low / g, (high - low) / g) for low, high in one.overturning_intervals]
        axes.broken_barh(stretches, lane, color=_FALLS, linewidth=0, zorder=2)
        if one.minimum is not None:
            axes.plot(one.minimum / g, row, "|", color=INK, markersize=6.5, markeredgewidth=1.2, zorder=3)
