"""Doors to what takes longer: does it stand, which objects stand, what does an impact cost."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from browser_pages import link

from rocking import examples

expect = pytest.importorskip("playwright.sync_api").expect


def asked(page: Any, view: str) -> Any:
    """Press the button, and wait for the answer or the refusal."""
    section = page.locator(f"#view-{view}")
    section.get_by_role("button", name="Compute", exact=True).click()
    outcome = section.get_by_test_id("outcome")
    expect(outcome).to_have_attribute("data-state", "done")
    return outcome


def test_does_it_stand(open_page: Callable[..., Any], shot: Callable[..., Any], served: Any, tmp_path: Path) -> None:
    """What the page says is what the command line says of the same file, and a report can be taken away."""
    page = open_page(link("sine:amplitude=3.2,period=0.8"))
    page.locator("#tab-decide").click()
    page.get_by_label("Author").fill("A. Person")
    outcome = asked(page, "decide")
    verdict = outcome.get_by_test_id("verdict").inner_text()
    question = served.api("questions", method="GET")["questions"][0]
    whole = served.api(f"questions/{question['id']}", method="GET")
    assert verdict == whole["answer"]["sentences"][0]
    assert whole["answer"]["author"] == "A. Person"
    rows = outcome.get_by_role("table", name="Models").locator("tbody tr")
    assert rows.count() == len(whole["answer"]["models"])
    expect(outcome.locator("img.drawing")).to_be_visible()
    assert outcome.locator("img.drawing").evaluate("image => image.naturalWidth") > 100
    with page.expect_download() as told:
        outcome.get_by_role("button", name="Report (PDF)").click()
    told.value.save_as(tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    shot(page, "decide")
    page.reload()
    page.locator("#view-decide").get_by_role("button", name="Show Assessment").click()
    expect(page.get_by_test_id("verdict")).to_have_text(verdict)


def test_how_likely_is_it(open_page: Callable[..., Any], served: Any) -> None:
    """One number and a range go as such; verdict, probabilities and shares are those of the command line."""
    page = open_page(link("sine:amplitude=3.2,period=0.8"))
    page.locator("#tab-decide").click()
    section = page.locator("#view-decide")
    section.get_by_label("Analysis").select_option("predict")
    for label, text in (("friction", "0.4, 0.6"), ("centre", "1,02"), ("restitution", "ked"), ("count", "16")):
        section.get_by_label(label, exact=True).fill(text)
    outcome = asked(page, "decide")
    question = served.api("questions", method="GET")["questions"][0]
    whole = served.api(f"questions/{question['id']}", method="GET")
    told = whole["toml"].split("[predict]")[1]
    lines = ("friction = [0.4, 0.6]", "centre = 1.02", 'restitution = "ked"', "count = 16")
    assert [each for each in lines if each not in told] == []
    assert outcome.get_by_test_id("verdict").inner_text() == whole["answer"]["verdict"]
    assert outcome.get_by_role("table", name="Probabilities").locator("tbody tr").count() == 3
    decided = any(share["total"] for share in whole["answer"]["contributions"].values())
    assert outcome.get_by_role("table", name="Contributions to variance").count() == decided
    expect(outcome.locator("img.drawing")).to_be_visible()
    section.get_by_label("friction", exact=True).fill("-1")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_role("alert")).to_contain_text("riction")


def test_what_is_wrong_is_marked_at_its_field(open_page: Callable[..., Any]) -> None:
    """What the page or the server refuses stands at its field, which has the keyboard, until it is changed."""
    page = open_page(link("sine:amplitude=3.2,period=0.8"))
    page.locator("#tab-decide").click()
    section = page.locator("#view-decide")
    ask = section.get_by_role("button", name="Compute", exact=True)
    margin = section.get_by_label("Required margin")
    for _ in range(2):
        margin.fill("-1")
        expect(margin).not_to_have_attribute("aria-invalid", "true")
        ask.click()
        expect(margin).to_have_attribute("aria-invalid", "true")
        expect(margin).to_be_focused()
        expect(margin).to_have_accessible_description("Enter a required margin above 0.")
    section.get_by_label("Analysis").select_option("predict")
    friction = section.get_by_label("friction", exact=True)
    friction.fill("-2")
    ask.click()
    expect(section.get_by_test_id("outcome")).to_have_attribute("data-state", "refused")
    expect(friction).to_be_focused()
    expect(friction).to_have_accessible_description("Friction must be in [0.01, 10]; it is \u22122.")
    expect(section.locator("[aria-invalid=true]")).to_have_count(1)
    friction.fill("0.5")
    expect(friction).not_to_have_attribute("aria-invalid", "true")
    for question in ("assess", "predict"):  # its field is made anew, and what was refused is past
        section.get_by_label("Analysis").select_option(question)
    expect(friction).to_have_value("0.5")
    expect(section.locator("[aria-invalid=true]")).to_have_count(0)
    section.get_by_role("button", name=re.compile("^Show ")).first.click()
    expect(section.get_by_role("alert")).to_contain_text("it is \u22122")  # of the present request alone
    expect(section.locator("[aria-invalid=true]")).to_have_count(0)


FORMS = """async () => {
  const [{ html, render }, { createForms }] = await Promise.all(
    ["/parts/preact.js", "/app/forms.js"].map((each) => import(each)));
  const [forms, drawn] = [createForms(), []];
  const places = ["one", "other"].map((view) => {
    const form = forms.of(view, { text: "" });
    const place = document.createElement("div");
    render(html`<${() => drawn.push(view) && html`<p>${form.value.text}</p>`} />`, place);
    return place;
  });
  forms.of("one", { text: "" }).at("text").value = "typed";
  await new Promise(requestAnimationFrame);
  await new Promise(requestAnimationFrame);
  return [drawn, places.map((place) => place.textContent), forms.get().one.text];
}"""


def test_what_is_typed_in_one_view_draws_no_other(open_page: Callable[..., Any]) -> None:
    """A letter in one form draws its own view once more, and no other."""
    assert open_page().evaluate(FORMS) == [["one", "other", "one"], ["typed", ""], "typed"]


def test_the_paper(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """One button recomputes the paper; its report can be taken away, and the command that makes it is told."""
    page = open_page(link())
    page.locator("#tab-measure").click()
    page.locator("#view-measure").get_by_label("Analysis").select_option("reproduce")
    outcome = asked(page, "measure")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("claims confirmed")
    assert outcome.get_by_role("table", name="Models").locator("tbody tr").count() > 10
    with page.expect_download() as told:
        outcome.get_by_role("button", name="Report (PDF)").click()
    told.value.save_as(tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    expect(outcome.locator("pre")).to_have_text("rocking reproduce -o reproduce")


def test_records_are_sent_together(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Two files make two motions; none, and a body that is wrong, are told before anything is asked."""
    page = open_page(link())
    page.locator("#tab-decide").click()
    page.get_by_label("Ground motions").select_option("records")
    section = page.locator("#view-decide")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_role("alert")).to_contain_text("Add a record")
    for k in range(2):
        lines = "\n".join(f"{0.02 * n:.2f} {0.1 * (n % (7 + k) - 3):.3f}" for n in range(300))
        (tmp_path / f"site {k}.txt").write_text(lines)
    section.get_by_label("Drop records here, or").set_input_files([tmp_path / "site 0.txt", tmp_path / "site 1.txt"])
    expect(section.get_by_role("list", name="Files").get_by_role("listitem")).to_have_count(2)
    page.get_by_label("Unit of the accelerations").fill("g")
    outcome = asked(page, "decide")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("of 2 motions")


def test_a_list_of_objects(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """Every row has its light, or the reason why it has none; a list that is none is refused in words."""
    page = open_page(view="inventory")
    section = page.locator("#view-inventory")
    section.get_by_label("Drop a list here, or").set_input_files(str(examples.path("objects")))
    expect(section.get_by_role("list", name="Files")).to_contain_text("objects.csv")
    section.get_by_label("Number of motions").fill("40")
    outcome = asked(page, "inventory")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("1 not assessed")
    expect(outcome.get_by_role("table", name="Rows without a rating")).to_contain_text("framed mirror")
    lights = outcome.get_by_role("table", name="Objects, highest risk first").locator("td.light").all_inner_texts()
    assert lights == sorted(lights, key=["RED", "AMBER", "GREEN"].index)
    shot(page, "inventory")
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    section.get_by_role("button", name="Remove objects.csv").click()
    wrong = {"name": "nothing.csv", "mimeType": "text/csv", "buffer": b"a,b\n1,2\n"}
    section.get_by_label("Drop a list here, or").set_input_files(wrong)
    expect(section.get_by_role("list", name="Files")).to_contain_text("nothing.csv")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_test_id("outcome")).to_have_attribute("data-state", "refused")
    expect(section.get_by_role("alert")).to_contain_text("nothing.csv")


def test_inventory_numbers_are_shown(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """Objects of the same name are told apart by number and note; lines that are not objects have their reasons."""
    page = open_page(view="inventory")
    section = page.locator("#view-inventory")
    content = (
        "Inv.-Nr.;Objekt;Maße (cm);;;Bemerkung\n;;Breite;Tiefe;Höhe;\nA-17;Vase;12;12;60;Fuß geklebt\n"
        "A-18;Vase;20;20;30;\nA-19;Vase;?;20;30;\nSumme: 3;;;;;\n"
    )
    sent = {"name": "liste.csv", "mimeType": "text/csv", "buffer": content.encode("utf-8")}
    section.get_by_label("Drop a list here, or").set_input_files(sent)
    expect(section.get_by_role("list", name="Files")).to_contain_text("liste.csv")
    section.get_by_label("Number of motions").fill("10")
    outcome = asked(page, "inventory")
    rows = outcome.get_by_role("table", name="Objects, highest risk first").locator("tbody tr")
    assert rows.locator("th").all_inner_texts() == ["A-17 Vase", "A-18 Vase"]
    expect(rows.first).to_contain_text("Fuß geklebt")
    expect(outcome.get_by_role("table", name="Rows without a rating")).to_contain_text("A-19 Vase")
    outcome.get_by_text("Lines that are not objects", exact=True).click()
    expect(outcome.get_by_role("table", name="Lines of the list that are not objects")).to_contain_text("Summe: 3")
    header = section.get_by_label("Header of the list", exact=True)
    expect(header).to_have_text("Inv.-Nr.;Objekt;Maße (cm);;;Bemerkung\n;;Breite;Tiefe;Höhe;")
    shot(page, "inventory numbers")
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0


MIXED = {
    "en": "name;width cm;depth cm;height cm\nvase;20;20;ca. 90\n;30;30;80\nbox;12x;3;?\nTotal;;;\n",
    "de": "Objekt;Breite cm;Tiefe cm;Höhe cm\nVase;20;20;ca. 90\n;30;30;80\nKiste;12x;3;?\nSumme;;;\n",
}
ENGLISH = re.compile(r"\b(the|must|of|it|is|with|not|line|and|taken)\b")
GERMAN = re.compile(r"\b(der|die|das|muss|von|es|ist|mit|nicht|Zeile|und|angenommen)\b")


@pytest.mark.parametrize(
    ("listed", "locale", "foreign"), [("de", "en", GERMAN), ("en", "de", ENGLISH), ("de", "it", GERMAN)]
)
def test_a_list_in_another_language(open_page: Callable[..., Any], listed: str, locale: str, foreign: Any) -> None:
    """The answer is in the language of the page, whatever that of the list is, but for what the list says itself."""
    page = open_page(view="inventory", locale=locale)
    section = page.locator("#view-inventory")
    sent = {"name": "list.csv", "mimeType": "text/csv", "buffer": MIXED[listed].encode("utf-8")}
    section.locator("input[type=file]").first.set_input_files(sent)
    expect(section.get_by_role("listitem")).to_contain_text("list.csv")
    section.locator("form button.primary, form button[type=submit]").first.click()
    outcome = section.get_by_test_id("outcome")
    expect(outcome).to_have_attribute("data-state", "done")
    said = " ".join(outcome.locator("td:not([translate=no]), th:not([translate=no]), p, h3, caption").all_inner_texts())
    assert len(said) > 300
    own = re.sub(r"'[^']*'|[\w ]+ cm\b", "", said)  # cells and titles of the list
    assert foreign.findall(own) == []


def test_a_list_is_put_right(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """Titles that nobody knows are named, a cell that is wrong is corrected in its line; every object has its light."""
    page = open_page(view="inventory")
    section = page.locator("#view-inventory")
    content = "thing;across;deep;tall\nDöschen;20;20;100\nbüste;?;20;30\n".encode("cp1252")
    odd = {"name": "odd.csv", "mimeType": "text/csv", "buffer": content}
    section.get_by_label("Drop a list here, or").set_input_files(odd)
    section.get_by_label("Number of motions").fill("10")
    section.get_by_text("List format").click()
    titles = "thing=name, across=width_cm, deep=depth_cm, tall=height_cm"
    section.get_by_label("map columns", exact=True).fill(titles)
    outcome = asked(page, "inventory")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("1 not assessed")
    line = section.get_by_label("Line 3", exact=True)
    expect(line).to_have_value("büste;?;20;30")
    shot(page, "inventory corrected")
    line.fill("büste;15;20;30")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_test_id("verdict")).not_to_contain_text("not assessed")
    lights = section.get_by_role("table", name="Objects, highest risk first")
    expect(lights.locator("tbody tr")).to_have_count(2)
    for name in ("Döschen", "büste"):
        expect(lights).to_contain_text(name)


BLOCK = {"units": "cm", "width": 10, "height": 40}


def body_link() -> str:
    """Return a link to the view with the block that was heard."""
    import base64

    text = base64.urlsafe_b64encode(json.dumps({"body": BLOCK}).encode()).decode().rstrip("=")
    return f"in={text}&view=measure"


def test_what_an_impact_costs(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """The times of the example say a coefficient with its interval, beside the models and with a picture."""
    recording = str(examples.path("block-sound")).replace(".toml", ".csv")
    page = open_page(body_link())
    section = page.locator("#view-measure")
    section.get_by_label("Drop a recording here, or").set_input_files(recording)
    expect(section.get_by_role("list", name="Files")).to_contain_text(".csv")
    outcome = asked(page, "measure")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("coefficient of restitution")
    expect(outcome.get_by_role("table", name="Models")).to_contain_text("ked")
    expect(outcome.locator("img.drawing")).to_be_visible()
    shot(page, "measure")


MICROPHONE = """
navigator.mediaDevices.getUserMedia = async () => {
  const context = new AudioContext();
  const tone = new OscillatorNode(context, { frequency: 440 });
  const out = context.createMediaStreamDestination();
  tone.connect(out);
  tone.start();
  return out.stream;
};
"""


def test_the_microphone(open_page: Callable[..., Any], served: Any) -> None:
    """What is heard becomes a WAV file that is sent; a tone is no rocking, and is refused in words."""
    page = open_page(body_link())
    page.evaluate(MICROPHONE)
    section = page.locator("#view-measure")
    section.get_by_role("button", name="Record with the microphone").click()
    end = section.get_by_role("button", name="Stop recording")
    expect(end).to_be_visible()
    page.wait_for_timeout(1500)
    end.click()
    expect(section.get_by_role("list", name="Files")).to_contain_text("recording.wav")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_test_id("outcome")).to_have_attribute("data-state", "refused")
    expect(section.get_by_role("alert")).to_contain_text("ecording.wav")


def test_a_question_is_stopped(open_page: Callable[..., Any]) -> None:
    """One that takes long can be stopped, and the next one is answered."""
    page = open_page(link())
    page.locator("#tab-decide").click()
    page.get_by_label("Ground motions").select_option("soft-ground")
    section = page.locator("#view-decide")
    section.get_by_role("button", name="Compute", exact=True).click()
    section.get_by_role("button", name="Stop").click()
    expect(section.get_by_test_id("outcome")).to_have_attribute("data-state", "stopped")
    page.get_by_label("Ground motions").select_option("")
    asked(page, "decide")


@pytest.mark.parametrize("view", ["inventory", "measure", "records", "space"])
def test_a_missing_file_is_asked_for_where_it_is_dropped(open_page: Callable[..., Any], view: str) -> None:
    """Asked without a file, the drop place is marked and has the keyboard; a file takes the mark away."""
    section = open_page(view=view).locator(f"#view-{view}")
    section.get_by_role("button", name="Compute", exact=True).click()
    drop = section.locator(".drop").first
    expect(drop).to_have_class("drop wrong")
    expect(drop.get_by_role("button").first).to_be_focused()
    expect(drop.get_by_role("button").first).to_have_accessible_description(re.compile("^Add a "))
    drop.locator("input[type=file]:not([webkitdirectory])").set_input_files(
        {"name": "a.csv", "mimeType": "", "buffer": b"a,b\n1,2\n"}
    )
    expect(drop).not_to_have_class(re.compile("wrong"))


def drifting() -> bytes:
    """Return times of impacts whose coefficient falls from one to the next."""
    times, pause = [0.0], 0.8
    for k in range(15):
        times.append(times[-1] + pause)
        pause *= 0.95 - 0.012 * k
    return ("time [s]\n" + "\n".join(f"{each:.5f}" for each in times) + "\n").encode()


def test_a_refusal_names_fields_of_the_page(
    open_page: Callable[..., Any], served: Any, until: Callable[..., None]
) -> None:
    """It has the keyboard, calls a file as it is called, and the field that it names is asked with."""
    page = open_page(view="measure")
    section = page.locator("#view-measure")
    section.locator("input[type=file]").first.set_input_files(
        {"name": "drift.csv", "mimeType": "", "buffer": drifting()}
    )
    expect(section.get_by_role("list", name="Files")).to_contain_text("drift.csv")
    section.get_by_label("The body").select_option("no")
    section.get_by_role("button", name="Compute", exact=True).click()
    refusal = section.get_by_test_id("outcome").get_by_role("alert")
    expect(refusal).to_contain_text("drift.csv: No coefficient")
    expect(refusal).to_contain_text("choose \u201cwith a trend\u201d under \u201cCoefficient of restitution\u201d.")
    assert not re.search(r"--|svg|=true", refusal.inner_text())
    expect(refusal).to_be_focused()
    before = len(served.api("questions", method="GET")["questions"])
    section.get_by_label("Coefficient of restitution").select_option("yes")
    section.get_by_role("button", name="Compute", exact=True).click()
    until(page, lambda: len(served.api("questions", method="GET")["questions"]) > before)
    question = served.api("questions", method="GET")["questions"][0]
    assert "trend = true" in served.api(f"questions/{question['id']}", method="GET")["toml"]
