"""A plane body of known depth is asked in space where a file of three dimensions is asked for."""

import json

import pytest

TABLES = """[body]
units = "cm"
width = 50
height = 200
depth = 40
density = 2400
feet = [10, 45]
[response]
friction = 0.5
[motion]
x = { pulse = "sine:amplitude=4,period=0.8" }
[restitution]
value = 0.5
"""


@pytest.mark.parametrize("command", ["restitution", "simulate"])
def test_a_plane_body_in_space(tmp_path, run, command):
    """With a .glb it is the solid of its depth, on its feet; without, it stays plane; without a depth it is refused."""
    file, out = tmp_path / "cabinet.toml", tmp_path / "cabinet.glb"
    file.write_text(TABLES)
    plane = json.loads(run(command, file, "--json")[1])
    answer = json.loads(run(command, file, "--output", out, "--json")[1])
    assert (plane["body"]["kind"] == "Solid", answer["body"]["kind"]) == (False, "Solid")
    assert answer["body"]["mass"] == pytest.approx(0.5 * 0.4 * 2.0 * 2400.0)
    assert answer["body"]["size"] == pytest.approx([0.5, 0.4, 2.0])
    assert out.read_bytes().startswith(b"glTF")
    if command == "restitution":
        corners = {tuple(round(x, 9) for x in each) for each in answer["body"]["base"]["base_vertices"]}
        assert corners == {(x, y) for x in (0.1, 0.45) for y in (-0.2, 0.2)}
    file.write_text(TABLES.replace("depth = 40\n", ""))
    assert "section with a depth" in run(command, file, "--output", tmp_path / "more.glb")[2]
