"""Plane bodies on each other."""

from collections.abc import Mapping
from typing import Any

from rocking.bodies.stack import Stack
from rocking.dynamics.mechanics_base import Combinations, RockingMechanics
from rocking.dynamics.settings import Settings
from rocking.dynamics.stack.settings import StackSettings
from rocking.errors import InvalidValueError


class StackRocking(RockingMechanics):
    """Rocking of plane bodies on each other."""

    name, title, subject = "stack", "rocking of a stack", "a stack"
    settings = StackSettings
    options = frozenset({"engine"})
    has_restitution = False

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Stack)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: StackSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.stack.response import response_of_stack

        return response_of_stack(body, motion, restitution, settings, start=start, **options)

    def study_settings(self, body: Any, options: Mapping[str, Any]) -> Settings:
        raise InvalidValueError("studies do not accept {subject}", subject=self.subject)

    @property
    def columns(self) -> tuple[str, ...]:
        return ()

    def follow_many(self, combinations: Combinations, settings: StackSettings) -> Any:
        raise InvalidValueError("simulate_many does not accept {subject}", subject=self.subject)
