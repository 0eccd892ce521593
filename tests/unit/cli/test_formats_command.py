"""`rocking formats`: every registered format, with what the user must say."""

import json

from rocking.motions.formats import formats


def test_table_names_every_format(run):
    """Every format stands in the table with its endings; only columns leave both unit and step to the user."""
    code, out, err = run("formats")
    assert (code, err) == (0, "")
    rows = {line.split()[0]: line for line in out.splitlines() if line[:1].strip()}
    assert set(formats()) <= set(rows)
    for name, kind in formats().items():
        assert all(suffix in out for suffix in kind.suffixes)
        assert ("you say" in rows[name]) == (not (kind.states_unit and kind.states_time_step))
    assert "--units" in out
    assert max(len(line) for line in out.splitlines()) <= 100


def test_json_is_what_the_formats_say(run):
    """JSON holds title, endings, unit, step and notes of each format, in the order in which they are tried."""
    code, out, _ = run("formats", "--json")
    answer = json.loads(out)
    assert code == 0
    assert list(answer) == list(formats())
    assert answer["peer"]["suffixes"] == [".at2"]
    assert answer["peer"]["states_unit"]
    assert not answer["columns"]["states_unit"]
    assert all(
        set(entry) == {"title", "suffixes", "states_unit", "states_time_step", "notes"} for entry in answer.values()
    )
