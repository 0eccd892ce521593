"""The problem of a study: bodies, motions, restitutions and settings from its tables."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import PLANE_BODIES, Body
from rocking.conventions import COMPARED_RESTITUTIONS, FRAME_RESTITUTION, FloatArray, g
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, located
from rocking.spec.bodies import body_for_motion, without_restraints
from rocking.spec.construction import motions_of, restitutions_of
from rocking.spec.reading import InputFiles
from rocking.studies.axis import friction_beside
from rocking.studies.motion_sets import MotionList, MotionSet

if TYPE_CHECKING:
    from rocking.spec.question import StudyQuestion
    from rocking.studies.histories import Product


@dataclass(frozen=True)
class StudyProblem:
    """Bodies, motions, restitutions and settings of a study."""

    document: Any  # an instance of a subclass of `StudyQuestion`
    bodies: list[Any]  # all 2D or all 3D; empty for spectra
    motions: MotionSet
    restitutions: dict[str, Any]  # restitutions by label
    settings: Settings  # settings of mechanics and integration
    inputs: InputFiles  # input files with their hashes

    @classmethod
    def of(cls, document: "StudyQuestion", files: Path | InputFiles) -> "StudyProblem":
        """Return the study problem of the tables. `files` records the named files, or is their folder."""
        inputs = files if isinstance(files, InputFiles) else InputFiles(files)
        with located("settings"):
            stated, axes = document.settings.stated(), document.axes
            stated |= friction_beside(axes, stated.get("friction"))
        turned = any(table.y is not None for table in document.motions) or any(axis.name == "azimuth" for axis in axes)
        if turned and document.plane:
            raise InvalidValueError(
                "The blocks of a spectrum accept motions along x and z only",
                parameter="motions",
                hint=document.without_body,
            )
        bodies: list[Any] = []
        for k, table in enumerate(document.bodies):
            with located("body" if len(document.bodies) == 1 else f"body[{k}]"):
                body = body_for_motion(table, inputs, in_space=turned)
                bodies.append(body if document.with_restraints else without_restraints(body))
        with located("settings"):
            kinds = {isinstance(body, PLANE_BODIES) for body in bodies}
            if len(kinds) > 1:
                raise InvalidValueError("A study needs only 2D bodies or only 3D bodies.")
            settings = study_settings(next(iter(bodies), None), stated, stated.pop("gravity", g))
        plane = document.plane or kinds == {True}
        motions: MotionSet = MotionList.empty()
        if document.motions:
            motions = motions_of(document.motions, inputs, paired=kinds == {False}, plane=plane)
        seed, mechanics = document.campaign.seed, mechanics_of(settings)
        restitutions = restitutions_of(document.restitution, seed, bodies, inputs, mechanics=mechanics)
        return cls(document, bodies, motions, restitutions, settings, inputs)

    @property
    def options(self) -> dict[str, Any]:
        """Settings and engine as keywords for the functions of studies."""
        return {**self.settings.stated, "engine": self.document.settings.engine}

    @property
    def stated(self) -> dict[str, Any]:
        """Stated settings of the document, and engine."""
        return {**self.document.settings.stated(), "engine": self.document.settings.engine}

    @property
    def restitution(self) -> Any:
        """The first restitution."""
        return next(iter(self.restitutions.values()))

    @property
    def with_compared_models(self) -> dict[str, "StudyProblem"]:
        """The problem with each compared restitution model; empty if the document states a restitution."""
        stated = "restitution" in self.document.model_fields_set | {axis.name for axis in self.document.axes}
        compared = not stated and FRAME_RESTITUTION not in self.restitutions
        return (
            {} if not compared else {name: replace(self, restitutions={name: name}) for name in COMPARED_RESTITUTIONS}
        )

    def answer(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Any:
        """Compute the study in memory."""
        return self.document.answer(self, progress, threads)

    @property
    def kept_motions(self) -> MotionList:
        """The motions, all in memory."""
        motions = self.motions
        return motions if isinstance(motions, MotionList) else MotionList([motions[k] for k in range(len(motions))])

    def only(self, field_name: str) -> Any:
        """Return the only body, motion or restitution. Raise an error if there are several."""
        items: Any = getattr(self, field_name)
        if len(items) != 1:
            raise InvalidValueError(
                "{name} accepts one entry without a campaign, got {count}", parameter=field_name, name=field_name,
                count=len(items), hint="rocking campaign accepts several",
            )  # fmt: skip
        return self.restitution if field_name == "restitutions" else items[0]

    def product(self, bodies: Sequence[Body], scales: FloatArray) -> "tuple[Product, dict[str, Any]]":
        """Return the histories of all bodies, motions, scales and restitutions, and the attributes of the study."""
        from rocking.studies.histories import Product

        settings, restitutions = self.settings, list(self.restitutions.values())
        make = mechanics_of(settings).parameters
        parameters = [[make(body, restitution, settings) for body in bodies] for restitution in restitutions]
        columns = [sides_of(row) for row in parameters]
        sides = {name: np.stack([column[name] for column in columns], axis=-1) for name in columns[0]}
        law, engine = parameters[0][0].law, self.document.settings.engine
        stated = {f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in settings.stated.items()}
        attributes = {"seed": int(getattr(law, "seed", 0)), **stated}
        if len(restitutions) == 1:
            attributes["restitution"] = parameters[0][0].label
        return Product(self.motions, sides, scales, law=law, settings=settings, engine=engine), attributes
