"""Pictures of fragility: observed fractions with intervals, fitted curves with bands, and incremental curves."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.summary import words_on
from rocking.plots.labels import PEAK, axis_label, geometric, plain_log, wrapped
from rocking.plots.style import (
    COLORS,
    DASHED,
    GREY,
    INK,
    MARKS,
    PALE,
    SINGLE,
    in_journal_style,
    legend_above,
    legend_below,
    look,
    new_figure,
    patch,
    stroke,
)
from rocking.studies.fragility.incremental_dynamic_analysis import WIDE, IncrementalDynamicAnalysis
from rocking.studies.fragility.limit_states import damage_state

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rocking.statistics.lognormal import LognormalFit
    from rocking.studies.fragility.curves import FragilityModel

_MOST, _MOST_STRIPES, _OUTCOMES = 12, 24, 8
"""Maximum numbers of points and of stripes, and minimum number of outcomes in a group of neighbouring levels."""

STATES = ("#E3EDF5", "#7FB2D6", "#AC5B2B", "#AC8191", "#7A2E00")
"""Colours from no rocking (light) to overturned (dark). They are distinct in grey."""

_APART = 2.2  # horizontal offset between points of different states [pt]


@in_journal_style
def fragility_picture(analysis: Any, *, level: float = 0.95, curves: "FragilityModel | None" = None) -> "Figure":
    """Draw a fragility analysis.

    Above: fraction of motions that reach a limit state, with exact binomial intervals, and lognormal curves of the
    states. Levels without possible uplift are shaded. If motions are used at several levels, the band of a curve
    results from a bootstrap of capacities (5 to 29 motions) or of motions; otherwise it results from the profile
    likelihood. Below: the fractions of the states, which add up to one. A text below the panels names states without a
    curve.

    Parameters
    ----------
    analysis : MultipleStripeAnalysis, CloudAnalysis or IncrementalDynamicAnalysis
        Analysis.
    level : float
        Confidence level of intervals and bands [-].
    curves : FragilityModel, optional
        Curves from `model_of`. They replace the curves fitted to single states, without a band; the text below the
        panels contains the reason.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels over the measure, one column wide.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility import fragility_analysis
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8, 1.0)]
    >>> analysis = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, [2.0, 4.0, 6.0, 8.0])
    >>> fragility_picture(analysis).axes[1].get_xlabel()
    'peak ground acceleration [m/s$^2$]'
    """
    level = checks.within("level", level, 0.5, 0.999)
    if not all(hasattr(analysis, name) for name in ("fits", "counts", "trials", "levels", "subject")):
        raise InvalidValueError(parameter="analysis", allowed="of stripes, cloud or incremental", value=analysis)
    figure, (upper, lower) = new_figure(SINGLE, 4.4, rows=2, sharex=True, height_ratios=[2.0, 1.0])
    levels = np.asarray(analysis.levels)
    fine = _fine(levels)
    shared = {} if curves is None else curves.shared
    for index, name in enumerate(analysis.counts):
        _points(upper, analysis, name, index, level)
        fit = analysis.fits.get(name)
        if name in shared:
            upper.plot(fine, shared[name].probability(fine), linewidth=1.2, zorder=2, **look(index))
        elif fit is not None and fit.exists:
            draw_fit(upper, fit, fine, index, level)
        elif fit is None:
            _step(upper, analysis.subject.uplift_threshold, fine, index)
    upper.set_ylim(-0.03, 1.03)
    upper.set_ylabel("probability [-]")
    _stack(lower, analysis)
    measure = analysis.subject.measure
    label = axis_label(measure.name, measure.unit, linear=analysis.subject.settings.linear)
    lower.set_xlabel(words_on(analysis.subject.support, label))
    lower.set_xlim(fine[0], fine[-1])
    if geometric(levels):
        plain_log(lower, "x")
    _legends(upper, lower, analysis)
    if verdicts := " ".join(filter(None, (caption(analysis), "" if curves is None else curves.adjusted))):
        figure.supxlabel(wrapped(verdicts, 80, 7), x=0.01, ha="left", fontsize=6, color=INK)
    return figure


def _step(axes: "Axes", threshold: float, fine: FloatArray, index: int) -> None:
    """Shade the levels without possible uplift."""
    axes.axvline(threshold, linewidth=1.0, **look(index))
    if threshold > fine[0]:
        axes.axvspan(0.5 * fine[0], min(threshold, 2.0 * fine[-1]), color=PALE, linewidth=0, zorder=0)
    if threshold > fine[0] + 0.08 * (fine[-1] - fine[0]):
        axes.text(
            min(threshold, fine[-1]), 0.5, "no uplift", transform=axes.get_xaxis_transform(), rotation=90,
            ha="right", va="center", fontsize=6.5, color=INK,
        )  # fmt: skip


def _fine(levels: FloatArray) -> FloatArray:
    low, high = float(levels[0]), float(levels[-1])
    if high <= low:
        low, high = 0.5 * low, 2.0 * high
    if geometric(levels) and high / low > 3.0:
        return np.geomspace(low / 1.15, 1.15 * high, 120)
    return np.linspace(max(low - 0.06 * (high - low), 1e-3 * low), high + 0.06 * (high - low), 120)


def grouped(levels: FloatArray, reached: FloatArray, trials: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return increasing levels with their counts [-]. Neighbouring levels are grouped if there are too many."""
    # the level of a group is the geometric mean, weighted by trials; groups without trials are omitted
    group = np.arange(levels.size)
    stripes = trials.sum() >= _OUTCOMES * levels.size
    if levels.size > (_MOST_STRIPES if stripes else _MOST):
        groups = max(1, min(_MOST, int(trials.sum()) // _OUTCOMES))
        group = np.minimum((np.cumsum(trials) - trials) * groups // max(trials.sum(), 1), groups - 1).astype(int)
    total = np.bincount(group, trials)
    mean = np.exp(np.bincount(group, trials * np.log(levels)) / np.maximum(total, 1.0))
    good = total > 0
    hits = np.bincount(group, reached)
    return mean[good], np.asarray(hits[good], np.float64), np.asarray(total[good], np.float64)


def fractions_of(analysis: Any, state: str, level: float = 0.95) -> dict[str, FloatArray]:
    """Return numbers and fractions of motions that reach a state at grouped levels, with intervals [-]."""
    from rocking.statistics.counts import share_interval

    columns = (analysis.levels, analysis.counts[state], analysis.trials)
    at, reached, trials = grouped(*(np.asarray(column, dtype=np.float64) for column in columns))
    share = reached / trials
    ends = [share_interval(s * n, n, level) for s, n in zip(share.tolist(), trials.tolist(), strict=True)]
    low, high = np.array(ends).reshape(-1, 2).T
    return {"x": at, "reached": reached, "trials": trials, "share": share, "low": low, "high": high}


def _points(axes: "Axes", analysis: Any, name: str, index: int, level: float) -> None:
    from matplotlib.transforms import ScaledTranslation

    fractions = fractions_of(analysis, name, level)
    levels, fraction = fractions["x"], fractions["share"]
    reach = np.abs(np.array([fractions["low"], fractions["high"]]) - fraction)
    figure: Any = axes.figure
    offset = (index - 0.5 * (len(analysis.counts) - 1)) * _APART / 72.0
    axes.errorbar(
        levels, fraction, reach, fmt=MARKS[index % 5], markersize=3.0, color=COLORS[index % len(COLORS)],
        markerfacecolor="white", markeredgewidth=0.8, linestyle="none", elinewidth=0.7, zorder=3,
        transform=axes.transData + ScaledTranslation(offset, 0.0, figure.dpi_scale_trans),
    )  # fmt: skip


def draw_fit(axes: "Axes", fit: "LognormalFit", fine: FloatArray, index: int, level: float) -> None:
    """Draw a curve and, if available, its band."""
    method: Any = "profile" if fit.counts.cluster_trials is None else "bootstrap"
    try:
        low, high = fit.band(fine, level, method)
        axes.fill_between(fine, low, high, color=COLORS[index % len(COLORS)], alpha=0.18, linewidth=0)
    except InvalidValueError:
        # a curve from few motions or outcomes has no band
        pass
    penalised = fit.method == "penalised"
    axes.plot(fine, fit.probability(fine), linewidth=0.7 if penalised else 1.2, zorder=2, **look(index))


def _stack(axes: "Axes", analysis: Any) -> None:
    """Draw the fractions of the states as bars that add up to one."""
    levels = np.asarray(analysis.levels)
    trials = np.asarray(analysis.trials, dtype=np.float64)
    parts = [grouped(levels, np.asarray(counts, dtype=np.float64), trials) for counts in _ordered(analysis).values()]
    at, _, total = parts[0]
    reached = [np.ones(at.size), *(hits / total for _, hits, _ in parts), np.zeros(at.size)]
    left, width = _widths(at, geometric(levels))
    for more, less, color in zip(reached[:-1], reached[1:], state_colors(len(parts)), strict=True):
        axes.bar(left, more - less, width, bottom=less, align="edge", color=color, edgecolor="white", linewidth=0.4)
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("fraction of\nmotions [-]")


def _ordered(analysis: Any) -> dict[str, FloatArray]:
    """Return the counts of the states of the rotation, which are in an order."""
    return {name: counts for name, counts in analysis.counts.items() if damage_state(name) is None}


def _widths(at: FloatArray, ratios: bool) -> tuple[FloatArray, FloatArray]:
    if at.size < 2:
        return 0.9 * at, 0.2 * at
    values = np.log(at) if ratios else at
    middles = 0.5 * (values[1:] + values[:-1])
    edges = np.concatenate([[2.0 * values[0] - middles[0]], middles, [2.0 * values[-1] - middles[-1]]])
    edges = np.exp(edges) if ratios else np.maximum(edges, 0.0)
    return edges[:-1], np.diff(edges)


def state_colors(states: int) -> list[str]:
    """Return colours from no rocking to overturned."""
    between = [STATES[1], STATES[2], STATES[3], "#009960"]
    return [STATES[0], *(between[k % 4] for k in range(states - 1)), STATES[-1]]


def _legends(upper: "Axes", lower: "Axes", analysis: Any) -> None:
    names, options = list(analysis.counts), {"borderaxespad": 0.2, "borderpad": None, "fontsize": 6.5}
    mark: dict[str, Any] = {"markersize": 3.0, "markerfacecolor": "white"}
    curves = [stroke(symbol(name), marker=MARKS[k % 5], **mark, **look(k)) for k, name in enumerate(names)]
    legend_above(upper, 2, handles=curves, **options)
    ordered = list(_ordered(analysis))
    none = "no rocking" if ordered[0] == "rocking" else f"not {symbol(ordered[0])}"
    state_labels = [none, *(f"{symbol(a)}, not worse" for a in ordered[:-1]), symbol(ordered[-1])]
    patches = [patch(color, label) for color, label in zip(state_colors(len(ordered)), state_labels, strict=True)]
    legend_above(lower, 2, handles=patches, handlelength=1.2, **options)


def symbol(state: str) -> str:
    r"""Return the name of a state with its symbols."""
    if not state.startswith("rotation > "):
        return "rocks" if state == "rocking" else state
    return rf"$\theta > {state.split()[2]}\,\alpha$"


def caption(analysis: Any) -> str:
    """Return the text below the picture: verdicts of states without a maximum likelihood curve."""
    return " ".join(f"{', '.join(map(symbol, names))}: {verdict}" for verdict, names in analysis.verdicts.items())


_CROSS, _FALLEN, _AGAIN = "#7A2E00", "#DDB7A0", "#0070B2"
_FRACTION: dict[str, Any] = {"color": INK, "linewidth": 1.2}
_PASSED: dict[str, Any] = {"color": _CROSS, "linewidth": 1.0, "linestyle": "--"}
_OVER = 1.06  # larger rotations without overturning are plotted at this value
_FIRST, _LAST = 1.12, 1.72  # range of the lanes of the motions, on the axis of rotation


@in_journal_style
def incremental_dynamic_analysis_picture(analysis: IncrementalDynamicAnalysis) -> "Figure":
    """Draw an incremental analysis, with the intensity measure on the vertical axis.

    Left: one grey curve per motion up to the first overturning. Higher levels without overturning (resurrection) are
    blue, and lines connect adjacent levels. Each motion with overturning has a lane, sorted by first crossing: brown
    with overturning, blue without. Right: fraction of motions with overturning at each level, and fraction of motions
    with a lower first crossing.

    Parameters
    ----------
    analysis : IncrementalDynamicAnalysis
        Result of `fragility_analysis`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, one column wide.

    Raises
    ------
    InvalidValueError
        If the argument has another type.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility import fragility_analysis
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.5, 0.7)]
    >>> block, levels = rk.Block(width=0.4, height=1.6), [3.0, 6.0, 9.0]
    >>> analysis = fragility_analysis(block, pulses, levels, restitution=0.9, analysis="incremental")
    >>> len(incremental_dynamic_analysis_picture(analysis).axes)
    2
    """
    checks.of_kind("analysis", analysis, IncrementalDynamicAnalysis, "incremental")
    figure, (left, right) = new_figure(SINGLE, 3.6, columns=2, sharey=True, width_ratios=[2.5, 1.0])
    for curve in analysis.curves:
        _curve(left, analysis.levels, curve)
    _crossings(left, analysis)
    crossings = np.sort(analysis.first_crossings[analysis.complete])
    if crossings.size:
        passed_fractions = np.searchsorted(crossings, analysis.levels, side="right") / crossings.size
        right.plot(passed_fractions, analysis.levels, **_PASSED)
    right.plot(analysis.fractions, analysis.levels, **_FRACTION)
    right.set(xlim=(-0.03, 1.03), xlabel="fraction\noverturned [-]")
    right.set_xticks([0.0, 0.5, 1.0], ["0", "0.5", "1"])
    measure = analysis.subject.measure
    left.set_ylabel(axis_label(measure.name, measure.unit, linear=analysis.subject.settings.linear))
    left.set_xlabel(PEAK, x=0.55 / (_LAST + 0.06))
    left.set(xlim=(-0.03, _LAST + 0.03), xticks=[0.0, 0.5, 1.0])
    left.axvline(1.0, color=GREY, linewidth=0.6, linestyle=DASHED, zorder=0)
    below: dict[str, Any] = {"transform": left.get_xaxis_transform(), "ha": "center", "va": "top", "fontsize": 7}
    left.text(0.5 * (_FIRST + _LAST), -0.045, "by motion", **below)
    low, high = float(analysis.levels[0]), float(analysis.levels[-1])
    left.set_ylim(low - 0.03 * (high - low), high + 0.03 * (high - low) or 1.1 * high)
    if geometric(analysis.levels) and high / low > 3.0:
        left.set_ylim(low / 1.04, 1.04 * high)
        plain_log(left, "y")
    _legend(figure, analysis)
    return figure


def _curve(axes: "Axes", levels: FloatArray, curve: FloatArray) -> None:
    """Draw one motion, in grey up to its first overturning, and in blue at higher levels without overturning."""
    over = np.isinf(curve)
    first = int(np.argmax(over)) if over.any() else curve.size
    shown = np.where(np.isfinite(curve), np.minimum(curve, _OVER), math.nan)
    axes.plot(shown[:first], levels[:first], color=GREY, linewidth=0.6, alpha=0.8, zorder=1)
    if np.isfinite(curve[first:]).any():
        axes.plot(shown[first:], levels[first:], color=_AGAIN, linewidth=1.0, zorder=3, marker="o", markersize=1.6)


def _crossings(axes: "Axes", analysis: IncrementalDynamicAnalysis) -> None:
    """Draw one lane per motion with overturning, and mark its first crossing."""
    starts = analysis.first_crossings
    order = [k for k in np.argsort(starts).tolist() if math.isfinite(starts[k])]
    places = np.linspace(_FIRST, _LAST, 2 * len(order) + 1)[1::2]
    lane = dict(zip(order, places.tolist(), strict=True))
    width = min(3.0, max(0.4, 36.0 / max(1, len(order))))
    top = float(analysis.levels[-1])
    falls = [(lane[i.motion], i.start, min(i.end, top)) for i in analysis.intervals if i.motion in lane]
    stands = [(lane[motion], low, high) for motion, low, high in analysis.survivals if high - low > WIDE * low]
    for segments, color in ((falls, _FALLEN), (stands, _AGAIN)):
        x, low, high = np.array(segments).T if segments else np.empty((3, 0))
        axes.vlines(x, low, high, color=color, linewidth=width, zorder=2)
    axes.plot(places, starts[order], linestyle="none", marker="x", markersize=2.6, color=_CROSS, zorder=4)


def _legend(figure: "Figure", analysis: IncrementalDynamicAnalysis) -> None:
    count, resurrections = int(analysis.complete.sum()), len(analysis.resurrected(WIDE))
    lane: dict[str, Any] = {"color": _FALLEN, "linewidth": 2.5, "markersize": 3.5, "markeredgecolor": _CROSS}
    ring: dict[str, Any] = {"color": _AGAIN, "linewidth": 1.0, "markersize": 3.0, "markerfacecolor": "white"}
    label = f"resurrection: {resurrections} motion{'s' * (resurrections != 1)}"
    rows = [
        stroke(f"{count} motion{'s' * (count != 1)}", color=GREY, linewidth=0.8),
        stroke("overturns, x: first", marker="x", **lane),
        *([stroke(label, marker="o", **ring)] if resurrections else []),
        stroke("fraction at the level", **_FRACTION),
        stroke("first crossing passed", **_PASSED),
    ]
    legend_below(figure, rows, 2, handlelength=1.8)
