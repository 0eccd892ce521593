"""Model curves and measured points, drawn the same way in every figure."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.evidence.measurements import DataSet
from rocking.plots.style import GROUP_STYLE, INK, model_styles
from rocking.restitution import RestitutionModel, model

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def curve(axes: "Axes", name: str, low: float, high: float, which: RestitutionModel | None = None) -> None:
    """Draw a model's coefficient against slenderness.

    low, high: range of h/b [-].
    """
    ratio = np.linspace(low, high, 400)
    axes.plot(ratio, (which or model(name)).of_slenderness(ratio), **model_styles()[name])


def points(axes: "Axes", data: DataSet, style: str, *, filled: bool = False, label: str | None = None) -> None:
    """Draw measured coefficients with the interval that rounding leaves open."""
    look = {**GROUP_STYLE[style], **({} if label is None else {"label": label})}
    reach = np.array([data.coefficient - data.low, data.high - data.coefficient])
    axes.errorbar(
        data.slenderness,
        data.coefficient,
        yerr=reach,
        linestyle="none",
        color=INK,
        markerfacecolor=INK if filled else "white",
        markeredgewidth=0.7,
        elinewidth=0.6,
        **look,
    )


def slenderness_axis(axes: "Axes") -> None:
    """Label the axis of slenderness."""
    axes.set_xlabel("slenderness ratio h/b [-]")
