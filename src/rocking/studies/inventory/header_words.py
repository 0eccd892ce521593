"""Words of lists in seven languages, of headers and of cells, as header_words.toml has them."""

import tomllib
from pathlib import Path
from typing import Any

_WORDS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("header_words.toml").read_text("utf-8"))

HEADERS: dict[str, dict[str, str]] = _WORDS["headers"]
UNITS: dict[str, str] = _WORDS["units"]
SIDES: dict[str, str] = _WORDS["sides"]
SHAPES: dict[str, str] = _WORDS["shapes"]
CONSEQUENCES: dict[str, str] = _WORDS["consequences"]
TELLING: str = _WORDS["telling"]
ABOUT: str = _WORDS["about"]
UNKNOWN: str = _WORDS["unknown"]
TOTALS: str = _WORDS["totals"]
WITH: str = _WORDS["with"]
PAIRS: str = _WORDS["pairs"]
