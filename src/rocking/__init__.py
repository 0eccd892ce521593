"""Predict what an impact costs a rocking body, how it rocks in an earthquake, and whether it overturns."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.version import __version__ as __version__

if TYPE_CHECKING:
    from rocking import bodies as bodies
    from rocking import dynamics as dynamics
    from rocking import errors as errors
    from rocking import evidence as evidence
    from rocking import examples as examples
    from rocking import motions as motions
    from rocking import plots as plots
    from rocking import restitution as restitution
    from rocking.assessment import assess as assess
    from rocking.bodies import Block as Block
    from rocking.bodies import MassPoints as MassPoints
    from rocking.bodies import Region as Region
    from rocking.bodies import Section as Section
    from rocking.bodies import Solid as Solid
    from rocking.bodies.formats import read_body as read_body
    from rocking.dynamics import Response as Response
    from rocking.dynamics import free_rocking as free_rocking
    from rocking.dynamics import simulate as simulate
    from rocking.dynamics import simulate_many as simulate_many
    from rocking.identification import identify as identify
    from rocking.motions import GroundMotion as GroundMotion
    from rocking.motions import pulses as pulses
    from rocking.motions import synthetic as synthetic
    from rocking.motions.formats import read_motion as read_motion
    from rocking.outcome import Outcome as Outcome
    from rocking.prediction import predict as predict
    from rocking.restitution import coefficient_of_restitution as coefficient_of_restitution
    from rocking.studies._overturning_map import overturning_map as overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum as rocking_spectrum
    from rocking.studies.fragility import fragility as fragility
    from rocking.studies.inventory import inventory as inventory
    from rocking.studies.minimum_acceleration import (
        minimum_overturning_acceleration as minimum_overturning_acceleration,
    )
else:
    __all__, __getattr__, __dir__ = exports(__name__)
