"""Plastic Winkler bed: pressure grows with indentation while a point descends, and is gone once it rises."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.restitution.contact import contact_of
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.model import InertiaModel
from rocking.restitution.plastic_bed import land

_LARGEST_BATCH = 128
_DEGREE = 80
_REACH = float(np.log(100.0))


@dataclass(frozen=True)
class PlasticWinkler(InertiaModel):
    """A flat base on springs that do not push back; the result does not depend on their stiffness.

    Pressure is k_w times indentation while a point still descends, zero after. Integrated in moment form: the
    state is (v, omega, Y = Int v dt, Theta = Int omega dt), without a mesh along the base.

    Examples
    --------
    >>> from rocking import Block
    >>> round(PlasticWinkler().coefficient(Block(width=1.0, height=2.0)), 8)
    0.81425939
    """

    name = "plastic-winkler"
    short_name = "plastic Winkler"
    colour, linestyle = "#E69F00", (0, (6, 2))
    title = "flat base on a bed of plastic springs that do not push back"
    reference = "derived in this project (theory, section 6); no publication yet"
    assumptions = (
        "flat base, sticking, impact much shorter than the motion",
        "the bed is uniform and gives nothing back while it unloads",
    )
    domain = "every body whose base leaves the ground behind it; otherwise the body stops: r = 0"
    known_defects = ("one pressure law for every interface: soft layers and rough contacts differ",)
    inertia_only = True

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Coefficients for bases that touch from foot to foot."""
        lever = geometry.new_lever
        kappa, back = np.broadcast_arrays(lever**2 / geometry.base_gyration, geometry.old_lever / lever)
        flat = np.column_stack([kappa.ravel(), back.ravel()])
        different, place = np.unique(flat, axis=0, return_inverse=True)
        values = [_impact(k, b, (-b, 1.0)) for k, b in different.tolist()]
        return np.array(values)[place].reshape(kappa.shape)

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        """Return the coefficients of homogeneous rectangles; many of them from an interpolant."""
        place = np.log(slenderness)
        inside = np.abs(place) <= _REACH
        if np.unique(slenderness).size <= _LARGEST_BATCH or not inside.all():
            return super().raw_of_slenderness(slenderness)
        return np.asarray(1.0 / (1.0 + np.exp(-_log_odds()(place))))

    def raw_coefficient(self, body: Body, onto: Foot) -> float:
        """Coefficient of a body, over the stretches of its base that touch."""
        geometry = ImpactGeometry.of_body(body, onto)
        lever, back = float(geometry.new_lever), float(geometry.old_lever)
        edges = (contact_of(body, onto) / lever).ravel().tolist()
        return _impact(lever**2 / float(geometry.base_gyration), back / lever, tuple(edges))


@lru_cache(maxsize=4096)
def _impact(kappa: float, back: float, edges: tuple[float, ...]) -> float:
    """Velocity ratio for levers in units of the new one; kappa = m b_new^2 / (I_C + m h^2)."""
    stretches = np.reshape(edges, (-1, 2))
    if float((stretches[:, 1] - stretches[:, 0]).sum()) <= 1e-9 * (1.0 + back):
        # feet without area: the whole impulse acts at the new one (Housner)
        return (1.0 - kappa * back) / (1.0 + kappa)  # Eq. 2
    left = land(kappa, back, stretches)
    # the bed leaves the body turning about its end; from there it steps onto the foot (Housner)
    return left.velocity * (1.0 + kappa * left.end) / (1.0 + kappa)  # Eq. 110


@lru_cache(maxsize=1)
def _log_odds() -> np.polynomial.Chebyshev:
    # ln(r / (1 - r)) against ln(h/b) is smooth, and straight at both ends: r ~ (h/b)^2 and 1 - r ~ (h/b)^-2
    def odds(place: FloatArray) -> FloatArray:
        r = PlasticWinkler().of_geometry(ImpactGeometry.of_slenderness(np.exp(place)))
        return np.asarray(np.log(r / (1.0 - r)))

    return np.polynomial.Chebyshev.interpolate(odds, _DEGREE, domain=[-_REACH, _REACH])
