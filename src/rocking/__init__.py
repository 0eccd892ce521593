"""Predict what an impact costs a rocking body, how it rocks in an earthquake, and whether it overturns."""

from typing import TYPE_CHECKING

from rocking.lazy import exports, presenters
from rocking.version import __version__ as __version__

if TYPE_CHECKING:
    from rocking import bodies, dynamics, errors, evidence, examples, motions, plots, restitution
    from rocking.assessment import assess
    from rocking.bodies import Block, MassPoints, Region, Section, Solid
    from rocking.bodies.formats import read_body
    from rocking.dynamics import Response, free_rocking, simulate, simulate_many
    from rocking.identification import identify
    from rocking.motions import GroundMotion, pulses, synthetic
    from rocking.motions.formats import read_motion
    from rocking.outcome import Outcome
    from rocking.prediction import predict
    from rocking.restitution import coefficient_of_restitution
    from rocking.studies._overturning_map import overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum
    from rocking.studies.fragility import fragility
    from rocking.studies.inventory import inventory
    from rocking.studies.minimum_acceleration import minimum_overturning_acceleration

__all__ = [
    "Block",
    "GroundMotion",
    "MassPoints",
    "Outcome",
    "Region",
    "Response",
    "Section",
    "Solid",
    "assess",
    "bodies",
    "coefficient_of_restitution",
    "dynamics",
    "errors",
    "evidence",
    "examples",
    "fragility",
    "free_rocking",
    "identify",
    "inventory",
    "minimum_overturning_acceleration",
    "motions",
    "overturning_map",
    "plots",
    "predict",
    "pulses",
    "read_body",
    "read_motion",
    "restitution",
    "rocking_spectrum",
    "simulate",
    "simulate_many",
    "synthetic",
]

_HOMES = {
    "assessment": ("assess",),
    "bodies": ("Block", "MassPoints", "Region", "Section", "Solid", "bodies"),
    "bodies.formats": ("read_body",),
    "dynamics": ("Response", "dynamics", "free_rocking", "simulate", "simulate_many"),
    "errors": ("errors",),
    "evidence": ("evidence",),
    "examples": ("examples",),
    "identification": ("identify",),
    "motions": ("GroundMotion", "motions", "pulses", "synthetic"),
    "motions.formats": ("read_motion",),
    "outcome": ("Outcome",),
    "plots": ("plots",),
    "prediction": ("predict",),
    "restitution": ("coefficient_of_restitution", "restitution"),
    "studies": ("minimum_overturning_acceleration", "overturning_map", "rocking_spectrum"),
    "studies.fragility": ("fragility",),
    "studies.inventory": ("inventory",),
}

__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)

presenters.update({
    "picture of Response": "rocking.plots:response_picture",
    "picture of ContactResponse": "rocking.plots:regimes_picture",
    "picture of HullResponse": "rocking.plots:spatial_picture",
    "picture of SpatialResponse": "rocking.plots:spatial_picture",
    "picture of Identification": "rocking.plots:identification_picture",
    "report of Identification": "rocking.reports:identification_report",
    "writer of pictures": "rocking.plots:write",
    "animation as .html": "rocking.plots:animate_html",
    "animation as .gif": "rocking.plots:animate_gif",
    "report": "rocking.reports:response_report",
    "recommendation": "rocking.evidence.recommending:recommendation_for",
})  # fmt: skip
