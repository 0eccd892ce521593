"""Rocking spectra: peak rotations of blocks of many sizes under motions."""

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking.errors import InvalidValueError, located
from rocking.spec.fields import JobTable, Numbers, key
from rocking.spec.question import Progress, StudyQuestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.study_plan import Study

_LONGEST = 1e100  # longest period whose square does not overflow [s]


class SpectrumTable(JobTable):
    """Blocks and scale factor of rocking spectra."""

    slenderness_angles: Numbers = key(
        "slenderness angles alpha = atan(b/h) [rad]", ..., allowed="increasing numbers > 0, < pi/2"
    )
    periods: Numbers = key("rocking periods 2 pi / p [s]", ..., allowed="increasing numbers > 0")
    scale: float = key("scale factor of the ground acceleration [-]", 1.0, allowed=">= -1e6, <= 1e6")


class SpectrumQuestion(StudyQuestion):
    """Peak rotations of blocks of many sizes under motions."""

    kind: ClassVar[str] = "rocking-spectrum"
    plane: ClassVar[bool] = True
    without_body: ClassVar[str] = (
        "a spectrum has its own blocks. Use a map over semi_diagonal for one body of many sizes."
    )

    spectrum: SpectrumTable

    @property
    def sizes(self) -> list[int]:
        """Numbers of motions, slenderness angles, periods and restitutions."""
        return [self.motion_count, self.spectrum.slenderness_angles.size, self.spectrum.periods.size, self.choices]

    @property
    def elements(self) -> dict[str, int]:
        """Number of blocks x number of restitutions."""
        blocks = self.spectrum.slenderness_angles.size * self.spectrum.periods.size
        return {"blocks times restitutions": blocks * self.choices}

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Return the dataset of `rocking_spectrum`."""
        from rocking.studies import rocking_spectrum

        table, motions = self.spectrum, [problem.motions[k] for k in range(len(problem.motions))]
        blocks = (table.slenderness_angles.numbers(), table.periods.numbers())
        options = {**problem.stated, "threads": threads, "progress": progress}
        return rocking_spectrum(motions, *blocks, problem.only("restitutions"), scale=table.scale, **options)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the study over motion, slenderness angle, period, and restitution (if several)."""
        from rocking import checks
        from rocking.studies._rocking_spectrum import spectrum_study

        table = self.spectrum
        angles = checks.positive_array("spectrum.slenderness_angles", table.slenderness_angles.numbers(), "rad")
        times = checks.positive_array("spectrum.periods", table.periods.numbers(), "s")
        for name, row in (("slenderness_angles", angles), ("periods", times)):
            if np.any(np.diff(row) <= 0.0):
                raise InvalidValueError("{parameter} must be strictly increasing.", parameter=f"spectrum.{name}")
        scale = checks.within("spectrum.scale", table.scale, -1e6, 1e6)
        if times.max() > _LONGEST:
            raise InvalidValueError(
                parameter="spectrum.periods", allowed=f"up to {_LONGEST:g} s", value=float(times.max())
            )
        with located("spectrum"):
            return spectrum_study(
                lambda blocks: problem.product(blocks, np.array([scale])), problem.motions, angles, times,
                gravity=problem.settings.gravity, scale=scale, restitutions=[*problem.restitutions],
            )  # fmt: skip

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of the spectra."""
        from rocking.plots.rocking_spectrum import rocking_spectrum_picture

        return rocking_spectrum_picture(finished.dataset(restitution))
