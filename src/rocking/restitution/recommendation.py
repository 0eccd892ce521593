"""Which restitution model to use for a body: asked here, answered by the room that knows the measurements."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rocking.lazy import presenter
from rocking.restitution.model import RestitutionModel

if TYPE_CHECKING:
    from rocking.bodies import Body, Solid
    from rocking.evidence import DataSet, Recommendation


def recommend(
    body: "Body | Solid",
    motion: Any = None,
    *,
    models: Sequence[str | RestitutionModel] | None = None,
    measurements: "DataSet | None" = None,
) -> "Recommendation":
    """Return which restitution model to use for a body, and how sure that is.

    The rule is one of the measurements, and nobody's opinion. Models stand against the measurements of similar
    slenderness; one whose error is above that of the closest by a 95 % paired bootstrap interval, and by more than the
    measurements were rounded, is set aside, unless the body is outside of what was measured. For a number the
    calibrated default is taken, which is judged by groups that it has not seen; where it is set aside, the closest
    model that remains. For a decision its scatter is drawn, and the models of the lowest and of the highest coefficient
    that remain are run beside it.

    Parameters
    ----------
    body : Body or Solid
        The body. No body in space was measured: of a Solid it is said what is known.
    motion : GroundMotion or Pulse, optional
        A motion, for the verdict under every model and under coefficients that scatter; of bodies in the plane.
    models : sequence of str or RestitutionModel, optional
        Models to judge, which may be your own; every registered one if not given.
    measurements : DataSet, optional
        What was measured, if not the 39 published coefficients; the calibrated default is then fitted to it, which
        takes a second.

    Returns
    -------
    Recommendation
        Models side by side, the model for a number and those for a decision, in words by `print`.

    Raises
    ------
    InvalidValueError
        If the body is none, a model is a value given by hand, or a motion is given for a body in space.
    UnknownModelError
        If there is no model of a name.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.restitution.recommend(rk.Block(width=0.02, height=0.16, depth=0.02))
    >>> found.prediction, found["calibrated"].standing.value
    ('calibrated', 'closest')
    >>> [each.name for each in found.models if each.name in found.remaining]
    ['calibrated', 'housner']
    """
    found: Recommendation = presenter("recommendation")(body, motion, models, measurements)
    return found
