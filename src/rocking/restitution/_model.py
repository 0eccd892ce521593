"""What every restitution model is: a coefficient for an impact, and an honest account of where it comes from."""

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
    """Why a coefficient is not the bare number of its model; the value is the sentence a user reads."""

    STOPS = Message("the model's equation gives r <= 0: the body does not step onto the new foot but stops (r = 0)")


@dataclass(frozen=True, slots=True)
class Restitution:
    """A coefficient of restitution with what the model says about it.

    Parameters
    ----------
    model : RestitutionModel
        The model that gave it.
    raw : float
        What the model's equation gives, also outside its domain [-].
    coefficient : float
        theta_dot_after / theta_dot_before, after the model's domain has been applied [-].
    flags : tuple of Flag
        Why `coefficient` differs from `raw`; empty inside the domain.
    """

    model: "RestitutionModel"
    raw: float
    coefficient: float
    flags: tuple[Flag, ...] = ()


class RestitutionModel(ABC):
    """One published or derived model of what an impact costs.

    A model of your own is a subclass with `name` and `raw_coefficient`; see the documentation, "add a model".

    Attributes
    ----------
    name : str
        Name in the registry and on the command line.
    title : str
        The model in one line.
    short_name, legend : str
        What people call it in a sentence, and in the legend of a picture if that is another; the name if empty.
    colour : str
        Of its curves; a model without one is not drawn among the others.
    linestyle : str or tuple
        Of its curves, as matplotlib takes it, so that grey print keeps them apart.
    reference : str
        Publication with DOI, or the derivation in this project.
    assumptions, known_defects : tuple of str
        What the model takes for granted, and where that is known to fail.
    domain : str
        Bodies it holds for, and what happens outside.
    inertia_only : bool
        Whether it claims to depend on mass, centre, polar inertia and feet alone.
    can_stop : bool
        Whether its equation can give r <= 0, where the body stops instead of stepping on.
    keeps_energy : bool
        Whether no impact creates energy, onto the longer lever either.
    sees_old_foot : bool
        Whether an impact onto the foot that the body stands on, which is none, costs nothing.
    slender_limit : float
        Coefficient that slender rectangles tend to [-].
    trials : tuple of str
        Parameters, as in a label, with which the tests that every model shares try it.

    Examples
    --------
    >>> import rocking as rk
    >>> class Half(rk.restitution.RestitutionModel):
    ...     name = "half"
    ...
    ...     def raw_coefficient(self, body, onto):
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
    def raw_coefficient(self, body: Body, onto: Foot) -> float:
        """Return what the model's equation gives for a body, before its domain is applied.

        Parameters
        ----------
        body : Body
            The body.
        onto : {"left", "right"}
            The foot on which it lands.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before [-].
        """

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the same for homogeneous rectangles, one by one unless a model knows better.

        Parameters
        ----------
        slenderness : ndarray
            Slenderness ratios h/b [-], checked.

        Returns
        -------
        ndarray
            Of the same shape [-].
        """
        blocks = (Block(width=1.0, height=ratio) for ratio in slenderness.ravel().tolist())
        values = [self.raw_coefficient(block, "right") for block in blocks]
        return np.array(values, dtype=np.float64).reshape(slenderness.shape)

    def evaluate(self, body: Body, onto: Foot = "right") -> Restitution:
        """Return the coefficient of a body with its flags.

        Parameters
        ----------
        body : Body
            The body.
        onto : {"left", "right"}
            The foot on which it lands.

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
        raw = checks.number(f"coefficient of model {self.name}", self.raw_coefficient(body, checks.foot("onto", onto)))
        return Restitution(self, raw, max(raw, 0.0), (Flag.STOPS,) if raw <= 0.0 else ())

    def coefficient(self, body: Body, onto: Foot = "right") -> float:
        """Return the coefficient of restitution of a body.

        Parameters
        ----------
        body : Body
            The body.
        onto : {"left", "right"}
            The foot on which it lands.

        Returns
        -------
        float
            theta_dot_after / theta_dot_before, zero where the body stops [-].
        """
        return self.evaluate(body, onto).coefficient

    def of_slenderness(self, slenderness: Any) -> FloatArray:
        """Return the coefficients of homogeneous rectangles.

        Parameters
        ----------
        slenderness : array_like
            Slenderness ratios h/b [-].

        Returns
        -------
        ndarray
            theta_dot_after / theta_dot_before, of the same shape, zero where the body stops [-].

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
        """Return where a homogeneous rectangle stops instead of stepping on.

        Parameters
        ----------
        slenderness : array_like
            Slenderness ratios h/b [-].

        Returns
        -------
        ndarray of bool
            Whether `Flag.STOPS` applies.
        """
        return self._raw_checked(slenderness) <= 0.0

    def _raw_checked(self, slenderness: Any) -> FloatArray:
        ratios = checks.real_array("slenderness_ratio", slenderness)
        flat = ratios.ravel()
        result = np.empty_like(flat)
        # pieces that stay in the cache: checks and arithmetic cost less than moving the data
        for start in range(0, flat.size, _PIECE):
            piece = flat[start : start + _PIECE]
            least = checks.all_within("slenderness_ratio", piece, _FLATTEST, _TALLEST, whole=ratios)
            self._fill(piece, least, result[start : start + _PIECE])
        return result.reshape(ratios.shape)

    def _fill(self, slenderness: FloatArray, least: float, out: FloatArray) -> None:
        """Write the coefficients of a piece, the least slenderness of which is known; a quick model writes in place."""
        raw = self.raw_of_slenderness(slenderness)
        if not math.isfinite(float(raw.sum())):
            raise InvalidValueError(
                "coefficient of model {model} must be finite for every slenderness", model=self.name
            )
        out[...] = raw

    @property
    def parameters(self) -> dict[str, float]:
        """The model's parameters and their values, empty for most."""
        try:
            return {field.name: getattr(self, field.name) for field in fields(self) if field.init}  # type: ignore[arg-type]
        except TypeError:
            return {}

    @property
    def label(self) -> str:
        """Name with parameters, as the command line takes it: ``shifted-impulse:k=0.6``."""
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items())
        return f"{self.name}:{values}" if values else self.name


class InertiaModel(RestitutionModel):
    """A model written once, for the impact geometry of one body or of arrays of them."""

    @abstractmethod
    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return what the model's equation gives for impacts.

        Parameters
        ----------
        geometry : ImpactGeometry
            Levers and inertia.

        Returns
        -------
        ndarray
            Of the shape of the geometry's fields [-].
        """

    def raw_coefficient(self, body: Body, onto: Foot) -> float:
        return float(self.of_geometry(ImpactGeometry.of_body(body, onto)))

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        return np.asarray(self.of_geometry(ImpactGeometry.of_slenderness(slenderness)))
