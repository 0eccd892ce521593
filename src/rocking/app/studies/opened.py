"""Finished studies in memory: their jobs and all results, the latest ones kept."""

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from rocking.app.studies.study_folder import StudyFolder
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import RockingError

if TYPE_CHECKING:
    import xarray as xr

    from rocking.campaigns.jobs import JobFolder
    from rocking.campaigns.jobs.adaptive import AdaptiveResult

_HELD = 256 * 2**20
_ANSWERS = 64 * 2**20


@dataclass(frozen=True)
class OpenStudy:
    """A finished study with its results."""

    id: str  # its name in addresses
    folder: StudyFolder  # where it is
    job: "JobFolder"  # the campaign with its job

    @classmethod
    def of(cls, folder: StudyFolder) -> "OpenStudy":
        """Open a study.

        Returns the study; results are read when they are asked for.
        """
        from rocking.campaigns.jobs import JobFolder

        try:
            return cls(folder.id, folder, JobFolder.open(folder.campaign, folder.path))
        except RockingError as error:
            raise type(error)(folder.without_paths(str(error))) from error

    @property
    def axes(self) -> tuple[str, ...]:
        """Dimensions beside the restitutions that are compared: it may be an axis, too."""
        study = self.job.job.study
        if self.job.job.document.map is not None:
            return tuple(study.dims)[-2:]
        return tuple(name for name in study.dims if name != "restitution")

    @cached_property
    def raw(self) -> Arrays:
        """Results as the engine gave them, one entry a history."""
        return self.job.campaign.results()

    @cached_property
    def results(self) -> Arrays:
        """Results as users know them, over the dimensions of the study."""
        study = self.job.job.study
        found = study.derived(0, study.histories.count, self.raw)
        return {name: values.reshape(study.shape) for name, values in found.items()}

    def history(self, number: int) -> dict[str, Any]:
        """Return the results of one history."""
        alone = {name: values[number : number + 1] for name, values in self.raw.items()}
        return {name: values[0] for name, values in self.job.job.study.derived(number, number + 1, alone).items()}

    @cached_property
    def analyses(self) -> dict[str, Any]:
        """Fragility analyses by restitution."""
        finish = self.job.job.study.finish
        return {} if finish is None else finish(self.raw)

    @cached_property
    def answer(self) -> "AdaptiveResult":
        """What an adaptive study has found, from all of its rounds."""
        from rocking.campaigns.jobs import answer

        return answer(self.job)

    def dataset(self, restitution: int = 0) -> "xr.Dataset":
        """Return the results with one restitution as the pictures take them."""
        import xarray as xr

        study = self.job.job.study
        several = len(self.axes) < len(study.dims)
        label = list(self.job.job.problem.restitutions)[restitution]
        arrays = {name: (tuple(study.dims), values) for name, values in self.results.items()}
        coordinates = {
            name: (one.dims, one.values, {"units": one.unit, "long_name": one.meaning})
            for name, one in study.coordinates.items()
        }
        made = xr.Dataset(arrays, coords=coordinates, attrs={**study.attributes, "restitution": label})
        return made.isel(restitution=restitution) if several else made

    @property
    def size(self) -> int:
        """Memory of the results, roughly [byte]."""
        return 170 * int(self.job.job.study.histories.count) + (1 << 20)


class OpenStudies:
    """The studies that were looked at lately, and the answers about them."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._studies: OrderedDict[str, OpenStudy] = OrderedDict()
        self._answers: OrderedDict[tuple[Any, ...], bytes] = OrderedDict()

    def get(self, folder: StudyFolder) -> OpenStudy:
        """Return a study; one that was opened lately is not opened again."""
        with self._lock:
            if folder.id in self._studies:
                self._studies.move_to_end(folder.id)
                return self._studies[folder.id]
        made = OpenStudy.of(folder)
        with self._lock:
            self._studies[folder.id] = made
            while len(self._studies) > 1 and sum(each.size for each in self._studies.values()) > _HELD:
                self._studies.popitem(last=False)
        return made

    def answer(self, key: tuple[Any, ...], make: Callable[[], bytes]) -> bytes:
        """Return an answer; one that was given lately is not made again."""
        with self._lock:
            if key in self._answers:
                self._answers.move_to_end(key)
                return self._answers[key]
        made = make()
        with self._lock:
            self._answers[key] = made
            while len(self._answers) > 1 and sum(map(len, self._answers.values())) > _ANSWERS:
                self._answers.popitem(last=False)
        return made

    def known(self, key: tuple[Any, ...]) -> bytes | None:
        """Return an answer that was given lately."""
        with self._lock:
            return self._answers.get(key)

    def forget(self, study: str) -> None:
        """Forget a study."""
        with self._lock:
            self._studies.pop(study, None)
            for key in [key for key in self._answers if key[0] == study]:
                del self._answers[key]
