"""Pictures: bodies, models against measurements, motions, responses, animations, studies, the paper's figures."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.plots.animation import animate_gif, animate_html
    from rocking.plots.body import body_picture, coefficient_picture
    from rocking.plots.cloud import cloud_picture, measures_picture
    from rocking.plots.comparison import animate_comparison
    from rocking.plots.energy_stages import energy_stages_picture
    from rocking.plots.falling import falling_picture
    from rocking.plots.fragility import fragility_picture, incremental_dynamic_analysis_picture
    from rocking.plots.ground_motion import (
        ground_motion_picture,
        processing_picture,
        record_set_picture,
        selection_picture,
        spectra_picture,
    )
    from rocking.plots.identification import identification_picture
    from rocking.plots.inventory import inventory_picture
    from rocking.plots.overturning_map import overturning_map_picture, refined_map_picture
    from rocking.plots.paper_figures import paper_figure
    from rocking.plots.prediction import assessment_picture, prediction_picture, reliability_picture
    from rocking.plots.regimes import regime_map_picture, regimes_picture
    from rocking.plots.response import response_picture
    from rocking.plots.rocking_spectrum import rocking_spectrum_picture
    from rocking.plots.sensitivity import difference_map_picture, sensitivity_picture
    from rocking.plots.solid import energy_picture, equilibria_picture, slices_picture, solid_picture
    from rocking.plots.spatial import spatial_picture
    from rocking.plots.style import journal_style, new_figure, write
    from rocking.plots.transitions import transitions_of_many_picture, transitions_picture

__all__ = [
    "animate_comparison",
    "animate_gif",
    "animate_html",
    "assessment_picture",
    "body_picture",
    "cloud_picture",
    "coefficient_picture",
    "difference_map_picture",
    "energy_picture",
    "energy_stages_picture",
    "equilibria_picture",
    "falling_picture",
    "fragility_picture",
    "ground_motion_picture",
    "identification_picture",
    "incremental_dynamic_analysis_picture",
    "inventory_picture",
    "journal_style",
    "measures_picture",
    "new_figure",
    "overturning_map_picture",
    "paper_figure",
    "prediction_picture",
    "processing_picture",
    "record_set_picture",
    "refined_map_picture",
    "regime_map_picture",
    "regimes_picture",
    "reliability_picture",
    "response_picture",
    "rocking_spectrum_picture",
    "selection_picture",
    "sensitivity_picture",
    "slices_picture",
    "solid_picture",
    "spatial_picture",
    "spectra_picture",
    "transitions_of_many_picture",
    "transitions_picture",
    "write",
]

_OTHERS = {
    "animate_comparison": "comparison",
    "animate_gif": "animation",
    "animate_html": "animation",
    "assessment_picture": "prediction",
    "coefficient_picture": "body",
    "difference_map_picture": "sensitivity",
    "energy_picture": "solid",
    "equilibria_picture": "solid",
    "incremental_dynamic_analysis_picture": "fragility",
    "journal_style": "style",
    "measures_picture": "cloud",
    "new_figure": "style",
    "paper_figure": "paper_figures",
    "prediction_picture": "prediction",
    "processing_picture": "ground_motion",
    "record_set_picture": "ground_motion",
    "refined_map_picture": "overturning_map",
    "reliability_picture": "prediction",
    "regime_map_picture": "regimes",
    "selection_picture": "ground_motion",
    "slices_picture": "solid",
    "spectra_picture": "ground_motion",
    "transitions_of_many_picture": "transitions",
    "write": "style",
}
"""Where what is not of the file of its name stands."""

__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{_OTHERS.get(name, name.removesuffix('_picture'))}" for name in __all__}
)
