"""`simulate_spatial_batch`: every body under every motion at every scale with every restitution and start."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.dynamics.spatial.ground import SpatialGround
from rocking.dynamics.spatial.rocker import SpatialBody
from rocking.dynamics.spatial_batch import engine as engines
from rocking.dynamics.spatial_batch.ground import joined
from rocking.dynamics.spatial_batch.laws import batch_law
from rocking.dynamics.spatial_batch.provenance import provenance
from rocking.dynamics.spatial_batch.result import SpatialBatch
from rocking.dynamics.spatial_batch.rows import RowTable
from rocking.dynamics.spatial_batch.run import run_compiled, run_reference
from rocking.dynamics.spatial_batch.settings import SpatialBatchSettings
from rocking.dynamics.spatial_batch.start import SpatialStart
from rocking.errors import InvalidValueError, RockingError

_LONG = 300.0


def simulate_spatial_batch(  # noqa: PLR0913 - every one of them is a question that users ask
    bodies: Any,
    motions: Any = None,
    restitution: Any = "housner-3d",
    *,
    scales: Any = 1.0,
    start: SpatialStart | Sequence[SpatialStart] | None = None,
    gravity: float = conventions.g,
    duration: float | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> SpatialBatch:
    """Return the outcome of every combination of bodies, motions, scales, restitutions and starts in space.

    Parameters
    ----------
    bodies : SpatialBody, any object that `simulate_spatial` takes, or a sequence of such
        The bodies; one that cannot be gives its rows a status, and the reason in `refused`.
    motions : GroundMotion, Pulse, tuple of up to three of them, or list of such, optional
        A tuple has the components x, y and vertical, None for a direction without; ground at rest if not given.
    restitution : str, float, law, or list of such
        "housner-3d", "horizontal-momentum-3d", "ked-3d", "ked-3d-point", or a coefficient from 0 to 1.
    scales : float or array_like
        Factors on the motions [-].
    start : SpatialStart or sequence of them, optional
        Initial conditions; standing upright at rest if not given.
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the bodies [s]; if not given, to the end of the motion, on ground at rest 300 / p. After
        that a history goes on until its energy decides whether it overturns.
    engine : {"auto", "fast", "reference"}
        Which engine; the reference engine takes thousands of times as long.
    threads : int, optional
        Threads of the compiled engine; the results do not depend on them.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        Fields of `SpatialBatchSettings`.

    Returns
    -------
    SpatialBatch
        Outcome, status, peak tilt, direction of overturning and more, and which engine ran.

    Raises
    ------
    InvalidValueError
        If an argument is none of these, the combination is empty, or the compiled engine does not know such a base.
    MissingExtraError
        If engine="fast" and it was not built.

    Examples
    --------
    >>> import rocking as rk
    >>> boxes = [SpatialBody.box(0.5, 0.4, height) for height in (1.5, 2.0)]
    >>> record = rk.pulses.sine(amplitude=4.0, period=0.8)
    >>> batch = simulate_spatial_batch(boxes, (record, record.scaled(0.5)), scales=[0.2, 0.8, 3.0])
    >>> batch.overturned[:, 0, :, 0, 0].tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
    """
    settings = SpatialBatchSettings.of(gravity, options)
    made, refused = _bodies(bodies)
    grounds, names = _grounds(motions, duration)
    laws = [batch_law(choice) for choice in _listed("restitution", restitution)]
    factors = np.atleast_1d(checks.real_array("scales", scales))
    starts = [SpatialStart()] if start is None else _listed("start", start)
    if factors.ndim != 1 or not factors.size or not all(isinstance(s, SpatialStart) for s in starts):
        raise InvalidValueError("scales must be one number or a row of them, and start one or more SpatialStart")
    for motion in _listed("motions", motions):
        plausibility.warn(plausibility.of_scaled(motion if isinstance(motion, tuple) else [motion], factors))
    if progress is not None and not callable(progress):
        raise InvalidValueError(f"progress must be a function of the histories done, or None, got {progress!r:.60}")
    shape = (len(made), len(grounds), factors.size, len(laws), len(starts))
    horizons = np.array([[_horizon(body, ground, duration, gravity) for ground in grounds] for body in made])
    table = RowTable(shape, factors, laws, starts, horizons)
    if engines.chosen(engine) == "fast":
        values, used = run_compiled(made, grounds, table, settings, threads, progress)
    else:
        values, used = run_reference(made, grounds, table, settings, progress)
    labels: dict[str, list[object]] = {
        "motion": list(names),
        "scale": factors.tolist(),
        "restitution": [law.label for law in laws],
    }
    source = provenance(made, _listed("motions", motions), starts, settings, duration)
    return SpatialBatch(shape, values, used, labels, refused, source)


def _horizon(body: SpatialBody | None, ground: SpatialGround, duration: float | None, gravity: float) -> float:
    if body is None:
        return 0.0
    if duration is not None:
        return max(duration, ground.end)
    return ground.end if ground.count else _LONG / body.frequency(gravity)


def _listed(name: str, given: Any) -> list[Any]:
    found = list(given) if isinstance(given, (list, np.ndarray)) else [given]
    if not found:
        raise InvalidValueError(f"{name} must be at least one, got none")
    return found


def _bodies(given: Any) -> tuple[list[SpatialBody | None], dict[int, str]]:
    several = isinstance(given, Sequence) and not isinstance(given, str)
    found: list[SpatialBody | None] = []
    refused: dict[int, str] = {}
    for number, body in enumerate(given if several else [given]):
        try:
            found.append(SpatialBody.of(body))
        except RockingError as error:
            found.append(None)
            refused[number] = str(error)
    if not found:
        raise InvalidValueError("bodies must be at least one, got none")
    return found, refused


def _grounds(given: Any, duration: float | None) -> tuple[list[SpatialGround], list[str]]:
    until = np.inf if duration is None else checks.positive("duration", duration, "s")
    grounds, names = [], []
    for motion in _listed("motions", given):
        parts = motion if isinstance(motion, tuple) else (motion,)
        if len(parts) > 3:
            raise InvalidValueError(f"a motion has at most three components, x, y and vertical, got {len(parts)}")
        grounds.append(joined(parts, until))
        names.append(", ".join("none" if part is None else part.name for part in parts))
    return grounds, names
