"""Move inline scripts of the theme into files, because the policy of the pages allows files only."""

import hashlib
import re
from pathlib import Path

from sphinx.application import Sphinx


def move(page: Path, static: Path, here: str) -> None:
    """Move the scripts of a page into files of the theme's folder."""

    def moved(script: re.Match[str]) -> str:
        name = f"inline-{hashlib.sha256(script[1].encode()).hexdigest()[:12]}.js"
        (static / name).write_text(script[1], "utf-8")
        return f'<script src="{here}_static/{name}"></script>'

    text = page.read_text("utf-8")
    page.write_text(re.sub(r"<script>(.*?)</script>", moved, text, flags=re.DOTALL), "utf-8")


def finished(app: Sphinx, error: Exception | None) -> None:
    """Treat every page."""
    if error is None and app.builder.format == "html":
        for page in Path(app.outdir).rglob("*.html"):
            depth = len(page.relative_to(app.outdir).parts) - 1
            move(page, Path(app.outdir) / "_static", "../" * depth)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("build-finished", finished)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
