"""Inputs of `simulate_many` for plane bodies, and its labelled dataset."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from rocking import checks, plausibility, quantities
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.mechanics_base import Combinations, row_of
from rocking.dynamics.parameters import COMPLEMENTARITY, is_none
from rocking.dynamics.plane_frictional.base import Start, starts_of
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, extra
from rocking.messages import listed
from rocking.motions.components import in_plane
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.summary import provenance_of
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr

_START_UNITS = {
    "rotation": "rad", "angular_velocity": "rad/s", "horizontal_velocity": "m/s", "height": "m",
    "vertical_velocity": "m/s",
}  # fmt: skip


def plane_inputs(
    cases: Combinations, kinds: tuple[type, ...] = (Body,)
) -> tuple[list[Any], list[Motion], FloatArray, list[Start] | None]:
    """Return bodies of the classes `kinds`, motions, scales and starts (None if not stated).

    Raise an error for other inputs.
    """
    bodies = _several("bodies", cases.bodies, kinds)
    motions = [in_plane(motion) for motion in _several("motions", cases.motions, (GroundMotion, Pulse, Mapping))]
    scales = row_of("scale", cases.scales)
    plausibility.warn(plausibility.of_scaled(motions, scales))
    if not cases.restitutions:
        raise InvalidValueError("restitution must be at least one model, got none")
    return bodies, motions, scales, starts_of(cases.start, cases.rotation, cases.angular_velocity)


def dataset_of(
    bodies: list[Body],
    motions: list[Motion],
    axes: dict[str, Any],
    results: dict[str, Any],
    settings: Settings,
    attributes: dict[str, Any],
) -> "xr.Dataset":
    """Return a dataset over body, motion and the axes from flat arrays of results, with units and provenance."""
    xarray = extra("xarray", "simulate_many")
    axes = {name: row for name, row in axes.items() if row is not None}
    starts = axes.get("start", [])
    dims = ("body", "motion", *axes)
    shape = (len(bodies), len(motions), *map(len, axes.values()))
    sides = [body.side("right", settings.gravity) for body in bodies]
    numbers = [name for name in ("scale", "friction") if name in axes]
    factors: dict[str, Any] = {name: (name, axes[name], {"units": "1"}) for name in numbers}
    dataset: xr.Dataset = xarray.Dataset(
        {name: (dims, values.reshape(shape), quantities.attributes(name)) for name, values in results.items()},
        coords={
            "slenderness_angle": ("body", [side.slenderness_angle for side in sides], {"units": "rad"}),
            "frequency_parameter": ("body", [side.frequency_parameter for side in sides], {"units": "rad/s"}),
            "motion": [m.name for m in motions],
            "motion_provenance": ("motion", [listed(provenance_of(m)) for m in motions]),
            "restitution": axes["restitution"],
            **factors,
            **_coordinates(starts),
        },
        attrs={
            "software": SOFTWARE,
            **quantities.with_units(attributes),
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in settings.integration.items()},
        },
    )
    return dataset


def _coordinates(starts: list[Start]) -> dict[str, Any]:
    """Return the coordinates of starts: rotation, angular velocity, and other quantities that are not zero."""
    if not starts:
        return {}
    rows = {name: [getattr(start, name) for start in starts] for name in _START_UNITS}
    shown = [name for name in rows if name in {"rotation", "angular_velocity"} or any(rows[name])]
    return {f"initial_{name}": ("start", rows[name], {"units": _START_UNITS[name]}) for name in shown}


_KINDS = {"motions": "GroundMotion, Pulse, Mapping"}


def _several(name: str, value: Any, kinds: tuple[type, ...]) -> list[Any]:
    allowed = f"one or more of {_KINDS.get(name) or kinds[0].__name__}"
    if isinstance(value, kinds):
        return [value]
    if isinstance(value, str) or not isinstance(value, Iterable):
        checks.of_kind(name, value, kinds, allowed)
    items = list(value)
    if not items:
        raise InvalidValueError("{parameter} must be {allowed}, got none", parameter=name, allowed=allowed)
    for index, item in enumerate(items):
        if not isinstance(item, kinds):
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {shown}", parameter=name, allowed=allowed, value=item,
                shown=checks.given(name, item, f" at index {index}"),
            )  # fmt: skip
    return items


def label_of(restitution: Any) -> str:
    """Return the label of a restitution."""
    if is_none(restitution):
        return COMPLEMENTARITY
    label = getattr(restitution, "label", None)
    return label if isinstance(label, str) else str(restitution)
