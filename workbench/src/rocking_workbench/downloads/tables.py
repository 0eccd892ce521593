"""Tables of results, POST /api/table/{what}.{kind}: CSV, Excel, MATLAB, netCDF."""

import codecs
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Literal, get_args

import numpy as np
from fastapi import APIRouter, Query, Request
from starlette.responses import Response as Answer

from rocking import GroundMotion, Response
from rocking.bodies import Body
from rocking.conventions import FEET
from rocking.errors import InvalidValueError
from rocking.motions import ground_displacement, ground_velocity
from rocking.motions.pulse import Motion
from rocking.plots.labels import fine_samples, traces
from rocking.quantities import QUANTITIES
from rocking.quantities import quantity as quantity_of
from rocking.reports.body_facts import ImpactAnswer
from rocking.reports.response_facts import measures_of, spectrum_answer
from rocking.tables import Cell, Column, Table, text_array, to_csv, to_dataset, to_excel, to_mat, to_netcdf
from rocking_workbench.answers import answered_with_file, attachment
from rocking_workbench.api.motion import DAMPING, spectrum_of
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.errors import NotFound
from rocking_workbench.inputs import Inputs
from rocking_workbench.plain_text import LONGEST_CELL, plain_line
from rocking_workbench.settings import state_of
from rocking_workbench.work import heavy

What = Literal["body", "coefficients", "measures", "motion", "spectrum", "response", "outcomes", "impacts"]
Kind = Literal["csv", "xlsx", "mat", "nc"]

MOST_CELLS = 2_000_000  # largest number of cells of a workbook; more cells take minutes to write and longer to open

router = APIRouter(prefix="/api", tags=["take away"], default_response_class=Answer)


@router.post("/table/{what}.{kind}", summary="A table", responses=answered_with_file("The table.", *get_args(Kind)))
async def table(
    request: Request,
    what: What,
    kind: Kind,
    inputs: Inputs,
    foot: Annotated[Literal["left", "right", "both"], Query(description="impact foot")] = "both",
    restitution: Annotated[
        int | None,
        Query(ge=0, description="index of the response; default: the first, in xlsx all"),
    ] = None,
) -> Answer:
    """Return a table as a file for Excel, MATLAB, Python or R."""
    evaluation = Evaluation(inputs, state_of(request).records, foot)
    data, name = await heavy(request, _named_table, what, kind, evaluation, restitution)
    return attachment(data, f"{name}.{kind}")


def _named_table(content: str, kind: str, evaluation: Evaluation, restitution: int | None) -> tuple[bytes, str]:
    data = table_of(content, kind, evaluation, restitution)
    of_one = content == "response" and (kind != "xlsx" or restitution is not None)
    return data, evaluation.file_stem(content, restitution) if of_one else f"{evaluation.label} {content}"


def table_of(content: str, kind: str, evaluation: Evaluation, restitution: int | None = None) -> bytes:
    """Return a table as a file."""
    if content == "response" and kind != "xlsx":  # the library writes this file, with its own names of quantities
        response = evaluation.chosen(restitution)
        write = {"csv": response.to_csv, "mat": response.to_mat, "nc": response.to_netcdf}[kind]
        with TemporaryDirectory(prefix="rocking-response-") as folder:
            data = write(Path(folder) / f"response.{kind}").read_bytes()
        return codecs.BOM_UTF8 + data if kind == "csv" else data
    if content != "response":
        return written([(content, _one_table(content, evaluation))], kind)
    about = evaluation.about
    if restitution is not None:
        chosen = evaluation.chosen(restitution)
        return written([(chosen.parameters.label, response_table(chosen, about))], kind)
    sheets = [(name, _one_table(name, evaluation)) for name in ("outcomes", "impacts")]
    return written(
        [*sheets, *((label, response_table(answer, about)) for label, answer in evaluation.responses.items())], kind
    )


def _one_table(content: str, evaluation: Evaluation) -> Table:
    about = evaluation.about
    if content == "body":
        return body_table(evaluation.body, evaluation.gravity, evaluation.name, about)
    if content == "coefficients":
        return coefficient_table(evaluation.impact, about)
    if content in {"impacts", "outcomes"}:
        return (impacts_table if content == "impacts" else outcomes_table)(evaluation.responses, about)
    of_motion = {"motion": motion_table, "measures": measures_table, "spectrum": spectrum_table}[content]
    return of_motion(evaluation.motion, about)


def body_table(body: Body, gravity: float, name: str, about: dict[str, str]) -> Table:
    """Return the properties of a body at an acceleration of gravity [m/s2]."""
    answer = body.answer(gravity)
    (left, right), (x, y) = answer["foot_positions"], answer["centre"]
    rows = [
        ("centre_x", "", x, "m"), ("centre_y", "", y, "m"), ("foot_x", "left", left, "m"),
        ("foot_x", "right", right, "m"),
        *((key, "", answer[key], QUANTITIES[key].unit) for key in ("mass", "moment_of_inertia", "gravity")),
        *(
            (key, foot, value, QUANTITIES[key].unit)
            for foot, side in answer["sides"].items() for key, value in side.items()
        ),
    ]  # fmt: skip
    quantity, foot, value, unit = zip(*rows, strict=True)
    return as_table(about, {
        "body": ("", [name or type(body).__name__] * len(rows)), "quantity": ("", quantity), "foot": ("", foot),
        "value": ("unit of its row", value), "unit": ("", unit),
    })  # fmt: skip


def coefficient_table(answer: ImpactAnswer, about: dict[str, str]) -> Table:
    """Return the coefficients of a body under every model."""
    rows = [
        {"foot": foot, **row.answer().values} for foot, rows_of_foot in answer.tables.items() for row in rows_of_foot
    ]
    joined = [{**row, "warnings": "; ".join(row["warnings"]), "admissible": int(row["admissible"])} for row in rows]
    return as_table(about, {name: (_unit(name), [row[name] for row in joined]) for name in joined[0]})


def _unit(name: str) -> str:
    """Return the unit of a quantity for headings; empty for texts."""
    entry = quantity_of(name)
    return "" if entry is None else "-" if entry.unit == "1" else entry.unit


def motion_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return time, acceleration, velocity and displacement of a motion."""
    if isinstance(motion, GroundMotion):
        curves = motion.time, motion.acceleration, ground_velocity(motion), ground_displacement(motion)
    else:
        fine = traces(motion)
        curves = fine.time, fine.acceleration, fine.velocity, fine.displacement
    columns = dict(zip(("time", "acceleration", "velocity", "displacement"), curves, strict=True))
    if isinstance(motion, GroundMotion) and motion.vertical is not None:
        columns["vertical_acceleration"] = motion.vertical
    return as_table(about, {name: (_unit(name), values) for name, values in columns.items()})


def measures_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return the intensity measures of a motion."""
    measures = measures_of(motion, fine_samples(motion))
    return as_table(about, {
        "motion": ("", [motion.name] * len(measures)),
        "key": ("", list(measures)),
        "measure": ("", [measure.name for measure in measures.values()]),
        "value": ("unit of its row", [measure.value for measure in measures.values()]),
        "unit": ("", ["1" if measure.unit == "-" else measure.unit for measure in measures.values()]),
    })  # fmt: skip


def spectrum_table(motion: Motion, about: dict[str, str]) -> Table:
    """Return the response spectrum of a motion for 5 % damping, at the plotted periods."""
    answer = spectrum_answer(spectrum_of(fine_samples(motion)))
    columns = {name: (_unit(name), values) for name, values in answer.values.items() if name != "damping_ratio"}
    return as_table({**about, "damping ratio": repr(DAMPING)}, columns)


def response_table(response: Response, about: dict[str, str]) -> Table:
    """Return the samples of a response."""
    return as_table(about, {key: (column.unit, column.values) for key, column in response.exported().columns.items()})


def impacts_table(responses: Mapping[str, Response], about: dict[str, str]) -> Table:
    """Return the impacts of all responses, one impact per row."""
    names = ("time", "velocity_before", "velocity_after", "coefficient", "foot")
    rows = [
        (label, number, *row)
        for label, response in responses.items()
        for number, row in enumerate(response.impacts.tolist(), start=1)
    ]
    units = {"restitution": "", "impact": "-", **{name: _unit(name) for name in names}, "foot": ""}
    return as_table(about, {name: (unit, [row[k] for row in rows]) for k, (name, unit) in enumerate(units.items())})


def outcomes_table(responses: Mapping[str, Response], about: dict[str, str]) -> Table:
    """Return the outcomes of all responses."""
    answers = [response.outcome_answer() for response in responses.values()]
    names = ("outcome", "summary", "peak_rotation", "peak_ratio", "overturning_time", "impacts")
    columns: dict[str, Any] = {"restitution": ("", list(responses))}
    columns |= {f"coefficient_{foot}": ("-", [row["coefficient"][foot] for row in answers]) for foot in FEET}
    columns |= {name: (_unit(name), [row[name] for row in answers]) for name in names}
    return as_table(about, {**columns, "outcome": ("", columns["outcome"][1])})


def as_table(about: dict[str, str], columns: "Mapping[str, tuple[str, Iterable[Cell] | np.ndarray]]") -> Table:
    """Return columns as a table; a column is a unit (empty for text, ``-`` for pure numbers) and values."""
    plain = {key: plain_line(value, LONGEST_CELL) for key, value in about.items()}
    return Table("row", {name: _column(unit, values) for name, (unit, values) in columns.items()}, plain, no_unit="-")


def _column(unit: str, values: "Iterable[Cell] | np.ndarray") -> Column:
    """Return a column of numbers, NaN for missing values, or of printable text."""
    plain: list[Any] = values.tolist() if isinstance(values, np.ndarray) else list(values)
    if any(isinstance(value, str) for value in plain):
        return Column(text_array(["" if v is None else plain_line(str(v), LONGEST_CELL) for v in plain]), unit)
    if plain and all(isinstance(value, int) for value in plain):
        return Column(np.array(plain, dtype=np.int64), unit)
    numbers = [value if isinstance(value, (int, float)) and math.isfinite(value) else math.nan for value in plain]
    return Column(np.array(numbers, dtype=np.float64), unit)


def written(sheets: Sequence[tuple[str, Table]], kind: str) -> bytes:
    """Return tables as a file: all tables in Excel, the first table in other formats."""
    if kind not in get_args(Kind):
        raise NotFound("unknown format {kind!r:.20}; allowed are {names}", names=", ".join(get_args(Kind)), kind=kind)
    first = sheets[0][1]
    with TemporaryDirectory(prefix="rocking-table-") as folder:
        path = Path(folder) / f"table.{kind}"
        if kind == "csv":
            to_csv(first, path, for_excel=True)
        elif kind == "xlsx":
            cells = sum(len(table) * len(table.columns) for _, table in sheets)
            if cells > MOST_CELLS:
                raise InvalidValueError(
                    "a workbook may have up to {limit} cells, got {count}; use csv or mat", limit=MOST_CELLS,
                    count=cells,
                )  # fmt: skip
            to_excel([(plain_line(name), sheet) for name, sheet in sheets], path, others="csv or mat", dressed=True)
        elif kind == "mat":
            to_mat(_doubles(first), path)
        else:
            units = {name: replace(column, unit=column.unit or "1") for name, column in _doubles(first).columns.items()}
            to_netcdf(to_dataset(replace(first, columns=units)), path)
        return path.read_bytes()


def _doubles(table: Table) -> Table:
    columns = {
        name: column if column.is_text else replace(column, values=column.values.astype(np.float64))
        for name, column in table.columns.items()
    }
    return replace(table, columns=columns)
