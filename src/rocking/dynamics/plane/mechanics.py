"""Pure rocking: a plane body turns about its feet and neither slides nor flies."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import errors
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.dynamics.mechanics_base import Combinations, RockingMechanics, Sample, in_space
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.errors import PureRockingWarning


class PlaneRocking(RockingMechanics):
    """Pure rocking of a plane body."""

    name, title, subject = "plane", "pure rocking", "a plane body without friction"
    settings, is_compared = PlaneSettings, True
    options = frozenset({"engine", "stream"})
    batch_options = frozenset({"start", "rotation", "angular_velocity", "engine", "threads", "twin", "progress"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return friction is None and not in_space(body)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: PlaneSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.response import response_of_rocking

        response = response_of_rocking(body, motion, restitution, settings, start=start, **options)
        for sentence in () if errors.silenced(PureRockingWarning) else response.doubts():
            errors.warn(sentence, PureRockingWarning)
        return response

    @property
    def columns(self) -> tuple[str, ...]:
        from rocking.dynamics.plane.fast_engine import RESULTS

        return (*RESULTS, "overturned", "lost_contact")

    def follow_many(self, combinations: Combinations, settings: PlaneSettings) -> Any:
        from rocking.dynamics.plane.many import rocking_alone

        return rocking_alone(combinations, settings)

    def rows(self, motions: Sequence[Any], law: ImpactLaw, settings: PlaneSettings, engine: str) -> Any:
        from rocking.dynamics.plane.batch import RowsInPlane

        return RowsInPlane(motions, law, settings, engine)

    def engine_of_study(self, *, fast: bool) -> str:
        return f"fast ({self.instruction_set()})" if fast else "reference"

    def instruction_set(self) -> str:
        from rocking.dynamics.plane import fast_engine

        return fast_engine.instruction_set()

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        quantiles = {"right": np.arange(33) / 256.0 + 0.8125, "left": np.arange(33) / 512.0 + 0.875}
        by_speed = SpeedRestitution(np.array([0.0, 1.0, 4.0]), np.array([1.0, 0.9375, 0.75]))
        return [
            (pulses, RandomRestitution(quantiles, 7), PlaneSettings(gravity=9.8125)),
            (flat, ConstantRestitution(), PlaneSettings(gravity=9.8125, order=6)),
            (upright, by_speed, PlaneSettings(gravity=9.8125)),
            (pulses, by_speed, PlaneSettings(gravity=9.8125, linear=True)),
        ]
