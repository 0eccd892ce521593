"""Question of a study (one body, one motion, restitution and settings), and variations of these."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks, quantities
from rocking.bodies import PLANE_BODIES, Block, Body, Restrained
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.dynamics.batch import Batch
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rows import Rows
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.messages import listed
from rocking.motions.components import Components, together
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.summary import provenance_of
from rocking.outcome import Outcome, flags
from rocking.restitution.from_file import origin_of
from rocking.version import SOFTWARE

UNLIFTED, SURVIVED, FAILED = -2, -1, -3
"""Modes that are not a number of impacts before overturning: no uplift, rocking without overturning, no result."""


@dataclass(frozen=True)
class Question:
    """One body under one motion, which can be varied."""

    body: Any  # a plane or 3D body
    motion: Any  # a motion, or components by axis, as for `simulate`
    restitution: Any = DEFAULT_RESTITUTION  # as for `simulate`
    settings: Settings = field(default_factory=PlaneSettings)  # settings of the integration
    threads: int | None = None  # number of threads of the fast engine; the results do not depend on this number
    engine: str = "auto"  # name of the engine

    def __post_init__(self) -> None:
        object.__setattr__(self, "motion", together(self.motion, plane=isinstance(self.body, PLANE_BODIES)))
        checks.of_kind("motion", self.motion, (GroundMotion, Pulse, Components), "a GroundMotion or a pulse")
        _ = self.parameters

    @cached_property
    def parameters(self) -> RockingParameters:
        """Parameters of the unchanged body."""
        return self.parameters_of(self.body)

    @property
    def law(self) -> ImpactLaw:
        """Law of the coefficient per impact."""
        return self.parameters.law

    @cached_property
    def batch(self) -> Batch:
        """The motion prepared for the engine."""
        return Batch([self.motion.segments()], self.law, self.settings, self.threads, self.engine)

    def parameters_of(self, body: Body | Restrained) -> RockingParameters:
        """Return the parameters of another body. The restitution is evaluated for this body."""
        return mechanics_of(self.settings).parameters(body, self.restitution, self.settings)

    def run(
        self,
        values: dict[str, FloatArray],
        stretch: FloatArray,
        stream: Any = None,
        progress: Callable[[int], None] | None = None,
    ) -> tuple[Arrays, dict[str, int]]:
        """Return the results of variations, including modes and relative peaks [-]."""
        # values: sides, scale and other varied inputs by the names of `batch.ROWS`, one entry per history
        count = stretch.size
        if np.any(stretch != 1.0):
            self.check_stretching("an axis")
        rows = Rows.of(count, 0, stream, **quickened(values, stretch))
        results, work = self.batch.run(count, rows.part, progress)
        for name in quantities.TIMES:
            results[name] = results[name] * stretch
        results["peak_velocity"] = results["peak_velocity"] / stretch
        results |= {"mode": modes_of(results), **flags(results)}
        results["peak_ratio"] = peak_ratio(results["peak_rotation"], values["alpha_right"], values["alpha_left"])
        return results, work

    def check_restraints(self, name: str) -> None:
        """Raise an error for a body with restraints, whose dimensions and motion in time do not vary."""
        if isinstance(self.body, Restrained):
            raise InvalidValueError(
                "{name} cannot vary for a body with restraints", name=name,
                hint="Use pga, scale, amplitude_ratio, restitution, initial_rotation or initial_angular_velocity.",
            )  # fmt: skip

    def check_stretching(self, name: str) -> None:
        """Raise an error if time is stretched for restraints, or for a restitution that depends on the speed."""
        self.check_restraints(name)
        if self.law.kind in {1, -1}:
            raise InvalidValueError(
                "{name} stretches the time of the motion, which needs a restitution that does not depend on the speed "
                "in rad/s, got {law}", name=name, law=type(self.law).__name__, hint="Vary scale and size.",
            )  # fmt: skip

    def attributes(self, work: dict[str, int]) -> dict[str, Any]:
        """Return inputs, settings and work of the computation, as plain values."""
        motion = self.motion
        return {
            "software": SOFTWARE,
            "engine": mechanics_of(self.settings).engine_of_study(fast=bool(work)),
            "body": repr(self.body),
            "motion": motion.name,
            "motion_provenance": listed(provenance_of(motion)),
            "restitution": self.parameters.label,
            **origin_of(self.parameters.label),
            "seed": int(getattr(self.law, "seed", 0)),
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in self.settings.stated.items()},
            **{f"work_{k}": v for k, v in work.items()},
        }


@dataclass(frozen=True)
class Case:
    """Variations of a question, one entry per variation. Axes return changed copies."""

    question: Question  # the question before variation
    count: int  # number of variations
    scale: FloatArray  # scale factor of the motion [-]
    stretch: FloatArray  # factor on the time of the motion [-]
    # dimensions that vary, by the names of `changed_body` [m, rad]
    geometry: Mapping[str, FloatArray] = field(default_factory=dict)
    # alpha, p and r (right and left) of the final bodies [rad, rad/s, -]
    sides: Mapping[str, FloatArray] = field(default_factory=dict)
    amplitude_is_set: bool = False  # True if an axis has set the amplitude; an axis of velocity then changes the time

    @classmethod
    def of(cls, question: Question, count: int) -> "Case":
        """Return equal copies of a question, as variations."""
        return cls(question, count, np.ones(count), np.ones(count))

    def settled(self) -> "Case":
        """Return the case with final bodies and restitution. Impossible bodies are NaN."""
        names = sorted(self.geometry)
        if not names:
            rows, inverse = np.empty((1, 0)), np.zeros(self.count, dtype=np.int64)
        else:
            rows, inverse = np.unique(np.stack([self.geometry[n] for n in names], axis=-1), axis=0, return_inverse=True)
        table = sides_of(self._parameters([dict(zip(names, row.tolist(), strict=True)) for row in rows]))
        return replace(self, sides={name: values[inverse.ravel()] for name, values in table.items()})

    def _parameters(self, dimensions: list[dict[str, float]]) -> list[RockingParameters | None]:
        parameters: list[RockingParameters | None] = []
        refused: InvalidValueError | None = None
        for sizes in dimensions:
            try:
                parameters.append(self.question.parameters_of(changed_body(self.question.body, sizes)))
            except InvalidValueError as error:
                parameters.append(None)
                refused = error
        if refused is not None and not any(parameters):
            raise refused
        return parameters

    @property
    def slenderness_angle(self) -> FloatArray:
        """Slenderness angle of the side that lifts first [rad]."""
        return np.fmin(self.sides["alpha_right"], self.sides["alpha_left"])

    @property
    def frequency_parameter(self) -> FloatArray:
        """Frequency parameter p of the side that lifts first [rad/s]."""
        left = self.sides["alpha_left"] < self.sides["alpha_right"]
        return np.where(left, self.sides["p_left"], self.sides["p_right"])

    @property
    def uplift_acceleration(self) -> FloatArray:
        """Ground acceleration of uplift: g tan alpha, or g alpha in the linear equations [m/s2]."""
        settings = self.question.settings
        return np.asarray(np.fmin(*mechanics_of(settings).uplift_accelerations(settings, self.sides)))

    @property
    def values(self) -> dict[str, FloatArray]:
        """Engine inputs of the variations."""
        return {**self.sides, "scale": self.scale}


_RATES = {"p_right", "p_left", "velocity"}


def quickened(values: Mapping[str, FloatArray], stretch: FloatArray) -> dict[str, FloatArray]:
    """Return bodies whose response to the motion equals the response of the given bodies to the stretched motion.

    A motion that is stretched in time by s has the same effect on a body with frequency parameter p as the unstretched
    motion on a body with p s, if all times are multiplied by s. Therefore, one motion replaces all stretched motions
    without approximation.
    """
    return {name: row * stretch if name in _RATES else row for name, row in values.items()}  # Eq. 179


def reference_side(body: Body) -> str:
    """Return the side of first uplift, which is the more slender side. If both are equal, return the right side."""
    return "left" if body.side("left").slenderness_angle < body.side("right").slenderness_angle else "right"


def changed_body(body: Any, parameters: Mapping[str, float]) -> Any:
    """Return a body with other dimensions."""
    # semi_diagonal [m] scales all lengths of any body; slenderness_angle [rad], width and height [m] are for a
    # block. Slenderness alone keeps the semi-diagonal, width alone keeps the height, and height alone keeps the width.
    if not parameters:
        return body
    if not isinstance(body, Body):
        if set(parameters) != {"semi_diagonal"}:
            raise InvalidValueError(
                "only the semi-diagonal of a 3D body varies, got {names}", names=", ".join(parameters)
            )
        return body.scaled(size=parameters["semi_diagonal"] / SpatialBody.of(body).size)
    if set(parameters) == {"semi_diagonal"}:
        side = body.side(reference_side(body))  # type: ignore[arg-type]
        return body.scaled(size=parameters["semi_diagonal"] / side.semi_diagonal)
    if not isinstance(body, Block):
        raise InvalidValueError(
            "slenderness, width and height vary only for a Block, got {value}", parameter="body", value=body
        )
    if body.known is not None or not body.stands_on_corners:
        raise InvalidValueError(
            "slenderness, width and height vary only for a homogeneous Block on its corners. Remove centre, "
            "moment_of_inertia and feet, or vary the semi-diagonal."
        )
    width, height = _dimensions(body, parameters)
    return Block(width=width, height=height, depth=body.depth, density=body.density)


def _dimensions(block: Block, dimensions: Mapping[str, float]) -> tuple[float, float]:
    alpha, diagonal = dimensions.get("slenderness_angle"), dimensions.get("semi_diagonal")
    width, height = dimensions.get("width"), dimensions.get("height")
    if alpha is not None:
        if height is not None:
            return height * math.tan(alpha), height
        if width is not None:
            return width, width / math.tan(alpha)
        size = 2.0 * (block.semi_diagonal if diagonal is None else diagonal)
        return size * math.sin(alpha), size * math.cos(alpha)
    if diagonal is not None:
        fixed = next((side for side in (height, width) if side is not None), 0.0)
        square = 4.0 * diagonal**2 - fixed**2
        if square <= 0.0:
            raise InvalidValueError(
                "no block of semi-diagonal {diagonal:g} m has a side of {side:g} m", diagonal=diagonal, side=fixed
            )
        other = math.sqrt(square)
        return (width, other) if width is not None else (other, dimensions["height"])
    return (block.width if width is None else width), (block.height if height is None else height)


def modes_of(results: Arrays) -> np.ndarray:
    """Return the modes: -3 failed, -2 no uplift, -1 rocking without overturning, n >= 0 overturned after n impacts.

    >>> modes_of({"outcome": np.array([0, 1, 2, 3]), "impacts": np.array([0, 3, 1, 0])}).tolist()
    [-2, -1, 1, -3]
    """
    outcome = np.asarray(results["outcome"])
    modes = {
        Outcome.OVERTURNED: results["impacts"], Outcome.NO_UPLIFT: UNLIFTED, Outcome.SLID: UNLIFTED,
        Outcome.FAILED: FAILED,
    }  # fmt: skip
    selected = np.select([outcome == kind.code for kind in modes], list(modes.values()), SURVIVED)
    return np.asarray(selected, dtype=np.int64)


def peak_ratio(peak: FloatArray, right: FloatArray, left: FloatArray) -> FloatArray:
    """Return the peak rotation / slenderness angle of its side [-]. Values above 1 need not be overturning."""
    return np.abs(peak) / np.where(np.asarray(peak) < 0.0, left, right)  # Eq. 181
