"""What was done to a surface to make it bound a body, and how much of volume and centre that can have moved."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.conventions import FloatArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

Repair = Literal["none", "safe", "all"]

"""Merging equal vertices alone; what stays within the bounds below; whatever it takes."""

InnerParts = Literal["refuse", "solid", "cavity"]
"""How to read a closed part inside another one and wound like it: not at all, as filled, or as a hollow."""

MOST_VOLUME = 0.01  # what safe repairs together may change of the volume [-]
MOST_SHIFT = 0.005  # how far safe repairs together may move the centre of mass, over the size of the body [-]

SKINS = {"wrap": Option("body.surface", "wrap"), "hull": Option("body.surface", "hull")}
HELP = Message(
    "{all} takes it all the same, {wrap} or {hull} a skin over its points instead; best is to mend it in the program "
    "that made it",
    {"all": Option("body.repair", "all"), **SKINS},
)


def in_words(place: FloatArray, unit: str = "m") -> str:
    """Return a place in words."""
    return f"({', '.join(f'{round(x, 9) + 0.0:.4g}' for x in place.tolist())}) {unit}"


@dataclass
class Changes:
    """Repairs of a surface, as they are made."""

    allowed: Repair = "safe"
    inner_parts: InnerParts = "refuse"
    place: Callable[[FloatArray], str] = in_words  # a place from the middle of the box [m], in the user's words
    made: list[tuple[str, float, FloatArray | None]] = field(default_factory=list)  # sentence, volume [m3], where [m]
    mended: list[FloatArray] = field(default_factory=list)  # faces that closed holes, (m, 3, 3) each [m]

    def __post_init__(self) -> None:
        self.allowed = checks.one_of("repair", self.allowed, get_args(Repair))
        self.inner_parts = checks.one_of("inner_parts", self.inner_parts, get_args(InnerParts))

    def say(self, sentence: str, volume: float = 0.0, where: FloatArray | None = None) -> None:
        """Note a repair; volume: what it can have changed [m3], about a place [m], or anywhere."""
        if self.allowed == "none":
            stated = Option("body.repair", "none")
            raise GeometryError(
                "it needs a repair, which {stated} refuses: {sentence}", stated=stated, sentence=sentence
            )
        self.note(sentence, volume, where)

    def note(self, sentence: str, volume: float = 0.0, where: FloatArray | None = None) -> None:
        """Note what repair="none" allows too."""
        self.made.append((sentence, volume, where))

    def bounds(self, whole: SolidMoments, size: float) -> list[tuple[float, float]]:
        """Return what each repair may have changed of the volume [-] and how far it may have moved the centre [m]."""
        # whole: volume and centre of the result; size: its largest side [m], half of which is how far from the centre a
        # change is taken to be that has no place
        found = []
        for _, volume, where in self.made:
            arm = 0.5 * size if where is None else float(np.linalg.norm(where - whole.centre))
            found.append((volume / whole.mass, volume / whole.mass * arm))
        return found

    def sentences(self, whole: SolidMoments, size: float) -> tuple[str, ...]:
        """Return what was done, each with its bound; refuse more than safe repairs may change."""
        bounds = self.bounds(whole, size)
        listed = [
            _bounded(words, share, shift) if share else words
            for (words, _, _), (share, shift) in zip(self.made, bounds, strict=True)
        ]
        share, shift = sum(pair[0] for pair in bounds), sum(pair[1] for pair in bounds)
        if self.allowed != "all" and (share > MOST_VOLUME or shift > MOST_SHIFT * size):
            raise GeometryError(
                "its repairs may change {volume} of the volume and move the centre by {shift:.2g} mm, more than the "
                "{most_volume} and {most_shift} of the size ({longest:.2g} mm) that are safe: {repairs}",
                volume=percent(share), shift=1000.0 * shift, most_volume=percent(MOST_VOLUME),
                most_shift=percent(MOST_SHIFT), longest=1000.0 * MOST_SHIFT * size,
                repairs="; ".join(words for words, pair in zip(listed, bounds, strict=True) if pair[0]), hint=HELP,
            )  # fmt: skip
        return tuple(listed)


def _bounded(words: str, share: float, shift: float) -> str:
    """Return a repair with what it can have changed of the volume [-] and of the centre [m]."""
    return Message(
        "{repair}; that is at most {share} of the volume and {shift:.2g} mm of the centre",
        {"repair": words, "share": percent(share), "shift": 1000.0 * shift},
    )
