"""Rocking of a plane body on an isolated base."""

from collections.abc import Mapping
from typing import Any, NoReturn

from rocking.bodies.isolated import Isolated
from rocking.dynamics.isolated.settings import IsolatedSettings
from rocking.dynamics.mechanics_base import Combinations, RockingMechanics
from rocking.errors import InvalidValueError


class IsolatedRocking(RockingMechanics):
    """Rocking of a plane body on a base that moves horizontally."""

    name, title, subject = "isolated", "rocking on an isolated base", "a body on an isolated base"
    settings = IsolatedSettings
    options = frozenset({"stream"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return isinstance(body, Isolated)

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
