"""Pictures: bodies, models against measurements, motions, responses, animations, studies, the paper's figures."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.plots.animation import animate_gif as animate_gif
    from rocking.plots.animation import animate_html as animate_html
    from rocking.plots.body import body_picture as body_picture
    from rocking.plots.body import coefficient_picture as coefficient_picture
    from rocking.plots.cloud import cloud_picture as cloud_picture
    from rocking.plots.cloud import measures_picture as measures_picture
    from rocking.plots.comparison import animate_comparison as animate_comparison
    from rocking.plots.energy_stages import energy_stages_picture as energy_stages_picture
    from rocking.plots.falling import falling_picture as falling_picture
    from rocking.plots.fragility import fragility_picture as fragility_picture
    from rocking.plots.fragility import incremental_dynamic_analysis_picture as incremental_dynamic_analysis_picture
    from rocking.plots.ground_motion import ground_motion_picture as ground_motion_picture
    from rocking.plots.ground_motion import processing_picture as processing_picture
    from rocking.plots.ground_motion import record_set_picture as record_set_picture
    from rocking.plots.ground_motion import selection_picture as selection_picture
    from rocking.plots.ground_motion import spectra_picture as spectra_picture
    from rocking.plots.identification import identification_picture as identification_picture
    from rocking.plots.inventory import inventory_distribution as inventory_distribution
    from rocking.plots.inventory import inventory_picture as inventory_picture
    from rocking.plots.overturning_map import overturning_map_picture as overturning_map_picture
    from rocking.plots.overturning_map import refined_map_picture as refined_map_picture
    from rocking.plots.paper_figures import paper_figure as paper_figure
    from rocking.plots.prediction import assessment_picture as assessment_picture
    from rocking.plots.prediction import prediction_picture as prediction_picture
    from rocking.plots.prediction import reliability_picture as reliability_picture
    from rocking.plots.regimes import regime_map_picture as regime_map_picture
    from rocking.plots.regimes import regimes_picture as regimes_picture
    from rocking.plots.response import response_picture as response_picture
    from rocking.plots.rocking_spectrum import rocking_spectrum_picture as rocking_spectrum_picture
    from rocking.plots.sensitivity import difference_map_picture as difference_map_picture
    from rocking.plots.sensitivity import sensitivity_picture as sensitivity_picture
    from rocking.plots.solid import energy_picture as energy_picture
    from rocking.plots.solid import equilibria_picture as equilibria_picture
    from rocking.plots.solid import slices_picture as slices_picture
    from rocking.plots.solid import solid_picture as solid_picture
    from rocking.plots.spatial import spatial_picture as spatial_picture
    from rocking.plots.style import journal_style as journal_style
    from rocking.plots.style import new_figure as new_figure
    from rocking.plots.style import write as write
    from rocking.plots.transitions import transitions_of_many_picture as transitions_of_many_picture
    from rocking.plots.transitions import transitions_picture as transitions_picture
else:
    __all__, __getattr__, __dir__ = exports(__name__)
