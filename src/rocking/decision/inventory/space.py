"""An object in three dimensions: its histories, and the anchor forces against uplift."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from rocking.bodies import Solid
from rocking.conventions import FloatArray, IntArray, g
from rocking.decision.inventory.draws import Draws, slenderest
from rocking.decision.inventory.hazard import Hazard
from rocking.decision.inventory.objects import InventoryObject
from rocking.decision.remedies import accelerations_of
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import sides_of
from rocking.motions.components import components_of
from rocking.studies.histories import Product, results_of
from rocking.studies.motion_sets import MotionList


class SpatialObject:
    """An object that slides, rocks and overturns under motions along its width and depth, with one body per motion."""

    def __init__(
        self, item: InventoryObject, hazard: Hazard, draws: Draws, gravity: float, friction: float | None,
        threads: int | None,
    ) -> None:  # fmt: skip
        self.item, self.hazard, self.gravity, self.threads = item, hazard, gravity, threads
        self.bodies = [variant.as_solid() for variant in draws.bodies(item)]
        self.number = draws.number(len(self.bodies))
        self.settings = study_settings(self.bodies[0], {"friction": friction}, gravity)
        self.friction = self.settings.friction
        self._first = slenderest(item).as_solid()  # variant with the smallest uplift acceleration

    def results(self, restitution: Any, motions: IntArray, scale: float) -> tuple[np.ndarray, FloatArray]:
        """Return outcomes, and peak rotations / slenderness angle, of selected motions in both directions."""
        outcome, ratio = np.zeros((len(motions), 2), np.int64), np.zeros((len(motions), 2))
        for own, rows in self.histories(restitution, motions, scale):
            arrays = results_of(rows, threads=self.threads)
            outcome[own] = arrays["outcome"].reshape(-1, 2)
            ratio[own] = np.abs(arrays["peak_rotation"]).reshape(-1, 2) / rows.sides["alpha_right"].item()
        return outcome, ratio

    def histories(self, restitution: Any, indices: IntArray, scale: float = 1.0) -> Iterator[tuple[IntArray, Product]]:
        """Yield the histories of each body, over motion and direction, with the indices of its motions."""
        model = getattr(restitution, "name", restitution)
        for k, body in enumerate(self.bodies):
            own = np.flatnonzero(self.number[indices] == k)
            if not own.size:
                continue
            motions = MotionList([turned for index in indices[own] for turned in self.turned(int(index))])
            parameters = mechanics_of(self.settings).parameters(body, model, self.settings)
            law: Any = parameters.law
            _ = law.on_hull  # raises an error for an unsuitable body before the computation
            sides = {name: values[None] for name, values in sides_of([parameters]).items()}
            yield own, Product(motions, sides, np.array([scale]), law=law, settings=self.settings)

    def turned(self, index: int) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
        """Return a motion along the width, and the same motion along the depth (rotated by 90 degrees)."""
        x, _, up = components_of(self.hazard.motions[index])
        y = self.hazard.across[index] if self.hazard.across else None
        return (x, y, up), (None if y is None else y.scaled(-1.0), x, up)

    def moves(self) -> list[float]:
        """Return the smallest steady accelerations along x and y with uplift or sliding [m/s2]."""
        return [min(self.friction * self.gravity, *pair) for pair in _uplift(self._first, self.gravity).tolist()]

    def pull(self) -> float:
        """Return the ratio of the anchor force along one edge to the weight; the other edge is the pivot [-]."""
        height = float(self._first.centre[2]) - self._first.ground
        max_force = 0.0
        for levers in _uplift(self._first, self.gravity) / self.gravity * height:
            for motion in self.hazard.motions:
                across, up = accelerations_of(motion)
                moment = across * height - (self.gravity + up) * levers.min()
                max_force = max(max_force, float(moment.max()) / (self.gravity * levers.sum()))  # Eq. 313
        return max_force


def _uplift(body: Solid, gravity: float) -> FloatArray:
    """Return the steady accelerations that lift a body over either side, along x and along y [m/s2]."""
    pose = body.equilibria().settling([0.0, 0.0, -1.0])
    accelerations = pose.uplift_acceleration(0.5 * np.pi * np.arange(4.0)) * gravity / g
    return np.asarray(accelerations).reshape(2, 2).T
