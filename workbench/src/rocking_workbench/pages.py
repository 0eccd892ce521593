"""Files of the pages in memory; their addresses contain a fingerprint, so that browsers keep them."""

import json
import mimetypes
import re
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response

STATIC = Path(__file__).parent / "static"
KEPT = "private, max-age=31536000, immutable"
"""Cache-Control of a file whose address changes with its content."""
PAGES = {
    "/": "index.html",
    "/index.html": "index.html",
    "/api-docs": "api-docs.html",
    "/api-docs.html": "api-docs.html",
}
"""Address -> page."""
_IMPORTS = re.compile(r'(?<=<script type="importmap">).*?(?=</script>)', re.DOTALL)
_LINKED = re.compile(r'(<(?:link|script)\b[^>]*?\b(?:href|src)=")/')

for _kind, _suffix in (
    ("text/javascript", ".js"),
    ("text/javascript", ".mjs"),
    ("text/css", ".css"),
    ("image/svg+xml", ".svg"),
):
    mimetypes.add_type(_kind, _suffix)  # replaces text/plain of some systems, which browsers reject


@dataclass(frozen=True)
class PageFiles:
    """Files of a folder by their path in it, and the fingerprint of all of them."""

    contents: dict[str, bytes]  # path with slashes -> content
    fingerprint: str  # first 16 hexadecimal digits of the hash of all paths and contents

    @classmethod
    def read(cls, folder: Path) -> "PageFiles":
        """Return all files of a folder."""
        paths = sorted(path for path in folder.rglob("*") if path.is_file())
        contents = {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}
        digest = sha256()
        for name, content in contents.items():
            digest.update(f"{name} {len(content)} ".encode() + content)
        return cls(contents, digest.hexdigest()[:16])

    def page(self, name: str) -> str:
        """Return a page whose links, scripts and imports have addresses with the fingerprint."""
        text = _LINKED.sub(rf"\1/{self.fingerprint}/", self.contents[name].decode())
        return _IMPORTS.sub(lambda match: self._imports(match[0]), text)

    def _imports(self, text: str) -> str:
        scripts = (name for name in self.contents if "/" in name and name.endswith((".js", ".mjs")))
        folders = sorted({f"/{name.partition('/')[0]}/" for name in scripts})
        paths: dict[str, str] = json.loads(text)["imports"] | {folder: folder for folder in folders}
        return json.dumps({"imports": {name: f"/{self.fingerprint}{path}" for name, path in paths.items()}})

    async def respond(self, request: Request) -> Response:
        """Return the file of an address with the fingerprint."""
        name = request.path_params["name"]
        if name not in self.contents:
            raise HTTPException(404)
        kind = mimetypes.guess_type(name)[0] or "text/plain"
        return Response(self.contents[name], media_type=kind, headers={"Cache-Control": KEPT})


FILES = PageFiles.read(STATIC)
INLINE = sorted({script for name in PAGES.values() for script in _IMPORTS.findall(FILES.page(name))})
"""Inline scripts of all pages: the import maps."""


async def page_answer(request: Request) -> Response:
    """Return a page."""
    return HTMLResponse(FILES.page(PAGES[request.url.path]))
