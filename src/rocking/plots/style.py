"""One journal style for every picture: sizes, colours, and files that come out the same every time."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from rocking.errors import MissingExtraError, RockingError, how_to_install
from rocking.restitution import models

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

P = ParamSpec("P")
T = TypeVar("T")

SINGLE, DOUBLE = 90.0 / 25.4, 190.0 / 25.4
"""Widths of one and of two journal columns [in]."""

INK, GREY, PALE = "#222222", "#8a8a8a", "#e6e6e6"

GROUP_STYLE: dict[str, dict[str, Any]] = {
    "table1": {"marker": "s", "label": "Table 1"},
    "S": {"marker": "v", "label": "S"},
    "M": {"marker": "o", "label": "M"},
    "L": {"marker": "^", "label": "L"},
}

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
    """Return colour, line and legend of every restitution model that has a colour (Okabe and Ito's), by its name."""
    return {
        name: {"color": kind.colour, "linestyle": kind.linestyle, "label": kind.legend or kind.short_name}
        for name, kind in models().items()
        if kind.colour
    }


def in_journal_style(draw: Callable[P, T]) -> Callable[P, T]:
    """Let a drawing function run in the journal style.

    Returns the same, refusing with `MissingExtraError` if matplotlib is not installed.
    """

    @wraps(draw)
    def styled(*args: P.args, **options: P.kwargs) -> T:
        """Draw in the style."""
        with _style():
            return draw(*args, **options)

    return styled


def _style() -> AbstractContextManager[None]:
    try:
        from matplotlib import rc_context
    except ImportError as error:
        raise MissingExtraError(how_to_install("drawing", "matplotlib", error)) from error
    return rc_context(_SETTINGS)


def new_figure(
    width: float, height: float, *, rows: int = 1, columns: int = 1, **options: Any
) -> tuple["Figure", list["Axes"]]:
    """Return a figure in the journal style with its axes.

    width, height: size [in].
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, list(axes.ravel())


def save(figure: "Figure", folder: Path, stem: str) -> list[Path]:
    """Write a figure as PNG and SVG, the same bytes every time.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    folder : Path
        Where to write.
    stem : str
        File name without suffix.

    Returns
    -------
    list of Path
        PNG and SVG.
    """
    return [write(figure, folder / f"{stem}.{kind}") for kind in ("png", "svg")]


def write(figure: "Figure", path: Path) -> Path:
    """Write a figure in the format that the suffix names.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : Path
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
    metadata: dict[str, dict[str, Any]] = {
        ".png": {"Software": None},
        ".svg": {"Date": None, "Creator": None},
        ".pdf": {"CreationDate": None},
    }
    if path.suffix not in metadata:
        raise RockingError(f"a picture is .png, .svg or .pdf, got {path.name!r}")
    try:
        with _style():
            figure.savefig(path, metadata=metadata[path.suffix])
    except OSError as error:
        raise RockingError(f"cannot write {path}: {error.strerror or error}") from error
    return path
