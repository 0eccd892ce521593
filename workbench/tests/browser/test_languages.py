"""The page in four languages from one catalogue: what appears is said in its words, and nothing else changes."""

import re
from collections.abc import Callable
from typing import Any

import pytest
from browser_pages import DECISIVE, GENTLE, facts, link, response
from waiting import wait_for

from rocking import checks
from rocking.decision.inventory import parse_inventory
from rocking.errors import InvalidValueError
from rocking.language import page_words
from rocking.messages import Amount, Message, as_message
from rocking.motions.summary import MotionSummary, condition
from rocking.outcome import contact_sentence
from rocking.plausibility import of_body
from rocking.reports.response_facts import ModelAgreement

OTHERS = ["de", "it", "zh"]
SHOWN = """() => {
  const found = new Set();
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const parent = node.parentElement;
    if (parent.closest("pre, code, textarea, script, [translate=no]") || !parent.checkVisibility()) continue;
    found.add(node.data.replace(/[ \\n\\t]+/g, " ").trim());
  }
  for (const node of document.querySelectorAll("[aria-label], [title], [placeholder]"))
    for (const name of ["aria-label", "title", "placeholder"])
      if (node.checkVisibility() && node.getAttribute(name) && !node.closest("[translate=no]"))
        found.add(node.getAttribute(name).trim());
  return [...found];
}"""
ANSWERED = {  # asked when shown
    "impact": "[data-testid=impact-results]:not([hidden])",
    "response": ".response-results[data-drawn]",
    "compare": "[data-testid=compare-verdict]",
}
COMPUTED = """(step) => [...document.querySelectorAll(`#view-${step} .waiting`)]
  .every((message) => !message.checkVisibility())"""
SAID = "async (texts) => { const { t } = await import('/app/words.js'); return texts.map((text) => t(text)); }"
STOPPED = """async (texts) => {
  const { stopped } = await import('/parts/fields.js');
  return texts.map((text) => stopped(text));
}"""
TOLD = """async (messages) => {
  const { spelt } = await import('/app/refusal.js');
  return messages.map((message) => spelt(message));
}"""


def _computed(page: Any, step: str) -> None:
    """Wait until nothing of a step is being computed."""
    wait_for(lambda: page.evaluate(COMPUTED, step))


def texts(page: Any) -> set[str]:
    """Return every text that can be seen or heard, in every step."""
    found: set[str] = set()
    for step in page.locator("[role=tab][data-view]").evaluate_all("tabs => tabs.map(tab => tab.dataset.view)"):
        page.locator(f"#tab-{step}").click()
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        page.wait_for_load_state("networkidle")
        if step in ANSWERED:
            page.locator(ANSWERED[step]).first.wait_for()
        _computed(page, step)
        found.update(page.evaluate(SHOWN))
    return found


def is_prose(text: str) -> bool:
    """Return whether a text has three words of its own: no name, unit, number or code."""
    return len(re.findall(r"\b[a-z]{3,}\b", text)) >= 3


@pytest.mark.parametrize("code", OTHERS)
def test_the_page_speaks_it(open_page: Callable[..., Any], code: str, shot: Callable[..., Any]) -> None:
    """Of all sentences no more than one in 25 is still English; units and numbers are the same but for their marks."""
    page = open_page(link(), locale=code)
    said = texts(page)
    shot(page, f"language {code}")
    assert page.evaluate("document.documentElement.lang") == code
    other = open_page(link(), locale="en")
    english = texts(other)
    other.locator("#tab-body").click()
    prose = [text for text in english if is_prose(text)]
    left = [text for text in prose if text in said]
    assert len(prose) > 80
    assert len(left) <= 0.04 * len(prose), left
    page.locator("#tab-body").click()
    marks = str.maketrans(",;", ".,") if code in {"de", "it"} else {}
    assert [[text.translate(marks) for text in row] for row in facts(page).values()] == [*facts(other).values()]


def test_a_page_without_words_does_not_pass(open_page: Callable[..., Any]) -> None:
    """The control: of a page in a language that there is no catalogue of, most sentences are found again in English."""
    prose = [text for text in texts(open_page(link(), locale="en")) if is_prose(text)]
    said = texts(open_page(link(), locale="fr"))
    gone = [text for text in prose if text not in said]
    assert len(gone) < 0.1 * len(prose), gone


def test_a_choice_is_kept_and_english_is_untouched(open_page: Callable[..., Any]) -> None:
    """The language is chosen beside the theme, kept over a reload, and English asks for no catalogue."""
    page = open_page(link(GENTLE), locale="fr")
    assert page.evaluate("document.documentElement.lang") == "en"
    asked = page.evaluate("performance.getEntriesByType('resource').map(each => each.name)")
    assert not any("/words/" in each for each in asked)
    with page.expect_navigation():
        page.get_by_label("Language").select_option("it")
    page.wait_for_selector("main section[data-ready=true]:not([hidden])")
    assert page.locator("#tab-body").inner_text().endswith(page_words("it")["Body"])
    page.reload()
    page.wait_for_selector("main section[data-ready=true]:not([hidden])")
    assert page.locator("#tab-body").inner_text().endswith(page_words("it")["Body"])


def test_only_whole_sentences_are_replaced(open_page: Callable[..., Any]) -> None:
    """A name that somebody typed stays where it is marked so; a sentence of others is not half translated."""
    page = open_page(link(), locale="de")
    made = page.evaluate(
        """async () => {
          const { el } = await import('/app/dom.js');
          const made = [
            el('p', { translate: 'no' }, 'Body'), el('p', {}, 'Body'), el('p', {}, 'from here to there and back'),
          ];
          return made.map((node) => node.textContent);
        }"""
    )
    assert made == ["Body", page_words("de")["Body"], "from here to there and back"]


def test_names_of_users_stay(open_page: Callable[..., Any]) -> None:
    """A project is called as it was called, though the catalogue has those words; what stands beside is German."""
    page = open_page(link(), locale="de")
    name = page.locator(".project-title")
    name.wait_for()
    assert name.inner_text() in page_words("de")
    assert page.locator("#tab-body").inner_text().endswith("Körper")
    page.get_by_test_id("project").click()
    page.locator("#project-rename").fill("Motion")
    page.locator("#project-rename").press("Enter")
    page.get_by_test_id("projects").get_by_role("heading", name="Stände von Motion bisher").wait_for()
    assert page.get_by_test_id("project").get_attribute("aria-label") == "Projekt: Motion"
    page.keyboard.press("Escape")
    page.locator("#tab-body").click()
    body = page.locator("#view-body").get_by_label("Name", exact=True)
    assert body.get_attribute("placeholder") == page_words("de")["optional"]
    body.fill("Motion")
    page.locator("#tab-decide").click()
    section = page.locator("#view-decide")
    section.get_by_role("button", name="Berechnen", exact=True).click()
    section.get_by_role("heading", name="Beurteilung von Motion").wait_for()


NUMBERS = """async () => {
  const { editable, fixed, number, numbers, parseNumber, quantity } = await import('/app/format.js');
  return [number(-1234.5, 5), number(12345.6, 6), number(1.25e-7), number(3), quantity(9.81, 'm/s2'), fixed(-0.25, 1),
    numbers([0.5, 2]), editable(0.5), parseNumber(number(-0.5)), parseNumber('0.5')];
}"""


@pytest.mark.parametrize(
    ("code", "mark", "between"), [("en", ".", ", "), ("de", ",", "; "), ("it", ",", "; "), ("zh", ".", ", ")]
)
def test_numbers_have_the_mark_of_the_language(
    open_page: Callable[..., Any], code: str, mark: str, between: str
) -> None:
    """What is read has the decimal mark of the page's language; what is edited has a point; both are read as typed."""
    assert open_page(link(), locale=code).evaluate(NUMBERS) == [
        f"\u22121234{mark}5", f"12\u202f345{mark}6", f"1{mark}25\u00d710\u207b\u2077", "3", f"9{mark}81\u00a0m/s\u00b2",
        f"\u22120{mark}3", f"0{mark}5{between}2", "0.5", -0.5, 0.5,
    ]  # fmt: skip


def test_dates_speak_it(open_page: Callable[..., Any]) -> None:
    """A date has the form of the page's language, not of the browser's first."""
    page = open_page(link(), locale="fr")
    with page.expect_navigation():
        page.get_by_label("Language").select_option("de")
    date = page.evaluate("import('/app/words.js').then(({ dateTime }) => dateTime('2026-03-01T12:30:00'))")
    assert date == "01.03.2026, 12:30"


def refusal(check: Callable[..., Any], *given: Any, **more: Any) -> Message:
    """Return what is said of a value that is refused."""
    with pytest.raises(InvalidValueError) as told:
        check(*given, **more)
    return told.value.message


def messages_of_the_server() -> list[str]:
    """Return sentences that no script of the page writes, as the server makes them now."""
    responses = {name: response(motion, name) for name, motion in (("ked", GENTLE), ("housner", DECISIVE))}
    agreement = ModelAgreement.of(responses)
    return [
        refusal(checks.within, "coefficient", 5.0, 0.0, 1.0, unit="m", hint="wrong unit?"),
        refusal(checks.length, "width", 2e10),
        refusal(checks.positive, "scale", -1.0),
        refusal(checks.whole, "count", 1.5, 0, 9),
        *of_body(900.0, 9000.0, [1.0]),
        *(one.summary for one in responses.values()),
        agreement.verdict,
        condition([MotionSummary.of(responses["ked"].motion)]),
        contact_sentence(2, 9),
    ]


@pytest.mark.parametrize("code", OTHERS)
def test_sentences_of_the_server_are_said_whole(open_page: Callable[..., Any], code: str) -> None:
    """Verdicts, doubts and refusals leave no English behind; a sentence of others, whole or in part, stays as it is."""
    page = open_page(link(), locale=code)
    made = messages_of_the_server()
    said = page.evaluate(TOLD, [as_message(text).data() for text in made])
    english = r"\b(the|must|be|got|after|with|is|of|and|rocked|overturned|difference|given)\b"
    assert len(made) >= 12
    for text, other in zip(made, said, strict=True):
        assert re.search(english, text, re.IGNORECASE), text
        assert not re.search(english, other, re.IGNORECASE), other
        assert "[object" not in other
    odd = Message("from {length} to there", {"length": Amount(25.0, "m")}, context="nowhere")
    assert page.evaluate(TOLD, [odd.data()]) == ["from 25 m to there"]
    foreign = [
        "from here to there and back", "a stone of ours. It fell; nobody was there.",
        "overturned by the cat; it was a stone of ours.",
    ]  # fmt: skip
    assert page.evaluate(SAID, foreign) == foreign


LIST = """name,width_cm,depth_cm,height_cm,base_width_cm,shape
a,12x,20,30,,
b,130-120,20,30,,
c,20,20,-3,,
d,20,20,30,40,
e,20,20,30,,star
f,20,20
g,20,,30,,
ok,20,20,30,,
"""


@pytest.mark.parametrize("code", OTHERS)
def test_what_the_catalogues_hold_is_said(open_page: Callable[..., Any], served: Any, code: str) -> None:
    """Of models, formats, families and steps, why a row of a list is none, and what buttons of charts are called."""
    info = served.api("info", method="GET")
    made = [one["domain"] for one in info["models"]]
    made += [each for one in info["models"] for each in (*one["assumptions"], *one["known_defects"])]
    made += [one["title"] for one in (*info["formats"], *info["families"])]
    made += [one["origin"] for one in info["families"]]
    steps = [*info["steps"].values(), *info["targets"].values()]
    made += [one["description"] for one in steps] + [
        each["description"] for one in steps for each in one["keys"].values()
    ]
    made += [
        "Choose files",
        "from a file",
        "within the interval",
        "The base is round. The table lists four directions.",
    ]
    made = [text for text in dict.fromkeys(made) if len(re.findall(r"\b[a-z]{2,}\b", text)) >= 2]
    assert len(made) > 110
    page = open_page(link(), locale=code)
    said = page.evaluate(SAID, made)
    assert [text for text, other in zip(made, said, strict=True) if text == other] == []
    helps = [key["description"] for key in info["keys"]["predict"].values()]
    stopped = page.evaluate(STOPPED, helps)
    assert [text for text, other in zip(helps, stopped, strict=True) if text.rstrip(".") in other] == []
    reasons = [one.reason for one in parse_inventory(LIST).not_assessed]
    told = page.evaluate(TOLD, [as_message(reason).data() for reason in reasons])
    assert [text for text, other in zip(map(str, reasons), told, strict=True) if text == other] == []


def test_the_history_of_a_project_speaks_it(open_page: Callable[..., Any]) -> None:
    """What was changed has its words part by part, whatever was changed at once."""
    page = open_page(locale="de")
    page.get_by_label("Höhe").first.fill("3")
    page.locator("#tab-decide").click()
    page.get_by_label("Verfasser").fill("A. Person")
    page.get_by_test_id("project-saved").get_by_text("gespeichert", exact=True).wait_for()
    page.get_by_test_id("project").click()
    states = page.get_by_test_id("projects").locator(".states li")
    states.last.wait_for()
    said = [states.nth(k).locator("span").first.inner_text() for k in range(states.count())]
    assert said[-1] == "begonnen"
    assert {part for each in said[:-1] for part in each.removesuffix(" geändert").split(", ")} == {
        "Körper",
        "Beurteilung",
    }


def test_what_a_chart_reads_out_speaks_it(answered: Callable[..., Any]) -> None:
    """The line of values under a chart has its words one by one, whatever the numbers are."""
    told = answered(locale="de").get_by_test_id("chart-energy").locator(".chart-readout")
    told.get_by_text("Zeit").wait_for()
    said = [re.split(r" \S+\s\S+$", part)[0] for part in told.inner_text().split(" · ")]
    assert said == ["Zeit", "Bewegungsenergie", "Lageenergie", "bei Stößen verloren", "Arbeit des Bodens"]


def test_a_saved_picture_speaks_it(open_page: Callable[..., Any]) -> None:
    """A chart that is drawn for a file, beside the page, has the words of the page; a name that is marked has not."""
    page = open_page(link(), locale="it")
    saved = page.evaluate(
        """async () => {
          const { saveSvg } = await import('/charts/save.js');
          const { svg } = await import('/app/dom.js');
          let blob;
          URL.createObjectURL = (given) => { blob = given; return '#'; };
          saveSvg(svg('svg', {}, svg('text', {}, 'Body'), svg('text', { translate: 'no' }, 'Body')), 'Body');
          return blob.text();
        }"""
    )
    assert re.findall("<text[^>]*>([^<]*)</text>", saved) == [page_words("it")["Body"], "Body"]


WIDER = "document.documentElement.scrollWidth - innerWidth"
CROWDED = """() => [...document.querySelectorAll('[role=tab][data-view]')].filter((tab) => {
  const words = document.createRange();
  words.selectNodeContents(tab);
  const [said, box] = [words, tab].map((each) => each.getBoundingClientRect());
  const sign = parseFloat(getComputedStyle(tab, '::before').width);
  return said.right > box.right + 0.5 || said.left < box.left + sign || tab.scrollWidth > tab.clientWidth;
}).map((tab) => tab.textContent)"""
LONG = """() => document.querySelectorAll('.scene-choice select').forEach((box) => {
  box.add(new Option('Mehrstufiges Schließungsmodell für unebene Grundflächen', 'x', true, true));
})"""


def test_long_words_fit_a_phone(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """In German no step is wider than a phone, no name of a step runs into the next, whatever a choice is called."""
    page = open_page(link(), locale="de", viewport={"width": 320, "height": 800})
    for step in page.locator("[role=tab][data-view]").evaluate_all("tabs => tabs.map(tab => tab.dataset.view)"):
        page.locator(f"#tab-{step}").click()
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        if step in ANSWERED:
            page.locator(ANSWERED[step]).first.wait_for()
        _computed(page, step)
        page.wait_for_load_state("networkidle")
        page.evaluate(LONG)
        for width in (320, 360, 390):
            page.set_viewport_size({"width": width, "height": 800})
            assert page.evaluate(WIDER) <= 0, (step, width)
    for width in (320, 360, 390, 700, 1000, 1350, 1390, 1400):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate(WIDER) <= 0, width
        assert page.evaluate(CROWDED) == [], width
    shot(page, "language de phone")
