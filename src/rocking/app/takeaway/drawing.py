"""Pictures as bytes: one at a time, because the style of a picture belongs to the whole process."""

import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PictureKind = Literal["png", "svg"]

MEDIA_TYPES: dict[str, str] = {"png": "image/png", "svg": "image/svg+xml"}
"""What a browser is told about a picture."""

ONE_AT_A_TIME = RLock()
"""Held by whoever draws."""


def drawn(make: "Callable[[], Figure]", kind: PictureKind) -> bytes:
    """Draw a picture and return its file.

    Parameters
    ----------
    make : callable
        Returns the figure.
    kind : {"png", "svg"}
        Format.

    Returns
    -------
    bytes
        The file, the same for the same figure.
    """
    with TemporaryDirectory(prefix="rocking-picture-") as folder:
        path = Path(folder) / f"picture.{kind}"
        draw_to(make, path)
        return path.read_bytes()


def draw_to(make: "Callable[[], Figure]", path: Path) -> None:
    """Draw a picture into a file.

    Parameters
    ----------
    make : callable
        Returns the figure.
    path : Path
        File ending in .png, .svg or .pdf.
    """
    from rocking.plots.style import write

    with ONE_AT_A_TIME:
        # names may be in any script: a box in place of a letter is no reason to stop
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from", category=UserWarning)
        warnings.filterwarnings("ignore", message=r"Matplotlib currently does not support", category=UserWarning)
        write(make(), path)
