"""Option `--output FILE`: the extension selects the kind of file. `--output NAME=FILE` states the kind."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking.cli.spelling import UsageError
from rocking.errors import MissingExtraError

PICTURES = (".png", ".svg", ".pdf")


@dataclass(frozen=True)
class Export:
    """A kind of output file of a result."""

    endings: tuple[str, ...]
    write: Callable[[Any, Path], Any]  # function of the answer and the path
    needs: str = ""  # name of a required module


@dataclass(frozen=True)
class Exports:
    """Requested output files by kind of file."""

    kinds: dict[str, Export]
    files: tuple[tuple[str, Path], ...]

    @classmethod
    def of(cls, texts: Sequence[str] | None, kinds: dict[str, Export]) -> "Exports":
        """Return the files of `--output`; refuse files that could not be written, before the computation."""
        files = tuple(_file(text, kinds) for text in texts or ())
        paths = [path for _, path in files]
        if duplicate := next((path for path in paths if paths.count(path) > 1), None):
            raise UsageError("{parameter} {file} is given twice", parameter="--output", file=duplicate)
        for name, path in files:
            if not path.parent.is_dir():
                raise UsageError(
                    "cannot write {file!r}: folder {folder!r} does not exist", folder=str(path.parent), file=path.name
                )
            if kinds[name].needs:
                from rocking.errors import extra

                extra(kinds[name].needs, path.name)
        return cls(kinds, files)

    @property
    def names(self) -> set[str]:
        """The requested kinds of files."""
        return {name for name, _ in self.files}

    def spare(self, *sources: str | Path) -> None:
        """Refuse to overwrite an input file; `sources` are files as typed, such as x=FILE#COMPONENT."""
        names = [name for word in map(str, sources) for name in (word, word.partition("=")[2])]
        read = {Path(source).resolve() for name in names for source in (name, name.rpartition("#")[0]) if source}
        if overwritten := next((path for _, path in self.files if path.resolve() in read), None):
            raise UsageError(
                "{parameter} {file} would overwrite an input file", parameter="--output", file=overwritten,
                hint="use another name",
            )  # fmt: skip

    def write(self, answer: Any) -> list[Path]:
        """Write all files; return their paths."""
        for name, path in self.files:
            try:
                self.kinds[name].write(answer, path)
            except MissingExtraError:
                raise
            except ImportError as error:  # some libraries detect a missing module only during writing
                raise MissingExtraError("cannot write {path}: {reason}", path=path, reason=str(error)) from error
        return [path for _, path in self.files]


def _file(text: str, kinds: dict[str, Export]) -> tuple[str, Path]:
    name, equals, file = text.partition("=")
    if equals and name in kinds:
        path = Path(file)
        if path.suffix.lower() not in kinds[name].endings:
            raise UsageError(
                "{content} must be {endings}, got {file!r:.60}", content=name, endings=_or(kinds[name].endings),
                file=path.name,
            )  # fmt: skip
        return name, path
    path = Path(text)
    kind_name = next((kind for kind, export in kinds.items() if path.suffix.lower() in export.endings), None)
    if kind_name is None:
        raise UsageError(
            "{parameter} {file!r:.60}: unknown extension. Allowed files: {contents}", parameter="--output",
            file=path.name, contents=_possible(kinds),
        )  # fmt: skip
    return kind_name, path


def _possible(kinds: dict[str, Export]) -> str:
    extensions: set[str] = set()
    parts = []
    for name, export in kinds.items():
        prefix = f"{name}=FILE with " if extensions & set(export.endings) else ""
        parts.append(f"{name} ({prefix}{_or(export.endings)})")
        extensions |= set(export.endings)
    return ", ".join(parts)


def described(kinds: dict[str, Export]) -> str:
    """Return the kinds of files, for the help of `--output`."""
    endings = dict.fromkeys(ending for export in kinds.values() for ending in export.endings)
    extensions: set[str] = set()
    named = []
    for name, export in kinds.items():
        named += [f"{name}=FILE"] if extensions & set(export.endings) else []
        extensions |= set(export.endings)
    also = f"; or {', '.join(named)}" if named else ""
    return f"File: {', '.join(endings)}{also}; repeatable."


def _or(endings: Sequence[str]) -> str:
    return endings[0] if len(endings) == 1 else f"{', '.join(endings[:-1])} or {endings[-1]}"


def draw(answer: Any, path: Path) -> None:
    """Write the picture of an answer."""
    from rocking.plots import write

    write(answer.draw(), path)


def _report(answer: Any, path: Path) -> None:
    from rocking.reports import report

    report(answer.result, path, name=getattr(answer, "name", ""), **getattr(answer, "signed", {}))


DRAWN = Export(PICTURES, draw, "matplotlib")
# files of results with a report and exported tables (`rocking.exported`)
REPORTED = {
    "picture": Export((".png", ".svg"), draw, "matplotlib"),
    "report": Export((".pdf", ".html"), _report, "matplotlib"),
}
CSV = Export((".csv",), lambda answer, path: answer.result.to_csv(path))
NETCDF = Export((".nc",), lambda answer, path: answer.result.to_netcdf(path), "h5netcdf")


def _write_dataset(answer: Any, path: Path) -> None:
    from rocking.tables import save

    save(answer.dataset, path)


# files of results that are a dataset
DATASET = {
    "picture": DRAWN,
    "csv": Export((".csv",), _write_dataset),
    "netcdf": Export((".nc",), _write_dataset),
    "excel": Export((".xlsx",), _write_dataset, "openpyxl"),
    "mat": Export((".mat",), _write_dataset),
}


def write_records(path: Path, records: list[dict[str, Any]]) -> None:
    """Write records with equal keys as CSV."""
    from rocking.quantities import quantity
    from rocking.tables import Column, Table, text_array, to_csv

    units = {name: entry.unit if (entry := quantity(name)) else "" for name in records[0]}
    columns = {name: Column(text_array([row[name] for row in records]), unit) for name, unit in units.items()}
    to_csv(Table("coefficient", columns), path)
