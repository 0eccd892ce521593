"""One journal style for every picture: sizes, colours, and files that come out the same every time."""

import re
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from functools import wraps
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from rocking.errors import RockingError, extra
from rocking.restitution import models
from rocking.tables.table import writing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.text import Text
    from matplotlib.transforms import BboxBase

P = ParamSpec("P")
T = TypeVar("T")

SINGLE, DOUBLE = 90.0 / 25.4, 190.0 / 25.4  # widths of one and of two journal columns [in]

INK, GREY, PALE = "#222222", "#8a8a8a", "#e6e6e6"

COLORS = ("#0070B2", "#D96C00", "#009960", "#AC8191", "#AC5B2B", "#008FE6")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (6, 2)))
MARKS = "osv^D<"
"""Colours that every kind of sight tells apart, with a line and a mark for each, so that grey print does too."""

_OVERHANG = 12.0  # dots by which a label may be longer than its axis
DASHED = (0, (4, 2))  # how limits are drawn

_SETTINGS: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 8.0,
    "lines.linewidth": 1.2,
    "lines.markersize": 4.0,
    "legend.frameon": False,
    "legend.fontsize": 7.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "svg.fonttype": "none",
    "svg.hashsalt": "rocking",
    "mathtext.default": "regular",
    "savefig.dpi": 300,
}


def model_styles() -> dict[str, dict[str, Any]]:
    """Return colour, line and legend of every restitution model that has a colour, by its name."""
    return {
        name: {"color": kind.colour, "linestyle": kind.linestyle, "label": kind.legend or kind.short_name}
        for name, kind in models().items()
        if kind.colour
    }


def in_journal_style(draw: Callable[P, T]) -> Callable[P, T]:
    """Let a drawing function run in the journal style, refusing with `MissingExtraError` without matplotlib."""

    @wraps(draw)
    def styled(*args: P.args, **options: P.kwargs) -> T:
        """Draw in the style."""
        with journal_style():
            from matplotlib.figure import Figure

            drawn = draw(*args, **options)
            if isinstance(drawn, Figure):
                _fit_labels(drawn)
            return drawn

    return styled


def _fit_labels(figure: "Figure") -> None:
    """Break labels that are longer than their axis, so that none is cut off or runs into its neighbour's."""
    shown = [axes for axes in figure.axes if axes.get_visible()]
    both = [(axes.bbox, axes.xaxis.label, "width") for axes in shown]
    both += [(axes.bbox, axes.yaxis.label, "height") for axes in shown]
    # what was broken by hand stays so, and a single word cannot be broken
    labels = [one for one in both if " " in (words := one[1].get_text()) and "\n" not in words]
    # panels are laid out, which takes its time, only where a label may be too long
    if any(_excess(*one) > -0.15 * getattr(one[0], one[2]) for one in labels):
        figure.draw_without_rendering()
    for box, label, side in labels:
        words, lines = label.get_text(), 1
        while _excess(box, label, side) > _OVERHANG and lines < len(words.split()):
            lines += 1
            label.set_text(broken(words, lines))


def _excess(box: "BboxBase", label: "Text", side: str) -> float:
    """Return by how much a label is longer than its axis, in dots."""
    return float(getattr(label.get_window_extent(), side) - getattr(box, side))


def broken(words: str, lines: int) -> str:
    r"""Return words in some lines of nearly equal length, formulas whole.

    >>> broken("peak ground velocity [m/s]", 2)
    'peak ground\nvelocity [m/s]'
    """
    whole = re.sub(r"\$[^$]*\$", lambda formula: formula[0].replace(" ", "\0"), words)
    width = max(len(whole) // lines, 1)
    while len(rows := wrap(whole, width, break_long_words=False, break_on_hyphens=False)) > lines:
        width += 1
    return "\n".join(rows).replace("\0", " ")


def journal_style() -> AbstractContextManager[None]:
    """Return a context in which figures are drawn in the style of this package: sizes, lines, fonts.

    Returns
    -------
    context manager
        Within it matplotlib's settings are those of a journal's column; afterwards they are what they were.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> with journal_style():
    ...     figure, (axes,) = new_figure(SINGLE, 2.0)
    >>> axes.spines["top"].get_visible()
    False
    """
    context: AbstractContextManager[None] = extra("matplotlib", "drawing").rc_context(_SETTINGS)
    return context


def new_figure(
    width: float, height: float, *, rows: int = 1, columns: int = 1, **options: Any
) -> tuple["Figure", list["Axes"]]:
    """Return a figure with its axes, laid out so that no label is cut off.

    Parameters
    ----------
    width, height : float
        Size [in]; `SINGLE` and `DOUBLE` of `rocking.plots.style` are the columns of a journal.
    rows, columns : int
        Panels.
    **options
        Of `matplotlib.figure.Figure.subplots`, such as sharex.

    Returns
    -------
    figure : matplotlib.figure.Figure
        The figure; draw into it within `journal_style`.
    axes : list of matplotlib.axes.Axes
        Its panels, row by row.

    Examples
    --------
    >>> figure, axes = new_figure(7.0, 3.0, columns=2)
    >>> len(axes)
    2
    """
    from rocking.plots.shown_figure import ShownFigure

    figure = ShownFigure(_SETTINGS, figsize=(width, height), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, list(axes.ravel())


def look(number: int) -> dict[str, Any]:
    """Return colour and line of a curve.

    >>> look(0)["color"], look(6)["color"] == look(0)["color"]
    ('#0070B2', True)
    """
    return {"color": COLORS[number % len(COLORS)], "linestyle": LINES[number % len(LINES)]}


def patch(color: str, label: str, **options: Any) -> "Patch":
    """Return an area of a colour, for a legend."""
    from matplotlib.patches import Patch

    return Patch(facecolor=color, label=label, **options)


def stroke(label: str, **options: Any) -> "Line2D":
    """Return a line or a mark, for a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], label=label, **options)


def legend_above(axes: "Axes", columns: int = 1, **options: Any) -> None:
    """Put the legend of a panel above it, where no curve runs."""
    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.0, "borderpad": 0.2}
    axes.legend(ncols=columns, **(place | options))


def legend_below(figure: "Figure", handles: Sequence[Any], columns: int, **options: Any) -> None:
    """Put the legend of a whole figure below its panels."""
    look: dict[str, Any] = {"loc": "outside lower center", "fontsize": 6.5, "handlelength": 1.2}
    figure.legend(handles=handles, ncols=columns, **(look | options))


def headline(figure: "Figure", sentence: str) -> None:
    """Head a figure with the sentence that says how a response ended."""
    lines = wrap(sentence[:1].upper() + sentence[1:], 88)
    figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8.5, fontweight="bold")


def write(figure: "Figure", path: str | Path) -> Path:
    """Write a figure in the format that the suffix names.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : str or Path
        File ending in .png, .svg or .pdf.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RockingError
        If the suffix is another, or the file cannot be written.
    """
    path = Path(path)
    metadata: dict[str, dict[str, Any]] = {
        ".png": {"Software": None},
        ".svg": {"Date": None, "Creator": None},
        ".pdf": {"CreationDate": None},
    }
    if path.suffix not in metadata:
        raise RockingError("a picture is .png, .svg or .pdf, got {file!r}", file=path.name)
    with writing(path), journal_style():
        figure.savefig(path, metadata=metadata[path.suffix])
    return path
