"""Sliding, hopping and flight of a plane body with friction."""

from collections.abc import Sequence
from typing import Any

from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics_base import Combinations, Mechanics, PlaneMechanics, Sample, in_space
from rocking.dynamics.plane_frictional.settings import ContactSettings


class PlaneContact(PlaneMechanics):
    """Rest, sliding, rocking and flight of a plane body."""

    name, title, subject = "contact", "sliding and hopping", "a plane body with friction"
    settings, slides = ContactSettings, True
    batch_options = Mechanics.batch_options | {"rotation", "angular_velocity"}

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        return friction is not None and not in_space(body)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: ContactSettings, *, start: Any, **options: Any
    ) -> Any:
        from rocking.dynamics.plane_frictional.response import response_with_contact

        return response_with_contact(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        from rocking.dynamics.plane_frictional.batch import COLUMNS

        return COLUMNS

    def follow_many(self, combinations: Combinations, settings: ContactSettings) -> Any:
        from rocking.dynamics.plane_frictional.batch import many_with_contact

        return many_with_contact(combinations, settings)

    def rows(self, motions: Sequence[Any], law: ImpactLaw, settings: ContactSettings, engine: str) -> Any:
        from rocking.dynamics.plane_frictional.batch import RowsWithContact

        return RowsWithContact(motions, law, settings, engine)

    def engine_of_study(self, *, fast: bool) -> str:
        from rocking.dynamics.plane_frictional.batch import FAST

        return FAST

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        return [
            (pulses, ConstantRestitution(), ContactSettings(gravity=9.8125, friction=0.3125)),
            (upright, ConstantRestitution(), ContactSettings(gravity=9.8125, friction=0.75, normal_restitution=0.25)),
        ]

    def sample_rows(self, values: dict[str, Any]) -> dict[str, Any]:
        # both sides have the same height and the same moment of inertia
        return values | {f"{name}_left": values[f"{name}_right"] for name in ("alpha", "p", "q")}
