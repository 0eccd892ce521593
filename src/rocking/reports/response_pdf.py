"""The report of a response as a PDF, set by Typst."""

import json
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking.errors import MissingExtraError, how_to_install
from rocking.reports.response_blocks import Pages


def response_pdf(pages: Pages, pictures: Mapping[str, bytes]) -> bytes:
    """Return the report as PDF.

    Returns the file; the same for the same content.
    """
    try:
        import typst
    except ImportError as error:
        raise MissingExtraError(how_to_install("the PDF report", "typst", error)) from error
    with TemporaryDirectory(prefix="rocking-report-") as made:
        folder = Path(made)
        for stem, data in pictures.items():
            (folder / f"{stem}.svg").write_bytes(data)
        source = folder / "response.typ"
        source.write_bytes(files("rocking.reports").joinpath("response.typ").read_bytes())
        content = {"document": json.dumps(pages.plain())}
        # its words in any script come from the fonts of the system; those of the pictures are always there
        pdf = typst.compile(str(source), root=made, sys_inputs=content, font_paths=_fonts())
        assert isinstance(pdf, bytes)
        return pdf


def _fonts() -> list[str]:
    from matplotlib import get_data_path

    return [str(Path(get_data_path()) / "fonts" / "ttf")]
