"""Histories for all combinations of 3D bodies, motions, scales, restitutions and starts, as arrays with provenance."""

import hashlib
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rocking import checks, plausibility
from rocking.answers import Answer
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.mechanics_base import Combinations, listed
from rocking.dynamics.response_base import motion_provenance
from rocking.dynamics.rolling import fast_engine
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.fast_engine import Bodies, Progress, Results, RowTable, batch_law
from rocking.dynamics.rolling.ground import SpatialGround, ground_of
from rocking.dynamics.rolling.impact_laws import law_of
from rocking.dynamics.rolling.reference import SpatialReference
from rocking.dynamics.rolling.settings import SpaceBatchSettings, SpaceSettings
from rocking.dynamics.rolling.trajectory import SpatialEventKind, SpatialTrajectory
from rocking.dynamics.settings import check_progress
from rocking.errors import InvalidValueError, RockingError, extra
from rocking.motions.components import components_of
from rocking.outcome import ContactMode, Outcome, Status, of_results, overturned
from rocking.quantities import attributes, with_units
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr

Made = TypeVar("Made")
DIMENSIONS = ("body", "motion", "scale", "restitution", "start")  # dimensions of the arrays of a batch, in order
_LONG = 300.0
_FEW = 100  # largest number of bodies in the provenance; for more bodies, it contains only the digest


@dataclass(frozen=True, eq=False)
class SpatialBatch:
    """Results of a batch. Every array has one axis per dimension."""

    shape: tuple[int, ...]
    values: dict[str, np.ndarray] = field(repr=False)  # flat results by name in `rocking.quantities`
    engine: str  # engine and method
    labels: dict[str, list[object]] = field(default_factory=dict, repr=False)  # motions, restitutions, scales
    refused: dict[int, str] = field(default_factory=dict)  # reasons for invalid bodies, by index
    provenance: dict[str, Any] = field(default_factory=dict, repr=False)  # bodies, starts, settings as plain values
    dimensions: tuple[str, ...] = DIMENSIONS

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array of the engine by name. In `results`, flags are NaN if there is no result."""
        return self.values[name].reshape(self.shape)

    def __len__(self) -> int:
        return int(np.prod(self.shape))

    @property
    def outcome(self) -> IntArray:
        """Codes of `Outcome`."""
        return self["outcome"]

    @property
    def status(self) -> IntArray:
        """Codes of `Status`."""
        return self["status"]

    @property
    def overturned(self) -> FloatArray:
        """1 with overturning, 0 without, NaN without a result."""
        return overturned(self.outcome)

    @property
    def still_rocking(self) -> FloatArray:
        """1 if the body has not overturned and still moves at the end, otherwise 0; NaN without a result."""
        return of_results(self.outcome, self["still_rocking"])

    @property
    def results(self) -> dict[str, np.ndarray]:
        """Flat results by name; flags are NaN without a result."""
        flags = {"overturned": self.overturned, "still_rocking": self.still_rocking}
        return self.values | {name: flag.ravel() for name, flag in flags.items()}

    def to_xarray(self) -> "xr.Dataset":
        """Return the results over the dimensions, with units and provenance."""
        xarray = extra("xarray", "a labelled dataset")
        data = {
            name: (self.dimensions, values.reshape(self.shape), attributes(name))
            for name, values in self.results.items()
        }
        coordinates = {name: (name, row) for name, row in self.labels.items()}
        refused = json.dumps({str(number): reason for number, reason in self.refused.items()})
        stated = {"software": SOFTWARE, "engine": self.engine, "refused": refused, **with_units(self.provenance)}
        dataset: xr.Dataset = xarray.Dataset(data, coordinates, stated)
        return dataset


def many_in_space(cases: Combinations, settings: SpaceBatchSettings) -> SpatialBatch:
    """Return the outcome of all combinations."""
    return batch_in_space(
        listed(cases.bodies), motions_in_space(cases.motions), cases.restitutions, cases.scales,
        None if cases.start is None else listed(cases.start), settings, cases.duration, cases.engine, cases.threads,
        cases.progress,
    )  # fmt: skip


def motions_in_space(motions: Any) -> list[Any]:
    """Return the components of motions of 3D bodies; None for ground at rest."""
    return [None if motion is None else components_of(motion) for motion in listed(motions)]


def batch_in_space(  # noqa: PLR0913, PLR0917 - the arguments of `simulate_many`
    bodies: Any,
    motions: Any = None,
    restitution: Any = "housner-3d",
    scales: Any = 1.0,
    start: SpatialStart | Sequence[SpatialStart] | None = None,
    settings: SpaceBatchSettings | None = None,
    duration: float | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> SpatialBatch:
    """Return the outcome of all combinations. `motions` contains tuples of components."""
    # the reference engine is thousands of times slower
    settings = settings or SpaceBatchSettings()
    body_list = bodies if isinstance(bodies, Sequence) and not isinstance(bodies, str) else [bodies]
    spatial_bodies, refused = converted_or_refused(SpatialBody.of, body_list)
    if not spatial_bodies:
        raise InvalidValueError("bodies must contain at least one body, got none")
    motion_list = _listed("motions", motions)
    grounds, names = _grounds(motion_list, duration)
    laws = [batch_law(item) for item in _listed("restitution", restitution)]
    factors = np.atleast_1d(checks.real_array("scales", scales))
    starts = [SpatialStart()] if start is None else _listed("start", start)
    if factors.ndim != 1 or not factors.size or not all(isinstance(s, SpatialStart) for s in starts):
        raise InvalidValueError("scales must be a number or a row of numbers, and start one or more SpatialStart")
    for item in starts:
        item.check_grounded()
    for motion in motion_list:
        plausibility.warn(plausibility.of_scaled(_components(motion), factors))
    check_progress(progress)
    shape = (len(spatial_bodies), len(grounds), factors.size, len(laws), len(starts))
    horizons = np.array(
        [[_horizon(body, item, duration, settings.gravity) for item in grounds] for body in spatial_bodies]
    )
    table = RowTable(shape, factors, laws, starts, horizons)
    if fast_engine.chosen(engine) == "fast":
        values, engine_name = fast_engine.run_compiled(spatial_bodies, grounds, table, settings, threads, progress)
    else:
        values, engine_name = _run_reference(spatial_bodies, grounds, table, settings, progress)
    labels: dict[str, list[object]] = {
        "motion": list(names), "scale": factors.tolist(), "restitution": [law.label for law in laws]
    }  # fmt: skip
    source = provenance_of(settings.stated, motion_list, starts, duration, "to the end of the motion")
    return SpatialBatch(shape, values, engine_name, labels, refused, source | _of_bodies(spatial_bodies))


def _horizon(body: SpatialBody | None, ground: SpatialGround, duration: float | None, gravity: float) -> float:
    if body is None:
        return 0.0
    if duration is not None:
        return max(duration, ground.end)
    return ground.end if ground.count else _LONG / body.frequency(gravity)


def _listed(name: str, values: Any) -> list[Any]:
    items = list(values) if isinstance(values, (list, np.ndarray)) else [values]
    if not items:
        raise InvalidValueError("{parameter} must contain at least one value, got none", parameter=name)
    return items


def _components(motion: Any) -> Sequence[Any]:
    return motion if isinstance(motion, tuple) else (motion,)


def converted_or_refused(
    make: Callable[[Any], Made], bodies: Sequence[Any]
) -> tuple[list[Made | None], dict[int, str]]:
    """Return the converted bodies (None for an invalid body), and the reasons by index."""
    objects: list[Made | None] = []
    refused: dict[int, str] = {}
    for index, body in enumerate(bodies):
        try:
            objects.append(make(body))
        except RockingError as error:
            objects.append(None)
            refused[index] = str(error)
    return objects, refused


def _grounds(motions: list[Any], duration: float | None) -> tuple[list[SpatialGround], list[str]]:
    until = np.inf if duration is None else checks.positive("duration", duration, "s")
    grounds, names = [], []
    for motion in motions:
        components = tuple(_components(motion))
        if len(components) > 3:
            raise InvalidValueError(
                "a motion has at most three components, x, y and vertical, got {count}", count=len(components)
            )
        grounds.append(ground_of(*components, until=until))
        names.append(", ".join("none" if component is None else component.name for component in components))
    return grounds, names


def _run_reference(
    bodies: Bodies, grounds: Sequence[SpatialGround], table: RowTable, settings: SpaceBatchSettings, progress: Progress
) -> tuple[Results, str]:
    """Return the results of all rows by the reference engine."""
    results, counts = fast_engine.empty_tables(len(table))
    own = SpaceSettings(settings.gravity, settings.most_events, settings.rest_speed)
    for k in range(len(table)):
        (numbers,), ((body, motion, _),) = table.piece(k, k + 1)
        law = table.laws[int(np.unravel_index(k, table.shape)[3])]
        results[k], counts[k] = _one(bodies[body], grounds[motion], law.law or law.label, numbers, own)
        if progress is not None:
            progress(1)
    return fast_engine.columns_by_name(results, counts), "reference, row by row"


def _one(
    body: SpatialBody | None, ground: SpatialGround, law: Any, row: FloatArray, settings: SpaceSettings
) -> tuple[FloatArray, list[int]]:
    refused = fast_engine.empty_tables(1)[0][0], [Outcome.FAILED.code, Status.INVALID.code, -1, -1, *[0] * 5]
    if body is None or not (np.abs(row) <= 1e9).all():
        return refused
    scaled = SpatialGround(ground.times, row[1] * ground.coefficients)
    try:
        history = SpatialReference(body, scaled, law_of(law, body), settings).run(row[3:7], row[7:10], float(row[2]))
    except RockingError:
        return refused
    return results_of(history)


def results_of(history: SpatialTrajectory) -> tuple[FloatArray, list[int]]:
    """Return a history of the reference engine as a row of a batch: floats (NaN if missing) and integers."""
    last, events = history.pieces[-1], history.events
    failed = history.outcome is Outcome.FAILED
    first = events[0].time if events else math.nan
    ends = [np.linalg.norm(piece.at(np.array([0.0, piece.until]))[1], axis=1).max() for piece in history.pieces]
    lost = sum(event.before - event.after for event in history.impacts)
    results = np.array([
        history.peak_tilt, history.peak_time, math.nan if failed else float(max(ends)), history.overturning_time,
        history.direction, first, last.end, history.held, lost,
    ])  # fmt: skip
    contact = history.overturned_over
    point = -1 if contact is None or not contact.points else contact.points[0]
    uplifts = sum(event.kind is SpatialEventKind.UPLIFT for event in events)
    still_rocking = history.outcome is Outcome.ROCKED and last.contact.mode is not ContactMode.REST
    counts = [history.outcome.code, history.status.code, -1 if contact is None else contact.mode.code, point]
    return results, [*counts, len(history.impacts), uplifts, len(events), len(history.pieces), int(still_rocking)]


def provenance_of(
    stated: dict[str, Any],
    motions: Sequence[Any],
    starts: Sequence[SpatialStart],
    duration: float | None,
    default_duration: str,
) -> dict[str, Any]:
    """Return the provenance of a batch without labels and bodies."""
    start_numbers = [start.numbers for start in starts if start.valid]
    return {
        "duration": default_duration if duration is None else float(duration),
        **{f"setting_{name}": value for name, value in stated.items()},
        "motions": json.dumps(
            [[motion_provenance(component) for component in _components(motion)] for motion in motions]
        ),
        "starts": json.dumps(start_numbers),
    }


def _of_bodies(bodies: Bodies) -> dict[str, Any]:
    """Return bodies as JSON, with a digest of all bodies.

    >>> len(json.loads(_of_bodies([SpatialBody.box(1.0, 1.0, 4.0)])["bodies"]))
    1
    """
    text = json.dumps([None if body is None else Answer(body.facts).plain() for body in bodies])
    digest = {"bodies_sha256": hashlib.sha256(text.encode()).hexdigest()}
    return ({"bodies": text} if len(bodies) <= _FEW else {}) | digest
