"""The picture of the README: where an impact takes the energy, and what was measured."""

from typing import TYPE_CHECKING

from rocking.bodies import Section
from rocking.bodies.region import Region
from rocking.plots._figure_2 import figure_2

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def hero() -> "Figure":
    """Draw the three stages of KED on a figure standing on a pedestal.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels.
    """
    pedestal = Region([(0.0, 0.0), (1.0, 0.0), (1.0, 0.7), (0.0, 0.7)], density=2700.0)
    figure = Region(
        [(0.2, 0.7), (0.8, 0.7), (0.72, 1.5), (0.78, 2.0), (0.58, 2.3), (0.42, 2.3), (0.22, 2.0), (0.28, 1.5)],
        density=2300.0,
    )
    return figure_2(Section([pedestal, figure]), angular_velocity=1.0)
