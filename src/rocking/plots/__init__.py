"""Pictures: the paper's figures, bodies, models against measurements, motions, responses, animations, studies."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.plots._body_picture import body_picture, coefficient_picture
    from rocking.plots._figure_1 import figure_1
    from rocking.plots._figure_2 import figure_2
    from rocking.plots._hero import hero
    from rocking.plots.animation import animate_gif, animate_html
    from rocking.plots.cloud import cloud_picture
    from rocking.plots.crossings import crossings_picture
    from rocking.plots.crossings_of_many import crossings_of_many_picture
    from rocking.plots.difference_map import difference_map_picture
    from rocking.plots.falling import falling_picture
    from rocking.plots.fragility import fragility_picture
    from rocking.plots.ground_motion import ground_motion_picture
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

__getattr__, __dir__ = exports(
    __name__,
    {
        "animate_gif": "rocking.plots.animation",
        "animate_html": "rocking.plots.animation",
        "body_picture": "rocking.plots._body_picture",
        "calibration_figure": "rocking.plots.overview",
        "cloud_picture": "rocking.plots.cloud",
        "coefficient_picture": "rocking.plots._body_picture",
        "crossings_of_many_picture": "rocking.plots.crossings_of_many",
        "crossings_picture": "rocking.plots.crossings",
        "difference_map_picture": "rocking.plots.difference_map",
        "energy_picture": "rocking.plots.solid",
        "falling_picture": "rocking.plots.falling",
        "figure_1": "rocking.plots._figure_1",
        "figure_2": "rocking.plots._figure_2",
        "figure_3": "rocking.plots.paper_figures",
        "figure_5": "rocking.plots.paper_figures",
        "figure_6": "rocking.plots.paper_figures",
        "figure_7": "rocking.plots.paper_figures",
        "figure_8": "rocking.plots.paper_figures",
        "figure_9": "rocking.plots.paper_figures",
        "fragility_picture": "rocking.plots.fragility",
        "ground_motion_picture": "rocking.plots.ground_motion",
        "hero": "rocking.plots._hero",
        "incremental_picture": "rocking.plots.incremental",
        "inventory_picture": "rocking.plots.inventory",
        "league_figure": "rocking.plots.overview",
        "measures_picture": "rocking.plots.measures",
        "models_and_measurements": "rocking.plots.overview",
        "overturning_map_picture": "rocking.plots.overturning_map",
        "record_set_picture": "rocking.plots.record_set",
        "refined_map_picture": "rocking.plots.refined_map",
        "regime_map_picture": "rocking.plots.regimes",
        "regimes_picture": "rocking.plots.regimes",
        "response_picture": "rocking.plots.response",
        "rocking_spectrum_picture": "rocking.plots.rocking_spectrum",
        "save": "rocking.plots.style",
        "sensitivity_picture": "rocking.plots.sensitivity",
        "slices_picture": "rocking.plots.solid",
        "solid_picture": "rocking.plots.solid",
        "spatial_picture": "rocking.plots.spatial",
        "write": "rocking.plots.style",
    },
)
