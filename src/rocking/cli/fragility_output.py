"""Files that `rocking fragility` writes."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.cli.files_output import check_files
from rocking.cli.fragility_question import FragilityAnswer, FragilityQuestion
from rocking.errors import InvalidValueError
from rocking.tables import Table, to_csv

if TYPE_CHECKING:
    from rocking.studies.fragility.curves import FragilityModel

_CURVES = ("p58", "nrml", "excel", "mat", "netcdf")
"""Files of the curves of one restitution; they cannot be without a curve."""

MOST_CHOICES = 6
"""Restitutions that can be told apart in a picture."""


@dataclass(frozen=True)
class FragilityFiles:
    """Files that were asked for."""

    picture: Path | None = None  # picture, csv, p58, nrml, excel, mat, netcdf: where each goes
    csv: Path | None = None
    p58: Path | None = None
    nrml: Path | None = None
    excel: Path | None = None
    mat: Path | None = None
    netcdf: Path | None = None
    # whether the curves in files are fitted again with one dispersion for all states, so that none cross
    common_dispersion: bool = False

    def check(self, question: FragilityQuestion) -> None:
        """Refuse, before anything is computed, what could not be written."""
        from rocking.errors import extra
        from rocking.studies.fragility.nrml import intensity_type

        check_files(self.picture, self.csv, *(getattr(self, name) for name in _CURVES))
        asked = [f"--{name}" for name in _CURVES if getattr(self, name) is not None]
        if asked and len(question.choices) > 1:
            raise InvalidValueError(f"{', '.join(asked)} holds the curves of one --restitution; --csv holds several")
        if self.picture is not None and len(question.choices) > MOST_CHOICES:
            raise InvalidValueError(
                f"a picture holds {MOST_CHOICES} --restitution at most, got {len(question.choices)}"
            )
        if self.nrml is not None:
            intensity_type(question.measure.name)
        needed = {"matplotlib": self.picture, "openpyxl": self.excel, "h5netcdf": self.netcdf}
        for module, path in needed.items():
            if path is not None:
                extra(module, f"{path.name}")

    def write(self, answer: FragilityAnswer, name: str | None) -> list[Path]:
        """Write them."""
        if self.picture is not None:
            _draw(answer, self.picture)
        if self.csv is not None:
            to_csv(counted(answer), self.csv)
        if any(getattr(self, kind) is not None for kind in _CURVES):
            self._write_curves(answer, name)
        return [path for path in vars(self).values() if isinstance(path, Path)]

    def _write_curves(self, answer: FragilityAnswer, name: str | None) -> None:
        from rocking.studies.fragility import export
        from rocking.studies.fragility.nrml import to_nrml

        model = self._model(answer, name or type(answer.question.body).__name__.lower())
        if self.p58 is not None:
            export.to_csv(model, self.p58, "fema-p58")
        writers = {"nrml": to_nrml, "excel": export.to_excel, "mat": export.to_mat, "netcdf": export.to_netcdf}
        for kind, write in writers.items():
            path = getattr(self, kind)
            if path is not None:
                write(model, path)

    def _model(self, answer: FragilityAnswer, name: str) -> "FragilityModel":
        from rocking.studies.fragility.curves import model_of
        from rocking.studies.fragility.nesting import nested

        model = model_of(answer.found, name)
        if self.common_dispersion:
            return nested(model, "common-dispersion")
        if self.p58 is not None or self.nrml is not None:
            # before the first file is written
            try:
                nested(model)
            except InvalidValueError as error:
                words = str(error).replace('crossing="common-dispersion"', "--common-dispersion")
                raise InvalidValueError(words) from error
        return model


def counted(answer: FragilityAnswer) -> Table:
    """Return what was counted at each level, and the fitted probability beside it.

    Returns A row for every restitution and level; the cell of a probability is empty where there is no curve.
    """
    measure, states = answer.found.subject.measure, list(answer.found.counts)
    first = ("restitution", f"{measure.name} [{measure.unit}]", "histories [-]")
    head = (*first, *(f"reached {name} [-]" for name in states), *(f"fitted {name} [-]" for name in states))
    rows: list[tuple[str | int | float, ...]] = []
    for label, result in answer.results.items():
        fits = [result.fits.get(name) for name in states]
        fitted = [fit.probability(result.levels) if fit is not None and fit.exists else None for fit in fits]
        for k, level in enumerate(result.levels.tolist()):
            reached = [int(result.counts[name][k]) for name in states]
            likely = ["" if values is None else float(values[k]) for values in fitted]
            rows.append((label, level, int(result.trials[k]), *reached, *likely))
    return Table.of_rows("counted", head, rows)


def _draw(answer: FragilityAnswer, path: Path) -> None:
    from rocking.plots.study_words import axis_label, shown_in
    from rocking.plots.style import write

    if answer.compared is not None:
        from rocking.plots.sensitivity import sensitivity_picture

        figure = sensitivity_picture(answer.compared, unit=answer.question.unit)
    elif answer.question.analysis == "incremental":
        from rocking.plots.incremental import incremental_picture

        figure = incremental_picture(answer.found)
    else:
        from rocking.plots.fragility import fragility_picture

        figure = fragility_picture(answer.found)
    unit, size = answer.question.unit
    own = axis_label(answer.question.measure.name, answer.question.measure.unit)
    for axes in figure.axes if answer.question.written else []:
        for which in ("x", "y"):
            if getattr(axes, f"get_{which}label")() == own:
                shown_in(axes, which, unit, size)
    write(figure, path)
