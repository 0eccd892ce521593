"""One journal style for all pictures: sizes, colours and reproducible files."""

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
"""Colours for all types of colour vision, with lines and marks for print in grey."""

_OVERHANG = 12.0  # number of dots by which a label may exceed its axis
DASHED = (0, (4, 2))  # line style of limits

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
    """Return colour, line and legend of the restitution models that have a colour, by name."""
    return {
        name: {"color": kind.colour, "linestyle": kind.linestyle, "label": kind.legend or kind.short_name}
        for name, kind in models().items()
        if kind.colour
    }


def in_journal_style(draw: Callable[P, T]) -> Callable[P, T]:
    """Return a drawing function in the journal style. It raises `MissingExtraError` without matplotlib."""

    @wraps(draw)
    def styled(*args: P.args, **options: P.kwargs) -> T:
        """Draw in the journal style."""
        with journal_style():
            from matplotlib.figure import Figure

            drawn = draw(*args, **options)
            if isinstance(drawn, Figure):
                _fit_labels(drawn)
            return drawn

    return styled


def _fit_labels(figure: "Figure") -> None:
    """Break labels that are longer than their axis into lines."""
    shown = [axes for axes in figure.axes if axes.get_visible()]
    candidates = [(axes.bbox, axes.xaxis.label, "width") for axes in shown]
    candidates += [(axes.bbox, axes.yaxis.label, "height") for axes in shown]
    # labels with line breaks stay unchanged, and a single word cannot be broken
    labels = [item for item in candidates if " " in (text := item[1].get_text()) and "\n" not in text]
    # the layout is slow, and is needed only if a label may be too long
    if any(_excess(*item) > -0.15 * getattr(item[0], item[2]) for item in labels):
        figure.draw_without_rendering()
    for box, label, side in labels:
        text, lines = label.get_text(), 1
        while _excess(box, label, side) > _OVERHANG and lines < len(text.split()):
            lines += 1
            label.set_text(broken(text, lines))


def _excess(box: "BboxBase", label: "Text", side: str) -> float:
    """Return the excess length of a label over its axis, in dots."""
    return float(getattr(label.get_window_extent(), side) - getattr(box, side))


def broken(text: str, lines: int) -> str:
    r"""Return a text in lines of nearly equal length, without breaks in formulas.

    >>> broken("peak ground velocity [m/s]", 2)
    'peak ground\nvelocity [m/s]'
    """
    protected = re.sub(r"\$[^$]*\$", lambda formula: formula[0].replace(" ", "\0"), text)
    width = max(len(protected) // lines, 1)
    while len(rows := wrap(protected, width, break_long_words=False, break_on_hyphens=False)) > lines:
        width += 1
    return "\n".join(rows).replace("\0", " ")


def journal_style() -> AbstractContextManager[None]:
    """Return a context that sets the figure style of this package: sizes, lines, fonts.

    Returns
    -------
    context manager
        Within the context, matplotlib has the settings of a journal column. Afterwards, the previous settings apply.

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
    """Return a figure with its axes, with a layout that shows all labels.

    Parameters
    ----------
    width, height : float
        Size [in]. `SINGLE` and `DOUBLE` of `rocking.plots.style` are widths of one and two journal columns.
    rows, columns : int
        Number of panels.
    **options
        Options of `matplotlib.figure.Figure.subplots`, such as sharex.

    Returns
    -------
    figure : matplotlib.figure.Figure
        The figure, for drawing within `journal_style`.
    axes : list of matplotlib.axes.Axes
        Panels, by rows.

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
    """Return a coloured area for a legend."""
    from matplotlib.patches import Patch

    return Patch(facecolor=color, label=label, **options)


def stroke(label: str, **options: Any) -> "Line2D":
    """Return a line or a mark for a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], label=label, **options)


def legend_above(axes: "Axes", columns: int = 1, **options: Any) -> None:
    """Put the legend of a panel above it."""
    layout: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.0, "borderpad": 0.2}
    axes.legend(ncols=columns, **(layout | options))


def legend_below(figure: "Figure", handles: Sequence[Any], columns: int, **options: Any) -> None:
    """Put the legend of a figure below its panels."""
    layout: dict[str, Any] = {"loc": "outside lower center", "fontsize": 6.5, "handlelength": 1.2}
    figure.legend(handles=handles, ncols=columns, **(layout | options))


def headline(figure: "Figure", sentence: str) -> None:
    """Set the title of a figure to the summary of a response."""
    lines = wrap(sentence[:1].upper() + sentence[1:], 88)
    figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8.5, fontweight="bold")


def write(figure: "Figure", path: str | Path) -> Path:
    """Write a figure in the format of the extension.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : str or Path
        File with extension .png, .svg or .pdf.

    Returns
    -------
    Path
        The written file.

    Raises
    ------
    RockingError
        If the extension is not allowed, or the file cannot be written.
    """
    path = Path(path)
    metadata: dict[str, dict[str, Any]] = {
        ".png": {"Software": None},
        ".svg": {"Date": None, "Creator": None},
        ".pdf": {"CreationDate": None},
    }
    if path.suffix not in metadata:
        raise RockingError("unsupported picture file {file!r}; use .png, .svg or .pdf", file=path.name)
    with writing(path), journal_style():
        figure.savefig(path, metadata=metadata[path.suffix])
    return path
