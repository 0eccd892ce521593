"""Inputs as a file of the command line, and such a file as inputs."""

import hashlib
import json
import re
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError

from rocking.app.errors import Refused
from rocking.app.schemas.inputs import Inputs, parsed_toml
from rocking.app.takeaway.command_words import simulate_words
from rocking.app.takeaway.plain_text import plain_line, record_file_name
from rocking.app.takeaway.toml_words import toml_of, toml_value
from rocking.bodies.formats.words import sentence
from rocking.conventions import Assumed

FILE_NAME = "response.toml"
"""What such a file is called."""

_TABLES = ("response", "body", "motion", "restitution", "settings")
_SHAPES = {"block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points", "units"}
_HASH = re.compile(r"[0-9a-f]{64}")
_RECORD = re.compile(r"^# record: ([0-9a-f]{64}) (\".*\")$", re.MULTILINE)

FindRecord = Callable[[str], str | None]
"""Returns the hash of the stored record that a word means, which is a hash or the name of a file."""


def plain_inputs(inputs: Inputs) -> dict[str, Any]:
    """Return inputs as plain values.

    Returns what was not given is left out.
    """
    return inputs.model_dump(exclude_none=True, exclude_unset=True)


def fingerprint(inputs: Inputs) -> str:
    """Return the SHA-256 of inputs, the same however they were written."""
    words = json.dumps(inputs.model_dump(exclude_none=True), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(words.encode()).hexdigest()


def record_name(inputs: Inputs) -> str | None:
    """Return the name of the record file beside a file of inputs.

    Returns A name without folders; None if the motion is no record.
    """
    if inputs.motion is None or inputs.motion.record is None:
        return None
    return record_file_name(inputs.motion.file_name or "", f"record-{inputs.motion.record[:12]}.txt")


def commands(inputs: Inputs) -> list[str]:
    """Return what to type for the same result.

    Returns with the file of inputs, and in words where that is possible; none while nothing moves the body.
    """
    if inputs.motion is None and inputs.response.free is None:
        return []
    words = simulate_words(plain_inputs(inputs), record_name(inputs))
    return [f"rocking simulate {FILE_NAME}", *([] if words is None else [words])]


def inputs_as_toml(inputs: Inputs) -> str:
    """Return inputs as a file that `rocking simulate` takes."""
    told, friction = plain_inputs(inputs), inputs.response.assumed_friction
    tables: dict[str, Any] = {
        "response": {
            **({} if isinstance(friction, Assumed) else {"assumed_friction": friction}),
            **told.get("response", {}),
        },
        "body": told["body"],
        "motion": _motion_on_disk(told.get("motion"), record_name(inputs)),
        "restitution": told.get("restitution", {"model": "ked"}),
        "settings": told.get("settings"),
    }
    return "\n".join([*_head(inputs), "", toml_of(tables)])


def inputs_from_toml(text: str, find: FindRecord) -> Inputs:
    """Return what a file of inputs says."""
    document = parsed_toml(text)
    unknown = sorted(set(document) - set(_TABLES))
    if unknown and "campaign" in document:
        raise Refused("this is a job of many histories: set it up in the step Studies, or `rocking run` takes it")
    if unknown and "body" not in document and _SHAPES & set(document):
        raise Refused("this is a file of a body alone: drop it in the step Body")
    if unknown:
        raise Refused(f"[{plain_line(unknown[0], 60)}] is no table of inputs; there are {', '.join(_TABLES)}")
    motion = document.get("motion")
    if isinstance(motion, dict) and isinstance(motion.get("record"), str):
        document["motion"] = motion | _stored(motion["record"], text, find)
    try:
        return Inputs.model_validate(document)
    except ValidationError as error:
        raise Refused(plain_line(sentence(error, None), 500)) from error


def _head(inputs: Inputs) -> list[str]:
    from importlib.metadata import version

    name = plain_line(inputs.body.name or "", 100)
    lines = [f"# How {name or 'a body'} rocks. Written by rocking {version('rocking')}."]
    for word, command in zip(("the command line", "or in words"), commands(inputs), strict=False):
        lines.append(f"# {word + ':':<17} {plain_line(command, 4000)}")
    if not commands(inputs):
        lines.append("# Nothing moves the body yet: add a table [motion], or free = 0.5 under [response].")
    if inputs.motion is not None and inputs.motion.record is not None:
        lines.append(f"# record: {inputs.motion.record} {toml_value(inputs.motion.file_name or '')}")
    return lines


def _motion_on_disk(motion: Mapping[str, Any] | None, record: str | None) -> dict[str, Any] | None:
    if motion is None or record is None:
        return None if motion is None else dict(motion)
    return {"record": record, **{key: value for key, value in motion.items() if key not in {"record", "file_name"}}}


def _stored(word: str, text: str, find: FindRecord) -> dict[str, Any]:
    """Return hash and name of the record that a file of inputs means."""
    noted = _RECORD.search(text)
    if noted is not None:
        name = str(parsed_toml(f"name = {noted[2]}")["name"])
        if record_file_name(name, f"record-{noted[1][:12]}.txt") == word and find(noted[1]) is not None:
            return {"record": noted[1], "file_name": name} if name else {"record": noted[1]}
    found = find(word)
    if found is None:
        raise Refused(
            f"motion.record: {plain_line(word, 80)} was not uploaded here; drop the file first, then read this"
        )
    return {"record": found} if _HASH.fullmatch(word) else {"record": found, "file_name": word}
