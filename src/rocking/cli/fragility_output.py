"""Files that `rocking fragility` writes."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli import output
from rocking.cli.fragility_question import FragilityAnswer, FragilityQuestion
from rocking.cli.output import check_files
from rocking.errors import InvalidValueError
from rocking.statistics.separation import Separation
from rocking.studies.fragility._incremental_dynamic_analysis import IncrementalDynamicAnalysis
from rocking.tables import Table, to_csv

if TYPE_CHECKING:
    from rocking.statistics.lognormal import LognormalFit
    from rocking.studies.fragility.curves import FragilityModel

_CURVES = ("p58", "nrml", "excel", "mat", "netcdf")
"""Files of the curves of one restitution; they cannot be without a curve."""

MOST_CHOICES = 6
"""Restitutions that can be told apart in a picture."""

WIDE = 0.01
"""Survivals of less width over their level are named apart: in them the body balances on its corner [-]."""


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
        from rocking.studies.fragility.export import intensity_type

        check_files(self.picture, self.csv, *(getattr(self, name) for name in _CURVES))
        asked = [f"--{name}" for name in _CURVES if getattr(self, name) is not None]
        if asked and len(question.restitutions) > 1:
            raise InvalidValueError(f"{', '.join(asked)} holds the curves of one --restitution; --csv holds several")
        if self.picture is not None and len(question.restitutions) > MOST_CHOICES:
            raise InvalidValueError(
                f"a picture holds {MOST_CHOICES} --restitution at most, got {len(question.restitutions)}"
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
        from rocking.studies.fragility.export import to_nrml

        model = self._model(answer, name or type(answer.question.body).__name__.lower())
        if self.p58 is not None:
            export.to_csv(model, self.p58, "fema-p58")
        writers = {"nrml": to_nrml, "excel": export.to_excel, "mat": export.to_mat, "netcdf": export.to_netcdf}
        for kind, write in writers.items():
            path = getattr(self, kind)
            if path is not None:
                write(model, path)

    def _model(self, answer: FragilityAnswer, name: str) -> "FragilityModel":
        from rocking.studies.fragility.curves import model_of, nested

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
    from rocking.plots.labels import axis_label, shown_in
    from rocking.plots.style import write

    if answer.compared is not None:
        from rocking.plots.sensitivity import sensitivity_picture

        figure = sensitivity_picture(answer.compared, unit=answer.question.unit)
    elif answer.question.analysis == "incremental":
        from rocking.plots.incremental_dynamic_analysis import incremental_dynamic_analysis_picture

        figure = incremental_dynamic_analysis_picture(answer.found)
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


def as_json(answer: FragilityAnswer) -> str:
    """Return everything as JSON."""
    asked, found = answer.question, answer.found
    compared = answer.compared
    facts = {
        "body": repr(asked.body),
        "assumed": list(asked.body.assumed),
        "motions": answer.motions,
        "gravity_m_s2": asked.settings["gravity"],
        "linear": asked.settings["linear"],
        "analysis": asked.analysis,
        "measure": asked.measure.name,
        "unit": asked.measure.unit,
        "states": list(asked.states),
        "uplift_threshold": found.subject.uplift_threshold,
        "levels": found.levels.tolist(),
        "results": [_result(one) for one in answer.results.values()],
        "comparison": None if compared is None else {"choices": compared.summary(), "verdict": compared.verdict},
    }
    return json.dumps(_plain(facts), indent=1, allow_nan=False)


def _result(found: Any) -> dict[str, Any]:
    told = found.summary()
    made = {
        "restitution": found.subject.parameters.label,
        "definition": found.definition,
        "uplift": told["uplift"],
        "failed": told["failed"],
        "contact": found.responses.contact,
        "trials": found.trials.tolist(),
        "reached": {name: counts.tolist() for name, counts in found.counts.items()},
        "curves": {name: fit.summary() for name, fit in found.fits.items()},
    }
    if "regression" in told:
        made["regression"] = told["regression"]
    if isinstance(found, IncrementalDynamicAnalysis):
        made |= {
            "first_crossing": told["first crossing"],
            "first_crossings": found.first_crossings.tolist(),
            "overturning_intervals": [{"motion": i.motion, "start": i.start, "end": i.end} for i in found.intervals],
            "resurrected_motions": found.resurrected(),
            "resurrected_motions_over_1_percent": found.resurrected(WIDE),
        }
    return made


def _plain(value: Any) -> Any:
    """Return a value with null where there is no finite number."""
    if isinstance(value, dict):
        return {str(name): _plain(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def show(answer: FragilityAnswer, length: str = "m") -> None:
    """Print the curves, and what is to be known of them."""
    from rich.console import Console

    console, found = Console(highlight=False, soft_wrap=True), answer.found
    labels = dict.fromkeys(one.subject.parameters.label for one in answer.results.values())
    head = {
        **dict(output.body_lines(answer.question.body, answer.question.settings["gravity"], length)),
        "motions": _motions(answer.motions),
        "restitution": ", ".join(labels),
        "measure": f"{found.subject.measure.name}, {found.subject.measure.words}",
        "rocking": _uplift(answer),
    }
    for name, words in head.items():
        console.print(f"{name + ':':13} {words}", markup=False)
    console.print(f"{found.definition[:1].upper()}{found.definition[1:]}.", markup=False)
    console.print()
    for label, result in answer.results.items():
        console.print(output.table(*_curves(answer, label if answer.compared is not None else "state", result)))
        console.print()
    for sentence in _sentences(answer):
        console.print(sentence, markup=False)


def _uplift(answer: FragilityAnswer) -> str:
    check = answer.found.uplift
    if check.threshold is None:
        return str(check.verdict)
    unit, factor = answer.question.unit
    return (
        f"certain above {check.threshold / factor:.4g} {unit}, impossible below; "
        f"{check.contradictions} of {check.checked} histories contradict it"
    )


def _motions(facts: dict[str, Any]) -> str:
    if facts["kind"] == "synthetic":
        return f"{facts['count']} synthetic motions of the family {facts['family']}, seed {facts['seed']}"
    kind = facts["kind"] if facts["count"] > 1 else facts["kind"][:-1]
    return f"{facts['count']} {kind}: {', '.join(' '.join(name.split()) for name in facts['names'][:4])}" + (
        ", ..." if facts["count"] > 4 else ""
    )


def _curves(answer: FragilityAnswer, first: str, result: Any) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    unit, factor = answer.question.unit
    head = (first, f"median [{unit}]", "95 %", "dispersion", "95 %")
    rows: list[tuple[str, ...]] = []
    for name, fit in result.fits.items():
        told = fit.summary()
        median = "none" if fit.median is None else f"{fit.median / factor:.4g}"
        spread = "none" if fit.dispersion is None else f"{fit.dispersion:.3g}"
        known = fit.exists and not _too_few(fit)
        middle = _interval(told["median_95"], factor) if known else ""
        rows.append((name, median, middle, spread, _interval(told["dispersion_95"], 1.0) if known else ""))
    return head, rows


def _interval(ends: list[float | None], factor: float) -> str:
    low, high = ("open" if end is None else f"{end / factor:.3g}" for end in ends)
    return f"{low} to {high}"


def _too_few(fit: "LognormalFit") -> str:
    """Return why motions that serve at several levels are too few for an interval; empty if they are not."""
    return fit.counts.scarcity if fit.counts.is_clustered else ""


def _sentences(answer: FragilityAnswer) -> list[str]:
    told: list[str] = []
    for label, result in answer.results.items():
        before = f"{label}, " if answer.compared is not None else ""
        told += [f"{before}{words}" for words in _verdicts(answer, result)]
        failed = result.failed
        if failed:
            told.append(f"! {before}{failed} histories could not be computed; they count at no level")
        if contact := result.responses.contact:
            told.append(f"! {before}{contact}")
    found = answer.found
    if answer.question.analysis == "cloud":
        told.append(_line(found))
    else:
        told += _intervals(answer)
    if isinstance(found, IncrementalDynamicAnalysis):
        told += _crossings(answer, found)
    if answer.compared is not None:
        told.append(answer.compared.told(answer.question.unit))
    return told


def _intervals(answer: FragilityAnswer) -> list[str]:
    """Return what the intervals are, and why there are none."""
    fits = [(name, fit) for result in answer.results.values() for name, fit in result.fits.items() if fit.exists]
    whys = {_too_few(fit): name for name, fit in fits}
    told = [
        f"No interval of {name}: motions serve at every level, and there are too few of them ({why})."
        for why, name in whys.items()
        if why
    ]
    if "" not in whys:
        return told
    how = (
        "the values of the parameter under which so few, or so many, failures as these are no rarity, each motion with "
        "one capacity"
        if any(fit.counts.draws_capacities for _, fit in fits)
        else "whole motions drawn anew"
    )
    return [*told, f"Intervals: {how}, since a motion serves at every level."]


def _verdicts(answer: FragilityAnswer, result: Any) -> list[str]:
    """Return what is to be known of curves that are not likeliest, the same words once; intervals are told apart."""
    states: dict[str, list[str]] = {}
    for name, fit in result.fits.items():
        if fit.separation is not Separation.OVERLAP or not fit.exists:
            words = fit.verdict.split(" Outcomes of one cluster")[0].split(" Intervals are")[0]
            states.setdefault(words, []).append(name)
    where = "" if (unit := answer.question.measure.unit) == "-" else f" (levels in {unit})"
    return [f"{', '.join(names)}: {words}{where}" for words, names in states.items()]


def _line(found: Any) -> str:
    try:
        line = found.regression
    except InvalidValueError as error:
        return f"No line of the rotation over the measure: {error}"
    return (
        f"Of {line.count} histories that rocked and stayed standing, ln(theta/alpha) grows with slope {line.slope:.3g} "
        f"over ln({found.subject.measure.name}), scatter {line.scatter:.3g}, R squared {line.determination:.3g}."
    )


def _crossings(answer: FragilityAnswer, found: IncrementalDynamicAnalysis) -> list[str]:
    unit, factor = answer.question.unit
    first, whole = found.first_crossing_fit, int(found.complete.sum())
    curve = (
        "too few motions overturn it for a curve"
        if first is None
        else f"median {first.median / factor:.4g} {unit}, dispersion {first.dispersion:.3g}"
    )
    words = found.definitions["first crossing"]
    return [
        f"{words[:1].upper()}{words[1:]}: {curve}.",
        f"{len(found.resurrected())} of {whole} motion{'s' * (whole != 1)} left it standing at levels above one "
        f"that overturns it, {len(found.resurrected(WIDE))} of them over more than 1 % of the level.",
    ]
