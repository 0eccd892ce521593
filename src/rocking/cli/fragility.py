"""`rocking fragility`: probability of rocking and overturning at each intensity level."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

import typer

from rocking.cli import options
from rocking.cli.exports import DRAWN, Export, Exports
from rocking.cli.numbers import row, values_table
from rocking.cli.page import bar, deliver
from rocking.cli.spelling import UsageError
from rocking.messages import Range
from rocking.spec.questions.fragility import ExportTable, FragilityTable

if TYPE_CHECKING:
    from rocking.cli.arguments import Arguments
    from rocking.cli.fragility_answer import FragilityAnswer
    from rocking.spec.study import StudyProblem

ANALYSES = ("stripes", "cloud", "incremental")
COUNT, SEED = 100, 1  # default number and seed of synthetic motions
MOST_MOTIONS = 5000  # limit, because all motions are in memory
MOST_IN_PICTURE = 6  # largest number of restitution models in a figure


def _csv(answer: "FragilityAnswer", path: Path) -> None:
    from rocking.tables import to_csv

    to_csv(answer.counted(), path)


def _of_curves(writer: str, *more: str) -> Any:
    """Return the function that writes the curves of one restitution model."""

    def write(answer: "FragilityAnswer", path: Path) -> None:
        from rocking.studies import fragility

        getattr(fragility, writer)(answer.curves, path, *more)

    return write


EXPORTS = {
    "picture": DRAWN,
    "csv": Export((".csv",), _csv),
    "p58": Export((".csv",), _of_curves("to_csv", "fema-p58")),
    "pelicun": Export((".csv",), _of_curves("to_csv", "pelicun")),
    "nrml": Export((".xml",), _of_curves("to_nrml")),
    "excel": Export((".xlsx",), _of_curves("to_excel"), "openpyxl"),
    "mat": Export((".mat",), _of_curves("to_mat")),
    "netcdf": Export((".nc",), _of_curves("to_netcdf"), "h5netcdf"),
}
CURVES = ("p58", "pelicun", "nrml", "excel", "mat", "netcdf")
"""Files that contain the curves of one restitution model."""


@options.takes(
    options.keys(
        FragilityTable,
        "im",
        "levels",
        "limit_states",
        "scale",
        levels=": 0.05g:1g:20",
        limit_states=": 0.2,0.5",
    ),
    before="restitution",
)
@options.takes(options.SIZES)
def fragility(
    context: typer.Context,
    body: options.BodyFile = None,
    record: Annotated[
        list[str] | None,
        typer.Argument(help="Record files, folders, FILE#COMPONENT or pulses."),
    ] = None,
    motion: options.SeveralMotions = None,
    synthetic: options.Family = None,
    count: Annotated[int | None, options.count(COUNT)] = None,
    seed: options.Seed = None,
    analysis: Annotated[
        str,
        typer.Option(
            help="Type: stripes, incremental or cloud"
        ),
    ] = "stripes",
    restitution: options.Restitutions = None,
    sets: options.Set = None,
    friction: options.Friction = None,
    threads: options.Threads = None,
    name: Annotated[
        str | None,
        typer.Option(help="Name of the body in the files. [default: kind of the body]", rich_help_panel=options.OUTPUT),
    ] = None,
    crossing_curves: Annotated[
        str,
        typer.Option(
            help="Treatment of crossing curves: keep-uplift, common-dispersion or refuse.",
            rich_help_panel=options.OUTPUT,
        ),
    ] = ExportTable.model_fields["crossing_curves"].default,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:  # fmt: skip
    """Run `rocking fragility`."""
    from rocking import checks
    from rocking.cli.arguments import Arguments
    from rocking.cli.fragility_answer import FragilityAnswer
    from rocking.cli.spelling import typed
    from rocking.cli.study import TABLES, histories_in, problem_in
    from rocking.studies.fragility.curves import Crossing

    exports = Exports.of(output, EXPORTS)
    checks.one_of("--crossing-curves", crossing_curves, get_args(Crossing))
    length, written = None, ""
    if problem := problem_in(context, body, "fragility", "name", "crossing_curves"):
        if not typed(context, "crossing_curves"):
            crossing_curves = problem.document.export.crossing_curves
    else:
        arguments = Arguments(context, *TABLES, "fragility")
        length = arguments.length
        own, written = _table(arguments)
        problem = _problem(arguments, own)
    _check(problem, exports)
    with bar("histories", histories_in(problem, compared=True), quiet=as_json) as progress:
        answer = FragilityAnswer.of(problem, progress, threads, written=written, length=length or "m")
    answer.name, answer.crossing_curves, answer.details = name, crossing_curves, details
    # the result is printed even if a file cannot be written
    deliver(answer, as_json=as_json)
    if {"p58", "pelicun", "nrml"} & exports.names:
        answer.check_crossing()
    for path in exports.write(answer):
        if not as_json:
            print(f"wrote {path}")


def _table(arguments: "Arguments") -> tuple[dict[str, Any], str]:
    """Return the table [fragility], and the unit of the given levels, in which medians are printed."""
    from rocking import checks
    from rocking.motions.intensity import measure as measure_of
    from rocking.studies.fragility.limit_states import limit_states_of
    from rocking.studies.fragility.subject import checked_levels

    kind, levels, states, scale = (arguments.options[name] for name in ("analysis", "levels", "limit_states", "scale"))
    checks.one_of("--analysis", kind, ANALYSES)
    sets = arguments.sets.get("fragility", {})
    im = arguments.table("fragility", {"im": arguments.options["im"]}, keys={"im"})
    if not isinstance(im["im"], str):
        raise UsageError(parameter="fragility.im", allowed="text", value=im["im"])
    intensity_measure = measure_of(im["im"])
    if len(arguments.options["restitution"] or ()) > 1 and kind != "stripes":
        raise UsageError(
            "--analysis {analysis} accepts one --restitution; use --analysis stripes for several", analysis=kind
        )
    own: dict[str, Any] = {**im, "limit_states": _states(states)}
    limit_states_of(tuple(own["limit_states"]))
    if scale is not None:
        if kind != "cloud":
            raise UsageError(
                "{parameter} is for --analysis cloud; {analysis} scales every motion to the levels",
                parameter="--scale", analysis=kind,
            )  # fmt: skip
        own["scale"] = scale
    written = "g" if intensity_measure.name == "pga" else ""
    if kind == "cloud":
        if levels is not None:
            raise UsageError("--levels is not for --analysis cloud, which does not scale the motions")
    elif intensity_measure.power == 0:
        raise UsageError(
            "{measure} does not change with the scale factor of a motion: use --analysis cloud",
            measure=intensity_measure.name,
        )
    elif levels is not None:
        unit = "1" if intensity_measure.unit == "-" else intensity_measure.unit
        own["levels"], written = values_table("--levels", levels, unit)
        checked_levels("--levels", row("--levels", levels, unit)[0], intensity_measure.unit)
    elif intensity_measure.uplift is None and "levels" not in sets:
        raise UsageError(
            "No intensity levels. Give --levels FIRST:LAST:COUNT of {measure} in {unit}",
            measure=intensity_measure.name,
            unit=intensity_measure.unit,
        )
    return arguments.table("fragility", own), written


def _states(text: str) -> list[float | str]:
    """Return limit states: rotations / slenderness angle [-], then names."""
    from rocking.studies.fragility.limit_states import NAMED, damage_state

    entries = [entry.strip() for entry in text.split(",")]
    names = [entry for entry in entries if entry in NAMED or damage_state(entry)]
    numbers = [entry for entry in entries if entry not in names]
    rotations = row("--limit-states", ",".join(numbers), "1")[0].tolist() if numbers or not names else []
    return [*rotations, *names]


def _problem(arguments: "Arguments", own: dict[str, Any]) -> "StudyProblem":
    from rocking.cli.study import motions_of, of_body

    kind, restitution = arguments.options["analysis"], arguments.options["restitution"]
    motions = motions_of(arguments, arguments.of_body, {"count": COUNT, "seed": SEED})
    count = motions[0].get("count")
    if isinstance(count, int) and not 1 <= count <= MOST_MOTIONS:
        raise UsageError(
            parameter="--count", allowed=Range(1, MOST_MOTIONS), value=count, hint="use rocking campaign for more"
        )
    if kind != "cloud" and "levels" not in own:  # default levels depend on the uplift acceleration
        bare = {key: own[key] for key in ("im", "limit_states")}
        own = {**own, "levels": _usual_levels(of_body(arguments, "cloud", bare, restitution, motions))}
    return of_body(arguments, kind, own, restitution, motions)


def _usual_levels(problem: "StudyProblem") -> list[float]:
    from rocking.studies.fragility.question import default_levels

    default: list[float] = default_levels(problem.document.analysis(problem, problem.restitution).subject).tolist()
    return default


def _check(problem: "StudyProblem", exports: Exports) -> None:
    """Refuse files that could not be written, before the computation."""
    several = len(problem.restitutions)
    if (curves := [f"{name}=FILE" for name in CURVES if name in exports.names]) and several > 1:
        raise UsageError(
            "{parameter} {files} accepts the curves of one --restitution", parameter="--output",
            files=", ".join(curves), hint="use csv=FILE for several",
        )  # fmt: skip
    if "picture" in exports.names and several > MOST_IN_PICTURE:
        raise UsageError(
            "a picture accepts at most {limit} --restitution, got {count}", limit=MOST_IN_PICTURE, count=several
        )
    from rocking.studies.fragility.export import intensity_type, pelicun_demand

    for name, check in (("nrml", intensity_type), ("pelicun", pelicun_demand)):
        if name in exports.names:
            check(problem.document.fragility.im)
