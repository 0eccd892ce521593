"""Bodies in space on the vertices of their convex hull, which rock, slide, hop, fly and fall into other poses."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.mechanics_base import Combinations, Sample, SpatialMechanics, in_space
from rocking.dynamics.parameters import UNIMPOSED, RockingParameters, RockingSide
from rocking.dynamics.settings import Settings


class HullRocking(SpatialMechanics):
    """Rocking, sliding, hopping and flight of a body in space."""

    name, title, subject = "hull", "a body in space with friction", "a body in space with friction"
    settings, slides = HullSettings, True
    options = frozenset({"engine"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        # in a study without friction, the body may hop and fall into other poses, but does not slide
        return (study or friction is not None) and in_space(body)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: HullSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.frictional.response import response_on_hull

        return response_on_hull(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        from rocking.dynamics.frictional.batch import RENAMED
        from rocking.dynamics.frictional.histories import COLUMNS

        return (*(RENAMED.get(name, name) for name in COLUMNS), "overturned")

    def follow_many(self, combinations: Combinations, settings: HullSettings) -> Any:
        from rocking.dynamics.frictional.batch import many_on_hulls

        return many_on_hulls(combinations, settings).to_xarray()

    def rows(self, motions: Sequence[Any], law: Any, settings: HullSettings, engine: str) -> Any:
        from rocking.dynamics.frictional.batch import RowsOnHull

        return RowsOnHull(motions, law, settings, engine)

    def parameters(self, body: Any, restitution: Any, settings: Settings) -> RockingParameters:
        from rocking.dynamics.frictional.restitution import RestitutionOnHull

        law = RestitutionOnHull.of(body, restitution, settings.gravity)
        r = UNIMPOSED if isinstance(law.model, str) else law.model
        side = RockingSide(law.slenderness_angle, law.frequency, law.size, r)
        return RockingParameters(side, side, law, law.label)

    def check_motions(self, motions: Sequence[Any]) -> None:
        """Accept motions with one or several components."""

    def engine_of_study(self, *, fast: bool) -> str:
        return "fast (Dormand-Prince with complementarity, compiled)"

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        from rocking.bodies.solid import Solid, box
        from rocking.dynamics.frictional.restitution import RestitutionOnHull

        law = RestitutionOnHull(body=Solid(box(0.5, 0.75, 1.5)), model="housner-3d", frequency=2.0, gravity=9.8125)
        return [(flat, law, HullSettings(gravity=9.8125, friction=0.5))]

    def sample_rows(self, values: dict[str, Any]) -> dict[str, Any]:
        return values | {"rotation": np.zeros_like(values["rotation"])}
