"""Sets of motions beside one another: their peaks, and the response spectra of the middle and of the spread."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions import peak_ground_acceleration, peak_ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import response_spectrum
from rocking.plots.study_words import look, plain, plain_log
from rocking.plots.style import DOUBLE, in_journal_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 2.9
PERIODS = np.geomspace(0.05, 4.0, 60)
"""Periods of the spectra, unless others are given [s]."""

_MARKS = "osv^D<"


@in_journal_style
def record_set_picture(sets: Mapping[str, Any], periods: Any = PERIODS) -> "Figure":
    """Draw sets of motions: peak velocity over peak acceleration, and their spectra.

    Left: a point a motion. Right: of each set the median of the pseudo-spectral acceleration with 5 % damping, and
    where the middle 68 % of the motions are.

    Parameters
    ----------
    sets : mapping of str to MotionSet or sequence of GroundMotion
        Up to six sets of at least two motions by what they are called.
    periods : array_like
        Periods of the spectra [s].

    Returns
    -------
    matplotlib.figure.Figure
        Two panels side by side, two columns wide.

    Raises
    ------
    InvalidValueError
        If there is no set, or one is not of at least two records.

    Examples
    --------
    >>> from rocking.studies import SyntheticSet
    >>> figure = record_set_picture({"far": SyntheticSet("point-source", 3, seed=1)}, [0.1, 0.5, 1.0])
    >>> figure.axes[1].get_xlabel()
    'period [s]'
    """
    from matplotlib.lines import Line2D

    if not 1 <= len(sets) <= len(_MARKS):
        raise InvalidValueError(f"sets must be 1 to {len(_MARKS)}, got {len(sets)}")
    places = checks.positive_array("periods", periods, "s")
    figure, (left, right) = new_figure(DOUBLE, HEIGHT, columns=2)
    for number, (name, motions) in enumerate(sets.items()):
        records = [motions[k] for k in range(len(motions))]
        if len(records) < 2 or not all(isinstance(each, GroundMotion) for each in records):
            raise InvalidValueError(f"set {name!r:.60} must have two ground motions or more, got {records!r:.60}")
        _peaks(left, records, number)
        _spectra(right, records, places, number)
    left.set_xlabel("peak ground acceleration [m/s$^2$]")
    left.set_ylabel("peak ground velocity [m/s]")
    right.set_xlabel("period [s]")
    right.set_ylabel("spectral acceleration, 5 % [m/s$^2$]")
    for panel in (left, right):
        for which in "xy":
            plain_log(panel, which)
    handles = [
        Line2D([], [], marker=_MARKS[number], markersize=3.0, label=f"{plain(name)}: {len(sets[name])}", **look(number))
        for number, name in enumerate(sets)
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=7, handlelength=3.6)
    return figure


def _peaks(axes: "Axes", records: list[GroundMotion], number: int) -> None:
    pga = [peak_ground_acceleration(each) for each in records]
    pgv = [peak_ground_velocity(each) for each in records]
    color = look(number)["color"]
    axes.plot(
        pga,
        pgv,
        linestyle="none",
        marker=_MARKS[number],
        color=color,
        markersize=3.0,
        alpha=0.7,
        markeredgewidth=0,
    )


def _spectra(axes: "Axes", records: list[GroundMotion], periods: FloatArray, number: int) -> None:
    found = np.array([response_spectrum(each, periods).pseudo_acceleration for each in records])
    low, middle, high = np.quantile(found, [0.16, 0.5, 0.84], axis=0)
    axes.fill_between(periods, low, high, color=look(number)["color"], alpha=0.15, linewidth=0)
    axes.plot(periods, middle, linewidth=1.2, **look(number))
