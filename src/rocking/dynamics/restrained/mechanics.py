"""Rocking of a plane body with tendons, dampers, fuses and springs."""

from typing import Any

from rocking.bodies.restrained import Restrained
from rocking.dynamics.mechanics_base import Combinations, PlaneMechanics
from rocking.dynamics.restrained.settings import RestrainedSettings


class RestrainedRocking(PlaneMechanics):
    """Rocking of a plane body with restraints."""

    name, title, subject = "restrained", "rocking with restraints", "a body with restraints"
    settings = RestrainedSettings
    options = frozenset({"engine", "stream"})
    batch_options = frozenset({"start", "rotation", "angular_velocity", "duration", "engine", "threads", "progress"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Restrained)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        return rotation, angular_velocity  # their limits depend on the body and are checked later

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        from rocking.dynamics.plane_frictional.base import rocking_start

        begun = super().begun(start, rotation, angular_velocity)
        return begun if start is None else rocking_start(begun)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: RestrainedSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.restrained.response import response_with_restraints

        return response_with_restraints(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        from rocking.dynamics.restrained.many import COLUMNS

        return COLUMNS

    def follow_many(self, combinations: Combinations, settings: RestrainedSettings) -> Any:
        from rocking.dynamics.restrained.many import many_with_restraints

        return many_with_restraints(combinations, settings)
