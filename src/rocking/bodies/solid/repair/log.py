"""Log of the repairs of a surface, with bounds of their effect on volume and centre of mass."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.surfaces import coordinates_text
from rocking.conventions import FloatArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

Repair = Literal["none", "safe", "all"]
"""Allowed repairs: merging of equal vertices only, repairs within the bounds below, all repairs."""

InnerParts = Literal["refuse", "solid", "cavity"]
"""Treatment of a closed part inside another part with the same orientation: error, solid, or cavity."""

MOST_VOLUME = 0.01  # largest change of the volume by all safe repairs / volume [-]
MOST_SHIFT = 0.005  # largest shift of the centre of mass by all safe repairs / size of the body [-]

SKINS = {"wrap": Option("body.surface", "wrap"), "hull": Option("body.surface", "hull")}
HELP = Message(
    "repair the mesh in the program that wrote it, or use {all} to allow all repairs, or {wrap} or {hull} for a skin "
    "around its "
    "points",
    {"all": Option("body.repair", "all"), **SKINS},
)


@dataclass
class RepairLog:
    """Repairs of a surface, in their order."""

    allowed: Repair = "safe"
    inner_parts: InnerParts = "refuse"
    describe: Callable[[FloatArray], str] = coordinates_text  # text of a point relative to the middle of the box [m]
    repairs: list[tuple[str, float, FloatArray | None]] = field(
        default_factory=list
    )  # repairs: sentence, bound of the volume change [m3], location [m]
    patches: list[FloatArray] = field(default_factory=list)  # triangles in former holes, shape (m, 3, 3) per hole [m]

    def __post_init__(self) -> None:
        self.allowed = checks.one_of("repair", self.allowed, get_args(Repair))
        self.inner_parts = checks.one_of("inner_parts", self.inner_parts, get_args(InnerParts))

    def add_repair(self, sentence: str, volume: float = 0.0, location: FloatArray | None = None) -> None:
        """Store a repair; `volume` is a bound of the volume change [m3] at a location [m], or anywhere."""
        if self.allowed == "none":
            stated = Option("body.repair", "none")
            raise GeometryError(
                "The surface needs a repair, but {stated} allows none: {sentence}", stated=stated, sentence=sentence
            )
        self.add_note(sentence, volume, location)

    def add_note(self, sentence: str, volume: float = 0.0, location: FloatArray | None = None) -> None:
        """Store a repair that repair="none" allows too."""
        self.repairs.append((sentence, volume, location))

    def bounds(self, result: SolidMoments, size: float) -> list[tuple[float, float]]:
        """Return bounds of the relative volume change [-] and of the shift of the centre of mass [m], by repair."""
        # `result` is the volume and centre of the repaired body; `size` is its largest side [m]. A change without
        # location has an assumed distance of size / 2 from the centre of mass.
        bounds_of_repairs = []
        for _, volume, location in self.repairs:
            distance = 0.5 * size if location is None else float(np.linalg.norm(location - result.centre))
            bounds_of_repairs.append((volume / result.mass, volume / result.mass * distance))
        return bounds_of_repairs

    def sentences(self, result: SolidMoments, size: float) -> tuple[str, ...]:
        """Return all repairs with their bounds, as sentences; refuse changes beyond the limits of safe repairs."""
        bounds = self.bounds(result, size)
        sentences = [
            _bounded(sentence, volume_change, shift) if volume_change else sentence
            for (sentence, _, _), (volume_change, shift) in zip(self.repairs, bounds, strict=True)
        ]
        volume_change, shift = sum(pair[0] for pair in bounds), sum(pair[1] for pair in bounds)
        if self.allowed != "all" and (volume_change > MOST_VOLUME or shift > MOST_SHIFT * size):
            raise GeometryError(
                "The repairs may change {volume} of the volume and move the centre by {shift:.2g} mm. The safe limits "
                "are {most_volume} and {most_shift} of the size ({longest:.2g} mm). Repairs: {repairs}",
                volume=percent(volume_change), shift=1000.0 * shift, most_volume=percent(MOST_VOLUME),
                most_shift=percent(MOST_SHIFT), longest=1000.0 * MOST_SHIFT * size,
                repairs="; ".join(text for text, pair in zip(sentences, bounds, strict=True) if pair[0]), hint=HELP,
            )  # fmt: skip
        return tuple(sentences)


def _bounded(repair: str, volume_change: float, shift: float) -> str:
    """Return a repair with its bounds of volume change [-] and shift of the centre of mass [m]."""
    return Message(
        "{repair}; changes at most {share} of the volume and moves the centre of mass by at most {shift:.2g} mm",
        {"repair": repair, "share": percent(volume_change), "shift": 1000.0 * shift},
    )
