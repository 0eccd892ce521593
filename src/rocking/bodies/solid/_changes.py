"""What was done to a surface to make it bound a body, and how much of volume and centre that can have moved."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from rocking.bodies.moments import SolidMoments
from rocking.conventions import FloatArray, percent
from rocking.errors import GeometryError, InvalidValueError

Repair = Literal["none", "safe", "all"]

REPAIRS: tuple[Repair, ...] = ("none", "safe", "all")
"""Nothing but merging equal vertices; what stays within the bounds below; whatever it takes."""

MOST_VOLUME = 0.01
"""What safe repairs together may change of the volume [-]."""

MOST_SHIFT = 0.005
"""How far safe repairs together may move the centre of mass, over the size of the body [-]."""

HELP = (
    'repair="all" takes it as it is then, and surface="wrap" stretches a skin over its vertices instead; better mend it '
    "in the program that made it"
)


def in_words(place: FloatArray, unit: str = "m") -> str:
    """Return a place in words."""
    return f"({', '.join(f'{round(x, 9) + 0.0:.4g}' for x in place.tolist())}) {unit}"


@dataclass
class Changes:
    """Repairs of a surface, as they are made."""

    allowed: Repair = "safe"
    place: Callable[[FloatArray], str] = in_words  # a place [m] in the user's words
    made: list[tuple[str, float, FloatArray]] = field(default_factory=list)  # sentence, volume [m3], where [m]

    def __post_init__(self) -> None:
        if self.allowed not in REPAIRS:
            raise InvalidValueError(f'repair must be "none", "safe" or "all", got {self.allowed!r:.60}')

    def say(self, sentence: str, volume: float = 0.0, where: FloatArray | None = None) -> None:
        """Note a repair; volume: what it can have changed [m3], about a place [m]."""
        if self.allowed == "none":
            raise GeometryError(f'it needs a repair, which repair="none" refuses: {sentence}')
        self.note(sentence, volume, where)

    def note(self, sentence: str, volume: float = 0.0, where: FloatArray | None = None) -> None:
        """Note what repair="none" allows too."""
        self.made.append((sentence, volume, np.zeros(3) if where is None else where))

    def sentences(self, whole: SolidMoments, size: float) -> tuple[str, ...]:
        """Return what was done, each with its bound; refuse more than safe repairs may change.

        whole: volume and centre of the result; size: its largest side [m].
        """
        shares = [volume / whole.mass for _, volume, _ in self.made]
        shifts = [
            share * float(np.linalg.norm(where - whole.centre))
            for share, (_, _, where) in zip(shares, self.made, strict=True)
        ]
        listed = [
            f"{words}; at most {percent(share)} of the volume, {1000.0 * shift:.2g} mm of the centre" if share else words
            for (words, _, _), share, shift in zip(self.made, shares, shifts, strict=True)
        ]
        if self.allowed != "all" and (sum(shares) > MOST_VOLUME or sum(shifts) > MOST_SHIFT * size):
            raise GeometryError(
                f"its repairs may change {percent(sum(shares))} of the volume and move the centre by "
                f"{1000.0 * sum(shifts):.2g} mm, more than the {percent(MOST_VOLUME)} and {percent(MOST_SHIFT)} of the "
                f"size that are safe: {'; '.join(words for words, share in zip(listed, shares, strict=True) if share)}; "
                f"{HELP}"
            )
        return tuple(listed)
