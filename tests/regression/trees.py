"""Whatever the package answers, as a tree of numbers and words that can be kept and compared."""

import csv
import dataclasses
import enum
import json
import math
import re
import sqlite3
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import closing
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

# what differs from run to run, or with the version: times, dates, folders, hashes of folders, processes, memory
_PASSING = (
    (r"/[^\s'\"]*?/golden-[a-z0-9_]+", "FOLDER"),
    (r"\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2}(:\d{2}(\.\d+)?)?(Z|[+-]\d{2}:?\d{2})?", "DATE"),
    (r"\d{4}-\d{2}-\d{2}", "DATE"),
    (r"\b[\d.,]+ (ms|s|min|h|seconds?|minutes?|hours?)\b(?=( of| left|,| with| on|\.|$| at))", "TIME"),
    (r"\b\d[\d,.]* histories a second", "PACE"),
    (r"\(\d+ bytes", "(BYTES"),
    (r"\bprocess \d+", "PROCESS"),
    (r"^[0-9a-f]{32}$", "CHECK"),
    (r"\b[0-9a-f]{64}\b", "HASH"),
    (r"(?<=fast \()(avx512|avx2|plain)|(?<=order [68], )(avx512|avx2|plain)|^(avx512|avx2|plain)$", "KERNELS"),
)
_NUMBER = re.compile(r"[-+]?\d+\.\d+(?:e[-+]?\d+)?")
_SMALL = 1e-3  # what is smaller is compared as if it were this: sums that leave nothing but rounding
_HASHES = ("sha256", "histories_key")
_KEYS = {
    "id", "created", "date", "seconds", "worker_seconds", "begun", "ended", "elapsed", "written", "made", "machine",
    "processor", "python", "events",
}  # fmt: skip


def tree(value: Any) -> Any:  # noqa: PLR0911 - one a kind
    """Turn an answer into dicts, lists, arrays, numbers and words."""
    if isinstance(value, str):
        return _of_text(value)
    if value is None or isinstance(value, (bool, int, float, np.ndarray)):
        return value
    if isinstance(value, np.generic):
        return tree(value.item())
    if isinstance(value, enum.Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, (xr.Dataset, xr.DataArray)):
        return _of_dataset(value if isinstance(value, xr.Dataset) else value.to_dataset(name="value"))
    if isinstance(value, Mapping):
        return {str(key): tree(one) for key, one in value.items() if not _passing(str(key))}
    if isinstance(value, (list, tuple, set, frozenset)):
        return [tree(one) for one in (sorted(value, key=str) if isinstance(value, (set, frozenset)) else value)]
    if isinstance(value, BaseException):
        return {"raised": type(value).__name__, "message": masked(str(value))}
    if dataclasses.is_dataclass(value):
        return {field.name: tree(getattr(value, field.name)) for field in dataclasses.fields(value)}
    return masked(str(value))


def _of_text(text: str) -> Any:
    """Return a text without what differs from run to run; what is JSON as a tree."""
    try:
        return tree(json.loads(text)) if text.startswith("{") else masked(text)
    except json.JSONDecodeError:
        return masked(text)


def _passing(key: str) -> bool:
    """Return whether the values of a key differ between runs or processors: times, hashes, counts of work."""
    return key in _KEYS or (key.startswith("work_") and key != "work_of_ground") or key.endswith(_HASHES)


def _of_dataset(data: xr.Dataset) -> dict[str, Any]:
    return {
        "attrs": tree(dict(data.attrs)),
        **{
            str(name): {"dims": list(map(str, one.dims)), "values": _plain(one.values), "attrs": tree(dict(one.attrs))}
            for name, one in data.variables.items()
            if not _passing(str(name))
        },
    }


def _plain(values: np.ndarray) -> Any:
    if values.dtype.kind in "OUS":
        return [tree(one) for one in values.ravel().tolist()]
    return values.astype("int64") if values.dtype.kind in "mM" else values


def masked(text: str) -> str:
    """Return a text without what differs from run to run."""
    for pattern, word in _PASSING:
        text = re.sub(pattern, word, text)
    return text


def of_files(folder: Path) -> dict[str, Any]:
    """Return all files that stand in a folder, as trees."""
    return {
        str(path.relative_to(folder)): of_file(path.name, path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def of_file(name: str, content: bytes) -> Any:  # noqa: PLR0911 - one a format
    """Return what a file holds; of pictures, films and PDF only that they are there."""
    kind = name.rpartition(".")[2].lower()
    if kind in {"png", "gif", "mp4", "pdf", "svg"}:
        return {"file": kind, "begins": content[:4].hex()}
    if kind == "nc":
        with xr.open_dataset(BytesIO(content), engine="h5netcdf", decode_times=False) as data:
            return _of_dataset(data.load())
    if kind == "mat":
        from scipy.io import loadmat

        return tree({k: v for k, v in loadmat(BytesIO(content), simplify_cells=True).items() if k[0] != "_"})
    if kind == "xlsx":
        from openpyxl import load_workbook

        book = load_workbook(BytesIO(content), read_only=True)
        return {sheet.title: [tree(list(row)) for row in sheet.iter_rows(values_only=True)] for sheet in book}
    if kind == "parquet":
        from pyarrow import parquet

        table = parquet.read_table(BytesIO(content))
        words = {k.decode(): tree(v.decode()) for k, v in (table.schema.metadata or {}).items()}
        return {"metadata": words, "columns": {name: tree(table[name].to_numpy()) for name in table.column_names}}
    if kind == "zip":
        with zipfile.ZipFile(BytesIO(content)) as packed:
            return {each: of_file(each, packed.read(each)) for each in sorted(packed.namelist())}
    if kind == "sqlite":
        return _of_ledger(content)
    if kind == "bin" or b"\0" in content[:4096]:
        return {"bytes": content.hex() if len(content) < 1 << 16 else np.frombuffer(content, np.uint8)}
    text = content.decode("utf-8", "replace")
    if kind == "json":
        return tree(json.loads(text))
    if kind == "csv":
        return [[tree(cell) for cell in row] for row in csv.reader(text.splitlines())]
    return [masked(line) for line in text.splitlines()]


def _of_ledger(content: bytes) -> Any:
    """Return the rows of a ledger without times."""
    with closing(sqlite3.connect(":memory:")) as base:
        base.deserialize(content[:18] + b"\1\1" + content[20:])  # a ledger in WAL mode does not open in memory
        names = [name for (name,) in base.execute("select name from sqlite_master where type = 'table' order by name")]
        rows = {name: base.execute(f"select * from {name}").fetchall() for name in names}
    return {name: [[tree(cell) for cell in row if not isinstance(cell, float)] for row in rows[name]] for name in names}


def leaves(value: Any, where: str = "") -> Iterator[tuple[str, Any]]:
    """Every leaf of a tree, with its place."""
    if isinstance(value, dict):
        for key, one in value.items():
            yield from leaves(one, f"{where}/{key}")
    elif isinstance(value, list):
        for place, one in enumerate(value):
            yield from leaves(one, f"{where}/{place}")
    else:
        yield where, value


def same(one: Any, other: Any, tolerance: float = 0.0) -> bool:  # noqa: PLR0911
    """Whether two leaves agree: numbers to a relative tolerance, words and whole numbers exactly."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        one, other = np.asarray(one), np.asarray(other)
        if one.shape != other.shape or one.dtype.kind != other.dtype.kind:
            return False
        if one.dtype.kind == "O":
            return all(same(each, beside, tolerance) for each, beside in zip(one.flat, other.flat, strict=True))
        if one.dtype.kind not in "fc" or tolerance == 0.0:
            return bool(np.array_equal(one, other, equal_nan=one.dtype.kind in "fc"))
        size = float(np.abs(one[np.isfinite(one)]).max(initial=0.0))
        return bool(np.allclose(one, other, rtol=tolerance, atol=tolerance * size, equal_nan=True))
    if isinstance(one, float) and isinstance(other, float):
        if math.isnan(one) or math.isnan(other):
            return math.isnan(one) and math.isnan(other)
        return one == other or abs(one - other) <= tolerance * max(abs(one), abs(other), _SMALL)
    if isinstance(one, str) and isinstance(other, str) and tolerance > 0.0:
        texts, numbers = zip(*((_NUMBER.split(text), _NUMBER.findall(text)) for text in (one, other)), strict=True)
        return texts[0] == texts[1] and all(
            a == b or same(float(a), float(b), tolerance) for a, b in zip(*numbers, strict=True)
        )
    return type(one) is type(other) and bool(one == other)


def by_heading(value: Any) -> Any:
    """Return a tree whose tables are columns by heading: their order may change."""
    if isinstance(value, dict):
        return {key: by_heading(one) for key, one in value.items()}
    if not isinstance(value, list):
        return value
    head = value[0] if value and isinstance(value[0], list) else []
    named = len(head) > 1 and all(isinstance(cell, str) and cell for cell in head) and len(set(head)) == len(head)
    if named and all(isinstance(row, list) and len(row) == len(head) for row in value):
        return dict(zip(head, map(list, zip(*value[1:], strict=True)), strict=False))
    return [by_heading(one) for one in value]


def differences(kept: Any, now: Any, tolerance: float = 0.0) -> list[str]:
    """Say every place where two trees differ."""
    before, after = dict(leaves(by_heading(kept))), dict(leaves(by_heading(now)))
    said = [f"gone: {where} (was {_short(before[where])})" for where in before if where not in after]
    said += [f"new: {where} = {_short(after[where])}" for where in after if where not in before]
    return said + [
        f"changed: {where}: {_short(before[where])} -> {_short(after[where])}"
        for where in before
        if where in after and not same(before[where], after[where], tolerance)
    ]


def _short(value: Any) -> str:
    text = repr(value).replace("\n", " ")
    return text if len(text) < 120 else text[:117] + "..."


def thinned(value: Any, most: int = 12) -> Any:
    """Return a tree for JSON, long arrays by some of their values, long lists by some of their entries."""
    if isinstance(value, dict):
        return {key: thinned(one, most) for key, one in value.items()}
    if isinstance(value, list):
        kept = value if len(value) <= 4 * most else [value[k] for k in _some(len(value), most)]
        return [thinned(one, most) for one in kept]
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "V":
            return {name: thinned(value[name], most) for name in value.dtype.names or ()}
        flat = value.ravel()
        some = flat.tolist() if flat.size <= most else flat[_some(flat.size, most)].tolist()
        return {"shape": list(value.shape), "values": some}
    return value


def _some(size: int, most: int) -> list[int]:
    return sorted({int(k) for k in np.linspace(0, size - 1, most)})
