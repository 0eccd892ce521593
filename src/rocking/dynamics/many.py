"""`simulate_many`: all combinations of bodies, motions, scales and restitutions, as a labelled dataset."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Unpack

from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION
from rocking.dynamics._simulate import IntegrationOptions
from rocking.dynamics.mechanics import mechanics_for_all
from rocking.dynamics.mechanics_base import Combinations, frictions_of, listed
from rocking.errors import extra
from rocking.motions.pulse import Motion

if TYPE_CHECKING:
    import xarray as xr


def simulate_many(  # noqa: PLR0913 - independent options
    bodies: Body | Sequence[Body],
    motions: Motion | Sequence[Motion],
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    friction: Any = None,
    scale: Any = 1.0,
    rotation: Any = 0.0,
    angular_velocity: Any = 0.0,
    start: Any = None,
    duration: float | None = None,
    threads: int | None = None,
    twin: bool = False,
    progress: Callable[[int], None] | None = None,
    **options: Unpack[IntegrationOptions],
) -> "xr.Dataset":
    """Return the outcome of all combinations of bodies, motions, scales and restitutions.

    Parameters
    ----------
    bodies : Body, Solid or SpatialBody, or a sequence of them
        Either plane bodies only or 3D bodies only. The histories of an invalid 3D body get an error status.
    motions : GroundMotion, Pulse or mapping as for `simulate`, or a sequence of them
        For plane bodies, either records only or pulses only. For 3D bodies, None means ground at rest.
    restitution : as for `simulate`, or a list of these
        A law that varies from impact to impact must be the only restitution.
    friction : float or array_like, optional
        Coulomb's coefficients between bodies and ground [-]: bodies may slide, hop and fly, as in `simulate`.
    scale : float or array_like
        Factors on the motions [-].
    rotation, angular_velocity : float or array_like
        Initial theta [rad] and theta' [rad/s] of plane bodies, as for `simulate`. Arrays of equal length give one start
        per entry, for example for a basin of attraction. A single number applies to all starts.
    start : Start or SpatialStart, or a sequence of them, optional
        Starts, instead of rotation and angular_velocity. The lowest vertex of a 3D body must be at rest on the ground.
        By default, the body is upright and at rest.
    duration : float, optional
        Duration for 3D bodies [s]. By default, a history ends with the motion, or after 300 / p on ground at rest, and
        is extended until the energy determines the outcome. With friction, the default is that of `simulate`; a 3D body
        is followed until it rests in a stable pose.
    threads : int, optional
        Number of threads of the fast engine. The results do not depend on this number.
    twin : bool
        If True, compute every history a second time with half steps. The changes of peak and outcome (`twin_change`,
        `twin_flips`) measure the integration error. The computation takes three times as long.
    progress : callable, optional
        Function called with the number of histories finished since the last call.
    **options
        normal_restitution, normal_restitution_law, gravity, engine, linear, rest_speed, most_events, longest_step,
        order and tolerance, as for `simulate`. For 3D bodies without friction, the last five are those of
        `SpaceBatchSettings`.

    Returns
    -------
    xarray.Dataset
        Dataset over ``body, motion, scale, restitution``: outcome, status, peak_rotation and other quantities, with
        units. 3D bodies have the additional dimension ``start``, the peak_tilt and the direction of overturning. With
        friction, the dataset has the additional dimension ``friction`` and the sliding distance, and for 3D bodies the
        final stable pose. Plane bodies with starts have ``start`` as the last dimension, with the coordinates
        initial_rotation [rad] and initial_angular_velocity [rad/s].

        Without friction, the simulation of a plane body stops at the end of the ground motion. The energy at this time
        determines the outcome and the peak of later half cycles; later impacts are not counted. ``still_rocking``
        is 1 if the body rocks at the end of the ground motion. The attributes contain the engine, and the reasons for
        invalid 3D bodies.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or there is no combination.
    MissingExtraError
        If xarray is not installed, or engine="fast" and it was not built.

    Examples
    --------
    >>> import rocking as rk
    >>> blocks = [rk.Block(width=0.5, height=h) for h in (1.0, 2.0, 3.0)]
    >>> pulse = rk.pulses.sine(amplitude=4.0, period=0.6)
    >>> result = rk.simulate_many(blocks, pulse, ["housner", "ked"], scale=[0.5, 1.0])
    >>> dict(result.sizes)
    {'body': 3, 'motion': 1, 'scale': 2, 'restitution': 2}
    >>> sliding = rk.simulate_many(blocks[0], pulse, friction=[0.2, 0.6])
    >>> (sliding.sliding_distance > 0.0).squeeze().values.tolist()
    [True, False]
    >>> released = rk.simulate_many(blocks[1], pulse, 0.9, rotation=[-0.1, 0.0, 0.1])
    >>> released.outcome.dims[-1], released.initial_rotation.values.tolist()
    ('start', [-0.1, 0.0, 0.1])
    >>> box = rk.dynamics.SpatialBody.box(width=0.5, depth=0.6, height=2.0)
    >>> in_space = rk.simulate_many(box, {"x": pulse, "y": pulse}, "housner", friction=[0.2, 0.6])
    >>> (in_space.sliding_distance > 0.01).squeeze().values.tolist()
    [True, False]
    """
    extra("xarray", "simulate_many")
    mechanics = mechanics_for_all(bodies, friction)
    frictions = frictions_of(friction)
    given_options = {
        **options, "friction": next(iter(frictions.tolist()), None), "rotation": rotation, "start": start,
        "angular_velocity": angular_velocity, "duration": duration, "threads": threads, "twin": twin,
        "progress": progress,
    }  # fmt: skip
    settings, own = mechanics.split(given_options, mechanics.batch_settings, mechanics.batch_options)
    return mechanics.follow_many(Combinations(bodies, motions, listed(restitution), scale, frictions, **own), settings)
