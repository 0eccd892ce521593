"""Base classes of restitution models: a coefficient for an impact, with reference, assumptions, domain and defects."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from enum import Enum
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body
from rocking.conventions import BoolArray, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.restitution.impact import ImpactGeometry

_PIECE = 16384
_FLATTEST, _TALLEST = 1e-18, 1e18


class Flag(Enum):
    """Reason for a coefficient that differs from the equation of its model; the value is a sentence for reports."""

    STOPS = Message("the model gives r <= 0: the body stops at the impact (r = 0) and does not step onto the new foot")


@dataclass(frozen=True, slots=True)
class Restitution:
    """Coefficient of restitution with its model and flags.

    Parameters
    ----------
    model : RestitutionModel
        The model.
    raw : float
        Value of the model's equation, also outside its domain [-].
    coefficient : float
        theta_dot_after / theta_dot_before, within the domain of the model [-].
    flags : tuple of Flag
        Reasons for a difference of `coefficient` and `raw`; empty inside the domain.
    """

    model: "RestitutionModel"
    raw: float
    coefficient: float
    flags: tuple[Flag, ...] = ()


class RestitutionModel(ABC):
    """Base class of restitution models, published or derived.

    A model of your own is a subclass with `name` and `raw_coefficient`; see the documentation, "add a model".

    Attributes
    ----------
    name : str
        Name in the registry and on the command line.
    title : str
        The model in one line.
    short_name, legend : str
        Name in sentences, and in the legend of a picture if different; by default `name`.
    colour : str
        Colour of its curves; a model without colour is not part of comparison plots.
    linestyle : str or tuple
        Line style of its curves for matplotlib, distinct in grey print.
    reference : str
        Publication with DOI, or the derivation in this project.
    assumptions, known_defects : tuple of str
        Assumptions of the model, and cases in which they are known to fail.
    domain : str
        Bodies to which the model applies, and its result for others.
    inertia_only : bool
        True if the model depends on mass, centre, polar inertia and feet only.
    can_stop : bool
        True if the equation can give r <= 0, for a body that stops at the impact.
    keeps_energy : bool
        True if no impact creates energy, including impacts onto the longer lever.
    sees_old_foot : bool
        True if an impact with coincident feet, which is no impact, has no energy loss.
    slender_limit : float
        Limit of the coefficient for slender rectangles [-].
    trials : tuple of str
        Parameters, in the form of a label, for the common tests of all models.

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
        """Return the value of the model's equation for a body, without the limits of its domain.

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

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the values of the model's equation for homogeneous rectangles.

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
        raw = checks.number(f"coefficient of model {self.name}", self.raw_coefficient(body, checks.foot("foot", foot)))
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
            theta_dot_after / theta_dot_before, zero for a body that stops [-].
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
            theta_dot_after / theta_dot_before, of equal shape, zero for a body that stops [-].

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
        # pieces fit in the cache, since moving the data costs more than the arithmetic
        for start in range(0, flat.size, _PIECE):
            piece = flat[start : start + _PIECE]
            smallest = checks.all_within("slenderness_ratio", piece, _FLATTEST, _TALLEST, array=ratios)
            self._fill(piece, smallest, result[start : start + _PIECE])
        return result.reshape(ratios.shape)

    def _fill(self, slenderness: FloatArray, smallest: float, out: FloatArray) -> None:
        """Write the coefficients of a piece; smallest: its smallest slenderness; fast models override it."""
        raw = self.raw_of_slenderness(slenderness)
        if not math.isfinite(float(raw.sum())):
            raise InvalidValueError(
                "the coefficient of model {model} must be finite for all slenderness ratios", model=self.name
            )
        out[...] = raw

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of the model and their values; empty for most models."""
        try:
            return {field.name: getattr(self, field.name) for field in fields(self) if field.init}  # type: ignore[arg-type]
        except TypeError:
            return {}

    @property
    def label(self) -> str:
        """Name with parameters, in the form for the command line: ``shifted-impulse:k=0.6``."""
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items())
        return f"{self.name}:{values}" if values else self.name


class InertiaModel(RestitutionModel):
    """Base class of models of the impact geometry, for one body or arrays of bodies."""

    @abstractmethod
    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the values of the model's equation for impacts.

        Parameters
        ----------
        geometry : ImpactGeometry
            Levers and inertia.

        Returns
        -------
        ndarray
            Values, of the shape of the fields of the geometry [-].
        """

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        return float(self.of_geometry(ImpactGeometry.of_body(body, foot)))

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        return np.asarray(self.of_geometry(ImpactGeometry.of_slenderness(slenderness)))
