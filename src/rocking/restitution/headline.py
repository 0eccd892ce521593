"""The sentence that names the restitution model of a result, and the reason for it."""

from rocking.conventions import DEFAULT_RESTITUTION
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
_STATED = "Restitution model of the result: {model}, as stated in the input."


def headline(label: str, *, in_space: bool = False) -> Message:
    """Return the sentence with the model of a result and its reason; in_space: True for a 3D body.

    >>> str(headline("ked"))
    'Restitution model of the result: ked, as stated in the input.'
    """
    name = label.removesuffix("-3d")
    if name != DEFAULT_RESTITUTION:
        return Message(_STATED, {"model": label})
    model = f"{name}-3d" if in_space else label
    return Message(_DEFAULT if model == name else _DEFAULT_3D, {"model": model, "count": len(kept(KEPT)["unseen"])})
