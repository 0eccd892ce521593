"""Reference of the keys of input files for the manual, made from the classes of the tables."""

import re
import types
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import fields as dataclass_fields
from inspect import Parameter, getdoc, signature
from itertools import chain
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from rocking.bodies.formats import schema
from rocking.decision.inventory import Thresholds
from rocking.dynamics import ContactSettings, PlaneSettings, Settings, SpaceSettings
from rocking.spec.documents.identification import IdentifyTable, MeasurementTable
from rocking.spec.documents.prediction import AssessTable, PredictTable
from rocking.spec.documents.response import ResponseTable
from rocking.spec.fields import JobTable, Values, limits_of, meaning_and_unit, stated_facts
from rocking.spec.key_facts import LARGEST_SHOWN, as_code, facts
from rocking.spec.motion_tables import ComponentsTable, FileKeys, MotionTable
from rocking.spec.question import BodyQuestion, CampaignTable
from rocking.spec.questions import questions
from rocking.spec.questions.inventory import ThresholdsTable
from rocking.spec.restitution_tables import RandomTable, RestitutionTable
from rocking.spec.settings_tables import StudySettingsTable

_TABLES: dict[str, tuple[type[JobTable], str]] = {
    "response": (ResponseTable, "`rocking simulate`"),
    "motion": (ComponentsTable, "`rocking simulate`, `rocking record show`"),
    "[motions]": (MotionTable, "all studies"),
    'motions.files."NAME"': (FileKeys, "all studies"),
    "restitution": (RestitutionTable, "all commands"),
    "restitution.distribution": (RandomTable, "all commands except `rocking inventory`"),
    "settings": (StudySettingsTable, "all commands"),
    "predict": (PredictTable, "`rocking predict`, `rocking assess` and `rocking validate-predictions`"),
    "assess": (AssessTable, "`rocking assess`"),
    "measurement": (MeasurementTable, "`rocking identify`"),
    "identify": (IdentifyTable, "`rocking identify`"),
    "campaign": (CampaignTable, "`rocking campaign`"),
}

_COMMANDS = {"minimum": "overturning-pga"}  # commands whose name differs from the name of their table

_BODIES: dict[str, type[BaseModel]] = {
    "the file": schema.BodyFile,
    "block": schema.BlockTable,
    "trapezoid": schema.TrapezoidTable,
    "ellipse": schema.EllipseTable,
    "regular_polygon": schema.RegularPolygonTable,
    "section": schema.SectionTable,
    "[section.region]": schema.RegionTable,
    "mass_points": schema.MassPointsTable,
    "frame": schema.FrameTable,
    "isolator": schema.IsolatorTable,
    "[restraint]": schema.RestraintTable,
    "stack": schema.StackTable,
    "solid": schema.SolidTable,
    "[solid.part]": schema.PartTable,
    "box": schema.BoxTable,
    "cylinder] and [cone": schema.UprightTable,
    "frustum": schema.FrustumTable,
    "sphere": schema.SphereTable,
    "ellipsoid": schema.EllipsoidTable,
    "extrusion": schema.ExtrusionTable,
    "revolution": schema.RevolutionTable,
    "mesh": schema.MeshTable,
    "turned": schema.TurnTable,
}


_HOW_TO_READ = (
    "The default is the value without the key. The default none has no effect. Numbers are finite. "
    "The range any has no limit, for the stated reason.\n"
)


def reference() -> dict[str, str]:
    """Return the pages of the manual by name: keys of input files, names of values, and keys of body files."""
    keys = chain(*(_table(name, table, f" Used by {where}.") for name, (table, where) in _tables().items()))
    body_keys = chain(*(_table(name, table) for name, table in _BODIES.items()))
    return {
        "input_files": "\n".join(["# Keys of input files\n", _HOW_TO_READ, *keys]),
        "names": "\n".join(["# Names of values\n", *_names()]),
        "body_files": "\n".join(["# Keys of body files\n", _HOW_TO_READ, *body_keys]),
    }


def _tables() -> dict[str, tuple[type[JobTable], str]]:
    """Return class and commands of all tables by name, including the tables of the studies."""
    of_studies: dict[str, tuple[type[JobTable], str]] = {}
    for question in questions().values():
        where = f"`rocking {_COMMANDS.get(question.own_table(), question.own_table())}`"
        of_studies = {**_within(question, where, {*BodyQuestion.model_fields}), **of_studies}
    return _TABLES | dict(sorted(of_studies.items()))


def _within(
    table: type[BaseModel], command: str, common_tables: Collection[str] = (), prefix: str = ""
) -> dict[str, tuple[type[JobTable], str]]:  # fmt: skip
    """Return the tables inside a table, at all depths."""
    inner: dict[str, tuple[type[JobTable], str]] = {}
    for name, field in table.model_fields.items():
        kind = field.annotation
        if (
            isinstance(kind, type)
            and issubclass(kind, JobTable)
            and not issubclass(kind, Values)
            and name not in common_tables
        ):
            inner |= {f"{prefix}{name}": (kind, command), **_within(kind, command, prefix=f"{prefix}{name}.")}
    return inner


def described(table: type[BaseModel]) -> dict[str, dict[str, Any]]:
    """Return unit, meaning, type, default, choices and limits of the keys of a table, by key."""
    return {
        field.alias or key: {
            **_facts_of_key(
                field.description or "",
                field.default,
                field.annotation,
                needed=field.is_required(),
                usual=stated_facts(field).get("usual", ""),
            ),
            **limits_of(field),
        }
        for key, field in table.model_fields.items()
    }


def steps() -> dict[str, dict[str, Any]]:
    """Return meaning and keys of every processing step; `single_key` is True if a step needs exactly one key."""
    from rocking.motions.intensity import MEASURES
    from rocking.motions.pipeline import STEPS
    from rocking.motions.pipeline import keys_of as keys_of_step

    facts = {}
    for name, step in STEPS.items():
        keys = keys_of_step(step)
        has_level = keys.pop("level", None) is not None
        scalable = [
            measure
            for measure in MEASURES.values()
            if has_level and measure.power and measure.is_listed and not measure.needs_body
        ]
        measures = {
            measure.name: _facts_of_key(f"{measure.description} [{measure.unit}]", None, float) for measure in scalable
        }
        facts[name] = {
            "description": _summary(step),
            "single_key": has_level,
            "keys": {**_documented(step, keys), **measures},
        }
    return facts


def targets() -> dict[str, dict[str, Any]]:
    """Return meaning and keys of the target spectra."""
    from rocking.motions.target_spectra import CODES

    return {
        name: {
            "description": _summary(make),
            "single_key": False,
            "keys": _documented(make, signature(make).parameters),
        }
        for name, make in CODES.items()
    }


_PARAMETERS = re.compile(r"^(\w+(?:, \w+)*) : .*\n((?: {4}.*\n?)+)", re.MULTILINE)


def _documented(function: Callable[..., Any], keys: Mapping[str, Parameter]) -> dict[str, dict[str, Any]]:
    """Return the facts of the given parameters of a function, read from its docstring."""
    text = (getdoc(function) or "").partition("\nReturns\n")[0]
    descriptions = {
        key: " ".join(description.split())
        for names, description in _PARAMETERS.findall(text)
        for key in names.split(", ")
    }
    return {
        key: _facts_of_key(
            descriptions.get(key, ""), None if needed else parameter.default, parameter.annotation, needed=needed
        )
        for key, parameter in keys.items()
        for needed in [parameter.default is parameter.empty]
    }


def _facts_of_key(
    description: str, default: Any, annotation: Any, *, needed: bool = False, usual: str = ""
) -> dict[str, Any]:
    """Return unit, meaning, type, default and choices of a key."""
    meaning, unit = meaning_and_unit(description)
    return {
        "unit": unit,
        "description": meaning,
        "kind": _kind(annotation),
        "usual": as_code(default).strip("`") or usual,
        "needed": needed,
        "choices": list(_choices(annotation)),
    }


def _choices(annotation: Any) -> tuple[str, ...]:
    """Return the allowed values of a key that is a flag or a choice."""
    if annotation is bool:
        return ("false", "true")
    return tuple(map(str, get_args(annotation))) if get_origin(annotation) is Literal else ()


def _summary(documented: Any) -> str:
    summary = _first_line(documented).removeprefix("Return ").rstrip(".")
    return f"{summary[:1].upper()}{summary[1:]}"


def keys_of(name: str) -> list[str]:
    """Return the keys of a table as they are written in files; empty for an unknown table."""
    table = _tables().get(name)
    return [] if table is None else [field.alias or key for key, field in table[0].model_fields.items()]


def _names() -> Iterator[str]:
    """Yield the names of values: axes of maps, intensity measures, synthetic families, pulses, steps, spectra."""
    from rocking.motions.intensity import MEASURES
    from rocking.motions.pulses import catalogue
    from rocking.motions.synthetic import families
    from rocking.studies.axis import axes

    measures = [(name, f"{measure.description} [{measure.unit}]") for name, measure in MEASURES.items()]
    pulses = [
        (
            f"{name}:{','.join(f'{key}=' for key in signature(make).parameters)}",
            _first_line(make).removeprefix("Return "),
        )
        for name, make in catalogue().items()
    ]
    for title, head, rows in (
        ("Axes of a map", "axis", [(name, f"{axis.meaning} [{axis.unit}]") for name, axis in axes().items()]),
        ("Intensity measures", "measure", [*measures, ("sa(T)", "spectral acceleration at the period T [m/s2]")]),
        ("Families of synthetic motions", "family", [(name, family.title) for name, family in families().items()]),
        ("Pulses", "pulse", pulses),
        ("Processing steps of a record", "step", _rows_of_entries(steps())),
        ("Target spectra", "spectrum", _rows_of_entries(targets())),
    ):
        yield f"## {title}\n\n| {head} | meaning |\n|---|---|"
        yield from (f"| `{name}` | {meaning.replace('[1]', '[-]').rstrip('.')} |" for name, meaning in rows)
        yield ""


def _rows_of_entries(described: dict[str, dict[str, Any]]) -> list[tuple[str, str]]:
    """Return one row per step or spectrum: name with keys, and meaning."""
    rows = []
    for name, entry in described.items():
        keys = ",".join(
            f"{key}={key_facts['usual']}" for key, key_facts in entry["keys"].items() if not entry["single_key"]
        )
        meaning = "; ".join(
            f"{key}: {key_facts['description'].rstrip('.')}" + (f" [{key_facts['unit']}]" if key_facts["unit"] else "")
            for key, key_facts in entry["keys"].items()
        )
        head = f"{name}:{keys}" if keys else name
        rows.append((head, f"{entry['description']}. {meaning}".strip()))
    return rows


def _first_line(documented: Any) -> str:
    return str(documented.__doc__ or "").splitlines()[0].replace("``", "`")


def _table(name: str, table: type[BaseModel], where: str = "") -> Iterator[str]:
    yield "## The file" if name == "the file" else f"## [{name}]"
    yield f"\n{_first_line(table)}{where}\n"
    yield "| key | type | unit | default | range | meaning |"
    yield "|---|---|---|---|---|---|"
    for key, field in table.model_fields.items():
        kind, unit, default, allowed, meaning = facts(field)
        if table is StudySettingsTable:
            default = _of_mechanics(_default_of_setting, key) if default == "none" else default
            allowed = allowed or _of_mechanics(_range_of_setting, key)
        elif table is ThresholdsTable:
            default = as_code(getattr(Thresholds(), key))
        elif (table, key) == (CampaignTable, "kind"):
            allowed = ", ".join(questions())
        yield f"| `{field.alias or key}` | {kind} | {unit} | {default} | {allowed} | {meaning} |"
    yield ""


_MECHANICS = {PlaneSettings: "", ContactSettings: " with friction", SpaceSettings: " in 3D"}


def _of_mechanics(fact: Callable[[type[Settings], str], str], key: str) -> str:
    """Return a fact of a setting for rocking, and where it differs, with friction and in 3D."""
    texts = {suffix: fact(settings, key) for settings, suffix in _MECHANICS.items()}
    return "; ".join(text + suffix for suffix, text in texts.items() if text and (not suffix or text != texts[""]))


def _default_of_setting(settings: type[Settings], key: str) -> str:
    return as_code(settings().stated.get(key))


def _range_of_setting(settings: type[Settings], key: str) -> str:
    """Return the limits of the check of a setting; empty without limits."""
    check = next((entry.metadata["check"] for entry in dataclass_fields(settings) if entry.name == key), None)
    limits = getattr(check, "keywords", {})
    if "high" not in limits:
        return ""
    low = f"{'>' if limits.get('open_low') else '>='} {limits['low']:,g}"
    high = f"{'<' if limits.get('open_high') else '<='} {limits['high']:,g}"
    return low if limits["high"] > LARGEST_SHOWN else f"{low}, {high}"


def _kind(annotation: Any) -> str:
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return ", ".join(str(argument).lower() if isinstance(argument, bool) else str(argument) for argument in inner)
    if origin in {Union, types.UnionType}:
        return " or ".join(dict.fromkeys(_kind(argument) for argument in inner if argument is not type(None)))
    if origin is list:
        return f"list of {_kind(inner[0])}"
    if isinstance(annotation, type) and issubclass(annotation, Values):
        return "numbers" if annotation is Values else "axis and numbers"
    if origin is dict or (isinstance(annotation, type) and issubclass(annotation, BaseModel)):
        return "table"
    names = {str: "text", float: "number", int: "whole number", bool: "true or false"}
    return names.get(annotation, _kind(inner[0]) if inner else "any")
