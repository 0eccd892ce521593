"""Histories: every motion with every body, scale factor and restitution."""

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from pydantic import Field

from rocking.errors import InvalidValueError, located
from rocking.messages import listed
from rocking.spec.fields import JobTable, Numbers, Values
from rocking.spec.question import BodyQuestion

if TYPE_CHECKING:
    from rocking.spec.study import StudyProblem
    from rocking.studies.study_plan import Study


class HistoriesTable(JobTable):
    """Scale factors of the histories of a campaign."""

    scales: Numbers = Field(
        default_factory=lambda: Values(values=[1.0]),
        description="scale factors of motions [-]",
        json_schema_extra={"usual": "1", "allowed": "any numbers: a negative factor reverses the motion"},
    )


class HistoriesQuestion(BodyQuestion):
    """Every motion with every body, scale factor and restitution."""

    kind: ClassVar[str] = "histories"
    with_restraints: ClassVar[bool] = True
    several_bodies: ClassVar[bool] = True

    histories: HistoriesTable = Field(default_factory=HistoriesTable)

    @property
    def sizes(self) -> list[int]:
        """Numbers of motions, bodies, restitutions and scale factors."""
        return [*super().sizes, self.histories.scales.size]

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, body, scale factor and restitution."""
        from rocking.motions.summary import provenance_of
        from rocking.studies.motion_sets import MotionList
        from rocking.studies.sensitivity.restitutions import sampled
        from rocking.studies.study_plan import Study, along, labels_along, motions_along

        scales, motions = self.histories.scales.numbers(), problem.motions
        bad = np.flatnonzero(np.abs(scales) > 1e6)
        if bad.size:
            raise InvalidValueError(
                "{parameter} must be from -1e6 to 1e6, got {value} at index {index}.", parameter="histories.scales",
                value=float(scales[bad[0]]), index=bad[0],
            )  # fmt: skip
        with located("body"):
            product, attributes = problem.product(problem.bodies, scales)
        angle, frequency = product.sides["alpha_right"][:, 0], product.sides["p_right"][:, 0]
        coordinates = {
            "motion": motions_along(motions),
            "body": along("body", np.arange(len(problem.bodies)), "1", "index of the body in the job"),
            "scale": along("scale", scales, "1", "scale factor of the motion"),
            "restitution": labels_along("restitution", problem.restitutions, "restitution"),
            "slenderness_angle": along("body", angle, "rad", "slenderness angle of the right side"),
            "frequency_parameter": along("body", frequency, "rad/s", "frequency parameter of the right side"),
        }
        if isinstance(motions, MotionList):
            sources = (listed(provenance_of(motions[k])) for k in range(len(motions)))
            coordinates["motion_provenance"] = labels_along("motion", sources, "source of the motion")
        sizes = (len(motions), len(problem.bodies), scales.size, len(problem.restitutions))
        dims = dict(zip(("motion", "body", "scale", "restitution"), sizes, strict=True))
        attributes["bodies"] = "; ".join(repr(body) for body in problem.bodies)[:4000]
        return Study(sampled(product), dims, coordinates, attributes)
