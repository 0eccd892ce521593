"""Bodies in space that rock about edges and vertices or roll on a rim, and do not slip."""

from typing import TYPE_CHECKING, Any

from rocking.dynamics.mechanics_base import Combinations, SpatialMechanics, in_space
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.settings import SpaceBatchSettings, SpaceSettings

if TYPE_CHECKING:
    import xarray as xr

    from rocking.dynamics.space.response import SpatialResponse


class SpaceRocking(SpatialMechanics):
    """Rocking and rolling of a body in space."""

    name, title, subject = "space", "a body in space", "a body in space without friction"
    settings, start_kind = SpaceSettings, SpatialStart
    batch_options = frozenset({"start", "duration", "engine", "threads", "progress"})

    @property
    def batch_settings(self) -> type[Settings]:
        """Class of the settings of `follow_many`."""
        return SpaceBatchSettings

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        """Return True of a body in space without friction; studies let it hop and fall into other poses."""
        return friction is None and not study and in_space(body)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: SpaceSettings, *, start: SpatialStart, **options: Any
    ) -> "SpatialResponse":
        """Return one history."""
        from rocking.dynamics.space.response import response_in_space

        return response_in_space(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the variables that `follow_many` fills."""
        from rocking.dynamics.space.fast_engine import COLUMNS

        return (*COLUMNS, "overturned")

    def follow_many(self, combinations: Combinations, settings: SpaceBatchSettings) -> "xr.Dataset":
        """Return every combination."""
        from rocking.dynamics.space.batch import many_in_space

        return many_in_space(combinations, settings).to_xarray()
