"""Equilibria of a body: stable poses, saddles and summits, and the passes between stable poses."""

from rocking.bodies.equilibria._equilibria import Equilibria, equilibria
from rocking.bodies.equilibria.base_tolerance import TOLERANCES, BaseTolerance, base_tolerances
from rocking.bodies.equilibria.poses import Equilibrium, Pass, Ring, StablePose

__all__ = [
    "TOLERANCES",
    "BaseTolerance",
    "Equilibria",
    "Equilibrium",
    "Pass",
    "Ring",
    "StablePose",
    "base_tolerances",
    "equilibria",
]
