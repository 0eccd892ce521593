"""All stretches of amplitudes that overturn a body, under many motions and with several restitutions."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking import checks
from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.plots.study_words import plain, plain_log
from rocking.plots.style import DOUBLE, INK, SINGLE, in_journal_style, new_figure
from rocking.studies.minimum_acceleration import Transitions

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LANE, _MARGIN = 0.17, 1.25
_MOST_LANES, _MOST_PANELS = 60, 4
_FALLS, _STANDS = "#E0812F", "#E4EFF8"


@in_journal_style
def crossings_of_many_picture(
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
    >>> crossings_of_many_picture(found, ["0.6 s", "0.8 s"], words="period").axes[0].get_xlabel()
    'peak ground acceleration [g]'
    """
    lanes = [*found.values()]
    if not 1 <= len(lanes) <= _MOST_PANELS or not 1 <= len(names) <= _MOST_LANES:
        raise InvalidValueError(
            f"a picture holds 1 to {_MOST_PANELS} restitutions and 1 to {_MOST_LANES} lanes, got {len(lanes)} and "
            f"{len(names)}"
        )
    for each in lanes:
        if len(each) != len(names) or not all(isinstance(one, Transitions) for one in each):
            raise InvalidValueError(f"found must have {len(names)} Transitions for each restitution, got {each!r:.60}")
    order = np.argsort([one.acceleration[0] if len(one) else np.inf for one in lanes[0]], kind="stable").tolist()
    width = SINGLE if len(lanes) == 1 else DOUBLE
    figure, axes = new_figure(width, _MARGIN + _LANE * len(names), columns=len(lanes), sharex=True, sharey=True)
    ends = _ends([one for each in lanes for one in each])
    if until is not None:
        ends = ends[0], checks.within("until", until, ends[0] * g, 1e6, open_low=True) / g
    for panel, (label, each) in zip(axes, found.items(), strict=True):
        _lanes(panel, [each[k] for k in order], ends)
        panel.set_title(plain(label), loc="left", fontsize=7.5)
        panel.set_xlabel("peak ground acceleration [g]")
        panel.tick_params(axis="y", length=0)
    axes[0].set_yticks(range(len(names)), [plain(names[k]) for k in order])
    axes[0].set_ylabel(words)
    axes[0].set_ylim(len(names) - 0.5, -0.5)
    axes[0].set_xlim(*ends)
    for panel in axes:
        plain_log(panel, "x")
    _legend(figure)
    return figure


def _ends(found: Sequence[Transitions]) -> tuple[float, float]:
    """Return how far it is worth showing [g]."""
    low = min(one.lowest for one in found)
    last = [1.35 * one.acceleration[-1] for one in found if len(one)]
    return low / g, max([2.0 * low, *last]) / g


def _lanes(axes: "Axes", found: Sequence[Transitions], ends: tuple[float, float]) -> None:
    for row, one in enumerate(found):
        axes.broken_barh(
            [(one.lowest / g, max(ends[1] - one.lowest / g, 0.0))], (row - 0.36, 0.72), color=_STANDS, linewidth=0
        )
        stretches = [(low / g, (high - low) / g) for low, high in one.overturning_intervals]
        axes.broken_barh(stretches, (row - 0.36, 0.72), color=_FALLS, linewidth=0, zorder=2)
        if one.minimum is not None:
            axes.plot(one.minimum / g, row, "|", color=INK, markersize=6.5, markeredgewidth=1.2, zorder=3)


def _legend(figure: "Figure") -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Patch | Line2D] = [
        Patch(facecolor=_STANDS, edgecolor=INK, linewidth=0.4, label="stays standing"),
        Patch(facecolor=_FALLS, label="overturns"),
        Line2D([], [], linestyle="none", marker="|", color=INK, markeredgewidth=1.2, label="least that overturns"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=6.5, handlelength=1.2)
