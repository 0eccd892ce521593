"""JAX and diffrax on the batch: all histories side by side, fixed steps, events by masks, compiled beforehand."""

from importlib import import_module
from typing import Any

import numpy as np

from benchmarks.engine_batch import STEP, Histories
from benchmarks.engine_peers import Verdicts
from rocking.conventions import g

GROUPS = 4


def jax_rk4(batch: Histories, substeps: int = 2) -> Verdicts:
    """Runge-Kutta steps written out."""
    jax = import_module("jax")
    jax.config.update("jax_enable_x64", True)

    def advance(rates: Any, y: Any, push: Any, h: Any) -> Any:
        (a, b), y = push, jax.numpy.stack(y)  # as an array, or the compiler works out stages several times
        middle = 0.5 * (a + b)

        def slope(y: Any, push: Any) -> Any:
            return jax.numpy.stack(rates((y[0], y[1]), push))

        k1 = slope(y, a)
        k2 = slope(y + 0.5 * h * k1, middle)
        k3 = slope(y + 0.5 * h * k2, middle)
        k4 = slope(y + h * k3, b)
        y += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        return y[0], y[1]

    return _compiled(jax, batch, advance, substeps)


def diffrax_tsit5(batch: Histories, substeps: int = 2) -> Verdicts:
    """Steps of diffrax's Tsit5 solver."""
    jax, diffrax = import_module("jax"), import_module("diffrax")
    jax.config.update("jax_enable_x64", True)
    solver = diffrax.Tsit5()

    def advance(rates: Any, y: Any, push: Any, h: Any) -> Any:
        a, b = push
        term = diffrax.ODETerm(lambda t, y, _: rates(y, a + (b - a) * (t / h)))
        state = solver.init(term, 0.0, h, y, None)
        return solver.step(term, 0.0, h, y, None, state, False)[0]

    return _compiled(jax, batch, advance, substeps)


def _compiled(jax: Any, batch: Histories, advance: Any, substeps: int) -> Verdicts:
    """Groups of histories of like lengths, each padded to its longest with ground at rest."""
    history = _history(jax, advance, substeps)
    order = np.argsort([record.size for record in batch.records])
    work = []
    for numbers in np.array_split(order, GROUPS):
        group = batch.some(numbers)
        longest = max(record.size for record in group.records)
        push = np.zeros((len(group), longest))
        for row, record, scale in zip(push, group.records, group.scale, strict=True):
            row[: record.size] = record * (scale / g)
        arrays = [jax.numpy.asarray(column) for column in (push, group.alpha, group.p, group.r)]
        work.append((numbers, jax.jit(jax.vmap(history)).lower(*arrays).compile(), arrays))

    def run() -> np.ndarray:
        out = np.zeros(len(batch), bool)
        for numbers, function, arrays in work:
            out[numbers] = np.asarray(function(*arrays))
        return out

    return run


def _history(jax: Any, advance: Any, substeps: int) -> Any:
    jnp, h = jax.numpy, STEP / substeps

    def history(record: Any, alpha: Any, p: Any, r: Any) -> Any:
        limit, slow = jnp.tan(alpha), 1e-3 * p * alpha

        def substep(state: Any, push: Any) -> Any:
            th, om, side, resting, fallen = state
            a, b = push
            lifts = resting & (jnp.abs(a) > limit)
            side = jnp.where(lifts, -jnp.sign(a), side)
            resting = resting & ~lifts

            def rates(y: Any, push: Any) -> Any:
                gap = alpha * side - y[0]
                return y[1], -p * p * (jnp.sin(gap) + push * jnp.cos(gap))

            th1, om1 = advance(rates, (th, om), push, h)
            hit = (side * th1 < 0.0) & ~resting
            share = jnp.where(hit, th / jnp.where(hit, th - th1, 1.0), 0.0)
            after = r * (om + share * (om1 - om))
            th1, om1 = jnp.where(hit, after * (1.0 - share) * h, th1), jnp.where(hit, after, om1)
            side = jnp.where(hit, -side, side)
            resting = resting | (hit & (jnp.abs(after) < slow) & (jnp.abs(b) < limit))
            th1 = jnp.where(resting, 0.0, jnp.where(fallen, th, th1))
            om1 = jnp.where(resting, 0.0, jnp.where(fallen, om, om1))
            return th1, om1, side, resting, fallen | (jnp.abs(th1) > 1.57)

        def sample(state: Any, push: Any) -> Any:
            a, b = push
            for k in range(substeps):
                rise = (b - a) / substeps
                state = substep(state, (a + k * rise, a + (k + 1) * rise))
            return state, None

        start = (jnp.array(0.0), jnp.array(0.0), jnp.array(1.0), jnp.array(True), jnp.array(False))
        (th, om, side, resting, fallen), _ = jax.lax.scan(sample, start, (record[:-1], record[1:]))
        outward, size = side * om, side * th
        passes = 0.5 * (om / p) ** 2 + jnp.cos(alpha - size) > 1.0
        over = jnp.where(size > alpha, ~((outward < 0.0) & passes), (outward > 0.0) & passes)
        return fallen | (over & ~resting)

    return history
