"""Rocking of a plane body on an isolated base."""

from collections.abc import Mapping
from typing import Any, NoReturn

from rocking.bodies.isolated import Isolated
from rocking.dynamics.isolated.settings import IsolatedSettings
from rocking.dynamics.mechanics_base import Combinations, PlaneMechanics
from rocking.errors import InvalidValueError


class IsolatedRocking(PlaneMechanics):
    """Rocking of a plane body on a base that moves horizontally."""

    name, title, subject = "isolated", "rocking on an isolated base", "a body on an isolated base"
    settings = IsolatedSettings
    options = frozenset({"stream"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Isolated)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        return rotation, angular_velocity  # their limits depend on the body and are checked later

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        from rocking.dynamics.plane_frictional.base import rocking_start

        begun = super().begun(start, rotation, angular_velocity)
        return begun if start is None else rocking_start(begun)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: IsolatedSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.isolated.response import response_on_a_base

        return response_on_a_base(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        return ()

    def follow_many(self, combinations: Combinations, settings: IsolatedSettings) -> NoReturn:
        raise _refusal()

    def study_settings(self, body: Any, options: Mapping[str, Any]) -> NoReturn:
        raise _refusal()


def _refusal() -> InvalidValueError:
    return InvalidValueError(
        "This analysis does not support isolated bases. Use simulate for each motion, or remove the base.",
        parameter="body",
    )
