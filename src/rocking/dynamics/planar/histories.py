"""The question that users ask: what does the body do when its feet may slide, hop and bounce."""

import math
from dataclasses import fields
from typing import Any

from rocking import checks, conventions, plausibility
from rocking.bodies import Body
from rocking.dynamics.impact_law import ImpactLaw
from rocking.dynamics.planar.engine import Planar
from rocking.dynamics.planar.footing import Footing
from rocking.dynamics.planar.response import PlanarResponse
from rocking.dynamics.planar.settings import GroundContact, PlanarSettings
from rocking.dynamics.planar.start import Start
from rocking.dynamics.rocker import Rocker
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments

# sqrt(g / R) times the step between samples of a pulse's response, and times what is followed after the motion
_FINE, _AFTER, _FREE = 0.1, 15.0, 60.0
_MOST_SAMPLES = 2_000_000


def simulate_with_contact(
    body: Body,
    motion: GroundMotion | Pulse | None,
    friction: float,
    *,
    bounce: float = 0.0,
    restitution: Any = None,
    scale: float = 1.0,
    duration: float | None = None,
    **options: Any,
) -> PlanarResponse:
    """Return how a body rests, slides, rocks, slides while it rocks, and flies.

    Impacts follow from complementarity: Newton's restitution `bounce` for velocities away from the ground, Coulomb
    friction along it, both feet at the same instant. With much friction and no bounce a slender block keeps Housner's
    coefficient, and one squatter than h / b = 1 / sqrt(2) stops.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints, standing on its two feet.
    motion : GroundMotion or Pulse, optional
        The motion; None for ground at rest.
    friction : float
        Coulomb's coefficient mu, from 0 to 1e6 [-].
    bounce : float
        Newton's coefficient e_N, in [0, 1) [-].
    restitution : str, RestitutionModel, float or mapping, optional
        Coefficient of restitution for rocking impacts, theta_dot_after / theta_dot_before without slip, as for
        `simulate`. It fixes where the resultant of the impulses acts; if that takes more friction than there is, the
        foot slides off under the friction there is (see `rocking.dynamics.planar.imposed`). Landings from flight keep
        to complementarity.
    scale : float
        Factor on both components of the motion [-].
    duration : float, optional
        How long to follow the body [s]; if not given, the motion and 15 sqrt(R / g) after it. One that leans beyond
        its slenderness angle then is followed, on ground at rest, until it lies or leans less: `outcome` needs it.
    **options
        ``start`` (a `Start`), ``gravity`` [m/s2], and further fields of `PlanarSettings`.

    Returns
    -------
    PlanarResponse
        Positions, regimes, impacts, sliding, forces, energy, outcome.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=1.0)
    >>> response = simulate_with_contact(block, rk.pulses.rectangular(4.0, 0.5), friction=0.3)
    >>> response.outcome.name, bool(response.sliding_distance > 0.0)
    ('SLID', True)
    """
    start = _start(options.pop("start", None))
    settings = _settings(options)
    footing = Footing.of_body(body)
    law = GroundContact(
        friction if isinstance(friction, conventions.Assumed) else checks.number("friction", friction),
        checks.number("bounce", bounce),
        _imposed(body, restitution, settings),
    )
    scale = checks.within("scale", scale, -1e6, 1e6)
    segments = _segments(motion, footing, settings.gravity, duration)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    history = Planar(footing, segments, law, settings, scale).run(start.state(footing))
    return PlanarResponse(body, motion, footing, law, settings, segments, scale, history)


def _start(given: object) -> Start:
    if given is None:
        return Start()
    if not isinstance(given, Start):
        raise InvalidValueError(f"start must be a Start(rotation=..., ...), got {given!r:.60}")
    return given


def _settings(options: dict[str, Any]) -> PlanarSettings:
    known = {f.name for f in fields(PlanarSettings)}
    unknown = sorted(set(options) - known)
    if unknown:
        raise InvalidValueError(f"no option named {unknown[0]!r}; there are start, {', '.join(sorted(known))}")
    return PlanarSettings(**{"gravity": conventions.g, **options})


def _imposed(body: Body, restitution: Any, settings: PlanarSettings) -> tuple[float, float] | None:
    if restitution is None:
        return None
    if isinstance(restitution, ImpactLaw):
        raise InvalidValueError(
            f"restitution must be a model, a name or a number here, got {type(restitution).__name__}: "
            "laws that change from impact to impact are for simulate()"
        )
    rocker = Rocker.of_body(body, restitution, settings.gravity)
    return rocker.left.coefficient, rocker.right.coefficient


def _segments(motion: object, footing: Footing, gravity: float, duration: float | None) -> Segments:
    slow = math.sqrt(footing.size / gravity)
    if motion is None:
        length = _FREE * slow if duration is None else checks.positive("duration", duration, "s")
        count = max(1, math.ceil(length / (_FINE * slow) - 1e-9))
        _check_samples(count)
        return Segments.still(length / count, count)
    if not isinstance(motion, (GroundMotion, Pulse)):
        raise InvalidValueError(f"motion must be a GroundMotion, a pulse or None, got {motion!r:.60}")
    length = motion.duration + _AFTER * slow if duration is None else checks.positive("duration", duration, "s")
    segments = motion.segments()
    if isinstance(motion, Pulse):
        segments = segments.refined(math.ceil(segments.step / (_FINE * slow)))
    _check_samples(length / segments.step)
    keep = max(1, math.ceil(length / segments.step - 1e-9))
    vertical = None if segments.vertical is None else segments.vertical[:keep]
    return Segments(segments.step, segments.horizontal[:keep], vertical).extended(length)


def _check_samples(count: float) -> None:
    if not count <= _MOST_SAMPLES:
        raise InvalidValueError(
            f"the response would have {count:.3g} samples, more than {_MOST_SAMPLES:.0e}; a shorter duration, please"
        )
