"""All mechanics, and the choice among them for a history, a batch or a study.

A new mechanics needs a folder with a `mechanics.py`, and an entry in `MECHANICS`.
"""

from collections.abc import Mapping
from typing import Any

from rocking import conventions
from rocking.bodies import PLANE_BODIES
from rocking.dynamics.frictional.mechanics import HullRocking
from rocking.dynamics.isolated.mechanics import IsolatedRocking
from rocking.dynamics.mechanics_base import Mechanics, in_space
from rocking.dynamics.plane.mechanics import PlaneRocking
from rocking.dynamics.plane_frictional.mechanics import PlaneContact
from rocking.dynamics.restrained.mechanics import RestrainedRocking
from rocking.dynamics.rolling.mechanics import SpaceRocking
from rocking.dynamics.settings import Settings
from rocking.dynamics.stack.mechanics import StackRocking
from rocking.restitution.headline import label_of

MECHANICS: tuple[Mechanics, ...] = (
    IsolatedRocking(), RestrainedRocking(), StackRocking(), PlaneRocking(), PlaneContact(), SpaceRocking(),
    HullRocking(),
)  # fmt: skip


def mechanics_for(body: Any, friction: Any, *, study: bool = False) -> Mechanics:
    """Return the mechanics of a body. `friction` is a coefficient or None; `study` is True in a study."""
    return next(mechanics for mechanics in MECHANICS if mechanics.takes(body, friction, study=study))


def mechanics_for_all(bodies: Any, friction: Any) -> Mechanics:
    """Return the mechanics of one or several bodies. The mechanics is 3D only if all bodies are 3D."""
    several = bodies if isinstance(bodies, (list, tuple)) else [bodies]
    plane = [body for body in several if isinstance(body, PLANE_BODIES)]
    return mechanics_for(next(iter(plane or filter(in_space, several)), None), friction)


def restitution_label(name: str, body: Any) -> str:
    """Return the label of a restitution model in results. Labels for 3D bodies end with -3d."""
    return label_of(name, in_space=in_space(body))


def mechanics_of(settings: Settings) -> Mechanics:
    """Return the mechanics to which settings belong."""
    return next(
        mechanics for mechanics in MECHANICS if isinstance(settings, (mechanics.settings, mechanics.batch_settings))
    )


def study_settings(body: Any, options: Mapping[str, Any], gravity: float = conventions.g) -> Settings:
    """Return the settings of a study of a plane or 3D body. `options` contains fields of the settings by name."""
    mechanics = mechanics_for(body, options.get("friction"), study=True)
    return mechanics.study_settings(body, {**options, "gravity": gravity})
