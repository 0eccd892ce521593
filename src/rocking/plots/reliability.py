"""Whether probabilities are right as often as they say, and whether they are better than plain curves."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.errors import InvalidValueError
from rocking.plots.style import COLORS, DASHED, DOUBLE, GREY, PALE, in_journal_style, legend_below, new_figure, stroke
from rocking.prediction import Validation

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOOKS = {"prediction": (COLORS[0], "o"), "logistic": (COLORS[1], "s")}
_MEASURES = {"brier": "Brier", "logarithmic": "logarithmic"}


@in_journal_style
def reliability_picture(found: Validation) -> "Figure":
    """Draw the reliability diagram, and by how much the prediction is better than plain curves.

    Parameters
    ----------
    found : Validation
        As of `rocking.prediction.score`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, two columns wide: what happened over what was said, with the number of outcomes in each step; and
        the paired differences of scores with their intervals.

    Raises
    ------
    InvalidValueError
        If it is no validation.

    Examples
    --------
    >>> from rocking.prediction import score
    >>> pga = [1.0, 2.0, 3.0, 4.0]
    >>> found = score([0.1, 0.4, 0.7, 0.9], [0, 0, 1, 1], ["a", "a", "b", "b"], pga=pga, pgv=pga)
    >>> [panel.get_xlabel() for panel in reliability_picture(found).axes]
    ['probability that was given [-]', 'score is better by [-, nat]']
    """
    known: object = found
    if not isinstance(known, Validation):
        raise InvalidValueError(f"found must be a Validation, got {found!r:.60}")
    figure, axes = new_figure(DOUBLE, 3.4, columns=2)
    _reliability(axes[0], found)
    _differences(axes[1], found)
    handles = [
        stroke(
            f"{name}, with 95 % intervals", color=_LOOKS[name][0], marker=_LOOKS[name][1], linestyle="-", markersize=3.5
        )
        for name in _LOOKS
        if name in found.forecasts
    ]
    handles.append(stroke("right as often as it says", color=GREY, linestyle=DASHED))
    legend_below(figure, handles, 3)
    return figure


def _reliability(axes: "Axes", found: Validation) -> None:
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linestyle=DASHED, linewidth=0.8)
    for name, offset in (("logistic", 0.008), ("prediction", -0.008)):
        if name not in found.forecasts:
            continue
        color, mark = _LOOKS[name]
        steps = found.forecasts[name].reliability()
        said, seen, low, high = np.array([(s.predicted, s.observed, s.low, s.high) for s in steps]).T
        reach = np.maximum([seen - low, high - seen], 0.0)
        axes.errorbar(
            said + offset, seen, yerr=reach, fmt=mark, color=color, markersize=3.5, linewidth=0.8,
            alpha=1.0 if name == "prediction" else 0.6,
        )  # fmt: skip
        if name == "prediction":
            for k, step in enumerate(steps):  # on two lines, since neighbours may be close
                axes.annotate(
                    str(step.count), (step.predicted, 1.03), (0, 2 + 6 * (k % 2)), textcoords="offset points",
                    ha="center", fontsize=5.5, color=color,
                )  # fmt: skip
    axes.set_xlim(-0.03, 1.03)
    axes.set_ylim(-0.03, 1.03)
    axes.set_aspect("equal")
    axes.set_xlabel("probability that was given [-]")
    axes.set_ylabel("share that happened [-]")
    axes.set_title(f"{found.event}: {found.count} outcomes, {found.clusters} motions", loc="left", fontsize=7.5, pad=16)


def _differences(axes: "Axes", found: Validation) -> None:
    rows = [
        (f"{_MEASURES[measure]},\nagainst the {name}", each)
        for name, scores in found.differences.items()
        for measure, each in scores.items()
    ]
    axes.axvline(0.0, color=GREY, linewidth=0.8)
    for k, (_, each) in enumerate(rows):
        color = COLORS[0] if found.enough and each.resolved else GREY
        ends = np.array([each.low, each.value, each.high])
        if np.isfinite(ends).all():
            axes.plot(ends[[0, 2]], [k, k], color=color, linewidth=1.0)
        axes.plot(each.value, k, "o", color=color, markersize=4.0)
    axes.set_yticks(range(len(rows)), [label for label, _ in rows])
    axes.set_ylim(max(len(rows), 1) - 0.5, -0.5)
    axes.set_xlabel("score is better by [-, nat]")
    words = {"not resolved": "not resolved", "mixed": "better by one score, worse by another"}
    axes.set_title(words.get(found.finding, f"the prediction is {found.finding}"), loc="left", fontsize=7.5, pad=16)
    axes.grid(axis="x", color=PALE, linewidth=0.5)
