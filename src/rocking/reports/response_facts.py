"""Agreement of several models, text of a restitution, and data of a motion."""

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
    Outcome.OVERTURNED: Message("The body overturns with all of these models."),
    Outcome.ROCKED: Message("The body does not overturn with any of these models."),
    Outcome.NO_UPLIFT: Message("The body has no uplift with any of these models."),
}
_SOME = {
    Outcome.OVERTURNED: Message("overturns with {models}"),
    Outcome.ROCKED: Message("does not overturn with {models}"),
    Outcome.NO_UPLIFT: Message("has no uplift with {models}"),
}
_ROCKING = "The body still rocks at the end of the computation with {models}."
_PULLED = "The contact force becomes tensile with {models}; the verdict assumes contact."
_EQUALS = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"


@dataclass(frozen=True, slots=True)
class ModelAgreement:
    """Agreement of the outcomes of several models."""

    models_differ: bool  # True if the outcomes differ
    verdict: str  # the agreement as a sentence
    doubts: tuple[str, ...]  # limitations of the computation

    @property
    def sentence(self) -> str:
        """Verdict and doubts."""
        return " ".join([self.verdict, *self.doubts])

    @classmethod
    def of(cls, responses: Mapping[str, Response]) -> "ModelAgreement":
        groups: dict[Outcome, list[str]] = {}
        for name, response in responses.items():
            groups.setdefault(response.outcome, []).append(name)
        rocking = ", ".join(name for name, response in responses.items() if response.still_rocking)
        pulled = ", ".join(name for name, response in responses.items() if response.lost_contact)
        doubts = [Message(_ROCKING, {"models": rocking})] if rocking else []
        if pulled:
            doubts.append(Message(_PULLED, {"models": pulled}))
        if len(groups) == 1:
            (outcome,) = groups
            return cls(False, _ALL[outcome], tuple(doubts))
        first, *others = (_SOME[outcome].of({"models": ", ".join(names)}) for outcome, names in groups.items())
        for other in others:
            first = Message("{first}, {second}", {"first": first, "second": other})
        return cls(
            True,
            Message("The result depends on the restitution model: the body {outcomes}.", {"outcomes": first}),
            tuple(doubts),
        )


def restitution_words(label: str) -> str:
    """Return the name of a restitution: the short name of a model, or the symbol and value of a coefficient.

    >>> restitution_words("ked"), restitution_words("shifted-impulse:k=0.6").replace(chr(160), " ")
    ('KED', 'shifted impulse, k = 0.6')
    >>> restitution_words("0.9"), restitution_words("left 0.9, right 0.8")
    ('r = 0.9', 'r: left 0.9, right 0.8')
    """
    factor, _, model = label.rpartition("*")
    name, _, parameters = model.partition(":")
    if name in (kinds := models()) and kinds[name].short_name:
        named = [
            kinds[name].short_name,
            *(parameter.strip().replace("=", _EQUALS) for parameter in parameters.split(",") if parameter),
        ]
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
    """Return the intensity measures of a motion. Peaks of a pulse result from its formulas."""
    measures = intensity_measures(samples)
    if not isinstance(motion, Pulse):
        return measures
    # the formulas give these three measures exactly
    peaks = (traces(motion) if curves is None else curves).peaks
    exact = {f"pg{name[0]}": abs(value) for name, (_, value) in peaks.items()}
    return measures | {key: replace(measures[key], value=value) for key, value in exact.items()}


def measure_quantities(measures: Mapping[str, Measure]) -> dict[str, Quantity]:
    """Return the quantities of intensity measures."""
    return {
        name: Quantity(name, "1" if measure.unit == "-" else measure.unit, measure.name, digits=".5g")
        for name, measure in measures.items()
    }


def record_answer(motion: GroundMotion | Pulse, samples: GroundMotion, measures: dict[str, Measure]) -> Answer:
    """Return source, duration and intensity of a motion."""
    is_record = isinstance(motion, GroundMotion)
    metadata = motion.metadata if isinstance(motion, GroundMotion) else {}
    return Answer(
        {
            "kind": "record" if is_record else "pulse",
            "name": motion.name,
            **{key: metadata.get(key) for key in ("format", "event", "station", "component")},
            "vertical_component": metadata.get("vertical component"),
            "file_unit": metadata.get("unit"),
            "samples": len(samples) if is_record else None,
            "time_step": samples.time_step if is_record else None,
            "duration": motion.duration,
            "warnings": motion.doubts,
            "provenance": provenance_of(motion),
            "peak_vertical_acceleration": None if samples.vertical is None else samples.peak_vertical,
            "intensity": {name: measure.value for name, measure in measures.items()},
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
