"""`simulate_many`: every body under every motion at every scale with every restitution, as a labelled dataset."""

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


def simulate_many(  # noqa: PLR0913 - every one of them is a question that users ask
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
    """Return the outcome of every combination of bodies, motions, scales and restitutions.

    Parameters
    ----------
    bodies : Body, Solid or SpatialBody, or a sequence of them
        All plane bodies, or all in space; of the latter one that cannot be gives its histories a status.
    motions : GroundMotion, Pulse or mapping as for `simulate`, or a sequence of them
        Of plane bodies all records or all pulses; in space None for ground at rest.
    restitution : as for `simulate`, or a list of such
        Laws that change from impact to impact cannot be mixed with others.
    friction : float or array_like, optional
        Coulomb's coefficients between bodies and ground [-]: they may slide, hop and fly, as in `simulate`.
    scale : float or array_like
        Factors on the motions [-].
    rotation, angular_velocity : float or array_like
        theta [rad] and theta' [rad/s] of plane bodies at the start, as for `simulate`. Rows of one length state one
        start per entry, for a basin of attraction for example; a number holds for each start.
    start : Start or SpatialStart, or a sequence of them, optional
        Instead of these: the starts of plane bodies, which friction may also lift or push along. In space the starts
        of the bodies, the lowest vertex at rest on the ground. Upright at rest if not given.
    duration : float, optional
        How long to follow bodies in space [s]; if not given, to the end of the motion, on ground at rest 300 / p. After
        that a history goes on until its energy decides whether it overturns. With friction as for `simulate`, in space
        until it rests in one of its stable poses.
    threads : int, optional
        Threads of the fast engine; the results do not depend on them.
    twin : bool
        Compute every history again with all steps halved, and tell by how much its peak changes and whether its
        verdict does (`twin_change`, `twin_flips`): what the integration leaves open. It takes three times as long.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        normal_restitution, normal_restitution_law, gravity, engine, linear, rest_speed, most_events, longest_step,
        order and tolerance, as for `simulate`; in space without friction the last five are those of
        `SpaceBatchSettings`.

    Returns
    -------
    xarray.Dataset
        Over ``body, motion, scale, restitution``: outcome, status, peak_rotation and more, with units; in space over
        ``start`` too, with peak_tilt and the direction of overturning; with friction over ``friction`` too, with how
        far they slid, in space also with the stable pose in which they end. Plane bodies with starts have ``start`` as
        the last dimension, with initial_rotation [rad] and initial_angular_velocity [rad/s] as its coordinates. Every
        history that rocks alone ends with its motion: energy then decides the outcome and the peak of the swings to
        come, whose impacts are not counted, so that ``still_rocking`` is the state at the end of the motion.
        Its attributes say which engine ran, and why bodies in
        space were refused.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the combination is empty.
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
    >>> let_go = rk.simulate_many(blocks[1], pulse, 0.9, rotation=[-0.1, 0.0, 0.1])
    >>> let_go.outcome.dims[-1], let_go.initial_rotation.values.tolist()
    ('start', [-0.1, 0.0, 0.1])
    >>> box = rk.dynamics.SpatialBody.box(width=0.5, depth=0.6, height=2.0)
    >>> in_space = rk.simulate_many(box, {"x": pulse, "y": pulse}, "housner", friction=[0.2, 0.6])
    >>> (in_space.sliding_distance > 0.01).squeeze().values.tolist()
    [True, False]
    """
    extra("xarray", "simulate_many")
    mechanics = mechanics_for_all(bodies, friction)
    frictions = frictions_of(friction)
    stated = {
        **options, "friction": next(iter(frictions.tolist()), None), "rotation": rotation, "start": start,
        "angular_velocity": angular_velocity, "duration": duration, "threads": threads, "twin": twin,
        "progress": progress,
    }  # fmt: skip
    settings, own = mechanics.split(stated, mechanics.batch_settings, mechanics.batch_options)
    return mechanics.follow_many(Combinations(bodies, motions, listed(restitution), scale, frictions, **own), settings)
