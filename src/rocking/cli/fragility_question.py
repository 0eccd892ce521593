"""The question of `rocking fragility`: which body, which motions, which levels, and what is counted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.cli import output
from rocking.cli.inputs import is_body, motion_from
from rocking.cli.simulate_question import refuse_reversed, restitution_from
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.intensity import IntensityMeasure, measure
from rocking.studies.fragility.subject import Subject, checked_levels, limit_states
from rocking.studies.motion_sets import MotionList

if TYPE_CHECKING:
    from rocking.studies.sensitivity import Sensitivity

ANALYSES = ("stripes", "cloud", "incremental")
MOST_HISTORIES = 10_000_000
"""A larger analysis is a campaign."""

_REACH = (0.9, 9.0, 16)
"""Levels of PGA that serve where none are given: from, to in what lifts the body, how many, in equal ratios."""

COUNT, SEED = 100, 1
"""What serves where nobody says otherwise."""

MOST_MOTIONS = 5000
"""All of them are held in memory."""

_SOURCES = ("record", "synthetic", "count", "seed")


@dataclass(frozen=True)
class FragilityQuestion:
    """An analysis that has been asked for."""

    body: Body
    analysis: str  # which one
    measure: IntensityMeasure
    # levels of the measure; None for a cloud, or for those that serve where none are given [its unit]
    levels: FloatArray | None
    written: str  # unit that the levels were written in, empty if none; medians are printed in it
    states: tuple[float, ...]  # rotations over alpha [-]
    factor: float  # factor on all motions of a cloud [-]
    restitutions: dict[str, Any]  # by the word that was given, the first one first
    settings: dict[str, Any]  # as of `rocking.cli.output.settings_from`

    @property
    def unit(self) -> tuple[str, float]:
        """Unit that the levels were written in, that of the measure if in none, and its size."""
        unit, written = self.measure.unit, self.written
        return (written, output.UNITS[unit][written]) if written else (unit, 1.0)

    @classmethod
    def of(
        cls, body: Body, asked: dict[str, Any], restitution: Sequence[str] | None, settings: dict[str, Any]
    ) -> "FragilityQuestion":
        """Put the question together; everything but the motions is checked here."""
        kind, wanted = checks.one_of("--analysis", asked["analysis"], ANALYSES), measure(asked["measure"])
        words = list(restitution or ["ked"])
        twice = next((word for word in words if words.count(word) > 1), None)
        if twice is not None:
            raise InvalidValueError(f"--restitution {twice[:60]} is given twice")
        if len(words) > 1 and kind != "stripes":
            raise InvalidValueError(f"several --restitution are compared by --analysis stripes, not by {kind}")
        levels, written = _levels(kind, wanted, asked["levels"])
        rotations = tuple(output.row("--states", asked["states"], "1")[0].tolist())
        limit_states(rotations)
        if asked["factor"] is not None and kind != "cloud":
            raise InvalidValueError(f"--factor is for --analysis cloud: {kind} brings every motion to the levels")
        factor = checks.positive("--factor", 1.0 if asked["factor"] is None else asked["factor"])
        choices = {word: restitution_from(word) for word in words}
        return cls(body, kind, wanted, levels, written, rotations, factor, choices, settings)

    def answered(self, sources: dict[str, Any], told: dict[str, Any], quiet: bool) -> "FragilityAnswer":
        """Make the motions and compute."""
        motions, facts = motions_from(sources, told, quiet=quiet)
        levels = self._levels(motions)
        total = len(motions) * (1 if levels is None else levels.size) * len(self.restitutions)
        if total > MOST_HISTORIES:
            raise InvalidValueError(
                f"there must be at most {MOST_HISTORIES} histories, got {total}; rocking campaign computes more"
            )
        with output.bar("histories", total, quiet=quiet) as tell:
            found, compared = self._computed(motions, levels, tell)
        return FragilityAnswer(self, facts, found, compared)

    def _levels(self, motions: MotionList) -> FloatArray | None:
        if self.analysis == "cloud" or self.levels is not None:
            return self.levels
        options = {name: value for name, value in self.settings.items() if name != "threads"}
        subject = Subject.of(self.body, motions, next(iter(self.restitutions.values())), self.measure, options)
        low, high, count = _REACH
        lifts = 1.0 if self.measure.uplift is None else self.measure.uplift(subject.scale)
        return np.geomspace(low * lifts, high * lifts, count)

    def _computed(
        self, motions: MotionList, levels: FloatArray | None, tell: Callable[[int], None]
    ) -> tuple[Any, "Sensitivity | None"]:
        from rocking.studies.fragility import cloud, incremental_dynamic_analysis, multiple_stripe_analysis
        from rocking.studies.sensitivity import fragility_sensitivity

        options = {**self.settings, "measure": self.measure, "states": self.states, "progress": tell}
        first = next(iter(self.restitutions))
        if len(self.restitutions) > 1:
            compared = fragility_sensitivity(self.body, motions, levels, self.restitutions, **options)
            return compared.results[first], compared
        law = self.restitutions[first]
        if self.analysis == "cloud":
            return cloud(self.body, motions, law, factor=self.factor, **options), None
        study = multiple_stripe_analysis if self.analysis == "stripes" else incremental_dynamic_analysis
        return study(self.body, motions, levels, law, **options), None


@dataclass(frozen=True, eq=False)
class FragilityAnswer:
    """What was found."""

    question: FragilityQuestion  # what was asked
    motions: dict[str, Any]  # where the motions come from, as plain values
    found: Any  # the analysis with the first restitution
    compared: "Sensitivity | None"  # those with all restitutions, where there are several

    @property
    def results(self) -> dict[str, Any]:
        """The analyses by their restitution."""
        if self.compared is not None:
            return self.compared.results
        return {next(iter(self.question.restitutions)): self.found}


def _levels(kind: str, wanted: IntensityMeasure, word: str | None) -> tuple[FloatArray | None, str]:
    if kind == "cloud":
        if word is not None:
            raise InvalidValueError("--levels is not for --analysis cloud, which takes the motions as they are")
        return None, "g" if wanted.name == "pga" else ""
    if wanted.power == 0:
        raise InvalidValueError(f"no factor on a motion changes {wanted.name}: take it with --analysis cloud")
    if word is None:
        if wanted.uplift is None:
            raise InvalidValueError(f"which levels of {wanted.name}? Give --levels FIRST:LAST:COUNT in {wanted.unit}")
        return None, "g" if wanted.name == "pga" else ""
    values, written = output.row("--levels", word, "1" if wanted.unit == "-" else wanted.unit)
    return checked_levels("--levels", values, wanted.unit), written


def body_and_records(body: str | None, motions: list[str], *, sized: bool) -> tuple[Path | None, list[str]]:
    """Return which word names the body and which ones the motions."""
    if sized and body is not None and not is_body(body):
        return None, [body, *motions]
    for motion in motions:
        refuse_reversed(body, motion)
    return None if body is None else Path(body), motions


def motions_from(
    sources: dict[str, Any], told: dict[str, Any], *, quiet: bool = False
) -> tuple[MotionList, dict[str, Any]]:
    """Return the motions that a command was given.

    Returns facts: kind, count, and family and seed, or names.
    """
    from rocking.motions.pulse import Pulse
    from rocking.studies.motion_sets import SyntheticSet

    records, synthetic, count, seed = (sources[name] for name in _SOURCES)
    if records:
        _refuse(
            {f"--{name}": sources[name] for name in _SOURCES[1:]}, "synthetic motions: leave it out beside --record"
        )
        found = MotionList([motion_from(word, **told) for word in records])
        kind = "pulses" if isinstance(found[0], Pulse) else "records"
        return found, {"kind": kind, "count": len(found), "names": [found[k].name for k in range(len(found))]}
    given = {"--" + name.replace("_", "-"): value for name, value in told.items()}
    _refuse(given, "record files: leave it out, or give --record")
    if synthetic is None:
        raise InvalidValueError("what shakes it? Give --record FILE, or --synthetic firm-ground")
    number = COUNT if count is None else count
    if not 1 <= number <= MOST_MOTIONS:
        raise InvalidValueError(f"--count must be in [1, {MOST_MOTIONS}], got {number}; rocking campaign takes more")
    family = SyntheticSet(synthetic, number, SEED if seed is None else seed)
    made = []
    with output.bar("motions", number, quiet=quiet) as tell:
        for k in range(number):
            made.append(family[k])
            tell(1)
    return MotionList(made), {"kind": "synthetic", "count": number, "family": family.family.name, "seed": family.seed}


def _refuse(given: dict[str, Any], whose: str) -> None:
    odd = [name for name, value in given.items() if value is not None]
    if odd:
        raise InvalidValueError(f"{', '.join(odd)} is for {whose}")
