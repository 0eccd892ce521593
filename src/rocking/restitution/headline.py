"""Sentence with the restitution model of a result and the reason for the model."""

from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION, FRAME_RESTITUTION
from rocking.messages import Message
from rocking.restitution.calibrated import KEPT, kept

_DEFAULT = (
    "Restitution model of the result: {model}. It is the default because it is fitted to {count} published "
    "measurements."
)
_DEFAULT_3D = (
    "Restitution model of the result: {model}. It is the default because its plane form is fitted to {count} "
    "published measurements; there is no measurement in 3D."
)
_FRAME = (
    "Restitution model of the result: {model}, Housner's model with impulses at both ends of each column. There are no "
    "published measurements of frames."
)
_STATED = "Restitution model of the result: {model}, as stated in the input."
_ASSESSED = (
    "The margin is the smallest of all restitution models ({case}). The probability uses the default, {model}, which "
    "is fitted to {count} published measurements."
)
_ASSESSED_3D = (
    "The margin is the smallest of all restitution models ({case}). The probability uses the default, {model}, whose "
    "plane form is fitted to {count} published measurements; there is no measurement in 3D."
)
_ASSESSED_STATED = (
    "The margin is the smallest of all restitution models ({case}). The probability uses {model}, as stated in the "
    "input."
)


def label_of(name: str, *, in_space: bool) -> str:
    """Return the label of a restitution model in a result. `in_space` is True for a 3D body.

    >>> label_of("ked", in_space=True), label_of("ked", in_space=False), label_of("0.9", in_space=True)
    ('ked-3d', 'ked', '0.9')
    """
    return f"{name}-3d" if in_space and name in {DEFAULT_RESTITUTION, *COMPARED_RESTITUTIONS} else name


def headline(label: str, *, in_space: bool = False, is_stated: bool = False, case: str = "") -> Message:
    """Return the sentence with the model of a result and its reason; `case` is the restitution of a margin.

    `in_space` is True for a 3D body, `is_stated` for a model that the input states.

    >>> str(headline("ked")), str(headline("calibrated", is_stated=True))[-23:]
    ('Restitution model of the result: ked, as stated in the input.', 'as stated in the input.')
    """
    if label == FRAME_RESTITUTION and not case:
        return Message(_FRAME, {"model": Message(FRAME_RESTITUTION)})
    name = label.removesuffix("-3d")
    model = label_of(name, in_space=True) if in_space and name == DEFAULT_RESTITUTION else label
    facts: dict[str, str | int] = {"model": model, **({"case": case} if case else {})}
    if is_stated or name != DEFAULT_RESTITUTION:
        return Message(_ASSESSED_STATED if case else _STATED, facts)
    facts["count"] = len(kept(KEPT)["unseen"])
    if model == name:
        return Message(_ASSESSED if case else _DEFAULT, facts)
    return Message(_ASSESSED_3D if case else _DEFAULT_3D, facts)
