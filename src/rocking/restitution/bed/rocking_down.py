"""Free rocking on a bed over several impacts."""

from dataclasses import dataclass, replace

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed import fast, reference
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.impact import BedStatus, status_of
from rocking.restitution.bed.laws import LawKind
from rocking.restitution.bed.setup import Results, RigidRocking, Setup, setup_of

_MAX_RUNS = 50
_AT_REST = 1e-3


@dataclass(frozen=True, eq=False)
class BedRocking:
    """Peaks of free rocking on a bed."""

    rotations: FloatArray  # |rotation| at the start and at the peaks [rad]
    times: FloatArray  # times of the peaks [s]
    touches: FloatArray  # starts of the impacts between the peaks (first contact beyond the old foot) [s]
    # ratio of the velocities at which rigid rocking would leave and reach theta = 0 [-]; above 1 if the energy of a hop
    # returns
    coefficients: FloatArray


def bed_free_rocking(
    body: Body, bed: ContactBed, *, rotation: float, peaks: int, tolerance: float = 1e-9
) -> BedRocking:
    """Return the peaks of free rocking from one foot over several impacts, with hops and vibration.

    With light damping (zeta <= 0.1), the energy of hops enters the next impact, and the ratio from peak to peak
    scatters. The ratio is then not a property of the body (docs/theory/contact_bed.md).

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Bed with a law without memory.
    rotation : float
        Initial rotation [rad].
    peaks : int
        Largest number of peaks. There are fewer peaks if the body no longer rocks from foot to foot.
    tolerance : float
        Relative error of a step [-].

    Returns
    -------
    BedRocking
        Rotations, times and ratios.

    Raises
    ------
    InvalidValueError
        If the law has a memory, or `peaks` is not a whole number above zero.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_free_rocking
    >>> block = Block(width=0.2, height=0.4)
    >>> bed = ContactBed.uniform(block, 2, KelvinVoigt(1e9, damping_ratio=1.0))
    >>> bed_free_rocking(block, bed, rotation=0.2, peaks=3).coefficients.round(2).tolist()
    [0.7, 0.7, 0.7]
    """
    peaks = checks.whole("peaks", peaks, 1)
    setup = setup_of(body, bed, rotation=rotation, tolerance=tolerance)
    if setup.law.kind is LawKind.PLASTIC:
        raise InvalidValueError(
            "a plastic law is not allowed, since the deformation of its points is lost from peak "
            "to peak; use a law without memory"
        )
    rigid = setup.rigid
    angles, times, touches, now, lingers = [float(rotation)], [0.0], list[float](), 0.0, False
    for _ in range(_MAX_RUNS * peaks):
        row = (fast.compute_one(setup) if fast.available() else reference.compute_one(setup))[0]
        now += row["time"]
        if status_of(row["status"]) is not BedStatus.PEAK or abs(row["rotation"]) < _AT_REST * rotation:
            break
        if row["rotation"] > 0.0 and not lingers and len(angles) > peaks:
            break
        if row["rotation"] > 0.0 and not lingers:
            angles.append(row["rotation"])
            times.append(now)
            touches.append(now - row["time"] + row["touch"])
        elif row["rotation"] > angles[-1]:  # two peaks, caused by vibration
            angles[-1], times[-1] = row["rotation"], now
        lingers = row["rotation"] <= 0.0
        setup = _turned(setup, row)
    speeds = [_velocity(rigid, angle if k % 2 else -angle) for k, angle in enumerate(angles)]
    return BedRocking(
        np.array(angles), np.array(times), np.array(touches), np.array(speeds[1:]) / np.array(speeds[:-1])
    )


def _velocity(rigid: RigidRocking, rotation: float) -> float:
    inertia = rigid.inertia_about(rigid.pivot(rotation))
    return float(np.sqrt(2.0 * rigid.potential(rotation) / inertia))  # Eq. 128


def _turned(setup: Setup, row: Results) -> Setup:
    """Return the mirrored setup of the next half cycle."""
    bed = setup.rigid.bed
    mirror = replace(bed, positions=-bed.positions[::-1], shares=bed.shares[::-1], heights=bed.heights[::-1])
    state = (row["y"], -row["rotation"], -row["u"], row["w"], -row["angular_velocity"])
    last = len(bed.positions) - 1
    return replace(
        setup,
        rigid=replace(setup.rigid, bed=mirror),
        state=state,
        old_foot=last - setup.new_foot,
        new_foot=last - setup.old_foot,
    )
