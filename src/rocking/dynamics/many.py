"""`simulate_many`: every body under every motion at every scale with every restitution, as a labelled dataset."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, conventions, plausibility, quantities
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics._simulate import components_of, in_plane, refuse, rocking_start
from rocking.dynamics.contact.base import Start, starts_of
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.parameters import COMPLEMENTARITY, RockingParameters, is_none, sides_of
from rocking.dynamics.response import start_within
from rocking.dynamics.settings import SHORTEST_STEP, Settings, in_space
from rocking.errors import InvalidValueError, extra
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.summary import provenance_of
from rocking.outcome import contact_words, flags, overturned
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr

    from rocking.dynamics.plane.batch import Rows


_START_UNITS = {
    "rotation": "rad", "angular_velocity": "rad/s", "horizontal_velocity": "m/s", "height": "m",
    "vertical_velocity": "m/s",
}  # fmt: skip


def simulate_many(  # noqa: PLR0913 - every one of them is a question that users ask
    bodies: Body | Sequence[Body],
    motions: Motion | Sequence[Motion],
    restitution: Any = "ked",
    *,
    friction: Any = None,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    scale: Any = 1.0,
    gravity: float = conventions.g,
    engine: str = "auto",
    threads: int | None = None,
    twin: bool = False,
    progress: Callable[[int], None] | None = None,
    rotation: Any = 0.0,
    angular_velocity: Any = 0.0,
    start: Any = None,
    duration: float | None = None,
    linear: bool = False,
    rest_speed: float | None = None,
    most_events: int = 100_000,
    longest_step: float | None = None,
    order: int | None = None,
    tolerance: float | None = None,
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
    bounce : float
        Coefficient of normal restitution, in [0, 1), with friction [-].
    bounce_law : {"newton", "poisson", "stronge"}
        What `bounce` is the ratio of, as for `simulate`.
    scale : float or array_like
        Factors on the motions [-].
    gravity : float
        Acceleration of gravity [m/s2].
    engine : {"auto", "fast", "reference"}
        Which engine.
    threads : int, optional
        Threads of the fast engine; the results do not depend on them.
    twin : bool
        Compute every history again with all steps halved, and tell by how much its peak changes and whether its
        verdict does (`twin_change`, `twin_flips`): what the integration leaves open. It takes three times as long.
    progress : callable, optional
        Called with the number of histories done since the last call.
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
    linear, rest_speed, most_events, longest_step, order, tolerance
        How to integrate: see `Settings`.

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
    given: dict[str, Any] = {
        "gravity": gravity, "linear": linear, "rest_speed": rest_speed, "most_events": most_events,
        "longest_step": longest_step, "order": order, "tolerance": tolerance,
    }  # fmt: skip
    several: list[Any] = list(bodies) if isinstance(bodies, (list, tuple)) else [bodies]
    if any(map(in_space, several)) and not any(isinstance(body, Body) for body in several):
        refuse("bodies in space, whose start is a SpatialStart", rotation=rotation, angular_velocity=angular_velocity)
        refuse("bodies in space", twin=twin, bounce=bounce, bounce_law=bounce_law)
        if friction is not None:
            mus = _row("friction", friction)
            settings = Settings(**given, mechanics="space with friction", friction=float(mus[0]))
            return _on_hulls(
                several, motions, restitution, _row("scale", scale), mus, start, settings, duration, engine, threads,
                progress,
            )  # fmt: skip
        settings = Settings(**given, mechanics="space, many")
        return _in_space(several, motions, restitution, scale, start, settings, duration, engine, threads, progress)
    body_list = _several("bodies", bodies, (Body,))
    motion_list = [in_plane(motion) for motion in _several("motions", motions, (GroundMotion, Pulse, Mapping))]
    restitutions = restitution if isinstance(restitution, (list, tuple)) else [restitution]
    scales = _row("scale", scale)
    plausibility.warn(plausibility.of_scaled(motion_list, scales))
    if not restitutions:
        raise InvalidValueError("restitution must be at least one model, got none")
    starts = starts_of(start, rotation, angular_velocity)
    if friction is None:
        refuse("bodies without friction=, which rock alone", bounce=bounce, bounce_law=bounce_law, duration=duration)
        return _rocking_alone(
            body_list, motion_list, scales, restitutions, starts, Settings(**given), twin, threads, engine, progress
        )
    from rocking.dynamics.contact.batch import many_with_contact

    refuse("bodies with friction", twin=twin)
    settings, mus = Settings(**given, mechanics="contact"), _row("friction", friction)
    results, ran = many_with_contact(
        body_list, motion_list, scales, restitutions, mus, settings, bounce=bounce, bounce_law=bounce_law,
        starts=starts or [Start()], duration=duration, engine=engine, threads=threads, progress=progress,
    )  # fmt: skip
    labels = list(map(_label, restitutions))
    return _dataset(
        body_list, motion_list, {"scale": scales, "restitution": labels, "friction": mus, "start": starts}, results,
        settings,
        {
            "engine": ran, "bounce": bounce, "bounce_law": bounce_law,
            "duration_s": np.nan if duration is None else duration,
        },
    )  # fmt: skip


def _rocking_alone(  # noqa: PLR0913, PLR0917
    bodies: list[Body],
    motions: list[Motion],
    scales: FloatArray,
    restitutions: Sequence[Any],
    starts: list[Start] | None,
    settings: Settings,
    twin: bool,
    threads: int | None,
    engine: str,
    progress: Callable[[int], None] | None,
) -> "xr.Dataset":
    from rocking.dynamics.plane.batch import Batch
    from rocking.dynamics.plane.fast_engine import instruction_set

    laws = [each for each in restitutions if isinstance(each, ImpactLaw)]
    if laws and len(restitutions) > 1:
        raise InvalidValueError("a law that changes from impact to impact must be the only restitution of a call")
    law = laws[0] if laws else ConstantRestitution()
    all_parameters = [
        [RockingParameters.of_body(body, each, settings.gravity) for each in restitutions] for body in bodies
    ]
    states = np.array([rocking_start(each) for each in starts or [Start()]])
    for row in all_parameters if starts else ():
        for state in states.tolist():
            start_within(row[0], *state)
    shape = (len(bodies), len(motions), scales.size, len(restitutions), len(states))
    batch = Batch([m.segments() for m in motions], law, settings, threads, engine)
    count = int(np.prod(shape))
    results, work = batch.run(count, _pieces(all_parameters, scales, states, shape), progress)
    if twin:
        finer = replace(settings, longest_step=max(SHORTEST_STEP, 0.5 * settings.longest_step))
        halved = replace(batch, motions=[segments.refined(2) for segments in batch.motions], settings=finer)
        again, _ = halved.run(count, _pieces(all_parameters, scales, states, shape))
        change = np.abs(np.abs(results["peak_rotation"]) - np.abs(again["peak_rotation"]))  # NaN without two results
        flips = np.abs(overturned(results["outcome"]) - overturned(again["outcome"]))
        results |= {"twin_change": change, "twin_flips": flips}
    results |= flags(results)
    labels = list(map(_label, restitutions))
    if law.kind:  # the label of the body that keeps the least of a distribution stands for all
        labels = [min((row[0] for row in all_parameters), key=lambda p: min(p.left.share, p.right.share)).label]
    attributes = {
        "engine": f"fast ({instruction_set()})" if work else "reference",
        "contact": contact_words(results["lost_contact"]),
        "seed": getattr(law, "seed", 0),
        **{f"work_{k}": v for k, v in work.items()},
    }
    axes = {"scale": scales, "restitution": labels, "start": starts}
    return _dataset(bodies, motions, axes, results, settings, attributes)


def _dataset(
    bodies: list[Body],
    motions: list[Motion],
    axes: dict[str, Any],
    results: dict[str, Any],
    settings: Settings,
    attributes: dict[str, Any],
) -> "xr.Dataset":
    """Return results, one after another over body, motion and the axes, with units and provenance."""
    xarray = extra("xarray", "simulate_many")
    axes = {name: row for name, row in axes.items() if row is not None}
    starts = axes.get("start", [])
    dims = ("body", "motion", *axes)
    shape = (len(bodies), len(motions), *map(len, axes.values()))
    sides = [body.side("right", settings.gravity) for body in bodies]
    numbers = [name for name in ("scale", "friction") if name in axes]
    counted: dict[str, Any] = {name: (name, axes[name], {"units": "1"}) for name in numbers}
    made: xr.Dataset = xarray.Dataset(
        {name: (dims, values.reshape(shape), quantities.attributes(name)) for name, values in results.items()},
        coords={
            "slenderness_angle": ("body", [side.slenderness_angle for side in sides], {"units": "rad"}),
            "frequency_parameter": ("body", [side.frequency_parameter for side in sides], {"units": "rad/s"}),
            "motion": [m.name for m in motions],
            "motion_provenance": ("motion", ["; ".join(provenance_of(m)) for m in motions]),
            "restitution": axes["restitution"],
            **counted,
            **_coordinates(starts),
        },
        attrs={
            "software": SOFTWARE,
            **attributes,
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in settings.stated.items()},
        },
    )
    return made


def _coordinates(starts: list[Start]) -> dict[str, Any]:
    """Return the coordinates of starts: rotation and angular velocity, and what else one of them has."""
    if not starts:
        return {}
    rows = {name: [getattr(start, name) for start in starts] for name in _START_UNITS}
    shown = [name for name in rows if name in {"rotation", "angular_velocity"} or any(rows[name])]
    return {f"initial_{name}": ("start", rows[name], {"units": _START_UNITS[name]}) for name in shown}


def _in_space(bodies: list[Any], *axes_and_how: Any) -> "xr.Dataset":
    from rocking.dynamics.space.batch import batch_in_space

    motions, restitution, scale, start, *how = axes_and_how
    restitutions = _listed(restitution)
    return batch_in_space(
        bodies, _components(motions), restitutions, scale, start if start is None else _listed(start), *how
    ).to_xarray()


def _on_hulls(bodies: list[Any], *axes_and_how: Any) -> "xr.Dataset":
    from rocking.dynamics.hull.batch import batch_on_hulls

    motions, restitution, scales, frictions, start, *how = axes_and_how
    starts = [None] if start is None else _listed(start)
    return batch_on_hulls(
        bodies, _components(motions), scales, _listed(restitution), frictions, starts, *how
    ).to_xarray()


def _components(motions: Any) -> list[Any]:
    """Return the components of motions of bodies in space, None for ground at rest."""
    return [None if motion is None else components_of(motion) for motion in _listed(motions)]


def _listed(given: Any) -> list[Any]:
    return list(given) if isinstance(given, Sequence) and not isinstance(given, str) else [given]


def _pieces(
    all_parameters: list[list[RockingParameters]], scales: FloatArray, states: FloatArray, shape: tuple[int, ...]
) -> "Callable[[int, int], Rows]":
    from rocking.dynamics.plane.batch import Rows

    both = sides_of([parameters for row in all_parameters for parameters in row])
    table = {name: values.reshape(shape[0], shape[3]) for name, values in both.items()}

    def rows(first: int, last: int) -> "Rows":
        body, motion, factor, choice, start = np.unravel_index(np.arange(first, last), shape)
        values = {name: array[body, choice] for name, array in table.items()}
        values |= {"rotation": states[start, 0], "velocity": states[start, 1]}
        return Rows.of(last - first, motion, np.arange(first, last), scale=scales[factor], **values)

    return rows


_KINDS = {"bodies": "Body", "motions": "GroundMotion, Pulse, Mapping"}


def _several(name: str, given: Any, kinds: tuple[type, ...]) -> list[Any]:
    wanted = f"{name} must be one or more of {_KINDS[name]}"
    if isinstance(given, kinds):
        return [given]
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InvalidValueError(f"{wanted}, got {checks.given(name, given)}")
    found = list(given)
    if not found:
        raise InvalidValueError(f"{wanted}, got none")
    for k, item in enumerate(found):
        if not isinstance(item, kinds):
            raise InvalidValueError(f"{wanted}, got {checks.given(name, item, f' at index {k}')}")
    return found


def _row(name: str, values: Any) -> FloatArray:
    row = np.atleast_1d(checks.real_array(name, values))
    if row.ndim != 1 or not row.size:
        raise InvalidValueError(f"{name} must be one number or a row of numbers, got shape {row.shape}")
    bad = np.flatnonzero(~(np.abs(row) <= 1e6))
    if bad.size:
        raise InvalidValueError(f"{name} must be finite and within 1e6, got {row[bad[0]]:g} at index {bad[0]}")
    return row


def _label(restitution: Any) -> str:
    if is_none(restitution):
        return COMPLEMENTARITY
    label = getattr(restitution, "label", None)
    return label if isinstance(label, str) else str(restitution)
