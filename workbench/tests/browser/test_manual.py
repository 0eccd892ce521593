"""The manual as `make docs` builds it: whole, no link broken, its search, under the application's policy."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import quote_plus, unquote, urlsplit

import pytest

ROOT = Path(__file__).parents[3]
MANUAL = ROOT / "build" / "manual"
pytestmark = pytest.mark.manual
PAGES = sorted(MANUAL.rglob("*.html"))
QUESTIONS = {
    "how do I give a centre of mass": "Set the mass, the centre of mass and the inertia",
    "which unit": "Set units",
    "what does ked assume": "Read the assumptions of a model",
    "record format": "Record formats",
    "resume a campaign": "Resume a campaign",
    "center of mass": "Set the mass, the centre of mass and the inertia",  # another spelling
    "draw overturing map": "Compute an overturning map",  # a misspelling
    "which command": "Command line",
    "meaning of margin": "Read the results",
}


class Targets(HTMLParser):
    """The addresses that a page asks for, and the names that others may ask of it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.asked: list[str] = []
        self.names: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.names |= {values[key] for key in ("id", "name") if values.get(key)}
        self.asked += [values[key] for key in ("href", "src") if values.get(key)]


def broken(pages: list[Path]) -> list[str]:
    """Return the links and files that lead nowhere, and those that leave for a script, a picture or a font."""
    targets = {page: Targets(page.read_text("utf-8")) for page in pages}
    faults = []
    for page, target in targets.items():
        for address in target.asked:
            parts = urlsplit(address)
            if parts.scheme or address.startswith("//"):
                continue
            at = (page.parent / unquote(parts.path)).resolve() if parts.path else page.resolve()
            if not at.exists():
                faults.append(f"{page.name}: {address}")
            elif parts.fragment and at in targets and unquote(parts.fragment) not in targets[at].names | {"", "top"}:
                faults.append(f"{page.name}: {address} has no such place")
    return faults


def test_the_manual_is_built():
    assert PAGES, f"there is no manual in {MANUAL}: make docs"


def test_no_link_is_broken():
    assert broken([page.resolve() for page in PAGES]) == []


def test_a_broken_link_is_noticed(tmp_path):
    """Negative control."""
    (tmp_path / "a.html").write_text('<a href="b.html#there">x</a><a href="b.html#not">x</a><img src="none.png">')
    (tmp_path / "b.html").write_text('<p id="there">')
    pages = [(tmp_path / name).resolve() for name in ("a.html", "b.html")]
    assert broken(pages) == ["a.html: b.html#not has no such place", "a.html: none.png"]


def test_every_public_name_is_in_the_reference():
    """What packages export, where they export it or where it is first."""
    sys.path.insert(0, str(ROOT / "docs" / "_ext"))
    from importlib import import_module

    import reference

    described = {
        name for page in (MANUAL / "reference").glob("*.html") for name in Targets(page.read_text("utf-8")).names
    }
    by_value = {}
    for room in reference.ROOMS:
        module = import_module(room)
        for name in reference.names_of(module):
            by_value.setdefault(id(getattr(module, name)), []).append(f"{room}.{name}")
    missing = [names for names in by_value.values() if not described & {*names, *(f"module-{each}" for each in names)}]
    assert len(by_value) > 300
    assert missing == []


@pytest.fixture(scope="module")
def manual(browser, served, new_record):
    """A page of the manual, from the application, and what it does that it must not."""
    context = browser.new_context()
    page, record = context.new_page(), new_record()
    record.watch(page, served.url)
    yield page, f"{served.url}/manual", record
    context.close()


@pytest.mark.parametrize(("question", "answer"), QUESTIONS.items())
def test_the_search_answers(manual, question, answer):
    """Within the first two results."""
    page, address, record = manual
    page.goto(f"{address}/search.html?q={quote_plus(question)}")
    page.wait_for_selector("#search-results li a")
    assert answer in page.locator("#search-results li a").all_inner_texts()[:2]
    assert record.faults == []


def test_the_search_is_reached_from_a_page(manual):
    """Typed into the box of any page; what is not there is said."""
    page, address, record = manual
    page.goto(f"{address}/")
    page.locator(".sidebar-search").fill("xylophone")
    page.keyboard.press("Enter")
    page.wait_for_url("**/search.html?q=xylophone**")
    assert "No result for" in page.inner_text("#search-summary")
    assert record.faults == []


def test_every_page_opens(manual):
    """Under the policy of the application: no script, style or request that it refuses, and nothing from elsewhere."""
    page, address, record = manual
    for path in PAGES:
        page.goto(f"{address}/{path.relative_to(MANUAL).as_posix()}")
        assert page.title()
    assert record.faults == []


def test_the_application_leads_to_it(page):
    page.get_by_role("link", name="Manual").click()
    page.wait_for_url("**/manual/")
    assert page.locator("h1").first.inner_text().startswith("rocking")
