"""Inputs as an input file or as a command, and input files as inputs."""

import hashlib
import json
import re
from collections.abc import Callable, Mapping
from shlex import quote
from typing import Any

from pydantic import ValidationError

from rocking.bodies.formats.schema import BLOCK_KEYS
from rocking.bodies.formats.words import from_pydantic
from rocking.conventions import DEFAULT_RESTITUTION, Assumed
from rocking.spec.response import problem_of
from rocking.spec.schema import migrated
from rocking.version import SOFTWARE
from rocking_workbench.errors import Refused
from rocking_workbench.inputs import Inputs, body_from, parsed_toml
from rocking_workbench.plain_text import plain_line, record_file_name, toml_of, toml_value
from rocking_workbench.records import is_hash

FILE_NAME = "response.toml"  # name of the input file
_TABLES = ("response", "body", "motion", "restitution", "settings")
_SHAPES = {"block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points", "units"}
_RECORD = re.compile(r"^# record: ([0-9a-f]{64}) (\".*\")$", re.MULTILINE)

FindRecord = Callable[[str], str | None]
"""Function that returns the hash of a stored record, from its hash or file name."""


def plain_inputs(inputs: Inputs) -> dict[str, Any]:
    """Return inputs as plain values, without unset keys."""
    return inputs.model_dump(exclude_none=True, exclude_unset=True)


def fingerprint(inputs: Inputs) -> str:
    """Return the SHA-256 of inputs, independent of their format."""
    text = json.dumps(inputs.model_dump(exclude_none=True), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def record_name(inputs: Inputs) -> str | None:
    """Return the record file name of an input file; None without a record."""
    if inputs.motion is None or inputs.motion.record is None:
        return None
    return record_file_name(inputs.motion.file_name or "", f"record-{inputs.motion.record[:12]}.txt")


def commands(inputs: Inputs) -> list[str]:
    """Return commands for the same result: one with the input file, and one with options if possible."""
    if inputs.motion is None and inputs.response.initial_rotation is None:
        return []
    command = simulate_words(plain_inputs(inputs), record_name(inputs))
    return [f"rocking simulate {FILE_NAME}", *([] if command is None else [command])]


def inputs_as_toml(inputs: Inputs) -> str:
    """Return inputs as an input file of `rocking simulate`."""
    plain, friction, record = plain_inputs(inputs), inputs.response.assumed_friction, record_name(inputs)
    motion: dict[str, Any] | None = plain.get("motion")
    if motion is not None and record is not None:
        motion = {"record": record} | {key: motion[key] for key in motion if key not in {"record", "file_name"}}
    assumed = {} if isinstance(friction, Assumed) else {"assumed_friction": friction}
    tables: dict[str, Any] = {
        "response": assumed | plain.get("response", {}),
        "body": plain["body"],
        "motion": motion,
        "restitution": plain.get("restitution", inputs.restitution.model_dump(exclude_none=True)),
        "settings": plain.get("settings"),
    }
    return "\n".join([*_head(inputs), "", toml_of(tables)])


def inputs_from_toml(text: str, find: FindRecord) -> Inputs:
    """Return the inputs of an input file."""
    document = migrated(parsed_toml(text))
    unknown = sorted(set(document) - set(_TABLES))
    if unknown and "campaign" in document:
        raise Refused("this is a campaign job: use the step Studies or `rocking campaign run`")
    if unknown and "body" not in document and _SHAPES & set(document):
        raise Refused("this file contains a body only: drop it in the step Body")
    if unknown:
        raise Refused(
            "unknown table [{table}]; allowed are {names}", table=plain_line(unknown[0], 60),
            names=", ".join(_TABLES),
        )  # fmt: skip
    motion = document.get("motion")
    if isinstance(motion, dict) and isinstance(motion.get("record"), str):
        document["motion"] = motion | _stored(motion["record"], text, find)
    try:
        inputs = Inputs.model_validate(document)
    except ValidationError as error:
        raise Refused(plain_line(str(from_pydantic(error.errors(include_url=False))), 500)) from error
    return inputs if isinstance(inputs.response.initial_rotation, float | None) else _with_fraction(inputs)


def _with_fraction(inputs: Inputs) -> Inputs:
    """Return inputs with the initial rotation as a fraction of the slenderness angle, as on the page."""
    fraction = problem_of(inputs, body_from(inputs.body), None).initial_rotation
    response = inputs.response.model_copy(update={"initial_rotation": fraction})
    return inputs.model_copy(update={"response": response})


def _head(inputs: Inputs) -> list[str]:
    name = plain_line(inputs.body.name or "", 100)
    lines = [f"# How {name or 'a body'} rocks. Written by {SOFTWARE}."]
    for word, command in zip(("the command line", "or in words"), commands(inputs), strict=False):
        lines.append(f"# {word + ':':<17} {plain_line(command, 4000)}")
    if not commands(inputs):
        lines.append("# Nothing moves the body yet: add a table [motion], or initial_rotation = 0.5 under [response].")
    if inputs.motion is not None and inputs.motion.record is not None:
        lines.append(f"# record: {inputs.motion.record} {toml_value(inputs.motion.file_name or '')}")
    return lines


def _stored(word: str, text: str, find: FindRecord) -> dict[str, Any]:
    """Return hash and name of the record in an input file."""
    noted = _RECORD.search(text)
    if noted is not None:
        name = str(parsed_toml(f"name = {noted[2]}")["name"])
        if record_file_name(name, f"record-{noted[1][:12]}.txt") == word and find(noted[1]) is not None:
            return {"record": noted[1], "file_name": name} if name else {"record": noted[1]}
    sha = find(word)
    if sha is None:
        raise Refused(
            "{parameter}: {record} is not stored here", parameter="motion.record", record=plain_line(word, 80),
            hint="upload the record first, then read this file",
        )  # fmt: skip
    return {"record": sha} if is_hash(word) else {"record": sha, "file_name": word}


def simulate_words(inputs: Mapping[str, Any], record: str | None = None) -> str | None:
    """Return the command with the same result, quoted for a shell; None if an input file is necessary.

    >>> block = {"units": "m", "width": 0.5, "height": 2.0}
    >>> simulate_words({"body": block, "motion": {"pulse": "sine:amplitude=3,period=0.8"}})
    'rocking simulate --width 0.5 --height 2.0 --units m --motion sine:amplitude=3,period=0.8 --restitution calibrated'
    """
    body, start, restitution = _body(inputs["body"]), _start(inputs, record), _restitution(inputs)
    if body is None or start is None or restitution is None:
        return None
    if "--units" in start:  # one option contains the units of body and record
        position = start.index("--units")
        body[-1] += f",{start[position + 1]}"
        start = start[:position] + start[position + 2 :]
    settings = dict(inputs.get("settings") or {})
    if settings.get("engine") == "auto":
        del settings["engine"]
    if not settings.get("linear"):
        settings.pop("linear", None)
    options = [*body, *start, *restitution, *_sets("settings", settings)]
    return " ".join(["rocking simulate", *map(quote, options)])


def _body(body: Mapping[str, Any]) -> list[str] | None:
    table = body.get("block", body)
    if "width" not in table or "feet" in table:
        return None
    sizes = {name: table[name] for name in BLOCK_KEYS if table.get(name) is not None}
    if "centre" in sizes:
        sizes["centre"] = ",".join(f"{value!r}" for value in sizes["centre"])
    return [*_options(sizes), "--units", str(body["units"])]


def _start(inputs: Mapping[str, Any], record: str | None) -> list[str] | None:
    motion, response = inputs.get("motion"), inputs.get("response") or {}
    friction = _sets("response", {"assumed_friction": response.get("assumed_friction")})
    if motion is None:
        rotation = {"initial_rotation": response.get("initial_rotation")}
        return [*_options(rotation), *friction] if _options(rotation) else None
    scale = _options({"scale": motion.get("scale")})
    if motion.get("pulse") is not None:
        return ["--motion", str(motion["pulse"]), *scale, *friction]
    if record is None or motion.get("record") is None:
        return None
    component, vertical = motion.get("component"), motion.get("vertical")
    file = record if component is None else f"{record}#{component}"
    upright = [] if vertical is None else ["--motion", f"z={record}#{vertical}"]
    units = _options({"units": motion.get("units")})
    rare = _sets("motion", {name: motion.get(name) for name in ("format", "time_step")})
    return ["--motion", f"x={file}" if upright else file, *upright, *units, *rare, *scale, *friction]


def _restitution(inputs: Mapping[str, Any]) -> list[str] | None:
    table = inputs.get("restitution") or {"model": DEFAULT_RESTITUTION}
    choices = [table.get("model"), *(table.get("models") or ()), table.get("value"), *(table.get("values") or ())]
    first = next((value for value in choices if value is not None), None)
    return None if first is None else ["--restitution", str(first)]


def _sets(table: str, values: Mapping[str, Any]) -> list[str]:
    stated = {name: value for name, value in values.items() if value is not None}
    texts = {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in stated.items()}
    return [word for name, text in texts.items() for word in ("--set", f"{table}.{name}={text}")]


def _options(values: Mapping[str, Any]) -> list[str]:
    options: list[str] = []
    for name, value in values.items():
        if value is not None:
            option, text = f"--{name.replace('_', '-')}", repr(value) if isinstance(value, float) else str(value)
            # with "=", a value can begin with a dash
            options += [f"{option}={text}"] if text.startswith("-") else [option, text]
    return options
