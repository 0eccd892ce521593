"""The interface factor: additional energy loss by mortar, tape, dust or rubber."""

from dataclasses import dataclass
from typing import ClassVar

from rocking import checks
from rocking.bodies import Body, Frame
from rocking.conventions import FloatArray, Foot
from rocking.errors import UnknownModelError
from rocking.restitution._model import RestitutionModel


@dataclass(frozen=True)
class Interface(RestitutionModel):
    """Model times an interface factor: ``r = eta * r_model``.

    Parameters
    ----------
    model : RestitutionModel
        The geometric model.
    eta : float
        Interface factor in (0, 1] [-].

    Raises
    ------
    InvalidValueError
        If eta is outside (0, 1].
    UnknownModelError
        If `model` is not a model object.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution import Housner
    >>> round(Interface(Housner(), eta=0.9).coefficient(Block(width=1.0, height=2.0)), 12)
    0.63
    """

    model: RestitutionModel
    eta: float

    name: ClassVar[str] = "interface"
    title: ClassVar[str] = "a geometric model times an interface factor"
    reference: ClassVar[str] = "this project"
    sees_old_foot: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Raise an error for a factor that would create energy."""
        wrapped: object = self.model
        if not isinstance(wrapped, RestitutionModel):
            raise UnknownModelError(
                "{parameter} of a factor must be a model object, got {value}",
                parameter="model",
                value=wrapped,
            )
        checks.within("eta", self.eta, 0.0, 1.0, open_low=True, hint="the interface factor only reduces energy")
        for name in ("assumptions", "domain", "known_defects", "inertia_only", "keeps_energy"):
            object.__setattr__(self, name, getattr(self.model, name))
        object.__setattr__(self, "sees_old_foot", self.eta == 1.0 and self.model.sees_old_foot)
        object.__setattr__(self, "slender_limit", self.eta * self.model.slender_limit)

    @property
    def parameters(self) -> dict[str, float]:
        return {**self.model.parameters, "eta": self.eta}

    @property
    def label(self) -> str:
        """Factor and wrapped model, such as ``0.98*ked``."""
        return f"{self.eta:.4g}*{self.model.label}"

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        return self.eta * self.model.raw_coefficient(body, foot)  # Eq. 112

    def of_frame(self, frame: Frame, foot: Foot) -> float:
        return self.eta * self.model.of_frame(frame, foot)  # Eq. 112

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        return self.eta * self.model.raw_of_slenderness(slenderness)  # Eq. 112
