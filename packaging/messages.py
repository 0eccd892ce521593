"""Compile the catalogues of messages, src/rocking/language/*.po, into what is read at run time (`make messages`)."""

import io
from datetime import UTC, datetime
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

FOLDER = Path(__file__).parents[1] / "src/rocking/language"
TEMPLATE = FOLDER / "messages.pot"
DATE = datetime(2000, 1, 1, tzinfo=UTC)  # of every compiled catalogue: files change with their messages alone
HEADER = 'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=UTF-8\\n"\n'


def catalogues() -> dict[str, Catalog]:
    """Return the catalogues by the codes of their languages."""
    return {path.stem: read(path, path.stem) for path in sorted(FOLDER.glob("*.po"))}


def read(path: Path, code: str | None = None) -> Catalog:
    """Return a catalogue, or the template."""
    with path.open("rb") as file:
        return read_po(file, locale=code)


def write(path: Path, catalogue: Catalog) -> None:
    """Write a catalogue, or the template, sorted by its messages."""
    for message in catalogue:
        message.flags -= {"python-format"}  # "95 % interval" is none
    text = io.BytesIO()
    write_po(text, catalogue, width=0, sort_output=True, omit_header=True, include_lineno=False)
    plurals = f'"Plural-Forms: {catalogue.plural_forms}\\n"\n' if catalogue.locale else ""
    path.write_text(f"{HEADER}{plurals}\n{text.getvalue().decode()}", "utf-8")


def compiled(catalogue: Catalog) -> bytes:
    """Return a catalogue as the standard library reads it."""
    catalogue.creation_date = catalogue.revision_date = DATE
    file = io.BytesIO()
    write_mo(file, catalogue)
    return file.getvalue()


if __name__ == "__main__":
    for code, catalogue in catalogues().items():
        (FOLDER / f"{code}.mo").write_bytes(compiled(catalogue))
