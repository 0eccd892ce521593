"""The project's page on the package index, made from the README when a distribution is built.

The one setting, `repository` in pyproject.toml, is the address of the published sources and empty until there is one.
With it, pictures and links are absolute and `[project.urls]` is there; without it the page has no picture and no link
that leads nowhere.
"""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

_FENCED = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)  # code: nothing in it is a link
_PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
_LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\(([^)\s]+)\)")
_TAG = re.compile(r"<img\b[^>]*>|</?(?:picture|source|video)\b[^>]*>", re.IGNORECASE)
_TAGGED = re.compile(r'\b(src|srcset|href)="([^"]+)"')
_ABSOLUTE = re.compile(r"[a-z]+:|//", re.IGNORECASE)


def dynamic_metadata(settings: Mapping[str, Any], project: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields `readme` and `urls` of the project for the build."""
    repository = str(settings["repository"]).rstrip("/")
    text = index_page(Path("README.md").read_text("utf-8"), repository, f"v{project['version']}")
    return {"readme": {"content-type": "text/markdown", "text": text}, "urls": urls(repository)}


def urls(repository: str) -> dict[str, str]:
    """Return the addresses of the project, none where nothing is published.

    >>> urls("")
    {}
    >>> urls("https://forge.example/rocking")["Issues"]
    'https://forge.example/rocking/issues'
    """
    if not repository:
        return {}
    return {
        "Source": repository,
        "Issues": f"{repository}/issues",
        "Changelog": f"{repository}/blob/main/CHANGELOG.md",
    }


def index_page(readme: str, repository: str, tag: str) -> str:
    """Return the README with pictures and links that hold on another site.

    >>> index_page("![a block](docs/block.png) and [how](docs/how.md)", "", "v1")
    ' and how'
    >>> index_page("![a block](docs/block.png)", "https://forge.example/rocking", "v1")
    '![a block](https://forge.example/rocking/raw/v1/docs/block.png)'
    """
    rewritten = _without_addresses if not repository else _with_addresses(repository, tag)
    sections = _FENCED.split(readme)
    return "".join(section if section.startswith("```") else rewritten(section) for section in sections)


def _without_addresses(text: str) -> str:
    def kept(match: re.Match[str], otherwise: str) -> str:
        return match[0] if _ABSOLUTE.match(match[2]) else otherwise

    text = _TAG.sub("", _PICTURE.sub(lambda match: kept(match, ""), text))
    text = _LINK.sub(lambda match: kept(match, match[1]), text)
    text = re.sub(r'<a href="(?![a-z]+:)[^"]*">(.*?)</a>', r"\1", text, flags=re.DOTALL)
    return re.sub(r"\n{3,}", "\n\n", text)  # where a picture stood by itself


def _with_addresses(repository: str, tag: str) -> Callable[[str], str]:
    def at(kind: str, path: str) -> str:
        if _ABSOLUTE.match(path):
            return path
        return f"{repository}#{path[1:]}" if path.startswith("#") else f"{repository}/{kind}/{tag}/{path}"

    def tagged(match: re.Match[str]) -> str:
        return f'{match[1]}="{at("blob" if match[1] == "href" else "raw", match[2])}"'

    def rewritten(text: str) -> str:
        text = _PICTURE.sub(lambda match: f"![{match[1]}]({at('raw', match[2])})", text)
        text = _LINK.sub(lambda match: f"[{match[1]}]({at('blob', match[2])})", text)
        return _TAGGED.sub(tagged, text)

    return rewritten
