"""Rocking of a plane body with tendons, dampers, fuses, springs and walls."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from rocking.bodies.restrained import Restrained, without_walls
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.mechanics_base import Combinations, RockingMechanics
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.restrained.settings import RestrainedSettings, RestrainedStudySettings
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError


class RestrainedRocking(RockingMechanics):
    """Rocking of a plane body with restraints."""

    name, title, subject = "restrained", "rocking with restraints", "a body with restraints"
    settings = RestrainedSettings
    options = frozenset({"engine", "stream"})
    batch_options = frozenset({"start", "rotation", "angular_velocity", "duration", "engine", "threads", "progress"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Restrained)

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

    def study_settings(self, body: Any, options: Mapping[str, Any]) -> Settings:
        without_walls(body)
        settings, _ = self.split(options, RestrainedSettings, frozenset())
        return RestrainedStudySettings(**settings.stated, body=body)

    def parameters(self, body: Any, restitution: Any, settings: Any) -> RockingParameters:
        if body is not settings.body and settings != replace(settings, body=body):
            raise InvalidValueError("a study accepts one body with restraints, got several")
        from rocking.dynamics.restrained.devices import parameters_of

        return parameters_of(body, restitution, settings.gravity)

    @property
    def study_columns(self) -> Mapping[str, Any]:
        from rocking.dynamics.restrained.rows import COLUMNS

        return COLUMNS

    def uplift_accelerations(self, settings: Any, sides: Mapping[str, FloatArray], tangent: Any = None) -> FloatArray:
        from rocking.dynamics.restrained.rows import uplift_accelerations

        return uplift_accelerations(settings, len(sides["alpha_right"]))

    def rows(self, motions: Sequence[Any], law: ImpactLaw, settings: RestrainedStudySettings, engine: str) -> Any:
        from rocking.dynamics.restrained.rows import RowsWithRestraints

        return RowsWithRestraints(motions, law, settings, engine)

    def engine_of_study(self, *, fast: bool) -> str:
        from rocking.dynamics.restrained.engines import FAST

        return FAST if fast else "reference"
