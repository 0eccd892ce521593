"""Base classes of restitution models: coefficient of an impact, reference, assumptions, domain and defects."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from enum import Enum
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body, Frame
from rocking.conventions import BoolArray, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.restitution.impact import ImpactGeometry

_PIECE = 16384
_FLATTEST, _TALLEST = 1e-18, 1e18


class Flag(Enum):
    """Reason why a coefficient differs from the equation of its model. The value is a sentence for reports."""

    STOPS = Message("the model gives r <= 0: the body stops at the impact (r = 0) and does not step onto the new foot")


@dataclass(frozen=True, slots=True)
class Restitution:
    """Coefficient of restitution with its model and flags.

    Parameters
    ----------
    model : RestitutionModel
        The model.
    raw : float
        Value of the equation of the model [-]. It may be outside the domain of the model.
    coefficient : float
        theta_dot_after / theta_dot_before, within the domain of the model [-].
    flags : tuple of Flag
        Reasons for a difference between `coefficient` and `raw`; empty inside the domain.
    """

    model: "RestitutionModel"
    raw: float
    coefficient: float
    flags: tuple[Flag, ...] = ()


class RestitutionModel(ABC):
    """Base class of restitution models, published or derived.

    A user-defined model is a subclass with `name` and `raw_coefficient`. See the documentation, "add a model".

    Attributes
    ----------
    name : str
        Name in the registry and on the command line.
    title : str
        Description of the model in one line.
    short_name, legend : str
        Name in sentences, and name in the legend of a picture. By default `name`.
    colour : str
        Colour of the curves. A model without colour is not part of comparison plots.
    linestyle : str or tuple
        Line style of the curves for matplotlib, distinct in grey print.
    reference : str
        Publication with DOI, or the derivation in this project.
    assumptions, known_defects : tuple of str
        Assumptions of the model, and known cases in which the assumptions fail.
    domain : str
        Bodies to which the model applies, and its result for other bodies.
    inertia_only : bool
        True if the model depends only on mass, centre of mass, polar inertia and feet.
    can_stop : bool
        True if the equation can give r <= 0, which means that the body stops at the impact.
    keeps_energy : bool
        True if no impact creates energy, including impacts onto the longer lever.
    sees_old_foot : bool
        True if the model gives no energy loss for coincident feet, for which there is no impact.
    slender_limit : float
        Limit of the coefficient for slender rectangles [-].
    trials : tuple of str
        Parameters for the common tests of all models, in the form of a label.

    Examples
    --------
    >>> import rocking as rk
    >>> class Half(rk.restitution.RestitutionModel):
    ...     name = "half"
    ...
    ...     def raw_coefficient(self, body, foot):
    ...         return 0.5
    >>> rk.coefficient_of_restitution(rk.Block(width=1.0, height=4.0), Half())
    0.5
    """

    name: ClassVar[str]
    title: ClassVar[str] = ""
    short_name: ClassVar[str] = ""
    legend: ClassVar[str] = ""
    colour: ClassVar[str] = ""
    linestyle: ClassVar[str | tuple[int, tuple[int, ...]]] = "-"
    reference: ClassVar[str] = "not stated"
    assumptions: ClassVar[tuple[str, ...]] = ()
    domain: ClassVar[str] = "not stated"
    known_defects: ClassVar[tuple[str, ...]] = ()
    inertia_only: ClassVar[bool] = False
    can_stop: ClassVar[bool] = True
    keeps_energy: ClassVar[bool] = True
    sees_old_foot: ClassVar[bool] = True
    slender_limit: ClassVar[float] = 1.0
    trials: ClassVar[tuple[str, ...]] = ("",)

    @abstractmethod
    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        """Return the value of the equation of the model for a body. The limits of the domain are not applied.

        Parameters
        ----------
        body : Body
            The body.
        foot : {"left", "right"}
            The foot on which the body lands.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-].
        """

    def of_frame(self, frame: Frame, foot: Foot) -> float:
        """Return the coefficient of a frame. By default, raise an error: models apply to single bodies.

        Parameters
        ----------
        frame : Frame
            Columns with a beam.
        foot : {"left", "right"}
            The foot on which each column lands.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-].
        """
        raise InvalidValueError(
            "the model {model} applies to single bodies; for a frame use housner, the projection of the frame, or a "
            "coefficient", parameter="restitution", model=self.name,
        )  # fmt: skip

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the values of the equation of the model for homogeneous rectangles.

        Parameters
        ----------
        slenderness : ndarray
            Slenderness ratios h/b within their limits [-].

        Returns
        -------
        ndarray
            Values of equal shape [-].
        """
        blocks = (Block(width=1.0, height=ratio) for ratio in slenderness.ravel().tolist())
        values = [self.raw_coefficient(block, "right") for block in blocks]
        return np.array(values, dtype=np.float64).reshape(slenderness.shape)

    def evaluate(self, body: Body, foot: Foot = "right") -> Restitution:
        """Return the coefficient of a body with its flags.

        Parameters
        ----------
        body : Body
            The body.
        foot : {"left", "right"}
            The foot on which the body lands.

        Returns
        -------
        Restitution
            Coefficient, raw value, flags.

        Raises
        ------
        InvalidValueError
            If the foot is unknown or the model does not return a finite number.
        """
        checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
        equation = self.of_frame if isinstance(body, Frame) else self.raw_coefficient
        raw = checks.number(f"coefficient of model {self.name}", equation(body, checks.foot("foot", foot)))  # type: ignore[arg-type]
        return Restitution(self, raw, max(raw, 0.0), (Flag.STOPS,) if raw <= 0.0 else ())

    def coefficient(self, body: Body, foot: Foot = "right") -> float:
        """Return the coefficient of restitution of a body.

        Parameters
        ----------
        body : Body
            The body.
        foot : {"left", "right"}
            The foot on which the body lands.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-]; zero for a body that stops.
        """
        return self.evaluate(body, foot).coefficient

    def of_slenderness(self, slenderness: Any) -> FloatArray:
        """Return the coefficients of homogeneous rectangles.

        Parameters
        ----------
        slenderness : array_like
            Slenderness ratios h/b [-].

        Returns
        -------
        ndarray
            theta_dot_after / theta_dot_before, with equal shape [-]; zero for a body that stops.

        Raises
        ------
        InvalidValueError
            If a ratio is not finite or not above zero.

        Examples
        --------
        >>> from rocking.restitution import Housner
        >>> Housner().of_slenderness([0.5, 2.0, 4.0]).round(6).tolist()
        [0.0, 0.7, 0.911765]
        """
        raw = self._raw_checked(slenderness)
        return np.maximum(raw, 0.0, out=raw) if self.can_stop else raw

    def stops(self, slenderness: Any) -> BoolArray:
        """Return True for homogeneous rectangles that stop at the impact.

        Parameters
        ----------
        slenderness : array_like
            Slenderness ratios h/b [-].

        Returns
        -------
        ndarray of bool
            True if `Flag.STOPS` applies.
        """
        return self._raw_checked(slenderness) <= 0.0

    def _raw_checked(self, slenderness: Any) -> FloatArray:
        ratios = checks.real_array("slenderness_ratio", slenderness)
        flat = ratios.ravel()
        result = np.empty_like(flat)
        # pieces fit in the cache, because moving the data takes longer than the arithmetic
        for start in range(0, flat.size, _PIECE):
            piece = flat[start : start + _PIECE]
            smallest = checks.all_within("slenderness_ratio", piece, _FLATTEST, _TALLEST, array=ratios)
            self._fill(piece, smallest, result[start : start + _PIECE])
        return result.reshape(ratios.shape)

    def _fill(self, slenderness: FloatArray, smallest: float, out: FloatArray) -> None:
        """Write the coefficients of a piece.

        `smallest` is its smallest slenderness. Fast models override this method.
        """
        raw = self.raw_of_slenderness(slenderness)
        if not math.isfinite(float(raw.sum())):
            raise InvalidValueError(
                "the coefficient of model {model} must be finite for all slenderness ratios", model=self.name
            )
        out[...] = raw

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of the model with their values; empty for most models."""
        try:
            return {field.name: getattr(self, field.name) for field in fields(self) if field.init}  # type: ignore[arg-type]
        except TypeError:
            return {}

    @property
    def label(self) -> str:
        """Name with parameters in the form of the command line, such as ``shifted-impulse:k=0.6``."""
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items())
        return f"{self.name}:{values}" if values else self.name


class InertiaModel(RestitutionModel):
    """Base class of models that depend on the impact geometry, for one body or arrays of bodies."""

    @abstractmethod
    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the values of the equation of the model for impacts.

        Parameters
        ----------
        geometry : ImpactGeometry
            Levers and inertia.

        Returns
        -------
        ndarray
            Values [-], with the shape of the fields of the geometry.
        """

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        return float(self.of_geometry(ImpactGeometry.of_body(body, foot)))

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        return np.asarray(self.of_geometry(ImpactGeometry.of_slenderness(slenderness)))
