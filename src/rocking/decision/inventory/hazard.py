"""Hazard of an inventory: the motions and their intensity level."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS, g
from rocking.errors import InvalidValueError, located
from rocking.language import language
from rocking.messages import Message
from rocking.motions import peak_ground_acceleration, peak_ground_velocity
from rocking.motions.components import Components, in_plane, together
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.processing import scaled_to
from rocking.motions.synthetic.families import Family
from rocking.studies.motion_sets import SyntheticSet

VELOCITY_UNITS = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001}
"""Units of a peak ground velocity [m/s]."""

MOST_MOTIONS = 5000
"""Largest number of motions of a hazard, because all motions are kept in memory."""

FAMILY, COUNT, SEED = "firm-ground", 200, 1
"""Defaults of synthetic motions."""

_LEVEL = re.compile(r"((?:[0-9]+(?:[.,][0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*([a-z].*)")
_THOUSANDS = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}")


@dataclass(frozen=True)
class IntensityLevel:
    """Peak ground acceleration or velocity to which motions are scaled."""

    kind: str  # "PGA" or "PGV"
    value: float  # the level [m/s2 or m/s]

    def __post_init__(self) -> None:
        if self.kind not in {"PGA", "PGV"}:
            raise InvalidValueError("a level is a PGA or a PGV, got {value}", parameter="kind", value=self.kind)
        unit, most = ("m/s2", 1000.0) if self.kind == "PGA" else ("m/s", 100.0)
        value = checks.within(self.kind, self.value, 0.0, most, unit=unit, open_low=True, hint="Check the unit.")
        object.__setattr__(self, "value", value)

    def __str__(self) -> str:
        return self.words()

    def words(self, code: str = "en") -> str:
        """Return the level in a language."""
        return language(code)(self.message)

    @property
    def message(self) -> Message:
        """The level with its unit."""
        if self.kind == "PGA":
            return Message("PGA {value:.4g} g", {"value": self.value / g})
        return Message("PGV {value:.4g} m/s", {"value": self.value})

    @classmethod
    def of(cls, kind: str, level: str) -> "IntensityLevel":
        """Return a level from a number with its unit, such as ``0.3g``, ``0,3g`` or ``25cm/s``."""
        if kind not in {"PGA", "PGV"}:
            raise InvalidValueError("a level is a PGA or a PGV, got {value}", parameter="kind", value=kind)
        units = ACCELERATION_UNITS if kind == "PGA" else VELOCITY_UNITS
        text: object = level
        match = _LEVEL.fullmatch(text.strip()) if isinstance(text, str) else None
        if match is None or match[2] not in units:
            example = "0.3g" if kind == "PGA" else "25cm/s"
            raise InvalidValueError(
                parameter=kind, value=level,
                allowed=f"a number with its unit, one of {', '.join(units)}, such as {example}",
            )  # fmt: skip
        if _THOUSANDS.fullmatch(match[1]):
            decimal, integer = match[1].replace(",", "."), match[1].replace(",", "")
            raise InvalidValueError(
                "{parameter} is ambiguous: {value} could be {decimal} or {whole} {unit}", parameter=kind, value=level,
                decimal=decimal, whole=integer, unit=match[2], hint="Write one of the two numbers.",
            )  # fmt: skip
        return cls(kind, float(match[1].replace(",", ".")) * units[match[2]])


@dataclass(frozen=True, eq=False)
class Hazard:
    """Motions of all objects of an inventory."""

    motions: tuple[GroundMotion, ...]  # the motions, scaled
    level: IntensityLevel | None  # level of the scaled motions; None for unscaled records
    source: Message  # source of the motions
    description: dict[str, Any]  # description of the source as plain values
    # horizontal components at right angles to the motions, for objects in 3D; None if missing
    across: tuple[GroundMotion | None, ...] = ()

    @classmethod
    def of_family(
        cls,
        which: str | Family,
        level: IntensityLevel,
        *,
        count: int = COUNT,
        seed: int = SEED,
        progress: Callable[[int], None] | None = None,
    ) -> "Hazard":
        """Return synthetic motions scaled to a level, which is required because the families define no level."""
        count = checks.whole("count", count, 1, MOST_MOTIONS)
        motions = SyntheticSet(which, count, seed, **{level.kind.lower(): level.value})
        shaken = []
        for k in range(count):
            shaken.append(motions[k])
            if progress is not None:
                progress(1)
        name = motions.family.name
        source = Message(
            "{count} synthetic motion of the family {family} ({title}), seed {seed}",
            {"count": count, "family": name, "title": Message(motions.family.title), "seed": seed},
            "{count} synthetic motions of the family {family} ({title}), seed {seed}",
        )
        return cls(tuple(shaken), level, source, motions.description())

    @classmethod
    def of_records(cls, records: Sequence[Any], level: IntensityLevel | None = None) -> "Hazard":
        """Return records; with a level, all components are scaled by the factor of the leading component."""
        pairs = [_apart(record) for record in records]
        checked = [checked_motion(record, f"records[{k}]") for k, (record, _) in enumerate(pairs)]
        if not 1 <= len(checked) <= MOST_MOTIONS:
            raise InvalidValueError(parameter="records", allowed=f"1 to {MOST_MOTIONS} motions", value=len(checked))
        scaled = [_scaled(record, level) for record in checked]
        across = tuple(
            other if other is None or new is old else other.scaled(new.peak / old.peak)
            for (_, other), old, new in zip(pairs, checked, scaled, strict=True)
        )
        source = Message("{count} record, as recorded", {"count": len(checked)}, "{count} records, as recorded")
        if level is not None:
            facts = {"count": len(checked), "level": level.message}
            source = Message("{count} record, each scaled to {level}", facts, "{count} records, each scaled to {level}")
        names = [record.name for record in checked]
        plain = {"kind": "records", "names": names, "provenance": [list(motion.provenance) for motion in scaled]}
        return cls(tuple(scaled), level, source, plain, across if any(motion is not None for motion in across) else ())

    @property
    def synthetic(self) -> bool:
        """True for synthetic motions."""
        return self.description.get("kind") == "synthetic"

    @property
    def vertical(self) -> bool:
        """True if a motion has a vertical component."""
        return any(motion.vertical is not None for motion in self.motions)

    def words(self, code: str = "en") -> str:
        """Return the level as text in a language, or the range of the PGA of unscaled records."""
        say = language(code)
        if self.level is not None:
            return self.level.words(code)
        peaks = [peak_ground_acceleration(motion) / g for motion in self.motions]
        if max(peaks) - min(peaks) <= 1e-9 * max(peaks):
            return say("PGA {value:.3g} g", value=max(peaks))
        return say("PGA {low:.3g} to {high:.3g} g", low=min(peaks), high=max(peaks))

    def peak(self) -> float:
        """Return the largest peak ground acceleration of all motions [m/s2]."""
        return max(peak_ground_acceleration(motion) for motion in self.motions)

    def velocity(self) -> tuple[float, float]:
        """Return the smallest and largest peak ground velocity [m/s]."""
        peaks = [peak_ground_velocity(motion) for motion in self.motions]
        return min(peaks), max(peaks)


def _apart(record: Any) -> tuple[Any, GroundMotion | None]:
    """Return the leading horizontal component with the vertical component, and the other horizontal component."""
    motion = together(record)
    if not isinstance(motion, Components):
        return motion, None
    x, y, z = motion.parts
    if y is not None and (x is None or y.peak > x.peak):
        x, y = y, None if x is None else x.scaled(-1.0)
    return in_plane((x, None, z)), None if y is None else checked_motion(y, "motion along y")


def _scaled(record: GroundMotion, level: IntensityLevel | None) -> GroundMotion:
    if level is None:
        return record
    with located(f"{record.name!r:.80}", "file"):
        return scaled_to(record, level.kind.lower(), level.value)
