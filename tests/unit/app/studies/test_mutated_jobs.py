"""Jobs with anything in any place: refused in a sentence or put in line, never an accident."""

import copy
import itertools
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from rocking.app.records import RecordStore
from rocking.app.settings import Limits
from rocking.app.studies.manager import StudyManager
from rocking.errors import RockingError

JOBS: list[dict[str, Any]] = [
    {
        "campaign": {"name": "m", "kind": "overturning-map", "seed": 1},
        "body": {"units": "m", "width": 0.5, "height": 2.0},
        "motions": [{"pulse": ["sine:amplitude=3,period=0.6"], "scale": 1.5}],
        "restitution": {"models": ["ked"], "values": [0.8]},
        "map": {"x": {"axis": "frequency_ratio", "from": 1, "to": 6, "count": 3},
                "y": {"axis": "pga", "values": [1, 2]}},
        "settings": {"gravity": 9.81, "linear": False, "engine": "auto"},
    },
    {
        "campaign": {"name": "s", "kind": "stripes"},
        "body": {"units": "cm", "section": {"region": [{"outline": [[0, 0], [50, 0], [25, 100]], "density": 2400}]}},
        "motions": {"pulse": ["sine:amplitude=1,period=0.6", "ricker:amplitude=1,period=0.5"]},
        "restitution": {"distribution": {"mean": 0.9, "deviation": 0.05, "each": "history"}},
        "fragility": {"measure": "pga", "levels": [1.0, 2.0], "states": [0.5]},
    },
    {
        "campaign": {"name": "r", "kind": "rocking-spectrum"},
        "motions": {"synthetic": "pulse-like", "count": 2, "pga": 4.0},
        "spectrum": {"slenderness_angles": [0.2], "periods": {"from": 1.5, "to": 3, "count": 2, "spacing": "log"}},
    },
]  # fmt: skip

ANYTHING = st.one_of(
    st.none(), st.booleans(), st.integers(-(10**20), 10**20), st.floats(), st.text(max_size=20),
    st.sampled_from(["ked", "pga", "mm", "cloud", "\ud800", "1e999", "sine:amplitude=1e300,period=1e-300"]),
    st.lists(st.integers(-3, 3), max_size=3), st.dictionaries(st.text(max_size=5), st.integers(), max_size=2),
    st.sampled_from([1e-300, 1e300, 5e-324, 1e-9, 1e9, 0, -1]),
)  # fmt: skip


def _places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inside:
        yield (*path, key)
        yield from _places(each, (*path, key))


PLACES = [(number, path) for number, job in enumerate(JOBS) for path in _places(job)]


def _refusal(manager: StudyManager, job: Any) -> str:
    try:
        manager.create(None, job)
    except RockingError as error:
        return str(error)
    return ""


@settings(max_examples=250, deadline=None)
@given(st.sampled_from(PLACES), ANYTHING)
def test_anything_in_any_place_is_refused_or_launched(place: tuple[int, tuple[Any, ...]], value: Any) -> None:
    """What comes out is a study or a sentence of this package, without the path of a folder in it."""
    job = copy.deepcopy(JOBS[place[0]])
    *way, last = place[1]
    inside: Any = job
    for key in way:
        inside = inside[key]
    inside[last] = value
    with tempfile.TemporaryDirectory() as folder:
        limits = Limits(histories=1000)
        manager = StudyManager(Path(folder), limits, RecordStore(Path(folder), limits), workers=1, at_once=0)
        refusal = _refusal(manager, job)
        assert folder not in refusal
        assert bool(refusal) != bool(list((Path(folder) / "studies").iterdir()))
        manager.close()


def test_the_jobs_themselves_are_launched(tmp_path: Path) -> None:
    """What is mutated is no wreck to begin with, and every place of it was reached."""
    manager = StudyManager(tmp_path, Limits(), RecordStore(tmp_path, Limits()), workers=1, at_once=0)
    assert len({manager.create(None, job) for job in JOBS}) == 3
    assert len(PLACES) == sum(1 for job in JOBS for _ in itertools.islice(_places(job), 1000)) > 60
    manager.close()
