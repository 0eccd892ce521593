"""Results of every kind for asymmetric bodies, as hashes of their bytes: run under settings that stand for processors.

``python results_to_compare.py [NAME ...]`` prints names and hashes as JSON; it says nothing of what is right. With
ROCKING_CAMPAIGN=1 histories are longer and more.
"""

import dataclasses
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import rocking as rk
from rocking.dynamics.plane import fast_engine as plane_engine
from rocking.dynamics.rolling import SpatialBody, SpatialStart
from rocking.dynamics.rolling import fast_engine as space_engine
from rocking.dynamics.rolling.batch import batch_in_space
from rocking.motions.filters import geometric
from rocking.restitution.bed import ContactBed, KelvinVoigt

STEP = 0.015625
LONG = os.environ.get("ROCKING_CAMPAIGN") == "1"
PEDESTAL = rk.Section([rk.Region([(-0.45, 0.0), (0.55, 0.0), (0.4, 2.5), (-0.15, 2.2)], density=2400.0)])
CORNERS = np.array([[-0.4, -0.3], [0.3, -0.35], [0.45, 0.15], [0.1, 0.4], [-0.35, 0.25]])
STATUE = rk.Solid([
    rk.bodies.Part(rk.bodies.solid.extrusion(CORNERS, 1.4), 2400.0),
    rk.bodies.Part(rk.bodies.solid.frustum(0.4, 0.2, 0.9), 1800.0).moved(0.05, -0.03, 1.4),
])  # fmt: skip
LAWS = ["housner-3d", "horizontal-momentum-3d", "ked-3d", 0.9]


def noise(factor: int, size: float, count: int = 400) -> rk.GroundMotion:
    """Shaking by remainders of whole numbers: every machine has it to the last bit."""
    number = np.arange(count)
    walk = (number * number * factor + 11 * number) % 101 - 50
    slow = (number * factor // 7) % 41 - 20
    return rk.GroundMotion(size * (walk + 2.0 * slow) / 64.0, STEP)


def shaking(seed: int) -> tuple[rk.GroundMotion, rk.GroundMotion, rk.GroundMotion]:
    """Three components."""
    return noise(37 + seed, 3.0), noise(53 + 3 * seed, 2.5), noise(91 + seed, 1.0)


def tower(radius: float | None = None) -> SpatialBody:
    """A body without symmetry on a polygon, or on a round base."""
    inertia = np.array([[410.0, 12.0, -21.0], [12.0, 380.0, 15.0], [-21.0, 15.0, 66.0]])
    return SpatialBody(1000.0, np.array([0.03, -0.02, 1.0]), inertia, CORNERS if radius is None else radius)


def bytes_of(value: Any) -> Iterator[bytes]:
    """Numbers of results: arrays, dataclasses, sequences and mappings of them."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        for part in value:
            yield from bytes_of(part)
    elif dataclasses.is_dataclass(value):
        yield from bytes_of([getattr(value, field.name) for field in dataclasses.fields(value)])
    elif isinstance(value, (int, float, np.ndarray, np.generic)):
        yield np.ascontiguousarray(value).tobytes()
    else:
        yield repr(value).encode()


def of_space(response: Any) -> list[Any]:
    """Return what a history in space says."""
    states = [response.quaternion, response.angular_velocity, response.centre]
    return [*states, response.impacts, response.peak_tilt, response.overturning_time, response.outcome.value]


def space(body: SpatialBody) -> list[Any]:
    """Histories of the reference engine, one a law."""
    laws = LAWS if body.matter else ["housner-3d", 0.95]
    end = (1.2 if body.round else 3.0) * (1.0 if LONG else 0.25)
    return [of_space(rk.simulate(body, shaking(k), law, scale=0.9, duration=end)) for k, law in enumerate(laws)]


def spatial_batch() -> list[Any]:
    """Histories of the compiled engine in space."""
    bodies, motions = [SpatialBody.of(STATUE), tower(), tower(0.3)], [shaking(k) for k in range(6 if LONG else 2)]
    laws: list[Any] = ["housner-3d", "horizontal-momentum-3d", 0.9, 0.97]
    found = batch_in_space(bodies, motions, laws, scales=[0.3, 0.6, 1.2])
    statue = batch_in_space(bodies[:1], motions[:2], ["ked-3d"], scales=[0.6])
    spun = [
        SpatialStart(tilt=0.05, azimuth=0.7 * k, yaw=0.3 * k, angular_velocity=(0.2, -0.1, 0.1 * k))
        for k in range(8 if LONG else 3)
    ]
    thrown = batch_in_space(bodies[:1], motions[:1], [0.9], start=spun)
    return [value for one in (found, statue, thrown) for value in one.values.values()]


def plane(engine: str) -> list[Any]:
    """Histories in the plane of one engine: records with a vertical part, and pulses of degree seven."""
    bodies = [PEDESTAL, rk.Block(width=0.5, height=2.0)]
    both = [
        rk.GroundMotion(noise(37 + k, 3.0).acceleration, STEP, noise(91 + k, 1.0).acceleration)
        for k in range(4 if LONG else 1)
    ]
    kinds = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.rectangular, rk.pulses.ricker, rk.pulses.antisymmetric_ricker)
    pulses = [kind(5.0, 0.8) for kind in kinds]
    found = [
        rk.simulate_many(bodies, motions, ["ked", "housner"], scale=[0.4, 1.0], engine=engine)
        for motions in (both, pulses)
    ]
    return [table.values for one in found for table in one.data_vars.values()]


def response() -> list[Any]:
    """One response with all that follows from it."""
    made = rk.simulate(PEDESTAL, shaking(0)[0], "ked", engine="reference", scale=0.5)
    return [made.rotation, made.angular_velocity, made.impacts, made.energy.work, made.energy.lost]


def contact() -> list[Any]:
    """Sliding, rocking and flight in the plane."""
    motion = rk.GroundMotion(noise(37, 3.0).acceleration, STEP, noise(91, 4.0).acceleration)
    made = [rk.simulate(PEDESTAL, motion, None, friction=friction, scale=0.6) for friction in (0.15, 0.4, 2.0)]
    return [[r.rotation, r.displacement, r.rise, r.outcome.value] for r in made]


def corrected() -> list[Any]:
    """Records with their trends, means and ends taken off, and their intensity."""
    trends = [rk.motions.detrended(noise(37, 3.0), n, fit) for n in (1, 2, 3) for fit in ("velocity", "acceleration")]
    made = [*trends, rk.motions.demeaned(noise(53, 3.0)), rk.motions.tapered(noise(91, 3.0), 0.1)]
    return [motion.acceleration for motion in made]


def bed(engine: Any) -> list[Any]:
    """Impacts on beds of springs and dashpots."""
    found = []
    for ratio in (0.2, 1.0):
        law = KelvinVoigt(PEDESTAL.mass * 2.0e6, damping_ratio=ratio)
        impact = rk.restitution.bed.bed_impact(
            PEDESTAL, ContactBed.uniform(PEDESTAL, 9, law), angular_velocity=0.5, engine=engine
        )
        found.append([impact.results, impact.samples])
    return found


def coefficients() -> list[Any]:
    """Coefficients in the plane: every model, one body and many."""
    many = np.linspace(0.5, 9.0, 101)
    names = [name for name in rk.restitution.models() if name not in {"fixed", "implied"}]
    one = [rk.coefficient_of_restitution(PEDESTAL, name) for name in names]
    blocks = [rk.Block(width=1.0, height=float(h)) for h in many]
    return [one, [rk.coefficient_of_restitution(b, name) for name in ("ked", "contact-bed") for b in blocks]]


def spatial_impacts() -> list[Any]:
    """Moments of a solid and impacts in space, onto corners and edges."""
    moments, edges = STATUE.local_moments, STATUE.base.edges
    made = [
        rk.restitution.space.impact_in_space(
            STATUE, -edges[0].direction, pivot=edges[0], onto=onto, model=model
        ).velocity
        for onto in (edges[2], STATUE.base.corners[3])
        for model in ("housner-3d", "horizontal-momentum-3d", "ked-3d")
    ]
    return [moments.mass, moments.centre, moments.second, *made]


def starts() -> list[Any]:
    """Free rocking in space from given angles."""
    return [
        of_space(
            rk.free_rocking(
                body,
                restitution="housner",
                start=SpatialStart(0.12, 0.6, angular_velocity=(0.1, 0.0, 0.8)),
                duration=3.0,
            )
        )
        for body in (tower(), tower(0.3))
    ]


def of_examples() -> list[Any]:
    """Motions of the package, and what its plane bodies lose under the paper's model."""
    made = [rk.examples.motion(name) for name in rk.examples.catalogue("motion")]
    motions = [part for one in made for part in (one.values() if isinstance(one, dict) else [one])]
    bodies = [body for body in map(rk.examples.body, rk.examples.catalogue("body")) if not isinstance(body, rk.Solid)]
    return [
        [motion.acceleration for motion in motions],
        [rk.coefficient_of_restitution(each, "ked", foot="left") for each in bodies],
    ]


RESULTS: dict[str, Callable[[], list[Any]]] = {
    "space, polygon, reference": lambda: space(tower()),
    "space, round base, reference": lambda: space(tower(0.3)),
    "space, solid, reference": lambda: space(SpatialBody.of(STATUE)),
    "space, free rocking": starts,
    "space, batch": spatial_batch,
    "space, impacts and moments": spatial_impacts,
    "plane, reference": lambda: plane("reference"),
    "plane, fast": lambda: plane("fast"),
    "plane, response": response,
    "plane, contact": contact,
    "plane, coefficients": coefficients,
    "levels in equal ratios": lambda: [geometric(np.array([2.0, 0.3]), np.array([9.0, 0.7]), 500)],
    "motions, corrected": corrected,
    "examples": of_examples,
    "bed, reference": lambda: bed("reference"),
    "bed, fast": lambda: bed("fast"),
}


def main(names: list[str]) -> None:
    """Print hashes."""
    missing = {"plane, fast": plane_engine, "space, batch": space_engine}
    made = {}
    for name in names or RESULTS:
        if name in missing and not missing[name].available():
            continue
        made[name] = hashlib.sha256(b"|".join(bytes_of(RESULTS[name]()))).hexdigest()[:12]
    print(json.dumps(made))


if __name__ == "__main__":
    main(sys.argv[1:])
