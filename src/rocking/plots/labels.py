"""Labels, words and scales of axes that the pictures of studies share."""

from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.intensity import MEASURES
from rocking.plots.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

SYMBOLS = {
    "frequency_ratio": r"$\omega_p\,/\,p$ [-]",
    "amplitude_ratio": r"$a_p\,/\,(g\,\tan\,\alpha)$ [-]",
    "scale": "factor on the motion [-]",
    "period": "period of the pulse [s]",
    "duration": "duration of the motion [s]",
    "semi_diagonal": "semi-diagonal R [m]",
    "slenderness_ratio": "slenderness h/b [-]",
    "slenderness_angle": r"slenderness angle $\alpha$ [rad]",
    "width": "width [m]",
    "height": "height [m]",
    "restitution": "coefficient of restitution r [-]",
}
"""Labels of axes, by name."""

TYPESET = {
    "/(g tan alpha)": r"$\,/\,(g\,\tan\,\alpha)$",
    "/PGA": " / PGA",
    "D5-95": "$D_{5-95}$",
    "D5-75": "$D_{5-75}$",
}
"""How parts of the symbols of measures are drawn."""

_UNITS = {"1": "-", "m/s2": "m/s$^2$", "": "-"}

PEAK = r"peak rotation $\theta\,/\,\alpha$ [-]"


def axis_label(name: str, unit: str = "1", *, linear: bool = False) -> str:
    """Return the label of an axis or a measure, with symbol and unit."""
    words, one = SYMBOLS.get(name, short_name(name)), MEASURES.get(name)
    if name not in SYMBOLS:
        unit = unit if one is None else one.unit
        # the symbol of a ratio says more than its words
        words = words if one is None or "/" in words else one.words
        words = f"{words} [{_UNITS.get(unit, unit)}]"
    return words.replace(r"\tan\,\alpha", r"\alpha") if linear else words


def short_name(name: str) -> str:
    """Return the short name of a measure."""
    if name in MEASURES:
        symbol = MEASURES[name].symbol or plain(name)
        for part, drawn in TYPESET.items():
            symbol = symbol.replace(part, drawn)
        return symbol
    return f"Sa({name[3:-1]} s)" if name.startswith("sa(") else plain(name)


def plain(words: object) -> str:
    r"""Return words on one line that are drawn as they are: dollar signs start no formula."""
    return " ".join(str(words).split()).replace("$", r"\$")


def wrapped(words: str, width: int, most: int = 4) -> str:
    r"""Return words in lines, cut off after the last."""
    return "\n".join(wrap(words, width, max_lines=most, placeholder=" ..."))


def geometric(values: FloatArray) -> bool:
    """Return whether numbers grow by equal ratios rather than by equal steps: they are drawn on a log axis."""
    if values.size < 3 or values[0] <= 0.0:
        return False
    ratios, steps = np.diff(np.log(values)), np.diff(values)
    return bool(np.ptp(ratios) / ratios.mean() < np.ptp(steps) / steps.mean())


def plain_log(axes: "Axes", which: str) -> None:
    """Make an axis logarithmic, with plain numbers at a few ticks."""
    from matplotlib.ticker import LogLocator

    getattr(axes, f"set_{which}scale")("log")
    axis = axes.xaxis if which == "x" else axes.yaxis
    low, high = axis.get_view_interval()
    steps: tuple[float, ...] = (1.0, 2.0, 5.0) if high / low < 300.0 else (1.0,)
    if high / low < 4.0:
        steps = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)
    axis.set_major_locator(LogLocator(subs=steps))
    plain_numbers(axis)


def plain_numbers(axis: "Axis") -> None:
    """Write plain numbers at the ticks of an axis that stand out, none at the others."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def note(axes: "Axes", words: str, width: int = 62) -> None:
    """Write a small line or two above a panel."""
    axes.set_title(wrapped(words, width).replace("m/s2", "m/s$^2$"), loc="left", fontsize=7, color=INK)


def shown_in(axes: "Axes", which: str, unit: str, size: float) -> None:
    """Give an axis the numbers of another unit than it was drawn in, round in that unit."""
    from matplotlib.ticker import FuncFormatter, Locator

    axis = axes.xaxis if which == "x" else axes.yaxis
    drawn = axis.get_major_locator()

    class _Round(Locator):
        def tick_values(self, vmin: float, vmax: float) -> list[float]:
            return [size * tick for tick in drawn.tick_values(vmin / size, vmax / size)]

        def __call__(self) -> list[float]:
            return self.tick_values(*axis.get_view_interval())

    axis.set_major_locator(_Round())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:.6g}"))
    head, _, _ = axis.get_label_text().rpartition("[")
    if head:
        axis.set_label_text(f"{head}[{unit}]")
