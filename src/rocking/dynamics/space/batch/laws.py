"""Impact laws as the compiled engine knows them: by number, with what each of them needs."""

from dataclasses import dataclass
from typing import Any

from rocking.dynamics.space.impact_laws import FixedSpatial, ModelLaw, SpatialImpactLaw, law_of
from rocking.errors import InvalidValueError

CODES = {"housner-3d": 0, "horizontal-momentum-3d": 1, "ked-3d": 3, "ked-3d-point": 4}
"""Laws without a number of their own."""

_FIXED = 2


@dataclass(frozen=True)
class BatchLaw:
    """An impact law of a batch."""

    # what the reference engine takes; None where the body decides it (ked-3d and ked-3d-point)
    law: SpatialImpactLaw | None
    label: str  # its name, or its coefficient
    code: int  # its number in the compiled engine
    coefficient: float = 0.0  # r of a fixed coefficient, otherwise 0 [-]

    @property
    def needs_moments(self) -> bool:
        """Whether it needs moments of the mass distribution."""
        return self.code == CODES["ked-3d-point"]

    @property
    def needs_positions(self) -> bool:
        """Whether it needs to know where the impulse of a landing of the whole base acts."""
        return self.code == CODES["ked-3d"]


def batch_law(restitution: Any) -> BatchLaw:
    """Return an impact law of a batch."""
    law = law_of(restitution)
    if isinstance(law, ModelLaw) and law.model.needs_solid and law.label in CODES:
        return BatchLaw(None, law.label, CODES[law.label])
    if isinstance(law, FixedSpatial):
        return BatchLaw(law, law.label, _FIXED, law.coefficient)
    if law.label in CODES and type(law).__module__.startswith("rocking."):
        return BatchLaw(law, law.label, CODES[law.label])
    raise InvalidValueError(
        f"restitution in a batch must be one of {', '.join(CODES)}, or a coefficient in [0, 1], got {law.label!r:.60}; "
        "one history, by simulate, takes any law"
    )
