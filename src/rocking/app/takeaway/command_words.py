"""Inputs as the words of a command line, where they can be said in words."""

from collections.abc import Mapping
from shlex import quote
from typing import Any

_OF_FILES = ("format", "units", "time_step", "component", "vertical")
_SAID = {"gravity", "linear", "engine"}


def simulate_words(inputs: Mapping[str, Any], record: str | None = None) -> str | None:
    """Return the command that gives the same result without a file of inputs.

    Returns the command, quoted for a shell; None where only a file of inputs can say it.

    >>> block = {"units": "cm", "width": 50.0, "height": 200.0}
    >>> simulate_words({"body": block, "motion": {"pulse": "sine:amplitude=3,period=0.8"}})
    'rocking simulate --width 50.0 --height 200.0 --units cm --motion sine:amplitude=3,period=0.8 --restitution ked'
    """
    parts = [_body(inputs["body"]), _start(inputs, record), _restitution(inputs), _how(inputs)]
    if any(part is None for part in parts):
        return None
    words = _one_of_units([word for part in parts if part is not None for word in part])
    return " ".join(["rocking simulate", *(quote(word) for word in words)])


def _one_of_units(words: list[str]) -> list[str]:
    """Return the words with the units of body and record in one option, as the command takes them."""
    places = [k for k, word in enumerate(words) if word == "--units"]
    if len(places) < 2:
        return words
    first, second = places
    joined = f"{words[first + 1]},{words[second + 1]}"
    return [*words[: first + 1], joined, *words[first + 2 : second], *words[second + 2 :]]


def _body(body: Mapping[str, Any]) -> list[str] | None:
    table = body.get("block", body)
    if "width" not in table or "feet" in table:
        return None
    sizes = {name: table[name] for name in ("width", "height", "depth", "density") if table.get(name) is not None}
    return [*_options(sizes), "--units", str(body["units"])]


def _start(inputs: Mapping[str, Any], record: str | None) -> list[str] | None:
    motion, response = inputs.get("motion"), inputs.get("response") or {}
    friction = _options({"friction": response.get("assumed_friction")})
    if motion is None:
        return None if response.get("free") is None else [*_options({"free": response["free"]}), *friction]
    scale = _options({"scale": motion.get("scale")})
    if motion.get("pulse") is not None:
        return ["--motion", str(motion["pulse"]), *scale, *friction]
    if record is None or motion.get("record") is None:
        return None
    return ["--motion", record, *_options({name: motion.get(name) for name in _OF_FILES}), *scale, *friction]


def _restitution(inputs: Mapping[str, Any]) -> list[str] | None:
    table = inputs.get("restitution") or {"model": "ked"}
    first = [table.get("model"), *(table.get("models") or ()), table.get("value"), *(table.get("values") or ())]
    said = [value for value in first if value is not None]
    return ["--restitution", str(said[0])] if said else None


def _how(inputs: Mapping[str, Any]) -> list[str] | None:
    settings = {name: value for name, value in (inputs.get("settings") or {}).items() if value is not None}
    if set(settings) - _SAID:
        return None
    linear = ["--linear"] if settings.pop("linear", False) else []
    if settings.get("engine") == "auto":
        del settings["engine"]
    return [*linear, *_options(settings)]


def _options(values: Mapping[str, Any]) -> list[str]:
    words: list[str] = []
    for name, value in values.items():
        if value is None:
            continue
        option, text = f"--{name.replace('_', '-')}", repr(value) if isinstance(value, float) else str(value)
        # with = between, a value may begin with a dash
        words += [f"{option}={text}"] if text.startswith("-") else [option, text]
    return words
