"""Plane bodies on each other."""

from typing import Any

from rocking.bodies.stack import Stack
from rocking.dynamics.mechanics_base import Combinations, PlaneMechanics
from rocking.dynamics.stack.settings import StackSettings
from rocking.errors import InvalidValueError


class StackRocking(PlaneMechanics):
    """Rocking of plane bodies on each other."""

    name, title, subject = "stack", "rocking of a stack", "a stack"
    settings = StackSettings
    options = frozenset({"engine"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Stack)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        return rotation, angular_velocity  # one value, or one value per body; checked later

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        if start is not None:
            raise InvalidValueError("a stack starts with rotation and angular_velocity, not with start")
        return self.start_of(rotation, angular_velocity)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: StackSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.stack.response import response_of_stack

        return response_of_stack(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        return ()

    def follow_many(self, combinations: Combinations, settings: StackSettings) -> Any:
        raise InvalidValueError("simulate_many does not accept {subject}", subject=self.subject)
