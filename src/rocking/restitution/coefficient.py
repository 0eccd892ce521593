"""The one-line question: the coefficient of restitution of a body under a model."""

from typing import Any

from rocking.bodies import Body
from rocking.conventions import Foot
from rocking.restitution.model import RestitutionModel
from rocking.restitution.registry import model as find


def coefficient_of_restitution(
    body: Body,
    model: str | RestitutionModel,
    *,
    onto: Foot = "right",
    eta: float = 1.0,
    **parameters: Any,
) -> float:
    """Return the coefficient of restitution of a body under a model.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    model : str or RestitutionModel
        Name of a model (see `rocking.restitution.models`) or a model object, which may be your own.
    onto : {"left", "right"}
        The foot on which the body lands.
    eta : float
        Interface factor in (0, 1] that multiplies the model's coefficient [-].
    **parameters
        The model's parameters: ``k``, ``q`` or ``r``.

    Returns
    -------
    float
        theta_dot_after / theta_dot_before; zero where the body stops instead of stepping on [-].

    Raises
    ------
    UnknownModelError
        If the model or a parameter is unknown.
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0)
    >>> round(rk.coefficient_of_restitution(block, "ked"), 8)
    0.94736684
    >>> round(rk.coefficient_of_restitution(block, "shifted-impulse", k=0.6), 8)
    0.94610778
    """
    return find(model, eta=eta, **parameters).coefficient(body, onto)
