"""Sampled quantities of an object, per motion: its coefficient of restitution and approximate sizes."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot, IntArray
from rocking.decision.inventory.objects import LENGTHS, SMALLEST, InventoryObject
from rocking.restitution import ImpactGeometry
from rocking.restitution.calibrated import drawn
from rocking.studies.sensitivity.restitutions import uniforms

STRATA = 5
"""Number of sampled bodies of an object with approximate sizes: a Latin hypercube, assigned to motions in turn."""

_ROUND = {"depth": "width", "base_depth": "base_width"}
_HIGHEST = 0.99  # largest height of a sampled centre of mass / height of the body


class Draws:
    """Random numbers that depend only on the seed, the motion and the name of the size."""

    def __init__(self, count: int, seed: int) -> None:
        self.count, self.seed = count, seed

    def bodies(self, item: InventoryObject) -> list[InventoryObject]:
        """Return the sampled variants of an object, or the object itself if its sizes are exact."""
        levels = {name: self._level(item, name) for name in LENGTHS if item.approximate.get(name, 0.0) > 0.0}
        shifts = [{name: 2.0 * values[k] - 1.0 for name, values in levels.items()} for k in range(STRATA)]
        return [_resized(item, shift) for shift in shifts] if levels else [item]

    def number(self, bodies: int) -> IntArray:
        """Return the index of the sampled body for each motion."""
        return np.arange(self.count) % bodies

    def restitution(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the coefficient of each motion, for one impact or one impact per motion [-]."""
        return drawn(geometry, *self._levels)

    @cached_property
    def _levels(self) -> tuple[FloatArray, FloatArray]:
        component, level = (uniforms(self.seed, np.arange(self.count), k) for k in (0, 1))
        return component, level

    def _level(self, item: InventoryObject, name: str) -> FloatArray:
        """Return the probabilities of a size, one per stratum in random order; equal for both sizes of a circle."""
        own = _ROUND.get(name, name) if item.shape == "round" and item.width == item.depth else name
        stream = 2 + 2 * LENGTHS.index(own)
        order, within = (uniforms(self.seed, np.arange(STRATA), stream + k) for k in (0, 1))
        return np.asarray((np.argsort(order) + within) / STRATA)


def slenderest(item: InventoryObject) -> InventoryObject:
    """Return the variant of an object with the smallest uplift acceleration within its approximate sizes."""
    higher = {name: 1.0 if name in {"height", "centre_of_mass_height"} else -1.0 for name in item.approximate}
    return _resized(item, higher) if higher else item


def impacts(bodies: Sequence[Body], foot: Foot, number: IntArray) -> ImpactGeometry:
    """Return the impacts onto a foot for the body of each motion."""
    geometries = [ImpactGeometry.of_body(body, foot) for body in bodies]
    return ImpactGeometry(
        *(np.array([getattr(geometry, name) for geometry in geometries])[number] for name in ImpactGeometry.__slots__)
    )


def restitutions(draws: Draws, bodies: Sequence[Body]) -> dict[Foot, FloatArray]:
    """Return the coefficients onto both feet for each motion, at equal probabilities [-]."""
    number = draws.number(len(bodies))
    return {foot: draws.restitution(impacts(bodies, foot, number)) for foot in FEET}


def _resized(item: InventoryObject, fractions: dict[str, float]) -> InventoryObject:
    """Return an object with sizes shifted by fractions of their half widths; inner sizes stay below outer sizes."""
    sizes: dict[str, Any] = {
        name: max(SMALLEST, getattr(item, name) + fractions.get(name, 0.0) * item.approximate.get(name, 0.0))
        for name in LENGTHS if getattr(item, name) is not None
    }  # fmt: skip
    limits = {"base_width": sizes["width"], "base_depth": sizes["depth"], LENGTHS[-1]: _HIGHEST * sizes["height"]}
    sizes |= {name: min(sizes[name], limit) for name, limit in limits.items() if name in sizes}
    # the weight is removed: it does not affect rocking, and may be impossible for the new sizes
    return replace(item, **sizes, mass=None, approximate={})
