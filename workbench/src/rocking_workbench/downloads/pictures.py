"""Figures of reports and of compared studies, one at a time."""

import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import wrap
from threading import RLock
from typing import TYPE_CHECKING

import numpy as np

from rocking import Outcome, Response
from rocking.plots import new_figure, write
from rocking.plots.response import ground_curve, motion_curves, over_slenderness, shown_until
from rocking.plots.style import DOUBLE, GREY, INK, PALE, in_journal_style, model_styles
from rocking.reports.response_facts import ModelAgreement, restitution_words
from rocking_workbench.api.response import thinned
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.plain_text import plain_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ENOUGH = 2700  # largest number of points of a curve: one per pixel of the widest figure
ONE_AT_A_TIME = RLock()  # lock for the drawing of figures

_SPARE = ("#4D9221", "#A6761D", "#7A5195", "#1A1A1A")
_DASHES = ((0, (3, 2, 8, 2)), (0, (12, 3)), (0, (5, 3, 1, 3)), (0, (2, 2)), "-")
_BEYOND = 2.2  # largest shown rotation of an overturning body / slenderness angle
_SMALL = 0.2  # fraction of the slenderness angle below which rotations fill the panel, without lines at +-1
_SHORT = {Outcome.OVERTURNED: "overturns", Outcome.ROCKED: "does not overturn", Outcome.NO_UPLIFT: "no uplift"}


def figure_of(picture: str, evaluation: Evaluation) -> "Figure":
    """Return a picture."""
    from rocking.plots import body_picture, coefficient_picture, ground_motion_picture, response_picture

    match picture:
        case "motion":
            figure, scale = ground_motion_picture(evaluation.motion), evaluation.scale
            # the name belongs to the unscaled motion
            return figure if scale == 1.0 else _titled(figure, f"{scale:g} times {evaluation.motion.name}")
        case "response" if len(evaluation.responses) > 1:
            return comparison_picture(evaluation.responses)
        case "response":
            chosen = evaluation.chosen(None)
            return in_words(response_picture(chosen, evaluation.problem.assumed_friction), [chosen.parameters.label])
        case "coefficients":
            tables = evaluation.impact.tables
            return in_words(
                coefficient_picture(evaluation.body, tables), [row.name for row in tables[evaluation.drawn_foot]]
            )
    return body_picture(evaluation.body)


def _titled(figure: "Figure", title: str) -> "Figure":
    figure.suptitle(drawn_text(title, 80), x=0.01, ha="left", fontsize=8.5, fontweight="bold")
    return figure


def drawn(make: "Callable[[], Figure]") -> bytes:
    """Draw a picture and return its reproducible SVG."""
    with TemporaryDirectory(prefix="rocking-picture-") as folder:
        path = Path(folder) / "picture.svg"
        draw_to(make, path)
        return path.read_bytes()


def draw_to(make: "Callable[[], Figure]", path: Path) -> None:
    """Draw a picture into a file."""
    with ONE_AT_A_TIME:
        # names can be in any script; a box in place of a letter is accepted
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from", category=UserWarning)
        warnings.filterwarnings("ignore", message=r"Matplotlib currently does not support", category=UserWarning)
        write(_thinned(make()), path)


def _thinned(figure: "Figure") -> "Figure":
    """Thin long curves; their extremes are kept."""
    for line in (line for axes in figure.axes for line in axes.get_lines()):
        x, y = (np.asarray(values, dtype=np.float64) for values in line.get_data(orig=False))
        if x.size > 2 * _ENOUGH and (np.diff(x) >= 0.0).all():
            kept = thinned(x, (y,), _ENOUGH)
            line.set_data(x[kept], y[kept])
    return figure


def in_words(figure: "Figure", labels: Iterable[str]) -> "Figure":
    """Replace restitution labels in a picture by their names."""
    from matplotlib.text import Text

    texts = {label: restitution_words(label) for label in labels}
    rows = {label.replace(":", "\n"): text_of_label.replace(", ", ",\n", 1) for label, text_of_label in texts.items()}
    for axes in figure.axes:
        names = [text.get_text() for text in axes.get_yticklabels()]
        if any(text in rows for text in names):
            axes.set_yticks(axes.get_yticks(), [rows.get(text, text) for text in names], fontsize=6)
    for text in figure.findobj(Text):
        for label, text_of_label in texts.items():
            text.set_text(text.get_text().replace(f"restitution: {label};", f"restitution: {text_of_label};"))
    return figure


@in_journal_style
def comparison_picture(responses: Mapping[str, Response]) -> "Figure":
    """Draw several responses to one motion: ground acceleration, rotations, velocities, energy lost at impacts."""
    first = next(iter(responses.values()))
    figure, axes = new_figure(DOUBLE, 5.6, rows=4, sharex=True, height_ratios=[0.7, 1.8, 1.0, 1.0])
    verdict = ModelAgreement.of({restitution_words(label): answer for label, answer in responses.items()})
    figure.suptitle(
        "\n".join(wrap(drawn_text(verdict.sentence, 330), 110)), x=0.01, ha="left", fontsize=8.5, fontweight="bold"
    )
    time, values = ground_curve(first)
    axes[0].plot(time, values, color=INK, linewidth=0.7)
    ground = "free rocking, the ground at rest"
    if first.motion is not None:
        times = "" if first.scale == 1.0 else f"{first.scale:g} times "
        ground = drawn_text(times + first.motion.name, 110)
    axes[0].set_title(ground, loc="left", fontsize=7.5)
    axes[0].set_ylabel("ground\nacceleration\n[m/s$^2$]")
    looks = _looks(list(responses))
    for label, response in responses.items():
        _draw_response(axes, label, response, looks[label])
    for panel in axes[:3]:
        panel.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    _rotations(axes[1], responses)
    _frame(axes, responses)
    figure.align_ylabels(axes)
    return figure


def drawn_text(text: str, longest: int) -> str:
    r"""Return a text for a figure, with escaped dollar signs."""
    return plain_line(text, longest).replace("$", r"\$")


def _draw_response(axes: "list[Axes]", label: str, response: Response, look: dict[str, object]) -> None:
    (time, rotation, velocity), energy = motion_curves(response), response.energy
    text = drawn_text(f"{restitution_words(label)}: {_SHORT[response.outcome]}", 60)
    style = {**look, "linewidth": 1.0}
    axes[1].plot(time, over_slenderness(response, rotation), label=text, **style)  # type: ignore[arg-type]
    axes[2].plot(time, velocity, **style)  # type: ignore[arg-type]
    axes[3].plot(energy.time, energy.lost, drawstyle="steps-post", **style)  # type: ignore[arg-type]


def _rotations(axes: "Axes", responses: Mapping[str, Response]) -> None:
    peak = max(
        float(np.abs(over_slenderness(response, motion_curves(response)[1])).max(initial=0.0))
        for response in responses.values()
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
    """Return the range of velocities before overturning."""
    curves = [(motion_curves(response), response.overturning_time) for response in responses.values()]
    values = np.concatenate([velocity[~(time > end)] for (time, _, velocity), end in curves])
    low, high = float(np.min(values, initial=0.0)), float(np.max(values, initial=0.0))
    room = 0.12 * (high - low) or 1.0
    return low - room, high + room


def _looks(labels: list[str]) -> dict[str, dict[str, object]]:
    """Return colour and dash by label: the style of the model for the first of a family, otherwise a spare style."""
    looks: dict[str, dict[str, object]] = {}
    taken: set[str] = set()
    styles = model_styles()
    for label in labels:
        family = label.rpartition("*")[2].partition(":")[0]
        if family in styles and family not in taken:
            taken.add(family)
            looks[label] = {key: styles[family][key] for key in ("color", "linestyle")}
        else:
            k = len(looks) - len(taken)
            looks[label] = {"color": _SPARE[k % len(_SPARE)], "linestyle": _DASHES[k % len(_DASHES)]}
    return looks
