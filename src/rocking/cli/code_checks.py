"""`rocking code-checks`: code methods compared with time histories."""

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from rocking.answers import Answer, Display
from rocking.bodies import Block
from rocking.cli import options
from rocking.cli.compared import model_facts, overturned, show_models, with_models
from rocking.cli.exports import Export, Exports, write_records
from rocking.cli.numbers import row
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.conventions import percent
from rocking.messages import Message
from rocking.quantities import Quantity, closely

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from rocking.cli.arguments import Arguments
    from rocking.decision.assessment import BodyAssessment
    from rocking.decision.code_methods import CalledSafe, CodeComparison
    from rocking.decision.code_methods.methods import CodeMethod
    from rocking.spec.study import StudyProblem

COUNT, SEED, LEVEL = 100, 1, "2"
"""Default number and seed of synthetic motions, and the level that they are scaled to."""


def _csv(answer: "CodesAnswer", path: "Path") -> None:
    result, rows = answer.result, []
    for method, (k, body), (j, level) in product(result.methods, enumerate(result.bodies), enumerate(result.levels)):
        name = method.name
        called, bias, outside = result.called_safe(name, k, j), result.bias(name, k), result.outside.get(name, "")
        rows.append({
            "method": name, "body": body, "level": level, "histories_known": called.total, "safe": called.safe,
            "overturned": called.overturned, "limit_ratio": called.ratio, "median": bias.median,
            "censored": bias.censored, "outside": outside,
        })  # fmt: skip
    write_records(path, rows)


EXPORTS = {"csv": Export((".csv",), _csv)}
_SHOWN = ("method", "safe", "limit_ratio", "fraction", "median", "scatter")
_OWN = {
    "fraction": Quantity("fraction", "1", "fraction of these that overturn", label="these overturn", digits="%"),
    "median": Quantity("median", "1", "median of capacity over truth", label="capacity/truth", digits=".3g"),
    **closely(scatter=".2g"),
}


@options.takes(options.SIZES, options.SEVERAL_SIZES)
def code_checks(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.SeveralRecords = None,
    motion: options.SeveralMotions = None,
    synthetic: options.Family = None,
    count: Annotated[int | None, options.count(COUNT)] = None,
    seed: options.Seed = None,
    im: Annotated[str, typer.Option(help="Intensity measure, as for rocking fragility.")] = "pga/(g tan alpha)",
    levels: Annotated[
        str | None,
        typer.Option(help="Intensity levels: FIRST:LAST:COUNT or A,B,C. [default: unscaled; synthetic motions: 2]"),
    ] = None,
    restitution: options.Restitution = None,
    slenderness: Annotated[
        str | None,
        typer.Option(
            help="Height over width, in place of --width; several values: 4,5,6.", rich_help_panel=options.SIZE
        ),
    ] = None,
    sets: options.Set = None,
    friction: options.Friction = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking code-checks`."""
    from rocking.cli.arguments import Arguments
    from rocking.cli.study import TABLES
    from rocking.decision.code_methods import compare_code_methods
    from rocking.motions.intensity import measure as measure_of

    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, *TABLES)
    intensity_measure = measure_of(im)
    problem = _problem(arguments)
    if levels is None and not arguments.body_and_motions()[1]:
        levels = LEVEL if intensity_measure.needs_body else None
    level_values = (
        None
        if levels is None
        else row("--levels", levels, "1" if intensity_measure.unit == "-" else intensity_measure.unit)[0]
    )
    with bar("histories", quiet=as_json) as progress:
        result, others = with_models(
            lambda study: compare_code_methods(
                study.bodies, study.motions, study.restitution, levels=level_values, im=intensity_measure,
                threads=threads, progress=progress, **study.stated,
            ), problem,
        )  # fmt: skip
    result = replace(result, bodies=_names(problem, Display(arguments.length or "m")))
    cautions = tuple(dict.fromkeys(body.caution for body in problem.bodies if body.caution))
    deliver(CodesAnswer(result, others, cautions, details), exports, as_json=as_json)


def _problem(arguments: "Arguments") -> "StudyProblem":
    from rocking.cli.study import models_table, motions_of, problem_of

    with arguments.hinted():
        motions = motions_of(arguments, arguments.of_body, {"count": COUNT, "seed": SEED})
        (body, _), model = arguments.body_and_motions(), arguments.options["restitution"]
        tables = {"body": _bodies(arguments, body), "restitution": models_table(model and [model])}
        return problem_of("histories", arguments, motions, **tables)


def _bodies(arguments: "Arguments", file: str | None) -> list[dict[str, Any]]:
    """Return the tables of the bodies: a file, or blocks of all given widths and heights."""
    typed_options = arguments.options
    widths, heights, ratios = (
        None if (text := typed_options[name]) is None else row(f"--{name}", text, "1")[0].tolist()
        for name in ("width", "height", "slenderness")
    )
    if ratios is not None:
        if widths is not None or heights is None:
            raise UsageError("--slenderness needs --height and replaces --width")
        if min(ratios) <= 0.0:
            raise UsageError(parameter="--slenderness", allowed="above 0", value=min(ratios), hint="height over width")
        heights, widths = zip(*[(h, h / ratio) for h in heights for ratio in ratios], strict=True)
    widths, heights = widths or [None], heights or [None]
    if len(widths) != len(heights) and 1 not in {len(widths), len(heights)}:
        raise UsageError(
            "--width and --height must have the same number of values, or one value; got {widths} and {heights}",
            widths=len(widths), heights=len(heights),
        )  # fmt: skip
    count = max(len(widths), len(heights))
    tables = []
    for k in range(count):
        size = {"width": widths[k % len(widths)], "height": heights[k % len(heights)]}
        arguments.options = {**typed_options, **size}
        tables.append(arguments.body_table(file))
    arguments.options = typed_options
    return tables


def _names(problem: "StudyProblem", display: Display) -> tuple[str, ...]:
    return tuple(
        f"{display.cell('size', body.width)} x {display.text('size', body.height)}"
        if isinstance(body, Block)
        else type(body).__name__
        for body in problem.bodies
    )


@dataclass(frozen=True)
class CodesAnswer:
    """Code methods compared with time histories."""

    result: "CodeComparison"
    others: dict[str, Any]  # results of the compared models
    cautions: tuple[str, ...]  # bodies with a depth that is the weaker side
    details: bool = False

    def answer(self) -> Answer:
        """Return the result of each method for each body, and the excluded methods."""
        from rocking.decision.code_methods import LEFT_OUT

        models = model_facts(self.result.restitution, self.others, _overturned)
        caution = {"caution": Message.joined(self.cautions)} if self.cautions else {}
        return self.result.answer() | {"left_out": LEFT_OUT, **caution, **models}

    def show(self, page: Page) -> None:
        from rocking.cli.study import source_lines

        result = self.result
        outcomes, count = result.overturned[result.overturned == result.overturned], len(result.motions)  # no NaN
        motions = result.motions[0] if count == 1 else f"{count}"
        page.facts([
            ("bodies", "; ".join(result.bodies)), ("motions", f"{motions}, {'; '.join(result.levels)}"),
            *source_lines(result.sources),
            ("histories", f"{int(outcomes.sum())} of {outcomes.size} overturned, restitution {result.restitution}"),
        ])  # fmt: skip
        for caution in self.cautions:
            page.line(caution)
        page.line()
        rows = [_row(result, method.name) for method in result.methods]
        page.rows(rows, _SHOWN, Display(own=_OWN), most=len(rows), dense=False)
        if self.details and len(result.bodies) * len(result.levels) > 1:
            page.line("\nFraction with overturning of the histories rated safe", "bold")
            names = [method.name for method in result.methods]
            for j, level in enumerate(result.levels):
                page.line(level)
                page.table(("body", *(name.replace("-", " ") for name in names)), [
                    (body, *(_share(result.called_safe(name, k, j)) for name in names))
                    for k, body in enumerate(result.bodies)
                ], ("body",))  # fmt: skip
        show_limits(page, result.methods, result)
        page.line()
        page.line("capacity/truth above 1: unsafe")
        if self.details:
            page.line("rated safe: fraction of the histories in the domain of the method")
            page.line("D/C: median of demand / capacity")
            page.line("capacity/truth: median of capacity / smallest intensity with overturning")
            page.line("scatter: half of the logarithm of the 84 % quantile / the 16 % quantile of capacity/truth")
        if result.asymmetric.any():
            page.line("Asymmetric bodies: the weaker side governs, in methods and histories.")
        show_models(page, self.answer(), Display(), result.restitution, _overturned(result))
        if not self.details:
            page.line("Definitions and single bodies: --details    Sources and domains: --json")


def _overturned(result: "CodeComparison") -> dict[str, Any]:
    is_computed = result.overturned == result.overturned  # NaN means no result
    return overturned(np.where(is_computed, result.overturned - 1.0, -3.0))


def show_limits(page: Page, methods: "Iterable[CodeMethod]", result: "BodyAssessment | CodeComparison") -> None:
    """Write the reasons for empty rows, and the treatment of vertical motion by each method."""
    from rocking.decision.code_methods.methods import VerticalMotion

    reasons = {name: reason for name, reason in result.outside.items() if reason}
    if reasons:
        page.line()
    for name, reason in reasons.items():
        page.line(f"{name}: outside its domain: {reason}")
    if not result.vertical:
        return
    page.line(f"\nVertical motion: in {result.vertical} of {len(result.motions)} motions.")
    for method in methods:
        treatment = f"{method.name} {method.vertical_motion}."
        if method.vertical is VerticalMotion.NOT_CONSIDERED:
            page.warn([treatment])
        else:
            page.line(treatment)


def _row(result: "CodeComparison", name: str) -> dict[str, Any]:
    rating, bias = result.called_safe(name), result.bias(name)
    if not rating.total:
        return {"method": name, "safe": "outside"}
    overturned = bias.count - bias.censored
    no_overturning = "none overturned" if bias.count else None
    median: float | str | None = (
        (bias.median if bias.median > 0.0 else "few overturned") if overturned else no_overturning
    )
    return {
        "method": name,
        "safe": rating.safe == 1 if rating.total == 1 else percent(round(rating.safe / rating.total, 3)),
        "limit_ratio": rating.ratio, "fraction": rating.fraction,
        "fraction_95": rating.interval if rating.safe else None,
        "median": median, "median_95": bias.interval if isinstance(median, float) else None,
        "scatter": bias.scatter if overturned else None,
    }  # fmt: skip


def _share(rating: "CalledSafe") -> str:
    return percent(round(rating.fraction, 3)) if rating.safe else "-"
