"""A body in a request: a body file as JSON, or the size of a block; it names no files."""

import sys
from typing import Any

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from rocking.app.schemas.caps import check_size
from rocking.bodies.formats.body_schema import BODIES, Document, Positive

_UPLOAD = "the application reads no file by its name: upload it to /api/body/file, which answers with its points"


class BodyInput(Document):
    """A unit of length, and one table that says what the body is, or width and height."""

    width: Positive | None = None
    height: Positive | None = None
    depth: Positive | None = None
    density: Positive | None = None

    @model_validator(mode="before")
    @classmethod
    def _names_no_file(cls, given: Any) -> Any:
        if isinstance(given, dict) and "file" in given:
            raise _refused(f"file: {_UPLOAD}")
        return given

    @model_validator(mode="after")
    def _one_body(self) -> "BodyInput":
        sized = self.width is not None or self.height is not None
        found = [key for key in BODIES if getattr(self, key) is not None] + ["width and height"] * sized
        if len(found) != 1:
            choice = ", ".join(("width and height", *BODIES))
            raise _refused(f"a body has exactly one of {choice}, got {' and '.join(found) or 'none'}")
        if sized and (self.width is None or self.height is None):
            raise _refused(f"{'width' if self.width is None else 'height'} is missing")
        if not sized and (self.depth is not None or self.density is not None):
            raise _refused(f"depth and density of a {found[0]} stand in its own table")
        for k, region in enumerate(self.section.region if self.section else ()):
            for key in ("geojson", "dxf"):
                if getattr(region, key) is not None:
                    raise _refused(f"section.region[{k}].{key}: {_UPLOAD}")
        check_size(self)
        _refuse_subnormal(self.table(), "")
        return self

    def table(self) -> dict[str, Any]:
        """Return the body as a table of a body file or job file.

        Returns plain values; what was not given is left out.
        """
        return self.model_dump(exclude_none=True, exclude_unset=True)


def _refuse_subnormal(given: Any, key: str) -> None:
    """Refuse numbers that have lost digits already: what is computed from them would have none that are right."""
    if isinstance(given, float) and 0.0 < abs(given) < sys.float_info.min:
        least = f"{sys.float_info.min:.3g}"
        raise _refused(f"{key} is {given!r}, too small for a number with all its digits ({least}); a wrong unit?")
    if isinstance(given, dict):
        for name, value in given.items():
            _refuse_subnormal(value, f"{key}.{name}" if key else name)
    if isinstance(given, (list, tuple)):
        for place, value in enumerate(given):
            _refuse_subnormal(value, f"{key}[{place}]")


def _refused(words: str) -> PydanticCustomError:
    return PydanticCustomError("contradiction", "{words}", {"words": words})
