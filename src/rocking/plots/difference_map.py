"""What one restitution changes in a map against another: both verdicts, and how far the peak rotation moves."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.errors import InvalidValueError
from rocking.plots.overturning_map import CLASSES, classes_of, draw_map
from rocking.plots.sensitivity import GAINED, LOST, UNKNOWN
from rocking.plots.study_words import plain
from rocking.plots.style import DOUBLE, INK, in_journal_style, new_figure
from rocking.studies.sensitivity.comparison import Sensitivity

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 3.0
_BOTH = "#BDBDBD"
_COLORS = "PuOr_r"
"""Purple to orange, white between: told apart by every eye, and unlike the colours of flips."""


@in_journal_style
def difference_map_picture(found: Sensitivity, choice: str | None = None) -> "Figure":
    r"""Draw the maps of the baseline and of another restitution, and their difference beside them.

    In the map of differences the colour says by how much the peak rotation over alpha is larger with the choice where
    the body stands with both, and two more colours where the verdict flips.

    Parameters
    ----------
    found : Sensitivity
        As of `map_sensitivity`.
    choice : str, optional
        The restitution that is compared with the baseline; the first after it if not given.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If it is no comparison of maps, or has no such choice.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.sensitivity import map_sensitivity
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0, 4.0]), ("amplitude_ratio", [1.0, 2.0, 3.0, 4.0])
    >>> figure = difference_map_picture(map_sensitivity(block, pulse, *axes, ["housner", "ked"]))
    >>> [panel.get_title(loc="left") for panel in figure.axes[:3]]
    ['a  housner', 'b  ked', 'c  ked less housner, 0 of 16 verdicts flip']
    """
    given: object = found
    if not isinstance(given, Sensitivity) or found.datasets[found.baseline].get("mode", np.empty(0)).ndim != 2:
        raise InvalidValueError(f"found must be a Sensitivity of maps, got {found!r:.60}")
    others = found.labels[1:]
    choice = others[0] if choice is None and others else choice
    if choice not in others:
        raise InvalidValueError(f"choice must be one of {', '.join(others)}, got {choice!r:.60}")
    figure, axes = new_figure(DOUBLE, HEIGHT, columns=3, sharex=True, sharey=True)
    kinds = {label: classes_of(found.datasets[label]) for label in (found.baseline, choice)}
    for letter, panel, (label, each) in zip("ab", axes, kinds.items(), strict=False):
        draw_map(panel, found.datasets[label], each)
        panel.set_title(f"{letter}  {plain(label)}", loc="left", fontsize=7.5)
    scale = _differences(axes[2], found, choice)
    bar = figure.colorbar(scale, ax=axes[2], pad=0.02, aspect=30)
    bar.set_label(r"change of peak rotation $\theta\,/\,\alpha$ [-]", fontsize=7)
    bar.outline.set_linewidth(0.6)
    for panel in axes:
        panel.label_outer()
    _legend(figure, kinds, _flips(found, choice))
    return figure


def _flips(found: Sensitivity, choice: str) -> "xr.DataArray":
    return found.differences("verdict").sel(restitution=choice)


def _differences(axes: "Axes", found: Sensitivity, choice: str) -> Any:
    """Draw the change of the peaks, and flips over it; return what the colours mean."""
    from matplotlib.colors import ListedColormap

    base, verdict = found.datasets[found.baseline], _flips(found, choice).values
    change = found.differences("peak_ratio").sel(restitution=choice)
    draw_map(axes, base, np.ones(verdict.shape, dtype=np.int64))
    axes.set_facecolor(_BOTH)
    axes.collections[-1].set_visible(False)
    y, x = (base[name].values for name in change.dims)
    stands = np.where(verdict == 0, change.values, np.nan)
    most = float(np.nanmax(np.abs(stands), initial=0.01))
    look: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    scale = axes.pcolormesh(x, y, stands, cmap=_COLORS, vmin=-most, vmax=most, **look)
    flipped = np.where(verdict == 0, np.nan, verdict)
    axes.pcolormesh(x, y, flipped, cmap=ListedColormap([LOST, "white", GAINED, UNKNOWN]), vmin=-1.5, vmax=2.5, **look)
    flips = found.flips_between(found.baseline, choice)
    words = f"{choice} less {found.baseline}, {flips.count:,} of {flips.compared:,} verdicts flip"
    axes.set_title(f"c  {plain(words)}", loc="left", fontsize=7)
    return scale


def _legend(figure: "Figure", kinds: dict[str, Any], verdict: "xr.DataArray") -> None:
    from matplotlib.patches import Patch

    present = sorted({kind for each in kinds.values() for kind in np.unique(each).tolist()})
    patch: dict[str, Any] = {"edgecolor": INK, "linewidth": 0.5}
    handles = [Patch(facecolor=CLASSES[kind][1], label=CLASSES[kind][0], **patch) for kind in present]
    told = ((1, GAINED, "overturns with the choice only"), (-1, LOST, "overturns with the baseline only"))
    handles += [Patch(facecolor=color, label=words, **patch) for sign, color, words in told if (verdict == sign).any()]
    handles.append(Patch(facecolor=_BOTH, label="overturns with both (c)", **patch))
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=6.5, handlelength=1.2)
