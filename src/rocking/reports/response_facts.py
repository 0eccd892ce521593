"""What several models say together, a restitution in words, and what is shown of a motion."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from rocking.answers import Answer
from rocking.dynamics.response import Response
from rocking.messages import Message
from rocking.motions.intensity import Measure, intensity_measures
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.spectrum import ResponseSpectrum
from rocking.motions.summary import provenance_of
from rocking.outcome import Outcome
from rocking.plots.labels import Traces, traces
from rocking.quantities import Quantity
from rocking.restitution import models

_ALL = {
    Outcome.OVERTURNED: Message("With every one of these models the body overturns."),
    Outcome.ROCKED: Message("With every one of these models the body stays standing."),
    Outcome.NO_UPLIFT: Message("With every one of these models the body is never lifted."),
}
_SOME = {
    Outcome.OVERTURNED: Message("overturns with {models}"),
    Outcome.ROCKED: Message("stays standing with {models}"),
    Outcome.NO_UPLIFT: Message("is never lifted with {models}"),
}
_ROCKING = "Still rocking when the computation ends: with {models}."
_PULLED = "The ground would have to pull, and the verdict assumes contact: with {models}."
_EQUALS = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"


@dataclass(frozen=True, slots=True)
class ModelAgreement:
    """What the models say together."""

    decides: bool  # whether they end differently
    verdict: str  # the same in words
    doubts: tuple[str, ...]  # about the computation

    @property
    def sentence(self) -> str:
        """Verdict and doubts."""
        return " ".join([self.verdict, *self.doubts])

    @classmethod
    def of(cls, responses: Mapping[str, Response]) -> "ModelAgreement":
        groups: dict[Outcome, list[str]] = {}
        for name, one in responses.items():
            groups.setdefault(one.outcome, []).append(name)
        rocking = ", ".join(name for name, one in responses.items() if one.still_rocking)
        pulled = ", ".join(name for name, one in responses.items() if one.lost_contact)
        doubts = [Message(_ROCKING, {"models": rocking})] if rocking else []
        if pulled:
            doubts.append(Message(_PULLED, {"models": pulled}))
        if len(groups) == 1:
            (outcome,) = groups
            return cls(False, _ALL[outcome], tuple(doubts))
        first, *others = (_SOME[outcome].of({"models": ", ".join(names)}) for outcome, names in groups.items())
        for other in others:
            first = Message("{first}, {second}", {"first": first, "second": other})
        return cls(True, Message("The model decides: the body {outcomes}.", {"outcomes": first}), tuple(doubts))


def restitution_words(label: str) -> str:
    """Return what a restitution is called: a model by its short name, a coefficient with its symbol.

    >>> restitution_words("ked"), restitution_words("shifted-impulse:k=0.6").replace(chr(160), " ")
    ('KED', 'shifted impulse, k = 0.6')
    >>> restitution_words("0.9"), restitution_words("left 0.9, right 0.8")
    ('r = 0.9', 'r: left 0.9, right 0.8')
    """
    factor, _, model = label.rpartition("*")
    name, _, parameters = model.partition(":")
    if name in (kinds := models()) and kinds[name].short_name:
        named = [kinds[name].short_name, *(one.strip().replace("=", _EQUALS) for one in parameters.split(",") if one)]
        times = f"{factor}\N{NO-BREAK SPACE}\N{MULTIPLICATION SIGN}\N{NO-BREAK SPACE}" if factor else ""
        return times + ", ".join(named)
    if label.startswith("left "):
        return f"r: {label}"
    try:
        float(label)
    except ValueError:
        return label
    return f"r = {label}"


def measures_of(
    motion: GroundMotion | Pulse, samples: GroundMotion, curves: Traces | None = None
) -> dict[str, Measure]:
    """Return the intensity measures of a motion; those of a pulse that its formulas give come from these."""
    measures = intensity_measures(samples)
    if not isinstance(motion, Pulse):
        return measures
    # these three are known from the formulas, not only from samples
    peaks = (traces(motion) if curves is None else curves).peaks
    exact = {f"pg{name[0]}": abs(value) for name, (_, value) in peaks.items()}
    return measures | {key: replace(measures[key], value=value) for key, value in exact.items()}


def measure_quantities(measures: Mapping[str, Measure]) -> dict[str, Quantity]:
    """Return the quantities of intensity measures."""
    return {
        name: Quantity(name, "1" if one.unit == "-" else one.unit, one.name, digits=".5g")
        for name, one in measures.items()
    }


def record_answer(motion: GroundMotion | Pulse, samples: GroundMotion, measures: dict[str, Measure]) -> Answer:
    """Return what a motion is and how strong."""
    record = isinstance(motion, GroundMotion)
    metadata = motion.metadata if isinstance(motion, GroundMotion) else {}
    return Answer(
        {
            "kind": "record" if record else "pulse",
            "name": motion.name,
            **{key: metadata.get(key) for key in ("format", "event", "station", "component")},
            "vertical_component": metadata.get("vertical component"),
            "file_unit": metadata.get("unit"),
            "samples": len(samples) if record else None,
            "time_step": samples.time_step if record else None,
            "duration": motion.duration,
            "warnings": motion.doubts,
            "provenance": provenance_of(motion),
            "peak_vertical_acceleration": None if samples.vertical is None else samples.peak_vertical,
            "intensity": {name: one.value for name, one in measures.items()},
        },
        measure_quantities(measures),
    )


def spectrum_answer(spectrum: ResponseSpectrum) -> Answer:
    """Return a response spectrum."""
    return Answer({
        "damping_ratio": spectrum.damping,
        "period": spectrum.periods,
        "pseudo_acceleration": spectrum.pseudo_acceleration,
        "pseudo_velocity": spectrum.pseudo_velocity,
        "spectral_displacement": spectrum.displacement,
        "absolute_acceleration": spectrum.absolute_acceleration,
    })  # fmt: skip
