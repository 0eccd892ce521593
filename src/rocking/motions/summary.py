"""Summaries of motions for results and reports: support, intensity, source and processing steps."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import plausibility
from rocking.answers import Answer
from rocking.conventions import g
from rocking.messages import Message, listed
from rocking.motions.components import Components, leading
from rocking.motions.integrals import integral_doubts
from rocking.motions.intensity import measure, sampled
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse

GROUND = "ground"
"""Name of the support of a motion at the ground."""

_MOST_ROWS = 12
_SHOWN_NAMES = 4


def provenance_of(motion: Any, pulse: Callable[[Pulse], str] = repr) -> tuple[str, ...]:
    """Return the source of a motion and its processing steps, in order. For components, differences are listed by axis.

    The source of a pulse is its exact definition, or the text that `pulse` returns.

    >>> from rocking.motions import pulses
    >>> provenance_of(pulses.sine(3.0, 0.8))[0][:9]
    'Sinusoids'
    """
    if isinstance(motion, Components):
        motion = dict(zip("xyz", motion.parts, strict=True))
    if isinstance(motion, Mapping):
        lines = {axis: provenance_of(component, pulse) for axis, component in motion.items() if component is not None}
        shared, own = _shared(lines)
        return (*(f"{axis}: {line}" for axis, steps in own.items() for line in steps), *shared)
    if isinstance(motion, Pulse):
        return (pulse(motion),)
    return tuple(getattr(motion, "provenance", ())) or (repr(motion),)


def support_of(motion: Any) -> str:
    """Return the support of a motion: "ground", or the floor of a building.

    >>> from rocking.motions import GroundMotion
    >>> support_of(GroundMotion([0.0, 1.0], 0.1))
    'ground'
    """
    return str(getattr(leading(motion), "metadata", {}).get("support", GROUND))


def peak_name(support: str, quantity: str = "A") -> str:
    """Return PGA, or PFA on a floor. For the quantity V, return PGV or PFV.

    >>> peak_name("ground"), peak_name("floor 3 of 5", "V")
    ('PGA', 'PFV')
    """
    return f"P{'G' if support == GROUND else 'F'}{quantity}"


def peak_names(supports: Iterable[str]) -> tuple[str, str]:
    """Return the names of peak acceleration and velocity of motions on these supports.

    >>> peak_names(["floor 3 of 5", "floor 2 of 5"]), peak_names(["ground", "roof"])
    (('PFA', 'PFV'), ('PGA/PFA', 'PGV/PFV'))
    """
    kinds = sorted(set(supports), key=GROUND.__ne__)
    acceleration, velocity = ("/".join(dict.fromkeys(peak_name(kind, quantity) for kind in kinds)) for quantity in "AV")
    return acceleration, velocity


def words_on(support: str, description: str) -> str:
    """Return the name of a measure for motions on a support.

    >>> words_on("floor 3 of 5", "peak ground acceleration")
    'peak floor acceleration, floor 3 of 5'
    """
    return description if support == GROUND else f"{description.replace('peak ground', 'peak floor')}, {support}"


@dataclass(frozen=True)
class MotionSummary:
    """Summary of a motion for results and reports.

    Parameters
    ----------
    name : str
        Name of the motion, or the names of all components.
    support : str
        "ground", or the floor on which the motion acts.
    peak : float
        Peak acceleration of the leading horizontal component [m/s2].
    peak_velocity : float
        Peak velocity of the same component, starting from rest [m/s].
    duration : float
        Duration [s].
    provenance : tuple of str
        Source with the SHA-256 of every file, and all processing steps, in order.
    doubts : tuple of str
        Warnings about implausible accelerations, time steps, velocities and displacements.
    """

    name: str
    support: str
    peak: float
    peak_velocity: float
    duration: float
    provenance: tuple[str, ...]
    doubts: tuple[str, ...] = ()

    @classmethod
    def of(cls, motion: Any) -> "MotionSummary":
        """Return the summary of a motion.

        Parameters
        ----------
        motion : GroundMotion, Pulse, Components, or mapping with x, y and z
            The motion.

        Returns
        -------
        MotionSummary
            Summary of the motion.

        Examples
        --------
        >>> from rocking.motions import pulses
        >>> MotionSummary.of(pulses.sine(3.0, 0.8)).peak
        3.0
        """
        motion = Components(*(motion.get(axis) for axis in "xyz")) if isinstance(motion, Mapping) else motion
        velocity = float(measure("pgv").of(sampled(leading(motion))))
        source = provenance_of(motion, lambda _: "analytical pulse")
        return cls(
            motion.name, support_of(motion), float(motion.peak), velocity, float(motion.duration), source,
            _doubts_of(motion),
        )  # fmt: skip

    def answer(self) -> Answer:
        """Return the summary as an answer.

        Returns
        -------
        Answer
            Name, support, peak acceleration and velocity, duration, provenance.
        """
        return Answer({
            "name": self.name, "support": self.support, "peak_ground_acceleration": self.peak,
            "peak_ground_velocity": self.peak_velocity, "duration": self.duration, "provenance": self.provenance,
            "warnings": self.doubts,
        })  # fmt: skip


def motion_answer(motion: Any, scale: float = 1.0) -> Answer | None:
    """Return the answer of a motion, scaled by a factor [-]; None without a motion."""
    if motion is None:
        return None
    summary, size = MotionSummary.of(motion), abs(scale)
    return summary.answer() | {
        "kind": "pulse" if isinstance(leading(motion), Pulse) else "record",
        "scale": scale,
        "peak_ground_acceleration": size * summary.peak,
        "peak_ground_velocity": size * summary.peak_velocity,
        "warnings": [*plausibility.of_acceleration(size * summary.peak), *summary.doubts]
        if size != 1.0
        else summary.doubts,
    }


def _doubts_of(motion: Any) -> tuple[str, ...]:
    if isinstance(motion, Components):
        parts = zip("xyz", motion.parts, strict=True)
        return tuple(f"{axis}: {doubt}" for axis, part in parts if part is not None for doubt in _doubts_of(part))
    return (*motion.doubts, *(integral_doubts(motion) if isinstance(motion, GroundMotion) else ()))


def summaries_of(motions: Any) -> tuple[MotionSummary, ...]:
    """Return the summaries of the motions of a sequence or set."""
    return tuple(MotionSummary.of(motions[k]) for k in range(len(motions)))


_CONDITIONS = {
    "ground": (
        "given this motion ({peak}; {velocity})",
        "given these {count} motions ({peak}; {velocity}: medians and ranges)",
    ),
    "floor": (
        "given this motion of {support} ({peak}; {velocity})",
        "given these {count} motions of {support} ({peak}; {velocity}: medians and ranges)",
    ),
}


def condition(summaries: Sequence[MotionSummary]) -> Message:
    """Return the condition of a probability as text: the motions and their intensity.

    >>> from rocking.motions import pulses
    >>> condition([MotionSummary.of(pulses.sine(2.94, 0.8))])[:26]
    'given this motion (PGA 0.3'
    """
    supports = {summary.support for summary in summaries}
    support = next(iter(supports)) if len(supports) == 1 else GROUND
    peaks = _median_and_range([summary.peak / g for summary in summaries], "g")
    velocities = _median_and_range([summary.peak_velocity for summary in summaries], "m/s")
    facts = {
        "support": support, "count": len(summaries),
        "peak": f"{peak_name(support)} {peaks}", "velocity": f"{peak_name(support, 'V')} {velocities}",
    }  # fmt: skip
    single, many = _CONDITIONS["ground" if support == GROUND else "floor"]
    return Message(single if len(summaries) == 1 else many, facts)


def provenance_rows(summaries: Sequence[MotionSummary]) -> list[tuple[str, str]]:
    """Return sources and processing steps as rows of motion and text. Steps common to all motions have one row."""
    if len(summaries) == 1:
        return [(summaries[0].name, listed(summaries[0].provenance))]
    shared, own = _shared(dict(enumerate(summary.provenance for summary in summaries)))
    rows = [(summaries[index].name, listed(lines)) for index, lines in own.items() if lines]
    return [*rows, *([(f"all {len(summaries)} motions", listed(shared))] if shared else [])]


def short_provenance(summaries: Sequence[MotionSummary]) -> list[tuple[str, str]]:
    """Return the rows of `provenance_rows` for a terminal. For many motions, only files and common steps."""
    rows = provenance_rows(summaries)
    if len(summaries) <= _SHOWN_NAMES:
        return rows
    files = [row for row in rows if "SHA-256" in row[1] or row[0].startswith("all ")]
    shown = files[-_MOST_ROWS:]
    remaining = len(rows) - len(shown)
    hint = "use --json for the source and each step of every motion"
    return [*shown, *([(f"{remaining} motions", hint)] if remaining else [])]


def _shared(lines: Mapping[Any, Sequence[str]]) -> tuple[list[str], dict[Any, list[str]]]:
    """Return the lines common to all sequences, and the other lines of every sequence by its key."""
    first, *others = lines.values() or [()]
    shared = [line for line in first if all(line in other for other in others)] if others else []
    return shared, {key: [line for line in own if line not in shared] for key, own in lines.items()}


def _median_and_range(values: Sequence[float], unit: str) -> str:
    low, middle, high = min(values), float(np.median(values)), max(values)
    if f"{low:.3g}" == f"{high:.3g}":
        return f"{middle:.3g} {unit}"
    return f"{middle:.3g} {unit}, {low:.3g} to {high:.3g} {unit}"
