"""Every figure of the report, by the name of its file."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from rocking.evidence._league import LeagueRow
from rocking.evidence.calibration import Calibration
from rocking.evidence.explanation import explanation
from rocking.plots._figure_1 import figure_1
from rocking.plots._figure_2 import figure_2
from rocking.plots.laboratory import bed_dependence_figure, explanations_figure, residuals_figure
from rocking.plots.overview import calibration_figure, league_figure, models_and_measurements
from rocking.plots.paper_figures import figure_3, figure_5, figure_6, figure_7, figure_8, figure_9

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Draw = Callable[[Sequence[LeagueRow], Calibration], "Figure"]


def _alone(draw: Callable[[], "Figure"]) -> Draw:
    return lambda league, fit: draw()


def paper_figures() -> dict[str, Draw]:
    """Return the figures of the report.

    Returns file name to the function that draws it from the league and the calibration.
    """
    plain: dict[str, Callable[[], Figure]] = {
        "figure_1": figure_1,
        "figure_2": figure_2,
        "figure_3": figure_3,
        "figure_5": figure_5,
        "figure_6": figure_6,
        "figure_7": figure_7,
        "figure_8": figure_8,
        "figure_9": figure_9,
    }
    drawn: dict[str, Draw] = {name: _alone(draw) for name, draw in plain.items()}
    return {
        **drawn,
        "league": lambda league, fit: league_figure(league),
        "models_and_measurements": lambda league, fit: models_and_measurements(fit),
        "calibration": lambda league, fit: calibration_figure(fit),
        "bed_dependence": lambda league, fit: bed_dependence_figure(),
        "explanations": lambda league, fit: explanations_figure(explanation()),
        "explanation_residuals": lambda league, fit: residuals_figure(explanation()),
    }
