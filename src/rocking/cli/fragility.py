"""`rocking fragility`: how likely a body is to rock or to overturn at a level of shaking."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli import options
from rocking.cli.exports import Export, Exports, picture
from rocking.cli.numbers import row, values_table
from rocking.cli.page import bar, deliver
from rocking.errors import InvalidValueError
from rocking.spec.document import FragilityTable

if TYPE_CHECKING:
    from rocking.cli.fragility_answer import FragilityAnswer
    from rocking.cli.question import Words
    from rocking.spec.study import StudyProblem

_SHAKING = "What shakes it"
ANALYSES = ("stripes", "cloud", "incremental")
MOST_HISTORIES = 10_000_000
"""A larger analysis is a campaign."""

_REACH = (0.9, 9.0, 16)
"""Levels of PGA that serve where none are given: from, to in what lifts the body, how many, in equal ratios."""

COUNT, SEED = 100, 1
"""What serves where nobody says otherwise."""

MOST_MOTIONS = 5000
"""All of them are held in memory."""

MOST_IN_PICTURE = 6
"""Restitutions that can be told apart in a picture."""


def _draw(answer: "FragilityAnswer") -> Any:
    return answer.draw()


def _csv(answer: "FragilityAnswer", path: Path) -> None:
    from rocking.tables import to_csv

    to_csv(answer.counted(), path)


def _of_curves(writer: str, *more: str) -> Any:
    """Return what writes the curves of one restitution; they cannot be without a curve."""

    def write(answer: "FragilityAnswer", path: Path) -> None:
        from rocking.studies import fragility

        getattr(fragility, writer)(answer.curves, path, *more)

    return write


EXPORTS = {
    "picture": picture(_draw, "matplotlib"),
    "csv": Export((".csv",), _csv),
    "p58": Export((".csv",), _of_curves("to_csv", "fema-p58")),
    "nrml": Export((".xml",), _of_curves("to_nrml")),
    "excel": Export((".xlsx",), _of_curves("to_excel"), "openpyxl"),
    "mat": Export((".mat",), _of_curves("to_mat")),
    "netcdf": Export((".nc",), _of_curves("to_netcdf"), "h5netcdf"),
}
CURVES = ("p58", "nrml", "excel", "mat", "netcdf")
"""Files of the curves of one restitution."""


def fragility(
    context: typer.Context,
    body: options.BodyFile = None,
    record: Annotated[
        list[str] | None,
        typer.Argument(help="Record files, file#COMPONENT, or pulses such as sine:amplitude=1,period=0.5."),
    ] = None,
    motion: options.Motions = None,
    synthetic: Annotated[
        str | None,
        typer.Option(
            help="Family of motions in their place: firm-ground, soft-ground, kanai-tajimi, point-source, pulse-like.",
            rich_help_panel=_SHAKING,
        ),
    ] = None,
    count: Annotated[
        int | None, typer.Option(help="How many synthetic motions, 100 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the synthetic motions, 1 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    analysis: Annotated[
        str,
        typer.Option(
            help="stripes: every motion at every level; incremental: and every level at which one begins or ceases to "
            "overturn; cloud: motions as they are."
        ),
    ] = "stripes",
    measure: Annotated[str, options.key(FragilityTable, "measure")] = "pga",
    levels: Annotated[
        str | None,
        options.key(
            FragilityTable, "levels",
            ": FIRST:LAST:COUNT, with :log for equal ratios, or A,B,C; with units, 0.05g:1g:20",
        ),
    ] = None,
    states: Annotated[str, options.key(FragilityTable, "states", ": 0.2,0.5")] = "0.5",
    factor: Annotated[float | None, options.key(FragilityTable, "factor")] = None,
    restitution: options.Restitutions = None,
    width: options.Width = None,
    height: options.Height = None,
    depth: options.Depth = None,
    density: options.Density = None,
    units: options.Units = None,
    sets: options.Set = None,
    threads: options.Threads = None,
    name: Annotated[
        str | None,
        typer.Option(help="Name of the body in the files; its kind if not given.", rich_help_panel=options.OUTPUT),
    ] = None,
    crossing: Annotated[
        str,
        typer.Option(
            help="Curves that cross, in files: refuse, or common-dispersion, one for all states, so that none cross.",
            rich_help_panel=options.OUTPUT,
        ),
    ] = "refuse",
    out: Annotated[list[str] | None, options.out(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:  # fmt: skip
    """Print how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""
    from rocking import checks
    from rocking.cli.fragility_answer import FragilityAnswer
    from rocking.cli.question import as_typed
    from rocking.cli.study import document_file, problem_in, words_of

    exports = Exports.of(out, EXPORTS)
    checks.one_of("--crossing", crossing, ("refuse", "common-dispersion"))
    file = document_file(context, "fragility")
    if file is not None:
        problem, written, length = problem_in(file, "fragility", sets), "", "m"
    else:
        words = words_of(context.params, "fragility")
        own, written = _table(analysis, measure, levels, states, factor, several=len(restitution or ()) > 1)
        problem = _problem(words, analysis, own, restitution)
        length = words.length or "m"
    _check(problem, exports)
    table = problem.document.fragility or FragilityTable()
    total = len(problem.motions) * (1 if table.levels is None else table.levels.numbers().size)
    total *= len(problem.restitutions)
    if total > MOST_HISTORIES:
        raise InvalidValueError(
            f"there must be at most {MOST_HISTORIES} histories, got {total}; rocking campaign computes more"
        )
    with bar("histories", total, quiet=as_json) as tell, as_typed():
        answer = FragilityAnswer.of(problem, tell, threads, written=written, length=length)
    answer.name, answer.crossing = name, crossing
    # the numbers are shown even if a file cannot be made of them
    deliver(answer, as_json=as_json)
    if {"p58", "nrml"} & exports.names:
        answer.check_crossing()  # before the first file is written
    for path in exports.write(answer):
        if not as_json:
            print(f"wrote {path}")


def _table(
    kind: str, measure: str, levels: str | None, states: str, factor: float | None, *, several: bool
) -> tuple[dict[str, Any], str]:
    """Return the table [fragility], and the unit that levels were written in, in which medians are printed."""
    from rocking import checks
    from rocking.motions.intensity import measure as measure_of

    checks.one_of("--analysis", kind, ANALYSES)
    wanted = measure_of(measure)
    if several and kind != "stripes":
        raise InvalidValueError(f"several --restitution are compared by --analysis stripes, not by {kind}")
    own: dict[str, Any] = {"measure": measure, "states": row("--states", states, "1")[0].tolist()}
    if factor is not None:
        if kind != "cloud":
            raise InvalidValueError(f"--factor is for --analysis cloud: {kind} brings every motion to the levels")
        own["factor"] = checks.positive("--factor", factor)
    in_g = "g" if wanted.name == "pga" else ""
    if kind == "cloud":
        if levels is not None:
            raise InvalidValueError("--levels is not for --analysis cloud, which takes the motions as they are")
        return own, in_g
    if wanted.power == 0:
        raise InvalidValueError(f"no factor on a motion changes {wanted.name}: take it with --analysis cloud")
    if levels is None:
        if wanted.uplift is None:
            raise InvalidValueError(f"which levels of {wanted.name}? Give --levels FIRST:LAST:COUNT in {wanted.unit}")
        return own, in_g
    from rocking.studies.fragility.subject import checked_levels

    unit = "1" if wanted.unit == "-" else wanted.unit
    own["levels"], written = values_table("--levels", levels, unit)
    checked_levels("--levels", row("--levels", levels, unit)[0], wanted.unit)
    return own, written


def _problem(words: "Words", kind: str, own: dict[str, Any], restitution: list[str] | None) -> "StudyProblem":
    from rocking.cli.question import as_typed
    from rocking.cli.study import problem_of
    from rocking.studies.fragility.subject import limit_states

    limit_states(tuple(own["states"]))
    motions = _motions(words)
    with as_typed():
        if kind == "cloud" or "levels" in own:
            return problem_of(kind, words, restitution, own, motions)
        # what lifts the body decides on the levels that serve where none are given
        subject = problem_of("cloud", words, restitution, own, motions)
        return problem_of(kind, words, restitution, {**own, "levels": _usual_levels(subject)}, motions)


def _usual_levels(problem: "StudyProblem") -> list[float]:
    import numpy as np

    from rocking.studies.fragility.subject import Subject

    table = problem.document.fragility or FragilityTable()
    subject = Subject.of(problem.bodies[0], problem.motions, problem.restitution, table.measure, problem.stated)
    lifts = 1.0 if subject.measure.uplift is None else subject.measure.uplift(subject.scale)
    low, high, count = _REACH
    return [float(level) for level in np.geomspace(low * lifts, high * lifts, count)]


def _motions(words: "Words") -> list[dict[str, Any]]:
    """Return the tables [[motions]]: record files and pulses, or one synthetic family."""
    from rocking.cli.study import motions_tables

    asked, stated = words.options, words.sets.get("motion", {})
    _, named = words.body_and_motions()
    family = {name: asked[name] for name in ("synthetic", "count", "seed")}
    if named:
        if odd := [f"--{name}" for name, value in family.items() if value is not None]:
            raise InvalidValueError(f"{', '.join(odd)} is for synthetic motions: leave it out beside --motion")
        return motions_tables(words, named)
    if words.acceleration is not None or stated:
        odd = [*(["--units"] if words.acceleration is not None else []), *(f"motion.{key}" for key in stated)]
        raise InvalidValueError(f"{', '.join(odd)} is for record files: leave it out, or give --motion")
    if asked["synthetic"] is None:
        raise InvalidValueError("what shakes it? Give --motion FILE, or --synthetic firm-ground")
    number = COUNT if asked["count"] is None else asked["count"]
    if not 1 <= number <= MOST_MOTIONS:
        raise InvalidValueError(f"--count must be in [1, {MOST_MOTIONS}], got {number}; rocking campaign takes more")
    return [{**family, "count": number, "seed": SEED if asked["seed"] is None else asked["seed"]}]


def _check(problem: "StudyProblem", exports: Exports) -> None:
    """Refuse, before anything is computed, what could not be written."""
    several = len(problem.restitutions)
    if (asked := [f"{name}=FILE" for name in CURVES if name in exports.names]) and several > 1:
        raise InvalidValueError(
            f"--out {', '.join(asked)} holds the curves of one --restitution; csv=FILE holds several"
        )
    if "picture" in exports.names and several > MOST_IN_PICTURE:
        raise InvalidValueError(f"a picture holds {MOST_IN_PICTURE} --restitution at most, got {several}")
    if "nrml" in exports.names:
        from rocking.studies.fragility.export import intensity_type

        intensity_type((problem.document.fragility or FragilityTable()).measure)
