"""Moreau and Jean's time stepping of convex polyhedra on a plane with Coulomb friction, many bodies at once.

Nothing of the engines is in it: velocities jump once a step, by impulses at the vertices that are below the ground in
the middle of the step (Moreau 1988; Jean 1999), found by Gauss-Seidel with the disk of friction. Impacts are plastic,
which is Housner's impact where one vertex lands. Penetration is not taken back, so that places have an error of the
order of the step.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, g

SWEEPS, CLOSE = 400, 1e-8
"""Most sweeps of a step, and the change of velocity over sqrt(g R) at which they end."""


@dataclass
class Bodies:
    """Bodies, one a row: vertices from the centre of mass [m], mass [kg], inertia [kg m2], friction [-]."""

    points: FloatArray
    mass: FloatArray
    inertia: FloatArray
    friction: FloatArray

    @classmethod
    def of(cls, hulls: list[Any], friction: Any) -> "Bodies":
        """Bodies that have `points`, `mass` and `inertia`; rows of fewer vertices are filled up with NaN."""
        points = np.full((len(hulls), max(len(hull.points) for hull in hulls), 3), np.nan)
        for row, hull in zip(points, hulls, strict=True):
            row[: len(hull.points)] = hull.points
        mass, inertia = (np.array([getattr(hull, name) for hull in hulls]) for name in ("mass", "inertia"))
        return cls(points, mass, inertia, np.broadcast_to(np.asarray(friction, dtype=float), mass.shape))

    @property
    def size(self) -> FloatArray:
        """Largest distance of a vertex [m]."""
        return np.nanmax(np.linalg.norm(self.points, axis=2), axis=1)


@dataclass
class Motion:
    """Place and velocity of the centre, attitude (body to ground) and angular velocity in axes of the ground."""

    place: FloatArray
    attitude: FloatArray
    velocity: FloatArray
    spin: FloatArray

    @classmethod
    def upright(cls, bodies: Bodies) -> "Motion":
        """At rest in the axes of the vertices, the lowest one on the ground."""
        position = np.zeros((len(bodies.mass), 3))
        position[:, 2] = -np.nanmin(bodies.points[..., 2], axis=1)
        return cls(
            position, np.tile(np.eye(3), (len(position), 1, 1)), np.zeros_like(position), np.zeros_like(position)
        )


def crossing(vectors: FloatArray) -> FloatArray:
    """Matrices of the vector product from the left."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    return np.stack([0 * x, -z, y, z, 0 * x, -x, -y, x, 0 * x], axis=-1).reshape(*vectors.shape, 3)


def rotation(angles: FloatArray) -> FloatArray:
    """Rotations by vectors (Rodrigues)."""
    size = np.linalg.norm(angles, axis=1)[:, None, None]
    k = crossing(angles)
    half = np.sinc(0.5 * size / np.pi)
    return np.eye(3) + np.sinc(size / np.pi) * k + 0.5 * half * half * (k @ k)


def advance(bodies: Bodies, now: Motion, pull: FloatArray, step: float, impulses: FloatArray) -> Motion:
    """One step under gravity less the ground's acceleration [m/s2]; `impulses` of the vertices are those to begin with.

    Free velocities by the rule of the middle, the law of contact at the end of the step.
    """
    attitude = rotation(0.5 * step * now.spin) @ now.attitude
    arms = bodies.points @ attitude.transpose(0, 2, 1)
    inertia = attitude @ bodies.inertia @ attitude.transpose(0, 2, 1)
    soft = np.linalg.inv(inertia)
    velocity, spin = now.velocity + step * pull, now.spin
    for _ in range(3):
        mean = 0.5 * (spin + now.spin)
        spin = now.spin - step * _times(soft, np.cross(mean, _times(inertia, mean)))
    low = arms[..., 2] + (now.place + 0.5 * step * now.velocity)[:, None, 2] <= 0.0
    rows = np.flatnonzero(low.any(axis=1))
    if rows.size:
        slots = np.argsort(~low[rows], axis=1, kind="stable")[:, : low.sum(axis=1).max()]
        at = (rows[:, None], slots)
        push = _contact(bodies, rows, arms[at], low[at], (velocity[rows], spin[rows], soft[rows]), impulses[at])
        impulses[rows] = 0.0
        impulses[at] = push
        velocity[rows] += push.sum(axis=1) / bodies.mass[rows, None]
        spin[rows] += _times(soft[rows], np.cross(np.where(low[at][..., None], arms[at], 0.0), push).sum(axis=1))
    place = now.place + 0.5 * step * (now.velocity + velocity)
    return Motion(place, rotation(0.5 * step * spin) @ attitude, velocity, spin)


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def _contact(
    bodies: Bodies, rows: Any, arms: FloatArray, low: FloatArray, free: tuple[FloatArray, ...], first: FloatArray
) -> FloatArray:
    """Impulses of the vertices that are low; shape (row, vertex, 3)."""
    velocity, spin, soft = free
    arms = np.where(low[..., None], arms, 0.0)
    levers = crossing(arms)
    mass = np.eye(3) / bodies.mass[rows, None, None]
    # what an impulse at a vertex does to the velocity of another one
    effect = mass[:, None, None] - levers[:, :, None] @ soft[:, None, None] @ levers[:, None, :]
    moving = velocity[:, None] + np.cross(spin[:, None], arms)
    push = np.where(low[..., None], first, 0.0)
    moving = moving + np.einsum("nklij,nlj->nki", effect, push)
    close = CLOSE * np.sqrt(g * bodies.size[rows])
    impulse, left = push.copy(), np.arange(len(rows))
    friction = bodies.friction[rows]
    for _ in range(SWEEPS):
        change = _sweep(effect, moving, push, low, friction)
        impulse[left] = push
        on = change > close[left]
        if not on.any():
            break
        if on.mean() < 0.7:
            left, effect, moving, push, low, friction = (x[on] for x in (left, effect, moving, push, low, friction))
    return impulse


def _sweep(effect: FloatArray, moving: FloatArray, push: FloatArray, low: FloatArray, friction: FloatArray) -> Any:
    """One sweep over the vertices; `moving` and `push` change. The largest change of a velocity by row."""
    change = np.zeros(len(push))
    for k in range(push.shape[1]):
        own, before = effect[:, k, k], push[:, k].copy()
        push[:, k, 2] = np.maximum(before[:, 2] - moving[:, k, 2] / own[:, 2, 2], 0.0)
        slip = moving[:, k, :2] + own[:, :2, 2] * (push[:, k, 2] - before[:, 2])[:, None]
        a, b, c = own[:, 0, 0], own[:, 1, 1], own[:, 0, 1]
        stiff = 0.5 * (a + b) + np.sqrt(0.25 * (a - b) ** 2 + c * c)
        level = before[:, :2] - slip / stiff[:, None]
        most, size = friction * push[:, k, 2], np.hypot(level[:, 0], level[:, 1])
        push[:, k, :2] = level * np.where(size > most, most / np.maximum(size, 1e-300), 1.0)[:, None]
        push[~low[:, k], k] = 0.0
        more = push[:, k] - before
        moving += (effect[:, :, k] @ more[:, None, :, None])[..., 0]
        change = np.maximum(change, np.abs(more).max(axis=1) * stiff)
    return change


@dataclass
class Tracks:
    """Results: upward direction in body axes at every time step, shape (step, body, 3), and last positions."""

    up: FloatArray
    end: Motion


def tracks(bodies: Bodies, ground: FloatArray, spacing: float, step: float, duration: float) -> Tracks:
    """Shake bodies from rest; ground: accelerations, shape (body, sample, 3), every `spacing` [m/s2, s]."""
    now, impulses = Motion.upright(bodies), np.zeros_like(bodies.points)
    up = np.empty((round(duration / step), len(bodies.mass), 3))
    last = ground.shape[1] - 1
    for k in range(len(up)):
        at = (k + 0.5) * step / spacing
        before, share = int(at), at - int(at)
        field = (1.0 - share) * ground[:, before] + share * ground[:, before + 1] if before < last else 0.0
        now = advance(bodies, now, np.array([0.0, 0.0, -g]) - field, step, impulses)
        up[k] = now.attitude[:, 2]
    return Tracks(up, now)
