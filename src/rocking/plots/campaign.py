"""The picture of a finished campaign: that of its study."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rocking.campaigns.jobs import JobFolder, analyses, answer, assessment, comparison
from rocking.campaigns.jobs.findings import datasets, label_of, refuse_unfinished
from rocking.campaigns.jobs.study import TYPES
from rocking.errors import InvalidValueError
from rocking.plots.fragility import fragility_picture, incremental_dynamic_analysis_picture
from rocking.plots.inventory import inventory_picture
from rocking.plots.overturning_map import overturning_map_picture
from rocking.plots.rocking_spectrum import rocking_spectrum_picture
from rocking.plots.sensitivity import sensitivity_picture
from rocking.plots.transitions import transitions_of_many_picture
from rocking.spec.questions.fragility import ExportTable
from rocking.studies.fragility.curves import shown_curves

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_OF_DATASETS: "dict[str, Callable[[Any], Figure]]" = {
    "overturning-map": overturning_map_picture, "rocking-spectrum": rocking_spectrum_picture,
}  # fmt: skip
WITHOUT = ("histories",)  # kinds of campaigns that have no picture


def check_picture(folder: JobFolder, restitution: str | None) -> None:
    """Refuse what has no picture, before anything is read."""
    kind, labels = folder.job.document.campaign.kind, list(folder.job.problem.restitutions)
    if kind in WITHOUT:
        raise InvalidValueError(f'a campaign of kind "{kind}" has no picture; take its table (.csv, .xlsx, .nc)')
    if restitution is not None or kind in {"cloud", "incremental"}:  # of which there is no picture that compares
        label_of("picture", restitution, labels)


def campaign_picture(folder: JobFolder, restitution: str | None = None) -> "Figure":
    """Draw a finished campaign: with one restitution, or all of them compared where none is named."""
    check_picture(folder, restitution)
    refuse_unfinished(folder)
    kind, labels = folder.job.document.campaign.kind, list(folder.job.problem.restitutions)
    if kind == "inventory":
        return inventory_picture(assessment(folder))
    if kind == "minimum-acceleration":
        return _transitions(folder, labels if restitution is None else [restitution])
    if restitution is None and len(labels) > 1:
        return sensitivity_picture(comparison(folder, tuple(TYPES)))
    label = restitution or labels[0]
    if folder.job.study.finish is not None:
        return _fragility(folder, analyses(folder)[label])
    if folder.job.study.search is not None:
        return overturning_map_picture(datasets(folder)[label], answer(folder).value[1])
    return _OF_DATASETS[kind](datasets(folder)[label])


def _fragility(folder: JobFolder, analysis: Any) -> "Figure":
    """Draw a fragility analysis with the curves that are exported."""
    if folder.job.document.campaign.kind == "incremental":
        return incremental_dynamic_analysis_picture(analysis)
    export = folder.job.document.export or ExportTable()
    return fragility_picture(analysis, curves=shown_curves(analysis, export.crossing))


def _transitions(folder: JobFolder, labels: list[str]) -> "Figure":
    """Draw minimum accelerations: a panel for each restitution, a lane for every motion and body."""
    problem, several = folder.job.problem, len(folder.job.problem.bodies) > 1
    lanes = [
        f"{problem.motions[k].name}, body {body}" if several else problem.motions[k].name
        for k in range(len(problem.motions)) for body in range(len(problem.bodies))
    ]  # fmt: skip
    every = answer(folder).value  # the body changes fastest, then the restitution
    bodies, restitutions = len(problem.bodies), list(problem.restitutions)
    found = {
        label: [
            every[(motion * len(restitutions) + restitutions.index(label)) * bodies + body]
            for motion in range(len(problem.motions)) for body in range(bodies)
        ]
        for label in restitutions if label in labels
    }  # fmt: skip
    for label, row in found.items():
        if None in row:
            raise InvalidValueError(
                f"there is no picture: no history of {lanes[row.index(None)]} with restitution {label} has a result"
            )
    return transitions_of_many_picture(found, lanes, words="motion and body" if several else "motion")
