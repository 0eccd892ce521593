"""No import of a room above, none in a circle, within functions and by strings too; one class name, one meaning."""

import pytest
from benchmarks import house


def test_no_circle_and_no_arrow_upward():
    arrows = house.imports(house.SOURCE)
    assert house.circles(arrows) == []
    assert house.upward(arrows) == []


def test_every_room_has_its_floor():
    """A room that the plan does not name would be looked at by nobody."""
    planned = {room for rooms in house.FLOORS for room in rooms}
    assert {name.split(".")[1] for name in house.trees(house.SOURCE) if "." in name} == planned


def test_the_mechanics_are_chosen_in_one_place():
    """No code outside the choice of mechanics asks whether a body is in space or whether it has friction."""
    assert house.choices_of_mechanics(house.SOURCE) == {
        "in_space()": [], "friction is None": [], "isinstance(..., Solid)": []
    }  # fmt: skip


CHOOSES = """from rocking.bodies import Body, Solid
def moves(body, settings, friction=None):
    if in_space(body) or bodies.in_space(body) or isinstance(body, (Body, Solid)):
        return settings.friction is not None
    return isinstance(body, Solid) and friction is None
"""


@pytest.mark.parametrize(("name", "count"), [("studies/map.py", 2), ("dynamics/frictional/mechanics.py", 0)])
def test_a_second_choice_of_mechanics_is_seen(name, count, tmp_path):
    """Negative control: each of the three questions is found twice in a study, and allowed where a mechanics asks."""
    path = tmp_path / "rocking" / name
    path.parent.mkdir(parents=True)
    path.write_text(CHOOSES, "utf-8")
    assert [len(places) for places in house.choices_of_mechanics(tmp_path / "rocking").values()] == [count] * 3


def test_facts_have_one_place():
    """Every key of an answer is named in quantities.py; sentences are not read back, and no string names a module."""
    stated = house.facts_stated_twice(house.SOURCE)
    keys, widths, sentences, modules = stated.values()
    assert keys == []
    assert sentences == []
    assert len(widths) <= WIDTHS, widths
    assert len(modules) <= MODULES, modules


WIDTHS, MODULES = 6, 11  # what is left of them
STATES = """from importlib import import_module
class BlockTable:
    width: float
    height: float
class RockingError(Exception): ...
def answer(found):
    names = [each.partition(":") for each in found.assumed]
    try:
        import_module(f"rocking.{found}")
    except RockingError as error:
        return Answer({"peak_rotation": 0.1, "peak_rotation_rad": 0.1, "why": str(error).split(";")})
    except ValueError as error:
        return str(error).split(";")
"""


def test_facts_with_two_places_are_seen(tmp_path):
    """Negative control: a key, a width, two sentences and a module; the sentence of another library is none."""
    (tmp_path / "rocking").mkdir()
    (tmp_path / "rocking" / "again.py").write_text(STATES, "utf-8")
    (tmp_path / "rocking" / "again.js").write_text('const FIELDS = [["width", "Width"]];', "utf-8")
    keys, widths, sentences, modules = house.facts_stated_twice(tmp_path / "rocking").values()
    assert [key.partition(" ")[2] for key in keys] == ["peak_rotation_rad", "why"]
    assert widths == ["rocking.again", "again.js"]
    assert sorted(sentences) == ["rocking.again:11", "rocking.again:7"]
    assert modules == ["rocking.again:9"]


def test_no_class_name_stands_twice():
    """Content hashes and readers know a class of ours by its name alone."""
    assert [name for name, count in house.classes(house.SOURCE).items() if count > 1] == []


LOWER = {
    "top": "from rocking.studies.map import drawn",
    "within a function": "def late():\n    from rocking.studies import map\n    return map",
    "the module": "def late():\n    import rocking.studies.map",
    "by a string": "import importlib\nfound = importlib.import_module('rocking.studies.map')",
    "by a package that hands it on": "from rocking.studies import drawn",
}


@pytest.mark.parametrize("way", LOWER)
def test_every_way_to_import_is_seen(way, tmp_path):
    """Negative control: a house in which a lower room reaches into a higher one, which builds on it."""
    house_of = {
        "__init__.py": "",
        "dynamics/__init__.py": "",
        "dynamics/engine.py": LOWER[way],
        "studies/__init__.py": "from rocking.studies.map import drawn",
        "studies/map.py": "from rocking.dynamics import engine\ndef drawn():\n    return engine",
    }
    for name, text in house_of.items():
        path = tmp_path / "rocking" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    arrows = house.imports(tmp_path / "rocking")
    assert house.circles(arrows) == [["rocking.dynamics.engine", "rocking.studies.map"]]
    assert house.upward(arrows) == [("rocking.dynamics.engine", "rocking.studies.map")]


DRAWS = """class Response:
    def {name}(self):
        from rocking.{room} import drawn
        return drawn(self)
"""


@pytest.mark.parametrize(
    ("name", "room", "upward"), [("plot", "plots", 0), ("report", "plots", 0), ("draw", "plots", 1), ("plot", "cli", 1)]
)
def test_methods_that_draw_alone_import_a_room_above(name, room, upward, tmp_path):
    """Methods named plot, animate and report import plots and reports; no other method and no other room."""
    house_of = {
        "__init__.py": "", "dynamics.py": DRAWS.format(name=name, room=room),
        f"{room}.py": "def drawn(response):\n    return response",
    }  # fmt: skip
    (tmp_path / "rocking").mkdir()
    for file, text in house_of.items():
        (tmp_path / "rocking" / file).write_text(text, "utf-8")
    assert len(house.upward(house.imports(tmp_path / "rocking"))) == upward


def test_what_only_the_checker_of_types_reads_is_no_arrow(tmp_path):
    (tmp_path / "rocking").mkdir()
    text = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from rocking.other import Name"
    (tmp_path / "rocking" / "__init__.py").write_text("", "utf-8")
    (tmp_path / "rocking" / "one.py").write_text(text, "utf-8")
    (tmp_path / "rocking" / "other.py").write_text("from rocking.one import x\nclass Name: ...", "utf-8")
    assert house.circles(house.imports(tmp_path / "rocking")) == []
