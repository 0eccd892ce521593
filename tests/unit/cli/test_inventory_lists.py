"""`rocking inventory` on lists as people keep them: own titles, and a museum's workbook."""

import pytest
from unit.studies.inventory import museum_list

import rocking as rk
from rocking.errors import InvalidValueError

COMMAND = "inventory"
FEW = ("--synthetic", "point-source", "--count", "80", "--seed", "2")


def test_columns_are_said_alike_at_every_door(answered, refuses, tmp_path):
    """A museum's own titles are mapped by an option, a key of a file, and in Python: the same verdicts."""
    (tmp_path / "objects.csv").write_text("Ding;Maß 1;Maß 2;Maß 3\nUrne;12,5;20;90\n", encoding="utf-8")
    columns = "Ding=name, Maß 1=width_cm, Maß 2=depth_cm, Maß 3=height_cm"
    few = ("--synthetic", "point-source", "--count", "5")
    refuses((tmp_path / "objects.csv", "--pga", "0.3g", *few), "the first line must name the columns")
    by_option = answered(tmp_path / "objects.csv", "--columns", columns, "--pga", "0.3g", *few)
    table = f'objects = "objects.csv"\npga = "0.3g"\ncolumns = "{columns}"'
    motions = '[[motions]]\nsynthetic = "point-source"\ncount = 5\nseed = 1'
    (tmp_path / "job.toml").write_text(f"[inventory]\n{table}\n{motions}\n", encoding="utf-8")
    assert answered(tmp_path / "job.toml")["objects"] == by_option["objects"]
    shares = rk.inventory(tmp_path / "objects.csv", "point-source", pga="0.3g", count=5, columns=columns)
    assert shares["overturned"].isel(restitution=0, object=0).values.tolist() == [
        each["overturned"] for each in by_option["objects"][0]["directions"]
    ]
    with pytest.raises(InvalidValueError, match="leave them out beside objects"):
        rk.inventory([], "point-source", pga="0.3g", columns=columns)


def test_a_museum_list_in_one_command(printed, tmp_path):
    """Thirty untidy rows of a German workbook: each has a verdict, or its reason."""
    museum_list.write_museum_list(tmp_path / "liste.xlsx")
    out = printed(tmp_path / "liste.xlsx", "--pga", "0.3g", *FEW)
    assert out.startswith("liste.xlsx (Objekte): PGA 0")
    labels = [" ".join(filter(None, line.split("|")[:2])) for line in museum_list.LIST.splitlines()[1:]]
    assert len(labels) == 30
    for label in labels:
        assert f"  {label}" in out or f" {label}, " in out
