"""The energy balance of the paper's Figure 2: what each stage of KED leaves of the kinetic energy, and where."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot, opposite
from rocking.errors import InvalidValueError
from rocking.restitution.ked import projected_moment

STAGES = ("before", "stage 1", "stage 2", "after")
"""Before the impact; vertical part lost; part along the line to the new foot lost; redistributed."""


@dataclass(frozen=True, slots=True)
class EnergyBalance:
    """Kinetic energy of a body through the stages of KED (Fig. 2, Mao et al. 2024).

    Parameters
    ----------
    body : Body
        The body.
    onto : {"left", "right"}
        The foot on which it lands.
    velocity_before, velocity_after : float
        Angular velocities about the old and about the new foot [rad/s].
    totals : dict of str to float
        Kinetic energy before, after stage 1, after stage 2 and after redistribution [J].

    Examples
    --------
    >>> from rocking import Block
    >>> balance = energy_balance(Block(width=1.0, height=2.0, density=1000.0))
    >>> [round(share, 6) for share in balance.shares.values()]
    [1.0, 0.8, 0.689413, 0.689413]
    """

    body: Body
    onto: Foot
    velocity_before: float
    velocity_after: float
    totals: dict[str, float]

    @property
    def shares(self) -> dict[str, float]:
        """Each total over the energy before the impact [-]."""
        before = self.totals["before"]
        return {stage: energy / before for stage, energy in self.totals.items()}

    def velocities(self, x: FloatArray, y: FloatArray) -> dict[str, FloatArray]:
        """Return the velocity that each stage leaves at points of the body.

        Parameters
        ----------
        x, y : ndarray
            Points in the user's coordinates, of one shape [m].

        Returns
        -------
        dict of str to ndarray
            Stage to velocities (v_x, v_y), one more dimension of length 2 at the end [m/s].
        """
        # clockwise rotation lands on the right foot, counter-clockwise on the left
        sense = 1.0 if self.onto == "right" else -1.0
        feet = dict(zip(("left", "right"), self.body.feet, strict=True))
        up = np.asarray(y, dtype=np.float64) - self.body.ground
        from_old = np.asarray(x, dtype=np.float64) - feet[opposite(self.onto)]
        from_new = np.asarray(x, dtype=np.float64) - feet[self.onto]
        before, after = sense * self.velocity_before, sense * self.velocity_after
        squared = up**2 + from_new**2
        kept = np.divide(up**2, squared, out=np.zeros_like(squared), where=squared > 0.0)
        return {
            "before": before * np.stack([up, -from_old], axis=-1),  # Eq. 6, Mao et al. 2024
            "stage 1": before * np.stack([up, np.zeros_like(up)], axis=-1),  # Eq. 7, Mao et al. 2024
            "stage 2": before * kept[..., None] * np.stack([up, -from_new], axis=-1),  # Eqs. 8, 9, Mao et al. 2024
            "after": after * np.stack([up, -from_new], axis=-1),  # Eq. 12, Mao et al. 2024
        }

    def energy_density(self, x: FloatArray, y: FloatArray) -> dict[str, FloatArray]:
        """Return the kinetic energy per volume that each stage leaves at points.

        Parameters
        ----------
        x, y : ndarray
            Points in the user's coordinates, of one shape [m].

        Returns
        -------
        dict of str to ndarray
            Stage to energy density, zero outside the body [J/m3].
        """
        density = known_density(self.body, x, y)
        fields = self.velocities(x, y)
        return {stage: 0.5 * density * (field**2).sum(axis=-1) for stage, field in fields.items()}


def known_density(body: Body, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return `density_at`, refused where only moments of the body are known [kg/m3]."""
    if body.known is not None:
        raise InvalidValueError(
            "the field of energy needs the distribution of mass, and of this body only moments are known: describe it "
            "as regions with their densities, without centre and moment_of_inertia"
        )
    return body.density_at(x, y)


def energy_balance(body: Body, *, onto: Foot = "right", angular_velocity: float = 1.0) -> EnergyBalance:
    """Return the energy balance of an impact under KED.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    onto : {"left", "right"}
        The foot on which it lands.
    angular_velocity : float
        Angular velocity before the impact [rad/s].

    Returns
    -------
    EnergyBalance
        Totals, shares, and fields over the body (Eqs. 6-17, Mao et al. 2024, doi:10.3390/buildings14072119).

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking import Block
    >>> round(energy_balance(Block(width=1.0, height=4.0)).velocity_after, 8)
    0.94736684
    """
    onto = checks.foot("onto", onto)
    speed = checks.positive("angular_velocity", angular_velocity, "rad/s")
    moments, half = body.local_moments, 0.5 * speed**2
    kept = projected_moment(body, onto)
    inertia = body.side(onto).moment_of_inertia
    totals = {
        "before": half * body.side(opposite(onto)).moment_of_inertia,
        "stage 1": half * (moments.yy + moments.mass * moments.y**2),
        "stage 2": half * kept,  # Eq. 11, Mao et al. 2024
    }
    after = speed * float(np.sqrt(kept / inertia))  # Eq. 16, Mao et al. 2024
    # Eq. 15, Mao et al. 2024
    return EnergyBalance(body, onto, speed, after, {**totals, "after": 0.5 * inertia * after**2})
