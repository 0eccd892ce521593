"""Several responses over one time axis: where the models part, and where they agree."""

from collections.abc import Mapping
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from rocking.app.takeaway.plain_text import plain_line
from rocking.dynamics.response import Response
from rocking.outcome import Outcome
from rocking.plots.response import ground_curve, motion_curves, over_slenderness, shown_until
from rocking.plots.style import DOUBLE, GREY, INK, PALE, in_journal_style, model_styles, new_figure
from rocking.reports.response_facts import ModelAgreement, restitution_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SPARE = ("#4D9221", "#A6761D", "#7A5195", "#1A1A1A")
_DASHES = ((0, (3, 2, 8, 2)), (0, (12, 3)), (0, (5, 3, 1, 3)), (0, (2, 2)), "-")
_BEYOND = 2.2
"""How far a falling body is followed, in slenderness angles."""

_SMALL = 0.2
"""Below this share of the slenderness angle the rotations fill their panel and +-1 is left out."""

_SHORT = {Outcome.OVERTURNED: "overturns", Outcome.ROCKED: "stays standing", Outcome.NO_UPLIFT: "is never lifted"}


@in_journal_style
def comparison_picture(responses: Mapping[str, Response]) -> "Figure":
    """Draw several responses to one motion: ground acceleration, rotations, velocities, energy lost at impacts."""
    first = next(iter(responses.values()))
    figure, axes = new_figure(DOUBLE, 5.6, rows=4, sharex=True, height_ratios=[0.7, 1.8, 1.0, 1.0])
    verdict = ModelAgreement.of({restitution_words(label): one for label, one in responses.items()})
    figure.suptitle(
        "\n".join(wrap(drawn_text(verdict.sentence, 330), 110)), x=0.01, ha="left", fontsize=8.5, fontweight="bold"
    )
    time, values = ground_curve(first)
    axes[0].plot(time, values, color=INK, linewidth=0.7)
    axes[0].set_title(_ground(first), loc="left", fontsize=7.5)
    axes[0].set_ylabel("ground\nacceleration\n[m/s$^2$]")
    looks = _looks(list(responses))
    for label, response in responses.items():
        _response(axes, label, response, looks[label])
    for panel in axes[:3]:
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    _rotations(axes[1], responses)
    _frame(axes, responses)
    figure.align_ylabels(axes)
    return figure


def drawn_text(text: str, longest: int) -> str:
    r"""Return a text that a picture shows as it is, with no dollar sign that begins a formula."""
    return plain_line(text, longest).replace("$", r"\$")


def _response(axes: "list[Axes]", label: str, response: Response, look: dict[str, object]) -> None:
    (time, rotation, velocity), energy = motion_curves(response), response.energy
    words = drawn_text(f"{restitution_words(label)}: {_SHORT[response.outcome]}", 60)
    style = {**look, "linewidth": 1.0}
    axes[1].plot(time, over_slenderness(response, rotation), label=words, **style)  # type: ignore[arg-type]
    axes[2].plot(time, velocity, **style)  # type: ignore[arg-type]
    axes[3].plot(energy.time, energy.lost, drawstyle="steps-post", **style)  # type: ignore[arg-type]


def _rotations(axes: "Axes", responses: Mapping[str, Response]) -> None:
    peak = max(
        float(np.abs(over_slenderness(one, motion_curves(one)[1])).max(initial=0.0)) for one in responses.values()
    )
    if 0.0 < peak < _SMALL:
        axes.set_ylim(-1.25 * peak, 1.25 * peak)
        axes.set_title(r"the slenderness angle, $\pm$1, lies far outside this panel", loc="right", fontsize=7)
    else:
        for level in (-1.0, 1.0):
            axes.axhline(level, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)
        low, high = axes.get_ylim()
        axes.set_ylim(max(low, -_BEYOND), min(high, _BEYOND))
    axes.set_ylabel("rotation /\nslenderness\nangle [-]")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.0, borderpad=0.2)


def _frame(axes: "list[Axes]", responses: Mapping[str, Response]) -> None:
    axes[2].set_ylim(*_reach(responses))
    axes[2].set_ylabel("angular\nvelocity\n[rad/s]")
    axes[3].set_ylabel("energy lost\nat impacts\n[J]")
    for panel in axes:
        panel.locator_params(axis="y", nbins=5)
    axes[0].set_xlim(0.0, max(shown_until(response) for response in responses.values()))
    axes[-1].set_xlabel("time [s]")


def _reach(responses: Mapping[str, Response]) -> tuple[float, float]:
    """Fit the velocities before a body falls for good."""
    low, high = 0.0, 0.0
    for response in responses.values():
        time, _, velocity = motion_curves(response)
        values = velocity[~(time > response.overturning_time)]
        low, high = min(low, float(np.min(values, initial=0.0))), max(high, float(np.max(values, initial=0.0)))
    room = 0.12 * (high - low) or 1.0
    return low - room, high + room


def _ground(response: Response) -> str:
    if response.motion is None:
        return "free rocking, the ground at rest"
    times = "" if response.scale == 1.0 else f"{response.scale:g} times "
    return drawn_text(times + response.motion.name, 110)


def _looks(labels: list[str]) -> dict[str, dict[str, object]]:
    """Return colour and dash of each: that of a model everywhere, of its family once, and others of their own."""
    found: dict[str, dict[str, object]] = {}
    taken: set[str] = set()
    styles = model_styles()
    for label in labels:
        family = label.rpartition("*")[2].partition(":")[0]
        if family in styles and family not in taken:
            taken.add(family)
            found[label] = {key: styles[family][key] for key in ("color", "linestyle")}
        else:
            k = len(found) - len(taken)
            found[label] = {"color": _SPARE[k % len(_SPARE)], "linestyle": _DASHES[k % len(_DASHES)]}
    return found
