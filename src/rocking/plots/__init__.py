"""Pictures: the paper's figures, bodies, models against measurements, motions, responses, animations, studies."""

from rocking.plots.animation import animate_gif, animate_html
from rocking.plots.body_picture import body_picture, coefficient_picture
from rocking.plots.cloud import cloud_picture
from rocking.plots.crossings import crossings_picture
from rocking.plots.crossings_of_many import crossings_of_many_picture
from rocking.plots.difference_map import difference_map_picture
from rocking.plots.falling import falling_picture
from rocking.plots.figure_1 import figure_1
from rocking.plots.figure_2 import figure_2
from rocking.plots.fragility import fragility_picture
from rocking.plots.ground_motion import ground_motion_picture
from rocking.plots.hero import hero
from rocking.plots.incremental import incremental_picture
from rocking.plots.inventory import inventory_picture
from rocking.plots.measures import measures_picture
from rocking.plots.overturning_map import overturning_map_picture
from rocking.plots.overview import calibration_figure, league_figure, models_and_measurements
from rocking.plots.paper_figures import figure_3, figure_5, figure_6, figure_7, figure_8, figure_9
from rocking.plots.record_set import record_set_picture
from rocking.plots.refined_map import refined_map_picture
from rocking.plots.regimes import regime_map_picture, regimes_picture
from rocking.plots.response import response_picture
from rocking.plots.rocking_spectrum import rocking_spectrum_picture
from rocking.plots.sensitivity import sensitivity_picture
from rocking.plots.solid import energy_picture, slices_picture, solid_picture
from rocking.plots.spatial import spatial_picture
from rocking.plots.style import save, write

__all__ = [
    "animate_gif",
    "animate_html",
    "body_picture",
    "calibration_figure",
    "cloud_picture",
    "coefficient_picture",
    "crossings_of_many_picture",
    "crossings_picture",
    "difference_map_picture",
    "energy_picture",
    "falling_picture",
    "figure_1",
    "figure_2",
    "figure_3",
    "figure_5",
    "figure_6",
    "figure_7",
    "figure_8",
    "figure_9",
    "fragility_picture",
    "ground_motion_picture",
    "hero",
    "incremental_picture",
    "inventory_picture",
    "league_figure",
    "measures_picture",
    "models_and_measurements",
    "overturning_map_picture",
    "record_set_picture",
    "refined_map_picture",
    "regime_map_picture",
    "regimes_picture",
    "response_picture",
    "rocking_spectrum_picture",
    "save",
    "sensitivity_picture",
    "slices_picture",
    "solid_picture",
    "spatial_picture",
    "write",
]
