"""Pictures as bytes: one at a time, because the style of a picture belongs to the whole process."""

import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock
from typing import TYPE_CHECKING, Literal

from rocking.app.api.response import thinned

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PictureKind = Literal["png", "svg"]

MEDIA_TYPES: dict[str, str] = {"png": "image/png", "svg": "image/svg+xml"}
"""What a browser is told about a picture."""

_ENOUGH = 2700
"""Runs of a curve whose extremes are drawn: one for each dot of the widest picture."""

ONE_AT_A_TIME = RLock()
"""Held by whoever draws."""


def drawn(make: "Callable[[], Figure]", kind: PictureKind) -> bytes:
    """Draw a picture and return its file.

    Returns the file, the same for the same figure.
    """
    with TemporaryDirectory(prefix="rocking-picture-") as folder:
        path = Path(folder) / f"picture.{kind}"
        draw_to(make, path)
        return path.read_bytes()


def draw_to(make: "Callable[[], Figure]", path: Path) -> None:
    """Draw a picture into a file."""
    from rocking.plots.style import write

    with ONE_AT_A_TIME:
        # names may be in any script: a box in place of a letter is no reason to stop
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from", category=UserWarning)
        warnings.filterwarnings("ignore", message=r"Matplotlib currently does not support", category=UserWarning)
        write(_thinned(make()), path)


def _thinned(figure: "Figure") -> "Figure":
    """Leave out of long curves what no eye can see; every extreme stays."""
    import numpy as np

    for line in (line for axes in figure.axes for line in axes.get_lines()):
        x, y = (np.asarray(values, dtype=np.float64) for values in line.get_data(orig=False))
        if x.size > 2 * _ENOUGH and (np.diff(x) >= 0.0).all():
            kept = thinned(x, (y,), _ENOUGH)
            line.set_data(x[kept], y[kept])
    return figure
