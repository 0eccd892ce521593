"""Tables of the reference that come from the package: keys of files, record formats, and the names of results."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


def table(heading: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table in Markdown."""
    heading = list(heading)
    lines = [heading, ["---"] * len(heading), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


class RecordFormats(SphinxDirective):
    """The record formats, one section each."""

    def run(self) -> list[nodes.Node]:
        """Return a table of all formats, and one paragraph of notes per format."""
        from rocking.motions.formats import formats

        every = formats()
        rows = [
            (
                f"`{name}`",
                record_format.title,
                ", ".join(f"`{suffix}`" for suffix in record_format.suffixes),
                "yes" if record_format.states_unit else "no: `units=`",
                "yes" if record_format.states_time_step else "no: `time_step=`",
            )
            for name, record_format in every.items()
        ]
        notes = [f"`{name}`\n: {record_format.notes}\n" for name, record_format in every.items() if record_format.notes]
        heading = ("name", "source", "extensions", "unit in the file", "time step in the file")
        text = "\n".join([table(heading, rows), "", "**Notes**", "", *notes])
        return self.parse_text_to_nodes(text)


class Quantities(SphinxDirective):
    """The names of results in JSON, tables and files."""

    def run(self) -> list[nodes.Node]:
        """Return a table of names, units and meanings."""
        from rocking.quantities import QUANTITIES

        rows = (
            (f"`{name}`", "-" if entry.unit == "1" else entry.unit, _meaning(entry))
            for name, entry in sorted(QUANTITIES.items())
        )
        return self.parse_text_to_nodes(table(("name", "unit", "meaning"), rows))


def _meaning(entry: object) -> str:
    meaning, codes = entry.meaning, entry.codes  # type: ignore[attr-defined]
    shown = f"{meaning} ({', '.join(f'{key} {word}' for key, word in codes.items())})" if codes else meaning
    return shown.replace("*", "\\*").replace("_", "\\_").replace("<", "&lt;")


class TestedBodies(SphinxDirective):
    """The kept scores of predictions of shaking-table tests: `scores`, `any-azimuth` or `reliability`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return a table of the scores of all forecasts, or of the observed fractions."""
        from rocking.decision.prediction.model_error import kept

        tests = {"any-azimuth": kept()["any_azimuth"]}.get(self.arguments[0], kept())
        return self.parse_text_to_nodes((_reliability if self.arguments[0] == "reliability" else _scores)(tests))


def _scores(tests: dict[str, Any]) -> str:
    heading = (
        "forecast",
        "Brier score",
        "balanced accuracy at 0.5",
        "Spiegelhalter's statistic",
        "better than logistic",
    )
    rows = (
        (name, _interval(item["brier"]), _interval(item["balanced_accuracy"]), f"{item['calibration']:.1f}",
         _interval(item["better_than_logistic"]))
        for name, item in tests["scores"].items()
    )  # fmt: skip
    return table(heading, rows)


def _reliability(tests: dict[str, Any]) -> str:
    rows = (
        (f"{row['low']:.1f} to {row['high']:.1f}", str(row["count"]), f"{row['observed']:.2f}",
         f"{row['observed_low']:.2f} to {row['observed_high']:.2f}")
        for row in tests["reliability"]
    )  # fmt: skip
    return table(("predicted probability", "tests", "overturned", "95 % interval"), rows)


def _interval(score: dict[str, float]) -> str:
    return f"{score['value']:.3f} ({score['low']:.3f} to {score['high']:.3f})"


def write(folder: Path) -> None:
    """Write the pages of the keys of input files and body files."""
    from rocking.spec.reference import reference
    from rocking.spec.schema import renamed_keys

    folder.mkdir(exist_ok=True)
    pages = reference()
    renamed = table(("old key", "key"), ((f"`{old}`", f"`{new}`") for old, new in renamed_keys()))
    pages["input_files"] += f"\n## Renamed keys\n\nFiles of older schemas are read with their old keys.\n\n{renamed}\n"
    for name, text in pages.items():
        path = folder / f"{name}.md"
        if not path.exists() or path.read_text("utf-8") != text:  # an unchanged page is not built again
            path.write_text(text, "utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directives."""
    app.connect("builder-inited", lambda started: write(Path(started.srcdir) / "keys"))
    app.add_directive("record-formats", RecordFormats)
    app.add_directive("quantities", Quantities)
    app.add_directive("tested-bodies", TestedBodies)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
