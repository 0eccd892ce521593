"""A figure that a notebook displays without pyplot."""

from collections.abc import Mapping
from io import BytesIO
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

_DOTS, _PIXELS = 144.0, 96.0  # dots of the image per inch, and pixels of a page per inch


class ShownFigure(Figure):
    """A matplotlib figure that IPython displays as an image, in the style of the figure."""

    def __init__(self, style: Mapping[str, Any], **options: Any) -> None:
        super().__init__(**options)
        self._style: Any = dict(style)

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        image = BytesIO()
        with rc_context(self._style):
            self.savefig(image, format="png", dpi=_DOTS, metadata={"Software": None})
        width, height = (self.get_size_inches() * _PIXELS).round().astype(int).tolist()
        return image.getvalue(), {"width": width, "height": height}
