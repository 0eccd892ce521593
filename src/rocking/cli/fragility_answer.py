"""Result of `rocking fragility` on the terminal, as JSON and in files."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from rocking.answers import Answer, Display
from rocking.cli.compared import model_facts, show_models, with_models
from rocking.cli.page import Page, sentence
from rocking.errors import InvalidValueError
from rocking.quantities import Quantity
from rocking.studies.fragility.incremental_dynamic_analysis import WIDE, IncrementalDynamicAnalysis

if TYPE_CHECKING:
    from rocking.motions.summary import MotionSummary
    from rocking.spec.study import StudyProblem
    from rocking.statistics.lognormal import LognormalFit
    from rocking.studies.fragility.curves import FragilityCurve, FragilityModel
    from rocking.tables import Table

# quantities in the unit of the measure
_MEASURED = (
    "levels", "median", "median_95", "median_interval", "crossings", "uplift_threshold", "lowest_uplift",
    "first_crossings", "interval",
)  # fmt: skip
_OF_CURVES = ("median", "dispersion", "median_95", "dispersion_95")


@dataclass(eq=False)
class FragilityAnswer:
    """The analyses of one body, by restitution."""

    problem: "StudyProblem"
    results: dict[str, Any]  # analyses by label of the restitution; files of curves contain only the first
    compared: Any  # comparison of several restitution models
    written: str  # unit of the given levels and of printed medians, empty if none
    length: str  # unit of lengths
    name: str | None = None  # name of the body in files
    crossing_curves: Any = "keep-uplift"  # treatment of curves that cross
    others: dict[str, Any] = field(default_factory=dict)  # analyses of the compared models
    details: bool = False

    @classmethod
    def of(
        cls, problem: "StudyProblem", progress: Any, threads: int | None, *, written: str, length: str
    ) -> "FragilityAnswer":
        """Compute an analysis."""
        analysis, others = with_models(lambda study: study.answer(progress, threads), problem)
        several = len(problem.restitutions) > 1
        results = analysis.results if several else {next(iter(problem.restitutions)): analysis}
        return cls(problem, results, analysis if several else None, written, length, others=others)

    @property
    def first(self) -> Any:
        """The analysis with the first restitution."""
        return next(iter(self.results.values()))

    @property
    def kind(self) -> str:
        """Stripes, cloud or incremental."""
        return str(self.problem.document.kind)

    @property
    def unit(self) -> tuple[str, float]:
        """Unit of the given levels, by default that of the measure, and its size in the unit of the measure."""
        from rocking.conventions import UNITS

        unit = self.first.subject.measure.unit
        return (self.written, UNITS[unit][self.written]) if self.written else (unit, 1.0)

    @cached_property
    def curves(self) -> "FragilityModel":
        """The curves in files and on the terminal."""
        from rocking.studies.fragility.curves import model_of

        name = self.name or type(self.problem.bodies[0]).__name__.lower()
        return model_of(self.first, name, crossing_curves=self.crossing_curves)

    @cached_property
    def shown(self) -> "FragilityModel | None":
        """The joint curves of all limit states, which replace separate curves; None without joint curves."""
        from rocking.studies.fragility.curves import shown_curves

        return None if self.compared is not None else shown_curves(self.first, self.crossing_curves)

    def check_crossing(self) -> None:
        """Refuse crossing curves, which FEMA P-58 and OpenQuake do not accept."""
        from rocking.studies.fragility.curves import nested

        nested(self.curves)

    def counted(self) -> "Table":
        """Return the counts at each level with the fitted probability, empty without a curve."""
        from rocking.tables import Table

        measure, states = self.first.subject.measure, list(self.first.counts)
        first = ("restitution", f"{measure.name} [{measure.unit}]", "histories [-]")
        head = (*first, *(f"reached {name} [-]" for name in states), *(f"fitted {name} [-]" for name in states))
        rows: list[tuple[str | int | float, ...]] = []
        for label, result in self.results.items():
            fits = {name: fit for name, fit in result.fits.items() if fit.exists} | self._adjusted()
            fitted = [fits[name].probability(result.levels) if name in fits else None for name in states]
            for k, level in enumerate(result.levels.tolist()):
                reached = [int(result.counts[name][k]) for name in states]
                probabilities = ["" if values is None else float(values[k]) for values in fitted]
                rows.append((label, level, int(result.trials[k]), *reached, *probabilities))
        return Table.of_rows("counted", head, rows)

    def draw(self) -> Any:
        from rocking.plots.labels import axis_label, shown_in

        if self.compared is not None:
            from rocking.plots.sensitivity import sensitivity_picture

            figure = sensitivity_picture(self.compared, unit=self.unit)
        elif self.kind == "incremental":
            from rocking.plots.fragility import incremental_dynamic_analysis_picture

            figure = incremental_dynamic_analysis_picture(self.first)
        else:
            from rocking.plots.fragility import fragility_picture

            figure = fragility_picture(self.first, curves=self.shown)
        measure = self.first.subject.measure
        own = axis_label(measure.name, measure.unit)
        for axes in figure.axes if self.written else []:
            for which in ("x", "y"):
                if getattr(axes, f"get_{which}label")() == own:
                    shown_in(axes, which, *self.unit)
        return figure

    def answer(self) -> Answer:
        """Return the counts and the curves."""
        body, first, compared = self.problem.bodies[0], self.first, self.compared
        unit = "1" if first.subject.measure.unit == "-" else first.subject.measure.unit
        return Answer({
            "body": repr(body),
            "assumed": list(body.assumed),
            "motions": self._motions_facts(),
            "gravity": self.problem.settings.gravity,
            "linear": self.problem.settings.linear,
            "analysis": self.kind,
            "im": first.subject.measure.name,
            "im_description": first.subject.measure_words,
            "limit_states": list(self.problem.document.fragility.limit_states),
            "uplift_threshold": first.subject.uplift_threshold,
            "lowest_uplift": first.subject.lowest_uplift,
            "levels": first.levels,
            "crossing_curves": {
                "method": self.crossing_curves, "adjusted": "" if self.shown is None else self.shown.adjusted
            },
            "results": [_result_facts(analysis, self._adjusted()) for analysis in self.results.values()],
            "comparison": None if compared is None else {
                "choices": compared.summary(),
                "verdict": compared.verdict,
            },
            **model_facts(", ".join(self.results), self.others, _of_model, body),
        }, {name: Quantity(name, unit, first.subject.measure_words) for name in _MEASURED})  # fmt: skip

    def _motions_facts(self) -> dict[str, Any]:
        from rocking.motions.components import leading
        from rocking.motions.pulse import Pulse

        table, motions = self.problem.document.motions[0], self.problem.motions
        sources = [summary.answer() for summary in self.sources]
        if table.synthetic is not None:
            seed = table.seed or 0
            family = getattr(motions, "family", None)
            name = table.synthetic if family is None else family.name
            facts = {"kind": "synthetic", "count": len(motions), "family": name, "seed": seed}
            return {**facts, "sources": sources}
        names = [motions[k].name for k in range(len(motions))]
        kind = "pulses" if isinstance(leading(motions[0]), Pulse) else "records"
        return {
            "kind": kind,
            "count": len(names),
            "names": names,
            "sources": [summary.answer() for summary in self.sources],
        }

    @cached_property
    def sources(self) -> "tuple[MotionSummary, ...]":
        """Intensity, source and processing of each motion."""
        from rocking.motions.summary import summaries_of

        return summaries_of(self.problem.motions)

    def show(self, page: Page) -> None:
        from rocking.cli.study import source_lines, subject_lines

        answer = self.answer()
        display = Display(
            self.length, own=answer.quantities, units=dict.fromkeys(_MEASURED if self.written else (), self.written)
        )
        first, labels = (
            self.first,
            dict.fromkeys(analysis.subject.parameters.label for analysis in self.results.values()),
        )
        page.facts(subject_lines(self.problem, display))
        page.facts([
            ("motions", _motions_line(self._motions_facts())),
            *(source_lines(self.sources) if self.details else ()),
            ("restitution", ", ".join(labels)),
            ("measure", f"{first.subject.measure.name}, {first.subject.measure_words}"),
            ("rocking", self._uplift(display)),
        ])  # fmt: skip
        if self.details:
            page.line(sentence(first.definition))
        page.line()
        for label, result in self.results.items():
            page.rows(self._curve_rows(label if self.compared is not None else "state", result), (), display)
            page.line()
        for line in self._sentences(display):
            page.line(line)
        page.warn(self._warnings())
        if self.compared is not None:
            page.line(self.compared.text(self.unit))
        show_models(page, answer, display, ", ".join(self.results), _of_model(first))
        if not self.details:
            page.line("Definitions, sources and comparison: --details    Files: -o curves.csv, -o picture.png")

    def _uplift(self, display: Display) -> str:
        check, lowest = self.first.uplift, self.first.subject.lowest_uplift
        if check.threshold is None:
            below = "" if lowest is None else f"; impossible below {display.text('lowest_uplift', lowest)}"
            return f"{check.verdict}{below}"
        return (
            f"certain above {display.text('uplift_threshold', check.threshold)}, impossible below; "
            f"{check.contradictions} of {check.checked} histories contradict it"
        )

    def _curve_rows(self, first: str, result: Any) -> list[dict[str, Any]]:
        """Return one row per limit state; rows with too few motions have no interval."""
        adjusted, rows = self._adjusted(), []
        for name, fit in result.fits.items():
            curve = _curve_facts(fit.summary(), adjusted.get(name))
            has_interval = name not in adjusted and fit.exists and not _too_few(fit)
            rows.append(
                {first: name, **{column: curve[column] for column in (_OF_CURVES if has_interval else _OF_CURVES[:2])}}
            )
        return rows

    def _adjusted(self) -> dict[str, "FragilityCurve"]:
        """Return the joint curves by limit state."""
        return {} if self.shown is None else self.shown.shared

    def _alone(self, display: Display) -> list[str]:
        """Return the reason for joint curves, and the separate curves with their intervals."""
        if self.shown is None or not self.shown.adjusted:
            return []
        if self._adjusted() and not self.details:
            text = "The curves have a common dispersion and no intervals, because separately fitted curves cross"
            return [f"{text} (--details)."]
        lines = [str(self.shown.adjusted)]
        for name in self._adjusted():
            summary, texts = self.first.fits[name].summary(), []
            for quantity in _OF_CURVES[:2]:
                ends = display.table([summary], [quantity])[-1]
                texts.append(f"{quantity} {display.text(quantity, summary[quantity])}, {ends.heading} {ends.cells[0]}")
            lines.append(f"{name} alone: {'; '.join(texts)}")
        return lines

    def _sentences(self, display: Display) -> list[str]:
        lines = self._alone(display)
        for label, result in self.results.items():
            before = f"{label}, " if self.compared is not None else ""
            lines += [f"{before}{text}" for text in _verdicts(result)]
        if not self.details:
            return lines
        lines += [_regression(self.first)] if self.kind == "cloud" else self._intervals()
        if isinstance(self.first, IncrementalDynamicAnalysis):
            lines += self._transitions(self.first, display)
        return lines

    def _warnings(self) -> list[str]:
        """Return the number of histories without a result, and the note on contact."""
        lines = []
        for label, result in self.results.items():
            before = f"{label}, " if self.compared is not None else ""
            if failed := result.failed:
                lines.append(f"{before}{failed} histories have no result and are ignored at every level")
            if contact := result.responses.contact:
                lines.append(f"{before}{contact}")
        return lines

    def _intervals(self) -> list[str]:
        """Return the method of the intervals, and the reasons for missing intervals."""
        fits = [(name, fit) for result in self.results.values() for name, fit in result.fits.items() if fit.exists]
        reasons = {_too_few(fit): name for name, fit in fits}
        lines = [
            f"No interval of {name}: each motion is used at every level, and there are too few motions ({reason})."
            for reason, name in reasons.items()
            if reason
        ]
        if "" not in reasons:
            return lines
        method = (
            "parameter values consistent with the number of failures; one capacity per motion"
            if any(fit.counts.draws_capacities for _, fit in fits)
            else "bootstrap of whole motions"
        )
        return [*lines, f"95 % intervals: {method}."]

    def _transitions(self, analysis: IncrementalDynamicAnalysis, display: Display) -> list[str]:
        first = analysis.first_crossing_fit
        curve = "too few motions with overturning"
        if first is not None:
            median, spread = display.text("median", first.median), display.text("dispersion", first.dispersion)
            curve = f"median {median}, dispersion {spread}"
        return [
            sentence(f"{analysis.definitions['first crossing']}: {curve}"),
            analysis.resurrection,
        ]


def _of_model(analysis: Any) -> dict[str, Any]:
    """Return the curve of the last limit state."""
    state, fit = list(analysis.fits.items())[-1]
    curve = fit.summary()
    return {"state": state, **{name: curve[name] for name in _OF_CURVES[:2]}}


def _result_facts(analysis: Any, adjusted: "dict[str, FragilityCurve]") -> dict[str, Any]:
    summary = analysis.summary()
    facts = {
        "restitution": analysis.subject.parameters.label,
        "definition": analysis.definition,
        "uplift": summary["uplift"],
        "failed": summary["failed"],
        "contact": analysis.responses.contact,
        "trials": analysis.trials,
        "reached": dict(analysis.counts),
        "curves": {name: _curve_facts(fit.summary(), adjusted.get(name)) for name, fit in analysis.fits.items()},
    }
    if "regression" in summary:
        facts["regression"] = summary["regression"]
    if isinstance(analysis, IncrementalDynamicAnalysis):
        facts |= {
            "first_crossing": summary["first crossing"],
            "first_crossings": analysis.first_crossings,
            "overturning_intervals": [{"motion": i.motion, "interval": [i.start, i.end]} for i in analysis.intervals],
            "resurrected_motions": analysis.resurrected(),
            "resurrected_motions_over_1_percent": analysis.resurrected(WIDE),
        }
    return facts


def _curve_facts(alone: dict[str, Any], curve: "FragilityCurve | None") -> dict[str, Any]:
    """Return a curve; a joint curve has no intervals and includes the separate curve."""
    if curve is None:
        return {**alone, "alone": None}
    return {**alone, **curve.facts, "alone": alone}


def _motions_line(facts: dict[str, Any]) -> str:
    if facts["kind"] == "synthetic":
        return f"{facts['count']} synthetic motions of the family {facts['family']}, seed {facts['seed']}"
    kind = facts["kind"] if facts["count"] > 1 else facts["kind"][:-1]
    return f"{facts['count']} {kind}: {', '.join(' '.join(name.split()) for name in facts['names'][:4])}" + (
        ", ..." if facts["count"] > 4 else ""
    )


def _too_few(fit: "LognormalFit") -> str:
    """Return the reason for a missing interval (too few motions that are used at several levels), or an empty text."""
    return fit.counts.scarcity if fit.counts.is_clustered else ""


def _verdicts(result: Any) -> list[str]:
    """Return notes on curves that are not maximum-likelihood fits, without duplicates."""
    where = "" if (unit := result.subject.measure.unit) == "-" else f" (levels in {unit})"
    return [f"{', '.join(names)}: {text}{where}" for text, names in result.verdicts.items()]


def _regression(analysis: Any) -> str:
    try:
        line = analysis.regression
    except InvalidValueError as error:
        return f"No regression of the rotation: {error}"
    return (
        f"Regression of ln(theta/alpha) on ln({analysis.subject.measure.name}) over {line.count} histories with "
        f"rocking and without overturning: slope {line.slope:.3g}, scatter {line.scatter:.3g}, R squared "
        f"{line.determination:.3g}."
    )
