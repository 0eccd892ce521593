"""3D bodies that rock about edges and vertices or roll on a rim, and do not slip."""

from typing import Any

from rocking.dynamics.mechanics_base import Combinations, SpatialMechanics, in_space
from rocking.dynamics.rolling.settings import SpaceBatchSettings, SpaceSettings
from rocking.dynamics.settings import Settings


class SpaceRocking(SpatialMechanics):
    """Rocking and rolling of a 3D body."""

    name, title, subject = "space", "a body in space", "a body in space without friction"
    settings = SpaceSettings

    @property
    def batch_settings(self) -> type[Settings]:
        return SpaceBatchSettings

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return friction is None and not study and in_space(body)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: SpaceSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.rolling.response import response_in_space

        return response_in_space(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        from rocking.dynamics.rolling.fast_engine import COLUMNS

        return (*COLUMNS, "overturned")

    def follow_many(self, combinations: Combinations, settings: SpaceBatchSettings) -> Any:
        from rocking.dynamics.rolling.batch import many_in_space

        return many_in_space(combinations, settings).to_xarray()
