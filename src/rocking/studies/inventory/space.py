"""An object in three dimensions: its histories on the vertices of its hull, and what would help it."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from rocking.bodies import Solid
from rocking.conventions import FloatArray, IntArray, g
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import sides_of
from rocking.motions.components import components_of
from rocking.studies.histories import Product, results_of
from rocking.studies.inventory.draws import Draws, slenderest
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.objects import InventoryObject
from rocking.studies.motion_sets import MotionList
from rocking.studies.remedies import parts_of


class SpatialObject:
    """An object that slides, rocks and falls, shaken along its width and along its depth; one body for each motion."""

    def __init__(
        self, item: InventoryObject, hazard: Hazard, draws: Draws, gravity: float, friction: float | None,
        threads: int | None,
    ) -> None:  # fmt: skip
        self.item, self.hazard, self.gravity, self.threads = item, hazard, gravity, threads
        self.bodies = [each.as_solid() for each in draws.bodies(item)]
        self.number = draws.number(len(self.bodies))
        self.settings = study_settings(self.bodies[0], {"friction": friction}, gravity)
        self.friction = self.settings.friction
        self._first = slenderest(item).as_solid()  # of approximate sizes, those that lift first

    def results(self, restitution: Any, which: IntArray, scale: float) -> tuple[np.ndarray, FloatArray]:
        """Return outcomes, and peak rotations over the slenderness angle, of some motions and both directions."""
        outcome, ratio = np.zeros((len(which), 2), np.int64), np.zeros((len(which), 2))
        for own, rows in self.histories(restitution, which, scale):
            found = results_of(rows, threads=self.threads)
            outcome[own] = found["outcome"].reshape(-1, 2)
            ratio[own] = np.abs(found["peak_rotation"]).reshape(-1, 2) / rows.sides["alpha_right"].item()
        return outcome, ratio

    def histories(self, restitution: Any, which: IntArray, scale: float = 1.0) -> Iterator[tuple[IntArray, Product]]:
        """Yield the histories of each body, over motion and direction, and which of the motions are its own."""
        word = getattr(restitution, "name", restitution)
        for k, body in enumerate(self.bodies):
            own = np.flatnonzero(self.number[which] == k)
            if not own.size:
                continue
            motions = MotionList([turned for one in which[own] for turned in self.turned(int(one))])
            parameters = mechanics_of(self.settings).parameters(body, word, self.settings)
            law: Any = parameters.law
            _ = law.on_hull  # what it cannot be for this body is said here, before anything is computed
            sides = {name: values[None] for name, values in sides_of([parameters]).items()}
            yield own, Product(motions, sides, np.array([scale]), law=law, settings=self.settings)

    def turned(self, which: int) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
        """Return a motion along the width, and a quarter turn from there along the depth."""
        x, _, up = components_of(self.hazard.motions[which])
        y = self.hazard.across[which] if self.hazard.across else None
        return (x, y, up), (None if y is None else y.scaled(-1.0), x, up)

    def moves(self) -> list[float]:
        """Return which steady acceleration along x, and along y, lifts it over either side, or makes it slide."""
        return [min(self.friction * self.gravity, *pair) for pair in _uplift(self._first, self.gravity).tolist()]

    def pull(self) -> float:
        """Return the force over the weight that anchors along one edge must hold, the other being the pivot [-]."""
        height = float(self._first.centre[2]) - self._first.ground
        most = 0.0
        for levers in _uplift(self._first, self.gravity) / self.gravity * height:
            for motion in self.hazard.motions:
                across, up = parts_of(motion)
                moment = across * height - (self.gravity + up) * levers.min()
                most = max(most, float(moment.max()) / (self.gravity * levers.sum()))  # Eq. 313
        return most


def _uplift(body: Solid, gravity: float) -> FloatArray:
    """Return which steady acceleration lifts a body over either side, along x and along y [m/s2]."""
    pose = body.equilibria().settling([0.0, 0.0, -1.0])
    lifts = pose.uplift_acceleration(0.5 * np.pi * np.arange(4.0)) * gravity / g
    return np.asarray(lifts).reshape(2, 2).T
