"""What is not known of an object, drawn anew for every motion: its coefficient of restitution and approximate sizes."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot, IntArray
from rocking.restitution import ImpactGeometry
from rocking.restitution.calibrated import drawn
from rocking.studies.inventory.objects import LENGTHS, SMALLEST, InventoryObject
from rocking.studies.sensitivity.restitutions import uniforms

STRATA = 5
"""Bodies standing for an object of approximate sizes: a Latin hypercube, which the motions take one after another."""

_ROUND = {"depth": "width", "base_depth": "base_width"}
_HIGHEST = 0.99  # of the height, for a centre of mass that is drawn


class Draws:
    """Numbers that hang on the seed, the motion and the name of the size alone: on no other object, thread or order."""

    def __init__(self, count: int, seed: int) -> None:
        self.count, self.seed = count, seed

    def bodies(self, item: InventoryObject) -> list[InventoryObject]:
        """Return the objects that stand for one; itself if its sizes are known."""
        levels = {name: self._level(item, name) for name in LENGTHS if item.approximate.get(name, 0.0) > 0.0}
        every = [{name: 2.0 * each[k] - 1.0 for name, each in levels.items()} for k in range(STRATA)]
        return [_resized(item, shares) for shares in every] if levels else [item]

    def number(self, bodies: int) -> IntArray:
        """Return which of so many bodies each motion has."""
        return np.arange(self.count) % bodies

    def restitution(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the coefficient under each motion, of one impact or one for each of them [-]."""
        return drawn(geometry, *self._levels)

    @cached_property
    def _levels(self) -> tuple[FloatArray, FloatArray]:
        which, level = (uniforms(self.seed, np.arange(self.count), k) for k in (0, 1))
        return which, level

    def _level(self, item: InventoryObject, name: str) -> FloatArray:
        """Return the probabilities of a size: one in each stratum, in an order of its own; a circle has one."""
        own = _ROUND.get(name, name) if item.shape == "round" and item.width == item.depth else name
        place = 2 + 2 * LENGTHS.index(own)
        order, within = (uniforms(self.seed, np.arange(STRATA), place + k) for k in (0, 1))
        return np.asarray((np.argsort(order) + within) / STRATA)


def slenderest(item: InventoryObject) -> InventoryObject:
    """Return the object with those of its approximate sizes at which it lifts first."""
    higher = {name: 1.0 if name in {"height", "centre_of_mass_height"} else -1.0 for name in item.approximate}
    return _resized(item, higher) if higher else item


def impacts(bodies: Sequence[Body], foot: Foot, number: IntArray) -> ImpactGeometry:
    """Return the impacts onto a foot of those bodies that each motion has."""
    each = [ImpactGeometry.of_body(body, foot) for body in bodies]
    return ImpactGeometry(
        *(np.array([getattr(one, name) for one in each])[number] for name in ImpactGeometry.__slots__)
    )


def restitutions(draws: Draws, bodies: Sequence[Body]) -> dict[Foot, FloatArray]:
    """Return the coefficients onto both feet under each motion, at the same probabilities [-]."""
    number = draws.number(len(bodies))
    return {foot: draws.restitution(impacts(bodies, foot, number)) for foot in FEET}


def _resized(item: InventoryObject, shares: dict[str, float]) -> InventoryObject:
    """Return an object whose sizes are moved by shares of their half widths, with what must stay smaller, smaller."""
    made: dict[str, Any] = {
        name: max(SMALLEST, getattr(item, name) + shares.get(name, 0.0) * item.approximate.get(name, 0.0))
        for name in LENGTHS if getattr(item, name) is not None
    }  # fmt: skip
    most = {"base_width": made["width"], "base_depth": made["depth"], LENGTHS[-1]: _HIGHEST * made["height"]}
    made |= {name: min(made[name], limit) for name, limit in most.items() if name in made}
    # the weight does not change how it rocks, and need not fit every size
    return replace(item, **made, mass=None, approximate={})
