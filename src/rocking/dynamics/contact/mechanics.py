"""Sliding, hopping and flight of a plane body with friction."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rocking.dynamics.contact.base import Start
from rocking.dynamics.contact.settings import ContactSettings
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.mechanics_base import Combinations, PlaneMechanics, Sample, in_space

if TYPE_CHECKING:
    import xarray as xr

    from rocking.dynamics.contact.batch import RowsWithContact
    from rocking.dynamics.contact.response import ContactResponse


class PlaneContact(PlaneMechanics):
    """Rest, sliding, rocking and flight of a plane body."""

    name, title, subject = "contact", "sliding and hopping", "a plane body with friction"
    settings, start_kind, slides = ContactSettings, Start, True
    batch_options = frozenset({"start", "rotation", "angular_velocity", "duration", "engine", "threads", "progress"})

    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        """Return True of what is no body in space, with friction."""
        return friction is not None and not in_space(body)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Start:
        """Return the start of a body that stands on its lower foot."""
        return Start(rotation, angular_velocity)

    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: ContactSettings, *, start: Start, **options: Any
    ) -> "ContactResponse":
        """Return one history."""
        from rocking.dynamics.contact.response import response_with_contact

        return response_with_contact(body, motion, restitution, settings, start=start, **options)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the variables that `follow_many` fills."""
        from rocking.dynamics.contact.batch import COLUMNS

        return COLUMNS

    def follow_many(self, combinations: Combinations, settings: ContactSettings) -> "xr.Dataset":
        """Return every combination."""
        from rocking.dynamics.contact.batch import many_with_contact

        return many_with_contact(combinations, settings)

    def rows(self, motions: Sequence[Any], law: ImpactLaw, settings: ContactSettings, engine: str) -> "RowsWithContact":
        """Return what computes the rows of a study."""
        from rocking.dynamics.contact.batch import RowsWithContact

        return RowsWithContact(motions, law, settings, engine)

    def engine_of_study(self, *, fast: bool) -> str:
        """Return which engine computes the rows of a study, in words."""
        from rocking.dynamics.contact.batch import FAST

        return FAST

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        """Return histories of pulses and of records with a vertical part, without and with bounces."""
        return [
            (pulses, ConstantRestitution(), ContactSettings(gravity=9.8125, friction=0.3125)),
            (upright, ConstantRestitution(), ContactSettings(gravity=9.8125, friction=0.75, bounce=0.25)),
        ]

    def sample_rows(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return rows whose sides are of one height and one moment of inertia."""
        return values | {f"{name}_left": values[f"{name}_right"] for name in ("alpha", "p", "q")}
