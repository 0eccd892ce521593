"""`rocking cor` of the file that the application gives to take away: its body, and a word about the rest."""

import json

import pytest

BODY = '[body]\nunits = "cm"\nwidth = 50\nheight = 200\n'
TAKEN = f"""[response]
friction = 0.5

{BODY}
[motion]
record = "not-here.AT2"
scale = 1.1

[restitution]
models = ["ked", "housner"]
"""


@pytest.fixture
def taken(file):
    """Return a file to take away, without the record beside it."""
    return file(TAKEN, "response.toml")


def test_the_body_is_taken_and_the_rest_is_for_simulate(run, taken):
    """The table is that of the block itself, below a sentence that says what is not used."""
    code, out, err = run("cor", taken)
    assert (code, err) == (0, "")
    first, _, rest = out.partition("\n")
    assert first.endswith("everything else it says is for `rocking simulate`.")
    assert rest == run("cor", "--width", 0.5, "--height", 2)[1]


def test_json_stays_alone_on_its_stream(run, taken):
    """With --json the sentence goes to the other stream, and the numbers are those of the block itself."""
    code, out, err = run("cor", taken, "--json")
    assert code == 0
    assert "rocking simulate" in err
    assert json.loads(out) == json.loads(run("cor", "--width", 0.5, "--height", 2, "--json")[1])


def test_its_gravity_holds_unless_another_is_given(run, tmp_path):
    """The settings of the file say the gravity; the option says it over them; nothing need move the body yet."""
    path = tmp_path / "moon.toml"
    path.write_text(f"[response]\n{BODY}[settings]\ngravity = 1.62\n")
    for words, gravity in (((), 1.62), (("--set", "settings.gravity=3.7"), 3.7)):
        answer = json.loads(run("cor", path, "--json", *words)[1])
        assert answer["body"]["gravity"] == gravity


@pytest.mark.parametrize(
    ("text", "words", "said"),
    [
        (TAKEN, ["--width", "1"], "takes no --width"),
        (TAKEN, ["--units", "cm"], "takes no --units"),
        (TAKEN.replace("width = 50", "width = -50"), [], "width"),
        (TAKEN.replace("height = 200\n", ""), [], "height"),
        (TAKEN + "[campaign]\n", [], "campaign"),
        ("[response]\nfree = 0.5\n", [], "body"),
    ],
)
def test_what_cannot_be_meant_is_refused(run, tmp_path, text, words, said):
    """Sizes beside the file, a body that is none and other tables are refused in a sentence with the file's name."""
    path = tmp_path / "response.toml"
    path.write_text(text)
    code, _, err = run("cor", path, *words)
    assert code != 0
    assert said in err
    assert "response.toml" in err
    assert "Traceback" not in err
