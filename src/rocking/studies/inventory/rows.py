"""What a row of a list says: its measures, its shape, and what of it is no more than a remark."""

from collections.abc import Callable, Sequence
from pathlib import Path, PureWindowsPath
from typing import Any

from rocking.bodies import Block, Section, Solid
from rocking.bodies.formats import read_body
from rocking.errors import InvalidValueError
from rocking.studies.inventory import header_words
from rocking.studies.inventory.cells import CellMeasure, is_missing
from rocking.studies.inventory.columns import plain, words_of
from rocking.studies.inventory.sheets import Cell

_SHAPES = {**dict.fromkeys(words_of(header_words.ROUND), "round"), **dict.fromkeys(words_of(header_words.BOX), "box")}
_CONSEQUENCES = {word: level for level, text in header_words.CONSEQUENCES.items() for word in words_of(text)}


class RowValues:
    """What the cells of a row say."""

    def __init__(self, row: int) -> None:
        self.fields: dict[str, Any] = {"row": row}
        self.titles: dict[str, str] = {}
        self.unknown: dict[str, str] = {}
        self.approximate: dict[str, float] = {}
        self.remarks: list[str] = []

    def take(self, fields: Sequence[str], one: CellMeasure, title: str, cell: Cell) -> None:
        for each in fields:
            if abs(self.fields.get(each, one.value) - one.value) > 1e-9 * abs(one.value):
                raise InvalidValueError(
                    f"{self.titles[each]} and {title} say another {each.replace('_', ' ')}; leave one out"
                )
        self.fields |= dict.fromkeys(fields, one.value)
        self.titles |= dict.fromkeys(fields, title)
        if one.half_width:
            self.approximate |= dict.fromkeys(fields, one.half_width)
            what = " and ".join(fields).replace("_", " ")
            self.remarks.append(
                f"{title} {cell!r:.60}: {what} taken as {one.value:.4g} m, give or take {one.half_width:.2g} m"
            )

    def optional(self, field: str, value: Any, remark: str) -> None:
        if value is None:
            self.remarks.append(remark)
        else:
            self.fields[field] = value

    def settle_shape(self) -> None:
        """Bring a diameter, or a shape that is said to be round, to width and depth."""
        fields, word = self.fields, self.fields.pop("shape", "")
        shape = _SHAPES.get(plain(word))
        if word and shape is None and not is_missing(word):
            self.remarks.append(f"shape {word!r:.40} is not round or rectangular: a box of its size is taken")
        if (across := fields.pop("diameter", None)) is not None:
            other = next(
                (way for way in ("width", "depth") if abs(fields.get(way, across) - across) > 1e-9 * across), None
            )
            if shape == "box" or other:
                against = f"the shape {word!r:.40}" if shape == "box" else f"another {other}"
                raise InvalidValueError(f"it has a {self.titles['diameter']} and {against}: leave one out")
            fields |= {"width": across, "depth": across}
            if half := self.approximate.pop("diameter", 0.0):
                self.approximate |= {"width": half, "depth": half}
            shape = "round"
        if shape != "round" or "solid" in fields:
            return
        sides = [way for way in ("width", "depth") if way in fields]
        if len(sides) == 1:
            (own,), (other,) = sides, {"width", "depth"} - set(sides)
            fields[other] = fields[own]
            if own in self.approximate:
                self.approximate[other] = self.approximate[own]
        if len(sides) == 2 and fields["width"] != fields["depth"]:
            self.remarks.append("it is said to be round, and its width is not its depth: a box of its size is taken")
        else:
            fields["shape"] = "round"

    def settle_words(self, find: Callable[[str], Path] | None) -> None:
        """Bring consequence and photo to what they mean."""
        if (word := self.fields.pop("consequence", None)) and not is_missing(word):
            self.fields["consequence"] = _CONSEQUENCES.get(plain(word), "high")  # the careful side
            if plain(word) not in _CONSEQUENCES:
                self.remarks.append(f"consequence {word!r:.40} is not low, medium or high: high is taken")
        if photo := self.fields.pop("photo", None):
            self.optional("photo", photo_of(photo, find), f"photo {photo!r:.80} is no picture beside the list")


def body_of(name: str, units: Any, find: Callable[[str], Path] | None) -> dict[str, object]:
    """Return the body of a file, and its size."""
    if find is None:
        raise InvalidValueError(f"names the body file {name!r:.60}, but no file can be named here")
    body = read_body(find(name), units=units)
    if isinstance(body, (Block, Section)):
        body = Solid.from_section(body)
    if not isinstance(body, Solid):
        raise InvalidValueError(f"{name}: mass points have no shape to stand on in three dimensions")
    size = body.box[1] - body.box[0]
    return {"solid": body, **dict(zip(("width", "depth", "height"), size.tolist(), strict=True))}


def photo_of(name: str, find: Callable[[str], Path] | None) -> Path | None:
    """Return where a picture is; None if it is none, or not beside the list or in a folder there."""
    parts_of = PureWindowsPath(name).parts
    if find is None or PureWindowsPath(name).anchor or name.startswith("/") or ".." in parts_of:
        return None
    try:
        from PIL import Image

        path = find("/".join(parts_of))
        if not path.resolve().is_relative_to(path.parents[len(parts_of) - 1].resolve()):
            return None
        with Image.open(path) as picture:
            picture.verify()
    except Exception:  # noqa: BLE001 - a damaged picture raises whatever its reader trips over
        return None
    return path
