"""One motion of a study: as inputs name it, and as it is, also where an axis stretches its time."""

from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from rocking.app.studies.opened import OpenStudy
from rocking.dynamics.response import Motion
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.pulses import pulse
from rocking.studies.job.inputs import Inputs
from rocking.studies.job.parts import motions_of

if TYPE_CHECKING:
    from rocking.studies.job.tables import MotionTable

_OF_RECORDS = ("format", "units", "time_step", "component", "vertical")
_OF_FAMILIES = ("pga", "pgv", "time_step")
_TIMES = {"period", "duration", "velocity"}
"""Parameters of pulses that grow with their time while the acceleration stays."""

_CLOSE = 1e-12


@dataclass(frozen=True)
class ChosenMotion:
    """One motion of a study."""

    motion: Motion  # the motion, without the factor of its table
    told: dict[str, Any] | None  # how inputs name it; None where they cannot
    scale: float  # the factor of its table [-]

    @classmethod
    def of(cls, study: OpenStudy, number: int, stretch: float) -> "ChosenMotion":
        """Return a motion of a study.

        stretch: factor on its time [-].
        """
        table, place = _found(study, number)
        if table.pulse is not None:
            return cls._of_pulse(table, place, stretch)
        if table.records is not None:
            return cls._of_record(table, place, stretch, study)
        told = {"synthetic": table.synthetic, "seed": table.seed or 0, "member": place}
        told |= {name: getattr(table, name) for name in _OF_FAMILIES if getattr(table, name) is not None}
        made = _stretched(study.job.job.parts.motions[number], stretch)
        return cls(made, told if stretch == 1.0 else None, 1.0)

    @classmethod
    def _of_pulse(cls, table: "MotionTable", place: int, stretch: float) -> "ChosenMotion":
        assert table.pulse is not None  # asked before
        words = stretched_words(table.pulse[place], stretch)
        return cls(pulse(words), {"pulse": words}, table.scale)

    @classmethod
    def _of_record(cls, table: "MotionTable", place: int, stretch: float, study: OpenStudy) -> "ChosenMotion":
        assert table.records is not None  # asked before
        name = table.records[place]
        alone = table.model_copy(update={"records": [name], "scale": 1.0})
        motion = _stretched(motions_of([alone], Inputs(study.folder.path))[0], stretch)
        path = PurePosixPath(name)
        told: dict[str, Any] = {"record": path.parent.name, "file_name": path.name}
        told |= {key: getattr(table, key) for key in _OF_RECORDS if getattr(table, key) is not None}
        return cls(motion, told if stretch == 1.0 else None, table.scale)


def stretched_words(words: str, stretch: float) -> str:
    """Return a pulse whose time is stretched while its acceleration stays, in words.

    stretch: factor on its time [-]. Returns the words of the stretched pulse; the same words where nothing is
    stretched.

    >>> stretched_words("sine:amplitude=3,period=0.5", 2.0)
    'sine:amplitude=3,period=1.0'
    """
    if stretch == 1.0:
        return words
    name, _, tail = words.partition(":")
    pairs = [tuple(part.strip() for part in item.partition("=")[::2]) for item in filter(None, tail.split(","))]
    changed = [(key, repr(float(value) * stretch) if key in _TIMES else value) for key, value in pairs]
    made = f"{name}:{','.join(f'{key}={value}' for key, value in changed)}"
    before, after = pulse(words), pulse(made)
    if abs(after.duration / (stretch * before.duration) - 1.0) + abs(after.peak / before.peak - 1.0) > _CLOSE:
        raise ArithmeticError(f"{made} is not {words} stretched by {stretch!r}")
    return made


def _found(study: OpenStudy, number: int) -> tuple["MotionTable", int]:
    """Return the table that a motion stands in, and its place there."""
    left = number
    for table in study.job.job.document.motions:
        size = int(table.count or 0) or len(table.records or []) or len(table.pulse or [])
        if left < size:
            return table, left
        left -= size
    raise IndexError(number)


def _stretched(motion: Motion, stretch: float) -> Motion:
    if stretch == 1.0 or isinstance(motion, Pulse):
        return motion
    assert isinstance(motion, GroundMotion)  # there is nothing else
    return replace(motion, time_step=motion.time_step * stretch)
