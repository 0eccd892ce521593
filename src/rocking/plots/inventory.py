"""Pictures of inventories: ratings, fractions of overturning and uplift accelerations of the objects."""

from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.conventions import g
from rocking.decision.inventory.assessment import Assessment, Verdict
from rocking.decision.inventory.lights import LIGHT_LETTERS, LIGHT_NAMES, Light
from rocking.decision.inventory.ranking import words_of
from rocking.errors import InvalidValueError
from rocking.language import Language
from rocking.plots.labels import plain, wrapped
from rocking.plots.style import DASHED, DOUBLE, GREY, INK, PALE, in_journal_style, legend_below, new_figure, stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROW, _MARGIN = 0.235, 1.05
MOST = 60
"""Maximum number of objects in a picture."""

_HEIGHT, _BINS = 2.1, 20  # height [in] and number of bins of the distribution
_LIGHTS = {Light.RED: ("#B2182B", "s"), Light.AMBER: ("#F4A300", "^"), Light.GREEN: ("#1B7F5C", "o")}
"""Colour and shape of a rating. A letter next to the shape has the same meaning."""

_RED: dict[str, Any] = {"color": _LIGHTS[Light.RED][0], "linewidth": 0.7, "linestyle": DASHED}
_PEAK: dict[str, Any] = {"color": INK, "linewidth": 0.8, "linestyle": (0, (1, 1))}


@in_journal_style
def inventory_picture(assessment: Assessment, most: int = MOST) -> "Figure":
    """Draw an inventory or its worst objects, with the worst object at the top.

    Left: fraction of motions with overturning per object, with its interval, and the rating as a shape and letter.
    Right: horizontal acceleration without uplift, compared with the peak acceleration of the hazard, if stated.

    Parameters
    ----------
    assessment : Assessment
        Result of `rocking.decision.inventory.assess`.
    most : int
        Maximum number of plotted objects [-]. The title contains the total number.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, two columns wide, one row per object.

    Raises
    ------
    InvalidValueError
        If the argument has another type, has no object, or `most` is not 1 to 60.

    Examples
    --------
    >>> from rocking.decision.inventory import Inventory, InventoryObject, assess
    >>> from rocking.decision.inventory.hazard import Hazard, IntensityLevel
    >>> hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=5, seed=1)
    >>> vase = InventoryObject(name="vase", width=0.12, depth=0.12, height=0.6)
    >>> figure = inventory_picture(assess(Inventory((vase,)), hazard))
    >>> figure.axes[0].get_xlabel()
    'fraction of motions with overturning [-]'
    """
    checks.of_kind("assessment", assessment, Assessment, "of an inventory")
    verdicts, say = _verdicts(assessment)[: checks.whole("most", most, 1, MOST)], words_of(assessment)
    figure, (left, right) = new_figure(
        DOUBLE, _MARGIN + _ROW * len(verdicts), columns=2, sharey=True, width_ratios=[1.5, 1.0]
    )
    for row, verdict in enumerate(verdicts):
        for panel in (left, right):
            panel.axhline(row, color=PALE, linewidth=0.5, zorder=0)
            panel.tick_params(axis="y", length=0)
        _share(left, row, verdict, say)
        right.plot(verdict.uplift_acceleration / g, row, "|", color=INK, markersize=7.0, markeredgewidth=1.6)
        right.hlines(row, 0.0, verdict.uplift_acceleration / g, color=GREY, linewidth=1.0)
    left.set_yticks(range(len(verdicts)), [wrapped(plain(item.item.label), 34, 1) for item in verdicts])
    left.set(xlim=(-0.1, 1.03), ylim=(len(verdicts) - 0.5, -0.5), xticks=[0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    left.set_xlabel(say("fraction of motions with overturning [-]"))
    left.axvline(assessment.thresholds.overturning_red, **_RED)
    right.set_xlim(left=0.0)
    right.set_xlabel(say("largest PGA without uplift [g]"))
    _finish(figure, right, assessment, len(verdicts))
    return figure


@in_journal_style
def inventory_distribution(assessment: Assessment) -> "Figure":
    """Draw the distribution of objects by fraction of overturning and by uplift acceleration, for every rating.

    Parameters
    ----------
    assessment : Assessment
        Result of `rocking.decision.inventory.assess`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, two columns wide, for the quantities of `inventory_picture` and all objects.

    Raises
    ------
    InvalidValueError
        If the argument has another type, or has no object.

    Examples
    --------
    >>> from rocking.decision.inventory import Inventory, InventoryObject, assess
    >>> from rocking.decision.inventory.hazard import Hazard, IntensityLevel
    >>> hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=5, seed=1)
    >>> vases = [InventoryObject(name="vase", width=0.12, depth=0.12, height=h) for h in (0.3, 0.6)]
    >>> figure = inventory_distribution(assess(Inventory(tuple(vases)), hazard))
    >>> float(sum(bar.get_height() for bar in figure.axes[0].patches))
    2.0
    """
    checks.of_kind("assessment", assessment, Assessment, "of an inventory")
    verdicts, say = _verdicts(assessment), words_of(assessment)
    figure, (left, right) = new_figure(DOUBLE, _HEIGHT, columns=2, sharey=False, width_ratios=[1.5, 1.0])
    limits = [item.uplift_acceleration / g for item in verdicts]
    shares = [item.worse.overturned_fraction for item in verdicts]
    for panel, values, upper in ((left, shares, 1.0), (right, limits, max(limits))):
        groups = [
            [value for value, item in zip(values, verdicts, strict=True) if item.light is light] for light in _LIGHTS
        ]
        colors = [color for color, _ in _LIGHTS.values()]
        panel.hist(groups, bins=_BINS, range=(0.0, upper), stacked=True, color=colors, edgecolor="white", linewidth=0.4)
        panel.locator_params(axis="y", integer=True)
        panel.set_ylabel(say("number of objects [-]"))
    left.set_xlabel(say("fraction of motions with overturning [-]"))
    left.axvline(assessment.thresholds.overturning_red, **_RED)
    right.set_xlabel(say("largest PGA without uplift [g]"))
    _finish(figure, right, assessment, len(verdicts))
    return figure


def _verdicts(assessment: Assessment) -> tuple[Verdict, ...]:
    if not assessment.verdicts:
        raise InvalidValueError("the inventory has no assessed object for a picture")
    return assessment.verdicts


def _finish(figure: "Figure", right: "Axes", assessment: Assessment, shown: int) -> None:
    """Draw the common parts of both pictures: peak of the ground motion, title, legend."""
    level, say = assessment.hazard.level, words_of(assessment)
    if level is not None and level.kind == "PGA":
        right.axvline(level.value / g, **_PEAK)
        right.set_xlim(right=max(right.get_xlim()[1], 1.05 * level.value / g))
    shaking = f"{assessment.hazard.words(say.code)}; {say(assessment.hazard.source)}"
    of_all = len(assessment.verdicts)
    shaking += f"\n{say('the worst {shown} of {count} objects', shown=shown, count=of_all)}" if shown < of_all else ""
    figure.suptitle(plain(shaking), x=0.01, ha="left", fontsize=7)
    _legend(figure, assessment)


def _share(axes: "Axes", row: int, verdict: Verdict, say: Language) -> None:
    color, shape = _LIGHTS[verdict.light]
    axes.hlines(row, *verdict.interval, color=color, linewidth=1.4, zorder=2)
    axes.plot(verdict.worse.overturned_fraction, row, shape, color=color, markersize=4.6, zorder=3, clip_on=False)
    letter = say(LIGHT_LETTERS[verdict.light])
    axes.text(-0.06, row, letter, ha="center", va="center", fontsize=7, color=INK, fontweight="bold")


def _legend(figure: "Figure", assessment: Assessment) -> None:
    counts, level, say = assessment.counts(), assessment.hazard.level, words_of(assessment)
    light_texts = {light: {"letter": say(LIGHT_LETTERS[light]), "light": say(LIGHT_NAMES[light])} for light in Light}
    mark: dict[str, Any] = {"linestyle": "none", "markersize": 4.6}
    handles = [
        stroke(
            say("{letter}: {light}, {count}", count=counts[light], **light_texts[light]),
            marker=shape,
            color=color,
            **mark,
        )
        for light, (color, shape) in _LIGHTS.items()
    ]
    handles.append(stroke(say("limit of red"), **_RED))
    if level is not None and level.kind == "PGA":
        handles.append(stroke(say("peak of the ground motion"), **_PEAK))
    legend_below(figure, handles, 5, handlelength=1.6)
