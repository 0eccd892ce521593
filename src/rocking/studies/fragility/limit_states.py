"""Limit states of a fragility analysis: rocking, rotations, damage of restraints, overturning."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class LimitState:
    """A limit state. A history that reaches a state of the rotation has reached all lesser states of the rotation."""

    name: str  # ``rocking``, ``rotation > 0.5 alpha``, ``overturned``, ``yield``, ``rupture of tendon 1``
    # rotation / alpha that must be exceeded [-]: 0 for rocking, infinite for overturning, NaN for restraints
    level: float = math.nan
    damage: str = ""  # ``yield`` or ``rupture`` for a limit state of restraints
    restraint: str = ""  # name of the restraint; empty for any restraint


NAMED = {"rocking": LimitState("rocking", 0.0), "overturning": LimitState("overturned", math.inf)}
DAMAGES = ("yield", "rupture")


def limit_states_of(levels: Sequence[float | str] = (0.5,)) -> tuple[LimitState, ...]:
    """Return limit states from rotations / alpha (increasing) and names, overturning last.

    If the sequence contains neither ``rocking`` nor ``overturning``, both are added. States of restraints are
    ``yield``, ``rupture``, ``yield of NAME`` and ``rupture of NAME``.
    """
    items: Any = [levels] if isinstance(levels, str) else levels
    names = [level for level in items if isinstance(level, str)] if isinstance(items, list | tuple) else []
    if len(set(names)) < len(names):
        raise InvalidValueError(
            "{parameter} must contain each name at most once, got {value}", parameter="limit_states", value=levels
        )
    damaged = [state for name in names if (state := damage_state(name)) is not None]
    chosen = [name for name in names if damage_state(name) is None]
    if unknown := [name for name in chosen if name not in NAMED]:
        raise InvalidValueError(
            parameter="limit_states", value=unknown[0],
            allowed=f"rotations / alpha, {', '.join(NAMED)}, yield, rupture, yield of NAME or rupture of NAME",
        )  # fmt: skip
    between = _rotations([level for level in items if not isinstance(level, str)] if names else items)
    rocking, overturning = ([state] * (not chosen or name in chosen) for name, state in NAMED.items())
    return (*rocking, *between, *damaged, *overturning)


def damage_state(name: str) -> LimitState | None:
    """Return the state of restraints with a name; None for another name."""
    damage, of, restraint = name.partition(" of ")
    return (
        LimitState(name, damage=damage, restraint=restraint)
        if damage in DAMAGES and bool(of) == bool(restraint)
        else None
    )


def _rotations(levels: Any) -> tuple[LimitState, ...]:
    rotations = np.atleast_1d(np.asarray(levels))
    rotations = checks.positive_array("limit_states", rotations) if rotations.size else np.empty(0)
    if rotations.ndim != 1:
        allowed = "a one-dimensional array of rotations / alpha"
        raise InvalidValueError(parameter="limit_states", allowed=allowed, value=levels)
    checks.increasing("limit_states", rotations)
    return tuple(LimitState(f"rotation > {level:.6g} alpha", float(level)) for level in rotations)
