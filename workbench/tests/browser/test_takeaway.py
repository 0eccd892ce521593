"""Take away: every file of the inputs, the link, and the TOML."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

INPUTS = {
    "body": {"units": "cm", "width": 50, "height": 200},
    "motion": {"pulse": "sine:amplitude=3.2,period=0.8"},
    "restitution": {"models": ["ked", "housner"]},
}
MAGIC = {
    "csv": b"\xef\xbb\xbf", "xlsx": b"PK", "mat": b"MATLAB", "nc": b"\x89HDF",
    "pdf": b"%PDF", "zip": b"PK", "html": b"<!doctype html", "gif": b"GIF8", "toml": b"",
}  # fmt: skip
SHEETS = ["body", "coefficients", "measures", "spectrum", "impacts"]
FILES = [
    "animation-html", "animation-gif", "take-toml", "take-zip", "take-report",
    *(f"table-{what}-{kind}" for what in SHEETS for kind in ("csv", "xlsx")),
    "table-motion-csv", "table-motion-mat", "table-response-csv", "table-response-mat", "table-response-nc",
]  # fmt: skip


@pytest.fixture
def takeaway(open_page: Callable[..., Any]) -> Any:
    """Open the step Take away with a block and a pulse."""
    from base64 import urlsafe_b64encode
    from urllib.parse import urlencode

    packed = urlsafe_b64encode(json.dumps(INPUTS).encode()).decode().rstrip("=")
    return open_page(urlencode({"in": packed, "view": "takeaway"}))


def saved(page: Any, testid: str, folder: Path) -> Path:
    """Press a button and keep its file."""
    with page.expect_download() as download:
        page.get_by_test_id(testid).click()
    target = folder / download.value.suggested_filename
    download.value.save_as(target)
    return target


def test_every_file(takeaway: Any, tmp_path: Path, shot: Any) -> None:
    """Every button saves a file that begins as its kind does."""
    shot(takeaway, "takeaway")
    for testid in FILES:
        found = saved(takeaway, testid, tmp_path)
        kind = found.suffix[1:]
        assert kind == {"take-toml": "toml", "take-zip": "zip", "take-report": "pdf"}.get(
            testid, testid.rsplit("-")[-1]
        )
        assert found.read_bytes().lower().startswith(MAGIC[kind].lower()), testid
        assert found.stat().st_size > 60, testid


def test_a_gif_says_that_it_is_drawn_and_can_be_stopped(takeaway: Any) -> None:
    """While the frames are drawn it says so, a second press asks for nothing more, and Cancel ends it."""
    asked: list[str] = []
    takeaway.on("request", lambda request: asked.append(request.url) if "animation.gif" in request.url else None)
    button = takeaway.get_by_test_id("animation-gif")
    button.click()
    expect(takeaway.locator("#view-takeaway").get_by_test_id("film-progress")).to_contain_text("Drawing the frames")
    button.dispatch_event("click")
    takeaway.get_by_role("button", name="Cancel the GIF").click()
    expect(takeaway.locator("#view-takeaway").get_by_test_id("film-progress")).to_be_hidden()
    expect(button).to_be_focused()
    assert len(asked) == 1


def test_the_model_of_a_file_is_chosen_and_named(takeaway: Any, tmp_path: Path) -> None:
    """The response as CSV is that of the model that was chosen; its name says which."""
    first = saved(takeaway, "table-response-csv", tmp_path)
    assert "ked" in first.name
    takeaway.get_by_label("Model in files with one model").select_option("housner")
    second = saved(takeaway, "table-response-csv", tmp_path)
    assert "housner" in second.name
    assert second.read_bytes() != first.read_bytes()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('units = "m"\n[block]\nwidth = 0.5\nheight = 2.0\n', "step Body"),
        ('[campaign]\nname = "x"\nkind = "histories"\n', "step Studies"),
    ],
)
def test_a_toml_of_another_kind_is_told_where_it_goes(takeaway: Any, tmp_path: Path, text: str, words: str) -> None:
    """A body file and a job file are refused with the step that takes them."""
    path = tmp_path / "other.toml"
    path.write_text(text, encoding="utf-8")
    takeaway.get_by_test_id("read-toml").set_input_files(path)
    expect(takeaway.get_by_text(words).first).to_be_visible()


def test_the_toml_on_the_command_line(takeaway: Any, tmp_path: Path, served: Any) -> None:
    """The saved TOML gives on the command line the numbers of the application, to the last digit."""
    path = saved(takeaway, "take-toml", tmp_path)
    done = subprocess.run(
        [sys.executable, "-m", "rocking", "simulate", str(path), "--json"], capture_output=True, text=True, check=True
    )
    told = json.loads(done.stdout)
    answer = served.api("response", json=INPUTS)["answers"][0]
    assert told["peak_rotation"] == answer["peak_rotation"]
    assert told["impacts"] == answer["impacts"]
    assert (
        served.api("response", json={**INPUTS, "motion": {"pulse": "sine:amplitude=3.1,period=0.8"}})["answers"][0][
            "impacts"
        ]
        != told["impacts"]
    )


def test_the_link_opens_the_same_inputs(takeaway: Any, open_page: Callable[..., Any]) -> None:
    """The permanent link, opened elsewhere, has the same inputs."""
    link = takeaway.get_by_test_id("permanent-link").input_value()
    takeaway.get_by_test_id("copy-link").click()
    takeaway.get_by_text("Link copied.").wait_for()
    other = open_page(link.partition("#")[2])
    other.get_by_role("tab", name="Export").click()
    again = other.get_by_test_id("permanent-link").input_value()
    assert re.search("in=([^&]+)", again)[1] == re.search("in=([^&]+)", link)[1]  # type: ignore[index]


def test_a_toml_comes_back(takeaway: Any, tmp_path: Path) -> None:
    """A TOML of other inputs, chosen as a file, becomes the inputs of the page."""
    path = tmp_path / "other.toml"
    body, motion = 'units = "cm"\nwidth = 40\nheight = 160', 'pulse = "ricker:amplitude=4,period=0.5"'
    path.write_text(f"[response]\n[body]\n{body}\n[motion]\n{motion}\n", encoding="utf-8")
    before = takeaway.get_by_test_id("permanent-link").input_value()
    takeaway.get_by_test_id("read-toml").set_input_files(path)
    expect(takeaway.get_by_test_id("permanent-link")).not_to_have_value(before)
