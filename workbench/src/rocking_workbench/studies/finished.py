"""Finished studies: jobs and results in memory and as files."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import RockingError
from rocking_workbench.errors import NotFound, Refused
from rocking_workbench.studies.study_folder import JOB, StudyFolder, without_paths

if TYPE_CHECKING:
    import xarray as xr

    from rocking.campaigns.jobs import Job, JobFolder
    from rocking.studies.study_plan import AdaptiveResult


Crossing = Literal["keep-uplift", "common-dispersion", "refuse"]

Kind = Literal["nc", "csv", "mat", "xlsx", "parquet", "toml", "svg", "xml"]


@dataclass(frozen=True)
class OpenStudy:
    """A finished study with its results."""

    id: str  # name of the study in URLs
    folder: StudyFolder  # folder of the study
    opened: "JobFolder"  # the campaign with its job

    @classmethod
    def of(cls, folder: StudyFolder) -> "OpenStudy":
        """Open a study. Results are read on demand."""
        from rocking.campaigns.jobs import JobFolder

        try:
            return cls(folder.id, folder, JobFolder.open(folder.campaign, folder.path))
        except RockingError as error:
            without_paths(error, folder.path)
            raise

    @property
    def job(self) -> "Job":
        """The job of the study."""
        return self.opened.job

    @property
    def question(self) -> Any:
        """The question of the study."""
        return self.job.document

    @property
    def axes(self) -> tuple[str, ...]:
        """Dimensions without the compared restitutions."""
        study = self.job.study
        if self.job.document.axes:
            return tuple(study.dims)[-2:]
        return tuple(name for name in study.dims if name != "restitution")

    @cached_property
    def raw(self) -> Arrays:
        """Raw results of the engine, one entry per simulation."""
        return self.opened.campaign.results()

    @cached_property
    def results(self) -> Arrays:
        """Results over the dimensions of the study."""
        study = self.job.study
        derived = study.derived(0, study.histories.count, self.raw)
        return {name: values.reshape(study.shape) for name, values in derived.items()}

    def history(self, number: int) -> dict[str, Any]:
        alone = {name: values[number : number + 1] for name, values in self.raw.items()}
        return {name: values[0] for name, values in self.job.study.derived(number, number + 1, alone).items()}

    @cached_property
    def analyses(self) -> dict[str, Any]:
        """Fragility analyses by restitution."""
        finish = self.job.study.finish
        return {} if finish is None else finish(self.raw)

    @cached_property
    def answer(self) -> "AdaptiveResult":
        """Result of an adaptive study, from all rounds."""
        from rocking.campaigns.jobs import answer

        return answer(self.opened)

    def dataset(self, restitution: int = 0) -> "xr.Dataset":
        """Return the results with one restitution."""
        label = list(self.job.problem.restitutions)[restitution]
        dataset = self.job.study.dataset(self.results).assign_attrs(restitution=label)
        return dataset.isel(restitution=restitution) if len(self.axes) < len(self.job.study.dims) else dataset

    @property
    def size(self) -> int:
        """Approximate memory of the results [byte]."""
        return 170 * int(self.job.study.histories.count) + (1 << 20)


def written(
    study: OpenStudy,
    kind: Kind,
    target: Path,
    content: str | None,
    restitution: int,
    crossing_curves: Crossing | None = None,
) -> None:
    """Write a finished study to a file. A figure contains incremental curves, or a comparison of restitutions."""
    labels = list(study.job.problem.restitutions)
    if not 0 <= restitution < len(labels):
        raise NotFound(
            "restitution must be in 0 ... {largest}, got {restitution}",
            largest=len(labels) - 1,
            restitution=restitution,
        )
    if kind == "toml":
        target.write_bytes((study.folder.path / JOB).read_bytes())
    elif kind == "svg":
        from rocking.plots import incremental_dynamic_analysis_picture
        from rocking.plots.campaign import campaign_picture
        from rocking_workbench.downloads.pictures import draw_to

        if study.job.document.kind == "incremental":
            analysis = list(study.analyses.values())[restitution]
            draw_to(lambda: incremental_dynamic_analysis_picture(analysis), target)
            return
        if len(labels) < 2 and study.question.has_motions():
            raise Refused("a study with one restitution has nothing to compare")
        draw_to(lambda: campaign_picture(study.opened), target)
    else:
        from rocking.campaigns.jobs import export

        content = content or ("fragility" if kind == "xml" else None)
        of_curves = content in {"fragility", "fema-p58"}
        try:
            export(
                study.opened,
                target,
                content,
                restitution=labels[restitution] if of_curves else None,
                crossing_curves=crossing_curves,
            )
        except RockingError as error:
            raise without_paths(error, study.folder.path).without_folder(target.parent).copied(Refused) from error
