"""Options of the commands; help texts come from the tables of `rocking.spec`."""

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic_core import PydanticUndefined

from rocking.bodies.formats.schema import BLOCK_KEYS, BlockTable
from rocking.cli import completion
from rocking.cli.help import HOW, OUTPUT, SHAKING, SIZE
from rocking.conventions import DEFAULT_RESTITUTION, UNITS
from rocking.spec.documents.prediction import PredictTable
from rocking.spec.fields import Values, kinds_of, meaning_and_unit, stated_facts
from rocking.spec.motion_tables import ComponentsTable
from rocking.spec.settings_tables import StudySettingsTable

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

Options = dict[str, tuple[Any, Any]]  # annotation and default of options by name
NONE: Mapping[str, Any] = {}


ROW = ": FIRST:LAST:COUNT, FIRST:LAST:COUNT:log or A,B,C"
"""End of the help of a key with a list of numbers."""


def key(table: type[Any], name: str, more: str = "", **options: Any) -> Any:
    """Return the option of a key of a table, with the key's description and stated default as its help."""
    field = table.model_fields[name]
    text = (field.description or "").replace("unit of the file", "m, or --units")
    usual = stated_facts(field).get("usual", "")
    is_value = usual and field.default is None and not usual.startswith(("no ", "required"))
    default = f" [default: {usual}]" if is_value else ""
    return typer.Option(help=f"{text[:1].upper()}{text[1:]}{more}.{default}".replace("[", r"\["), **options)


def keys(
    table: type[Any],
    *names: str,
    panel: str | None = None,
    kind: Any = None,
    defaults: Mapping[str, Any] = NONE,
    **more: str,
) -> Options:
    """Return the options of keys of a table by name, with type, default and help of the fields.

    `kind` is the type of all options, by default the type of the field. `defaults` contains defaults of keys that have
    no default in files. `more` contains texts that are appended to the help, by key.
    """
    options = {}
    for name in dict.fromkeys((*names, *more)):
        field = table.model_fields[name]
        usual = defaults.get(name) if field.default is PydanticUndefined else field.default
        usual = ",".join(map(str, usual)) if isinstance(usual, list) else usual
        option = key(table, name, more.get(name, ROW if Values in kinds_of(field) else ""), rich_help_panel=panel)
        option_type = kind or _type_of(field)
        options[name] = Annotated[option_type if usual is not None else option_type | None, option], usual
    return options


def takes(*groups: Options, before: str = "sets") -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Add options to a command before one of its own options; `Arguments` reads the added options."""

    def with_options(command: Callable[..., None]) -> Callable[..., None]:
        own = dict(signature(command).parameters)
        added = {name: option for group in groups for name, option in group.items() if name not in own}

        @wraps(command)
        def taking(**values: Any) -> None:
            command(**{name: value for name, value in values.items() if name in own})

        parameters = [parameter.replace(kind=Parameter.KEYWORD_ONLY) for parameter in own.values()]
        k = list(own).index(before)
        parameters[k:k] = [
            Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=annotation)
            for name, (annotation, default) in added.items()
        ]
        taking.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
        taking.__annotations__ = {**command.__annotations__, **{n: annotation for n, (annotation, _) in added.items()}}
        return taking

    return with_options


def _type_of(field: "FieldInfo") -> Any:
    """Return the type of the option of a key: for a number without unit or a flag that of the field, otherwise text."""
    kinds, (_, unit) = kinds_of(field), meaning_and_unit(field.description or "")
    return kinds[0] if len(kinds) == 1 and kinds[0] in {int, float, bool} and not UNITS.get(unit) else str


Density = Annotated[float | None, typer.Option(help=r"Density of a block or a mesh \[kg/m3].", rich_help_panel=SIZE)]
Units = Annotated[
    str | None,
    typer.Option(help="Length unit, record unit or both: mm; gal; mm,g."),
]
SIZES = {**keys(BlockTable, *BLOCK_KEYS, panel=SIZE), "density": (Density, None), "units": (Units, None)}
"""Options of the size of a block, instead of a body file."""
SEVERAL_SIZES = keys(BlockTable, panel=SIZE, kind=str, width=": A,B,C", height=": A,B,C")


RecordUnits = Annotated[str | None, typer.Option("--units", help="Record unit: m/s2, cm/s2, mm/s2, gal, g, g/10, mg.")]


def _set(example: str) -> Any:
    text = f"Input-file key: {example}; repeatable."
    return typer.Option("--set", autocompletion=completion.keys, help=text, rich_help_panel=HOW)


Set = Annotated[list[str] | None, _set("settings.gravity=9.81")]
SetOfRecords = Annotated[list[str] | None, _set("motion.target=eurocode8:ag=0.35g,ground=C, motion.count=7")]
SetOfProcessing = Annotated[list[str] | None, _set('"motion.process=mean; bandpass:low=0.1,high=25"')]
SetOfAssessment = Annotated[list[str] | None, _set("assess.margin=1.5, assess.project, assess.author")]
Friction = Annotated[float | None, key(StudySettingsTable, "friction", rich_help_panel=HOW)]
Threads = Annotated[int | None, typer.Option(help="Number of threads.", rich_help_panel=HOW)]
AsJson = Annotated[bool, typer.Option("--json", help="Result as JSON.", rich_help_panel=OUTPUT)]

Details = Annotated[bool, typer.Option("--details", help="All models, tables and values.", rich_help_panel=OUTPUT)]

BodyFile = Annotated[str | None, typer.Argument(help="Body: TOML, WKT, GeoJSON, DXF, STL, OBJ, PLY or GLB.")]
Record = Annotated[
    str | None,
    typer.Argument(
        help="Record file, FILE#COMPONENT or pulse: sine:amplitude=3,period=0.8.",
        autocompletion=completion.pulses,
    ),
]
Motion = Annotated[
    list[str] | None,
    typer.Option(
        help="Record or pulse; components x=FILE, y=FILE, z=FILE.",
        autocompletion=completion.pulses,
    ),
]
Motions = Annotated[
    list[str] | None,
    typer.Option("--motion", help="Record or pulse; repeatable.", autocompletion=completion.pulses),
]
SeveralRecords = Annotated[
    list[str] | None,
    typer.Argument(help="Record files, folders, FILE#COMPONENT or pulses."),
]
SeveralMotions = Annotated[
    list[str] | None,
    typer.Option(
        "--motion",
        help="Record or pulse; or x=FILE y=FILE z=FILE; repeatable.",
        autocompletion=completion.pulses,
    ),
]
Restitution = Annotated[
    str | None,
    typer.Option(
        help=f"Model, FILE.py:MODEL or coefficient. [default: {DEFAULT_RESTITUTION}]",
        autocompletion=completion.models,
    ),
]
Restitutions = Annotated[
    list[str] | None,
    typer.Option(
        help=f"Model or coefficient; repeatable [default: {DEFAULT_RESTITUTION}]",
        autocompletion=completion.models,
    ),
]
MeasuredRestitution = Annotated[
    str | None, typer.Option(help="Model or coefficient. [default: calibrated, with sampled coefficients]")
]
FRICTION_RANGE = 'a range: --set "predict.friction=[0.2,0.6]"'
FrictionOfRange = Annotated[
    float | None,
    typer.Option(help=rf"Coefficient of friction \[-]; {FRICTION_RANGE}. [default: 0.3 to 0.8]".replace("=[", r"=\[")),
]
Family = Annotated[
    str | None,
    typer.Option(
        help="Synthetic motions: firm-ground, soft-ground, kanai-tajimi, point-source, pulse-like.",
        rich_help_panel=SHAKING,
    ),
]
Seed = Annotated[
    int | None, typer.Option(help="Random seed of the synthetic motions. [default: 1]", rich_help_panel=SHAKING)
]
ScaledToPeak = Annotated[str | None, key(PredictTable, "pga", rich_help_panel=SHAKING)]


def count(usual: int, panel: str = SHAKING) -> Any:
    """Return the option of the number of synthetic motions."""
    return typer.Option(help=f"Number of synthetic motions. [default: {usual}]", rich_help_panel=panel)


def output(kinds: dict[str, Any] | str) -> Any:
    """Return the option `--output` of a command; `kinds` are the kinds of its files, or the help text."""
    from rocking.cli.exports import described

    text = kinds if isinstance(kinds, str) else described(kinds)
    return typer.Option("-o", "--output", help=text, rich_help_panel=OUTPUT)


def key_of(option: str) -> str:
    """Return `--set` with the key of the motion or the settings that has the name of an option; empty without a key.

    >>> key_of("--gravity"), key_of("--time-step"), key_of("--colour")
    ('--set settings.gravity=VALUE', '--set motion.time_step=VALUE', '')
    """
    key = option.removeprefix("--").replace("-", "_")
    keys = {"motion": ComponentsTable.model_fields, "settings": StudySettingsTable.model_fields}
    return next((f"--set {name}.{key}=VALUE" for name, fields in keys.items() if key in fields), "")
