"""Check the types of the page's scripts (`make types`) by one pinned release of TypeScript; nothing is compiled."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PROJECT = ROOT / "workbench"
COMPILER = ROOT / "build/typescript/package/lib/tsc.js"
ANSWERS = ROOT / "build/types/answers.d.ts"
LOCK = ROOT / "requirements/typescript.lock"
WAITING = PROJECT / "types/waiting.txt"
PLAIN = {"string": "string", "number": "number", "integer": "number", "boolean": "boolean", "null": "null"}


def fetch() -> str:
    """Put the pinned compiler into build, unless it is there; return what did not come. Another hash ends all."""
    words = LOCK.read_text("utf-8")
    release, digest = re.findall(r"(\S+) \\\s+--hash=sha512:([0-9a-f]{128})", words)[0]
    folder = COMPILER.parents[2]
    if COMPILER.is_file() and (folder / "lock").is_file() and (folder / "lock").read_text("utf-8") == words:
        return ""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if subprocess.run(
        ["npm", "pack", "--silent", "--fetch-retries=1", "--fetch-timeout=20000", release],
        cwd=folder,
        check=False,
        capture_output=True,
    ).returncode:
        return release
    (archive,) = folder.glob("*.tgz")
    hash_of_file = hashlib.sha512(archive.read_bytes()).hexdigest()
    if hash_of_file != digest:
        sys.exit(f"{release} has the hash {hash_of_file}, {LOCK.name} says {digest}")
    with tarfile.open(archive) as held:
        held.extractall(folder, filter="data")
    (folder / "lock").write_text(words, "utf-8")
    return ""


def declarations(schema: dict[str, Any]) -> Iterator[str]:
    """Yield in TypeScript what the server declares: tables of questions and answers, and the answer of every call."""
    yield "declare namespace Server {"
    for name, table in schema["components"]["schemas"].items():
        yield f"type {name} = {kind(table)};"
    calls = {
        (method.upper(), re.sub(r"{\w+}", "${string}", path.removeprefix("/api/"))): told["application/json"]["schema"]
        for path, item in schema["paths"].items()
        for method, operation in item.items()
        for status, answer in operation["responses"].items()
        if status.startswith("2") and (told := answer.get("content", {})).get("application/json", {}).get("schema")
    }
    # An address with places also fits what lies below it: the longer ones are asked for first.
    ordered = sorted(calls, key=lambda call: (-call[1].count("/"), call[1].count("$"), call))
    yield "type Answer<Method extends string, Path extends string> = string extends Path ? any"
    yield from (f": `${{Method}} ${{Path}}` extends `{way} {path}` ? {kind(calls[way, path])}" for way, path in ordered)
    yield ": unknown;\n}"


def kind(shape: dict[str, Any]) -> str:
    """Return a type for a shape of the schema."""
    if "$ref" in shape:
        return str(shape["$ref"].rpartition("/")[2])
    if choices := shape.get("anyOf") or shape.get("oneOf"):
        return " | ".join(kind(each) for each in choices)
    if values := shape.get("enum") or [shape[key] for key in ("const",) if key in shape]:
        return " | ".join(json.dumps(each) for each in values)
    if shape.get("type") == "array":
        return list_of(shape)
    if shape.get("type") == "object":
        return table_of(shape)
    return PLAIN.get(shape.get("type", ""), "any")


def list_of(shape: dict[str, Any]) -> str:
    """Return the type of a list, which may have so many places and no more."""
    least, most = shape.get("minItems"), shape.get("maxItems")
    each = shape.get("prefixItems") or [shape.get("items", {})] * (most if least == most and most else 0)
    return f"[{', '.join(map(kind, each))}]" if each else f"({kind(shape.get('items', {}))})[]"


def table_of(shape: dict[str, Any]) -> str:
    """Return the type of a table: its keys, or any keys with such values."""
    needed = shape.get("required", [])
    keys = [
        f"{json.dumps(key)}{'' if key in needed else '?'}: {kind(each)}"
        for key, each in shape.get("properties", {}).items()
    ]
    rest = shape.get("additionalProperties")
    if isinstance(rest, dict):
        keys.append(f"[key: string]: {kind(rest)}")
    return f"{{ {'; '.join(keys)} }}" if keys else "{ [key: string]: any }"


def declare(target: Path = ANSWERS) -> None:
    """Write down what the server declares now."""
    from rocking_workbench.application import create_app
    from rocking_workbench.settings import ServerSettings

    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("\n".join(declarations(create_app(ServerSettings()).openapi())) + "\n", "utf-8")


def faults(project: Path) -> list[str]:
    """Return what the compiler finds in a project, a line each."""
    run = subprocess.run(
        ["node", str(COMPILER), "--pretty", "false", "-p", str(project)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    lines = run.stdout.splitlines()
    errors = [line for line in lines if re.match(r"\S+\(\d+,\d+\): error TS", line)]
    if run.returncode and not errors:
        sys.exit(run.stdout + run.stderr)
    return errors


def absent() -> str:
    """Return what is missing on this machine; nothing where the check can run."""
    return " and ".join(name for name in ("node", "npm") if shutil.which(name) is None)


def main() -> int:
    """Check, or say why not, which is a failure where machines look on."""
    if missing := absent() or fetch():
        watched = os.environ.get("CI", "") not in {"", "0", "false"}
        word = "FAILED" if watched else "SKIPPED"
        print(f"{word}: the types of the page's scripts are NOT checked: there is no {missing} here.")
        return int(watched)
    declare()
    waiting = [line for line in WAITING.read_text("utf-8").split("\n") if line and not line.startswith("#")]
    errors = faults(PROJECT)
    told = [line for line in errors if not any(f"static/{each}" in line for each in waiting)]
    print(
        *told,
        f"{len(told)} faults in the types of the page's scripts; not asked yet: {', '.join(waiting) or 'none'}",
        sep="\n",
    )
    return min(1, len(told))


if __name__ == "__main__":
    sys.exit(main())
