"""What answers and reports state of a motion: its support, its intensity, its source and each processing step."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import g
from rocking.motions.components import Components, leading
from rocking.motions.intensity import measure, sampled
from rocking.motions.pulse import Pulse

GROUND = "ground"
"""Support of a motion that is not that of a floor."""

_MOST_ROWS = 12
_SHOWN_NAMES = 4


def provenance_of(motion: Any, pulse: Callable[[Pulse], str] = repr) -> tuple[str, ...]:
    """Return the source of a motion and each processing step, in order; of components what differs by axis.

    The source of a pulse is its exact definition, or the text that `pulse` returns.

    >>> from rocking.motions import pulses
    >>> provenance_of(pulses.sine(3.0, 0.8))[0][:9]
    'Sinusoids'
    """
    if isinstance(motion, Components):
        motion = dict(zip("xyz", motion.parts, strict=True))
    if isinstance(motion, Mapping):
        lines = {axis: provenance_of(part, pulse) for axis, part in motion.items() if part is not None}
        shared, own = _shared(lines)
        return (*(f"{axis}: {line}" for axis, each in own.items() for line in each), *shared)
    if isinstance(motion, Pulse):
        return (pulse(motion),)
    return tuple(getattr(motion, "provenance", ())) or (repr(motion),)


def support_of(motion: Any) -> str:
    """Return where a motion acts: "ground", or the floor of a building.

    >>> from rocking.motions import GroundMotion
    >>> support_of(GroundMotion([0.0, 1.0], 0.1))
    'ground'
    """
    return str(getattr(leading(motion), "metadata", {}).get("support", GROUND))


def peak_name(support: str, quantity: str = "A") -> str:
    """Return PGA, or PFA on a floor; quantity V: PGV or PFV.

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
    acceleration, velocity = ("/".join(dict.fromkeys(peak_name(each, of) for each in kinds)) for of in "AV")
    return acceleration, velocity


def words_on(support: str, words: str) -> str:
    """Return the words of a measure of motions on a support.

    >>> words_on("floor 3 of 5", "peak ground acceleration")
    'peak floor acceleration, floor 3 of 5'
    """
    return words if support == GROUND else f"{words.replace('peak ground', 'peak floor')}, {support}"


@dataclass(frozen=True)
class MotionSummary:
    """What answers and reports state of a motion.

    Parameters
    ----------
    name : str
        Name of the motion; of components the names of all.
    support : str
        "ground", or the floor on which it acts.
    peak : float
        Peak acceleration of the leading horizontal component [m/s2].
    peak_velocity : float
        Peak velocity of the same component, from rest [m/s].
    duration : float
        Duration [s].
    provenance : tuple of str
        Source, with the SHA-256 of each file, and each processing step, in order.
    """

    name: str
    support: str
    peak: float
    peak_velocity: float
    duration: float
    provenance: tuple[str, ...]

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
            Its summary.

        Examples
        --------
        >>> from rocking.motions import pulses
        >>> MotionSummary.of(pulses.sine(3.0, 0.8)).peak
        3.0
        """
        whole = Components(*(motion.get(axis) for axis in "xyz")) if isinstance(motion, Mapping) else motion
        first = leading(whole)
        velocity = float(measure("pgv").of(sampled(first)))
        source = provenance_of(whole, lambda _: "analytical pulse")
        return cls(whole.name, support_of(whole), float(whole.peak), velocity, float(whole.duration), source)

    def as_dict(self) -> dict[str, Any]:
        """Return the summary as plain values.

        Returns
        -------
        dict
            Values in SI units, named in the keys.
        """
        return {
            "name": self.name, "support": self.support, "peak_acceleration_m_s2": self.peak,
            "peak_velocity_m_s": self.peak_velocity, "duration_s": self.duration, "provenance": list(self.provenance),
        }  # fmt: skip


def summaries_of(motions: Any) -> tuple[MotionSummary, ...]:
    """Return the summary of each motion of a sequence or set."""
    return tuple(MotionSummary.of(motions[k]) for k in range(len(motions)))


def condition(found: Sequence[MotionSummary]) -> str:
    """Return the condition under which a probability holds: the motions and their intensity, in words.

    >>> from rocking.motions import pulses
    >>> condition([MotionSummary.of(pulses.sine(2.94, 0.8))])[:26]
    'given this motion (PGA 0.3'
    """
    supports = dict.fromkeys(each.support for each in found)
    support = next(iter(supports)) if len(supports) == 1 else GROUND
    peaks = _median_and_range([each.peak / g for each in found], "g")
    speeds = _median_and_range([each.peak_velocity for each in found], "m/s")
    where = "" if support == GROUND else f" of {support}"
    words = f"{peak_name(support)} {peaks}; {peak_name(support, 'V')} {speeds}"
    if len(found) == 1:
        return f"given this motion{where} ({words})"
    return f"given these {len(found)} motions{where} ({words}: medians and ranges)"


def provenance_rows(found: Sequence[MotionSummary]) -> list[tuple[str, str]]:
    """Return sources and processing steps as rows of motion and text; what all motions share stands in one row."""
    if len(found) == 1:
        return [(found[0].name, "; ".join(found[0].provenance))]
    keys = {f"{k}": each.provenance for k, each in enumerate(found)}
    shared, own = _shared(keys)
    rows = [(found[int(k)].name, "; ".join(each)) for k, each in own.items() if each]
    return [*rows, *([(f"all {len(found)} motions", "; ".join(shared))] if shared else [])]


def short_provenance(found: Sequence[MotionSummary]) -> list[tuple[str, str]]:
    """Return the rows of `provenance_rows` that a terminal shows: of many motions the files and the shared steps."""
    rows = provenance_rows(found)
    if len(found) <= _SHOWN_NAMES:
        return rows
    files = [row for row in rows if "SHA-256" in row[1] or row[0].startswith("all ")]
    shown = files[-_MOST_ROWS:]
    left = len(rows) - len(shown)
    return [*shown, *([(f"{left} motions", "--json lists the source and each step of every motion")] if left else [])]


def _shared(lines: Mapping[str, Sequence[str]]) -> tuple[list[str], dict[str, list[str]]]:
    """Return the lines that all have, and the other lines of each."""
    every = list(lines.values())
    shared = [line for line in every[0] if all(line in each for each in every[1:])] if len(every) > 1 else []
    return shared, {name: [line for line in each if line not in shared] for name, each in lines.items()}


def _median_and_range(values: Sequence[float], unit: str) -> str:
    low, middle, high = min(values), float(np.median(values)), max(values)
    if f"{low:.3g}" == f"{high:.3g}":
        return f"{middle:.3g} {unit}"
    return f"{middle:.3g} {unit}, {low:.3g} to {high:.3g} {unit}"
