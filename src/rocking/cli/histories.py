"""`rocking histories`, and commands of other studies without a module here; options come from their tables."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import BaseModel

from rocking.answers import Answer, Display
from rocking.cli import options
from rocking.cli.compared import model_facts, overturned, show_models, with_models
from rocking.cli.exports import DATASET, Exports
from rocking.cli.page import Page, bar, deliver
from rocking.dynamics.mechanics import restitution_label
from rocking.outcome import contact_words, lost_contact, mode_shares
from rocking.spec.fields import Values, kinds_of
from rocking.spec.question import BodyQuestion, StudyQuestion
from rocking.spec.questions import questions

if TYPE_CHECKING:
    import xarray as xr

    from rocking.spec.study import StudyProblem

COUNT, SEED = 20, 1  # default number and seed of synthetic motions
_OF_FILES = {"body", "motion_provenance"}  # coordinates that occur only in files
_PLURALS = {"body": "bodies", "branch": "branches"}
_BODY: options.Options = {"body": (options.BodyFile, None)}
_MOTIONS: options.Options = {
    "record": (options.SeveralRecords, None),
    "motion": (options.SeveralMotions, None),
    "synthetic": (options.Family, None),
    "count": (Annotated[int | None, options.count(COUNT)], None),
    "seed": (options.Seed, None),
}


def command_of(kind: str) -> Callable[..., None]:
    """Return the command of a kind of study."""
    question = questions()[kind]
    own = question.own_table()
    table: Any = question.model_fields[own].annotation
    has_body = issubclass(question, BodyQuestion)
    pictured = question.plot is not StudyQuestion.plot
    exports = {name: export for name, export in DATASET.items() if pictured or name != "picture"}
    names = [name for name, field in table.model_fields.items() if _is_option(kinds_of(field))]

    @options.takes(
        options.keys(table, *names), *([_BODY] * has_body), *([_MOTIONS] * question.has_motions()), before="restitution"
    )
    @options.takes(options.SIZES if has_body else {"units": (options.RecordUnits, None)})
    @options.takes({"output": (Annotated[list[str] | None, options.output(exports)], None)}, before="as_json")
    def command(
        context: typer.Context,
        restitution: options.Restitutions = None,
        sets: options.Set = None,
        friction: options.Friction = None,
        threads: options.Threads = None,
        as_json: options.AsJson = False,
    ) -> None:
        from rocking.cli.arguments import Arguments
        from rocking.cli.study import TABLES, histories_in, models_table, motions_of, of_body, problem_in, problem_of

        files, length = Exports.of(context.params["output"], exports), None
        first = context.params["body"] if has_body else next(iter(context.params["record"] or ()), None)
        if (problem := problem_in(context, first, own)) is None:
            arguments = Arguments(context, *TABLES, own)
            length = arguments.length
            stated = arguments.table(own, arguments.values(table))
            usual = {"count": COUNT, "seed": SEED}
            motions = motions_of(arguments, arguments.of_body, usual) if question.has_motions() else []
            if has_body:
                problem = of_body(arguments, kind, stated, restitution, motions)
            else:
                problem = problem_of(kind, arguments, motions, restitution=models_table(restitution), **{own: stated})
        with bar("histories", histories_in(problem, compared=True), quiet=as_json) as progress:
            dataset, others = with_models(lambda study: study.answer(progress, threads), problem)
        deliver(HistoriesAnswer(problem, dataset, length or "m", others), files, as_json=as_json)

    return command


def _is_option(kinds: list[Any]) -> bool:
    """Return True if an option can represent a key: any type except tables; `Values` is allowed."""
    return not any(isinstance(kind, type) and issubclass(kind, BaseModel) and kind is not Values for kind in kinds)


@dataclass(frozen=True, eq=False)
class HistoriesAnswer:
    """The histories of a study."""

    problem: "StudyProblem"
    dataset: "xr.Dataset"
    length: str  # unit of lengths
    others: dict[str, Any]  # histories of the compared models

    @property
    def label(self) -> str:
        """Labels of the restitution models, separated by commas."""
        return ", ".join(self._labels)

    @property
    def _labels(self) -> list[str]:
        return [restitution_label(name, self.problem.bodies[0]) for name in self.problem.restitutions]

    def draw(self) -> Any:
        return self.problem.document.plot(_Finished(self.problem, self.dataset), None)

    def answer(self) -> Answer:
        """Return every history, and the fraction of each mode."""
        from rocking.motions.summary import summaries_of

        dataset, problem = self.dataset, self.problem
        names = [str(name) for name in (*dataset.coords, *dataset.data_vars) if name not in _OF_FILES]
        return Answer({
            "bodies": [str(body) for body in problem.bodies],
            "assumed": list(dict.fromkeys(text for body in problem.bodies for text in getattr(body, "assumed", ()))),
            "motions": [summary.answer() for summary in summaries_of(problem.kept_motions)],
            "restitution": self._labels,
            "gravity": problem.settings.gravity,
            **{name: dataset[name].values.tolist() for name in names},
            "modes": mode_shares(dataset["mode"].values),
            "findings": [
                *problem.document.findings(problem, dataset),
                *(
                    row
                    for name, other in problem.with_compared_models.items()
                    if hasattr(self.others[name], "data_vars")
                    for row in problem.document.findings(other, self.others[name])
                ),
            ],
            "contact": contact_words(lost_contact(dataset)),
            **model_facts(self.label, self.others, _overturned, problem.bodies[0]),
        })  # fmt: skip

    def show(self, page: Page) -> None:
        from rocking.cli.study import source_lines, subject_lines
        from rocking.motions.summary import summaries_of

        problem, answer = self.problem, self.answer()
        if len(problem.bodies) == 1:
            page.facts(subject_lines(problem, Display(self.length)))
        page.facts([("restitution", self.label)])
        page.facts(source_lines(summaries_of(problem.kept_motions)))
        counts = [
            f"{size} {name if size == 1 else _PLURALS.get(str(name), f'{name}s')}".replace("_", " ")
            for name, size in self.dataset["mode"].sizes.items()
        ]
        page.line(f"histories:    {' x '.join(counts)}\n")
        if answer["findings"]:
            page.rows(answer["findings"])
        else:
            page.rows(answer["modes"], ("mode", "count", "share"), dense=False)
        page.warn(filter(None, [answer["contact"]]))
        show_models(page, answer, Display(), self.label, _overturned(self.dataset))


def _overturned(dataset: "xr.Dataset") -> dict[str, Any]:
    return overturned(dataset["mode"].values)


@dataclass(frozen=True, eq=False)
class _Finished:
    """Histories in the form for the figure of a study."""

    problem: "StudyProblem"
    histories: "xr.Dataset"

    def dataset(self, restitution: str | None) -> "xr.Dataset":
        """Return the histories with one restitution, the first by default."""
        labels = list(self.problem.restitutions)
        label = restitution or labels[0]
        selected = (
            self.histories.isel(restitution=labels.index(label), drop=True) if len(labels) > 1 else self.histories
        )
        return selected.assign_attrs(restitution=label)
