"""An inventory at a glance: each object with its light, how often it falls, and what it takes to lift it."""

from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.language import Language
from rocking.plots.labels import plain, wrapped
from rocking.plots.style import DASHED, DOUBLE, GREY, INK, PALE, in_journal_style, legend_below, new_figure, stroke
from rocking.studies.inventory.assessment import Assessment, Verdict
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.table import words_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROW, _MARGIN = 0.235, 1.05
_MOST = 60
_LIGHTS = {Light.RED: ("#B2182B", "s"), Light.AMBER: ("#F4A300", "^"), Light.GREEN: ("#1B7F5C", "o")}
"""Colour and shape: the letter beside it says the same, for who sees no colours."""

_RED: dict[str, Any] = {"color": _LIGHTS[Light.RED][0], "linewidth": 0.7, "linestyle": DASHED}
_PEAK: dict[str, Any] = {"color": INK, "linewidth": 0.8, "linestyle": (0, (1, 1))}


@in_journal_style
def inventory_picture(assessment: Assessment) -> "Figure":
    """Draw an inventory, the worst object on top.

    Left: the share of the motions that overturn each object, with its interval, and the light as a shape with its
    letter. Right: the level acceleration below which it stays still, beside the peak acceleration of the shaking where
    the hazard is one.

    Parameters
    ----------
    assessment : Assessment
        As of `rocking.studies.inventory.assess`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, two columns wide, a row an object.

    Raises
    ------
    InvalidValueError
        If it is no assessment, or of too many objects for a picture.

    Examples
    --------
    >>> from rocking.studies.inventory import Inventory, InventoryObject, assess
    >>> from rocking.studies.inventory.hazard import Hazard, IntensityLevel
    >>> hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=5, seed=1)
    >>> vase = InventoryObject(name="vase", width=0.12, depth=0.12, height=0.6)
    >>> figure = inventory_picture(assess(Inventory((vase,)), hazard))
    >>> figure.axes[0].get_xlabel()
    'share of motions that overturn it [-]'
    """
    checks.of_kind("assessment", assessment, Assessment, "of an inventory")
    verdicts, say = assessment.verdicts, words_of(assessment)
    if not 1 <= len(verdicts) <= _MOST:
        raise InvalidValueError(
            f"a picture holds 1 to {_MOST} objects, got {len(verdicts)}; the report has room for all"
        )
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
    left.set_yticks(range(len(verdicts)), [wrapped(plain(each.item.name), 30, 1) for each in verdicts])
    left.set(xlim=(-0.1, 1.03), ylim=(len(verdicts) - 0.5, -0.5), xticks=[0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    left.set_xlabel(say("picture.share"))
    left.axvline(assessment.thresholds.overturning_red, **_RED)
    right.set_xlim(left=0.0)
    right.set_xlabel(say("picture.still"))
    level = assessment.hazard.level
    if level is not None and level.kind == "PGA":
        right.axvline(level.value / g, **_PEAK)
    shaking = f"{assessment.hazard.words(say.code)}; {say.translated(assessment.hazard.source)}"
    figure.suptitle(plain(shaking), x=0.01, ha="left", fontsize=7)
    _legend(figure, assessment)
    return figure


def _share(axes: "Axes", row: int, verdict: Verdict, say: Language) -> None:
    color, shape = _LIGHTS[verdict.light]
    axes.hlines(row, *verdict.interval, color=color, linewidth=1.4, zorder=2)
    axes.plot(verdict.worse.overturned_share, row, shape, color=color, markersize=4.6, zorder=3, clip_on=False)
    letter = say(f"letter.{verdict.light.word}")
    axes.text(-0.06, row, letter, ha="center", va="center", fontsize=7, color=INK, fontweight="bold")


def _legend(figure: "Figure", assessment: Assessment) -> None:
    counts, level, say = assessment.counts(), assessment.hazard.level, words_of(assessment)
    said = {each: {"letter": say(f"letter.{each.word}"), "light": say(f"light.{each.word}")} for each in Light}
    mark: dict[str, Any] = {"linestyle": "none", "markersize": 4.6}
    handles = [
        stroke(say("picture.light", count=counts[light], **said[light]), marker=shape, color=color, **mark)
        for light, (color, shape) in _LIGHTS.items()
    ]
    handles.append(stroke(say("picture.red"), **_RED))
    if level is not None and level.kind == "PGA":
        handles.append(stroke(say("picture.peak"), **_PEAK))
    legend_below(figure, handles, 5, handlelength=1.6)
