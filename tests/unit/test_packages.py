"""What is built, published and installed: index page, versions, bounds of dependencies, workflow, recipe."""

import json
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

import rocking as rk

ROOT = Path(__file__).parents[2]
ADDRESS = "https://forge.example/rocking"
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
WORKFLOW = yaml.safe_load((ROOT / ".github/workflows/wheels.yml").read_text("utf-8"))
RECIPE = yaml.safe_load((ROOT / "packaging/conda/recipe.yaml").read_text("utf-8"))


def name_of(requirement):
    """Name of what a requirement asks for."""
    return re.match(r"[\w-]+", requirement)[0]


def bounds(requirements):
    """Lower bounds by name, as numbers."""
    found = re.findall(r"^([\w-]+) ?[>=]=\s*([\d.]+)$", "\n".join(requirements), flags=re.MULTILINE)
    return {name: version.removesuffix(".0").removesuffix(".0") for name, version in found}


CORE = PYPROJECT["project"]["dependencies"]
EXTRAS = PYPROJECT["project"]["optional-dependencies"]
FOR_USERS = EXTRAS["all"][0].removeprefix("rocking[").removesuffix("]").split(",")
WORKBENCH = tomllib.loads((ROOT / "workbench/pyproject.toml").read_text("utf-8"))
OF_USERS = [each for name in FOR_USERS for each in EXTRAS[name]] + WORKBENCH["project"]["dependencies"]


# ---- the page of the index ----------------------------------------------------------------------


@pytest.fixture(scope="module")
def metadata(tmp_path_factory):
    """Metadata that the build backend makes, with and without an address of the sources."""

    def made(address):
        folder = tmp_path_factory.mktemp("source")
        text = (ROOT / "pyproject.toml").read_text("utf-8")
        assert text.count('repository = ""') == 1
        (folder / "pyproject.toml").write_text(text.replace('repository = ""', f'repository = "{address}"'), "utf-8")
        shutil.copy(ROOT / "README.md", folder)
        shutil.copytree(ROOT / "packaging", folder / "packaging")
        (folder / "src/rocking").mkdir(parents=True)
        shutil.copy(ROOT / "src/rocking/version.py", folder / "src/rocking")
        words = [sys.executable, "-m", "scikit_build_core.build", "project-table"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    return {address: made(address) for address in ("", ADDRESS)}


class Addresses(HTMLParser):
    """Where pictures and links of a page lead."""

    def __init__(self, html):
        super().__init__()
        self.pictures, self.links = [], []
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        if tag == "img":
            self.pictures.append(found.get("src") or "")
        if tag == "a" and not (found.get("href") or "").startswith("#user-content-"):  # the renderer's, of headings
            self.links.append(found.get("href") or "")


def on_the_index(text):
    """The page as the index renders it: by its own library."""
    from readme_renderer.markdown import render

    html = render(text)
    assert html is not None
    return html


def test_the_index_page_has_nothing_broken(metadata):
    """Without an address of the sources the page has no picture and no relative link; README itself has both."""
    html = on_the_index(metadata[""]["readme"]["text"])
    found = Addresses(html)
    assert found.pictures == []
    assert all(link.startswith("https://") for link in found.links)
    assert "](" not in re.sub(r"<pre.*?</pre>|<code.*?</code>", "", html, flags=re.DOTALL)
    readme = Addresses(on_the_index((ROOT / "README.md").read_text("utf-8")))
    assert readme.pictures
    assert any(not link.startswith("https://") for link in readme.links)


def test_with_an_address_pictures_and_links_are_absolute(metadata):
    """The one setting brings pictures, links of this version and the addresses of the project."""
    found = Addresses(on_the_index(metadata[ADDRESS]["readme"]["text"]))
    tag = f"v{rk.__version__}"
    for prefix, addresses in ((f"{ADDRESS}/raw/{tag}/", found.pictures), (f"{ADDRESS}/blob/{tag}/", found.links)):
        inside = [address.removeprefix(prefix) for address in addresses if address.startswith(prefix)]
        assert inside
        assert all((ROOT / path.partition("#")[0]).exists() for path in inside), inside
    assert all(address.startswith("https://") for address in found.pictures + found.links)
    assert metadata[ADDRESS]["urls"]["Source"] == ADDRESS
    assert metadata[""]["urls"] == {}


@pytest.mark.parametrize(
    ("readme", "page"),
    [
        ("see [the *how*](docs/how.md#a)!", "see the *how*!"),
        ("[![badge](docs/b.svg)](docs/b.md)", ""),
        ('<picture><img src="docs/a.gif" width="3"></picture>', ""),
        ('<a href="docs/a.md">how</a>', "how"),
        ("[there](https://there.example)", "[there](https://there.example)"),
        ("```\nx[0](y)\n```", "```\nx[0](y)\n```"),
    ],
)
def test_what_a_page_keeps_without_addresses(readme, page):
    """Pictures go, relative links become their words, absolute ones and code stay."""
    made = runpy.run_path(str(ROOT / "packaging/index_page.py"))["index_page"]
    assert made(readme, "", "v1") == page


def test_what_a_page_makes_of_an_address():
    """Pictures, links, links to a place of the page and HTML lead to the published sources."""
    made = runpy.run_path(str(ROOT / "packaging/index_page.py"))["index_page"]
    readme = '[![a](b.svg)](c.md) [d](#d) <img src="e.gif"> <a href="f.md">f</a> ![g](https://there.example/g.png)'
    assert made(readme, ADDRESS, "v1") == (
        f"[![a]({ADDRESS}/raw/v1/b.svg)]({ADDRESS}/blob/v1/c.md) [d]({ADDRESS}#d) "
        f'<img src="{ADDRESS}/raw/v1/e.gif"> <a href="{ADDRESS}/blob/v1/f.md">f</a> ![g](https://there.example/g.png)'
    )


# ---- versions, and where they stand ----------------------------------------------------------------


def test_there_is_one_version(metadata):
    """Both distributions, metadata, citation and recipe have the version of the source."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    workbench = WORKBENCH["project"]["version"]
    versions = {metadata[""]["version"], str(citation["version"]), RECIPE["context"]["version"], workbench}
    assert versions == {rk.__version__}
    changes = re.search(r"^## \[(.+?)\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)[1]
    assert changes in {"Unreleased", rk.__version__}


def test_lower_bounds_are_those_that_are_tried():
    """Every lower bound that users meet is what `make oldest` installs, and nothing else is installed there."""
    tried = bounds((ROOT / "requirements/oldest.txt").read_text("utf-8").splitlines())
    asked = bounds(each.split(" #")[0] for each in CORE + OF_USERS if not each.startswith("rocking["))
    assert tried == asked
    assert len(asked) == len([each for each in CORE + OF_USERS if not each.startswith("rocking[")])


def test_the_recipe_asks_for_the_same():
    """The conda recipe has the core's dependencies with their bounds."""
    names = {"matplotlib-base": "matplotlib"}
    asked = {names.get(name, name): least for name, least in bounds(RECIPE["requirements"]["run"]).items()}
    assert asked == bounds(CORE)


# ---- the workflow ------------------------------------------------------------------------------------


def test_every_python_that_is_promised_is_built():
    """Classifiers and cibuildwheel name the same Pythons, from the lowest that the package admits."""
    classifiers = PYPROJECT["project"]["classifiers"]
    promised = [each.rpartition(" ")[2] for each in classifiers if re.search(r":: 3\.\d+$", each)]
    built = PYPROJECT["tool"]["cibuildwheel"]["build"].split()
    assert built == [f"cp{version.replace('.', '')}-*" for version in promised]
    assert PYPROJECT["project"]["requires-python"] == f">={promised[0]}"


def test_the_workflow_publishes_what_it_tried():
    """Every system is there, publication waits for all jobs and a tag, and every action is pinned by its hash."""
    jobs = WORKFLOW["jobs"]
    systems = jobs["wheels"]["strategy"]["matrix"]["system"]
    assert [sum(each.startswith(name) for each in systems) for name in ("ubuntu", "macos", "windows")] == [2, 2, 1]
    assert {*jobs["publish"]["needs"], jobs["workbench"]["needs"]} == set(jobs) - {"publish"}
    assert jobs["publish"]["if"] == "github.ref_type == 'tag'"
    assert jobs["publish"]["permissions"] == {"id-token": "write"}
    for step in [step for job in jobs.values() for step in job["steps"] if "uses" in step]:
        assert re.search(r"@[0-9a-f]{40}$", step["uses"]), step


def test_the_packages_of_the_application_bring_the_manual():
    """They wait for the manual and lay it into the package; only packages are published."""
    jobs = WORKFLOW["jobs"]
    steps = jobs["workbench"]["steps"]
    (fetched,) = [step["with"] for step in steps if "download-artifact" in step.get("uses", "")]
    assert jobs["workbench"]["needs"] == "manual"
    assert fetched["path"] == f"workbench/{WORKBENCH['tool']['scikit-build']['sdist']['include'][0]}"
    for job in (jobs["wheels"], jobs["source"], jobs["workbench"]):
        (kept,) = [step["with"] for step in job["steps"] if "upload-artifact" in step.get("uses", "")]
        assert kept["name"].startswith("dist-")
    (published,) = [step["with"] for step in jobs["publish"]["steps"] if "download-artifact" in step["uses"]]
    assert published["pattern"] == "dist-*"


def test_files_that_the_workflow_names_exist():
    """Scripts of the project that workflow, cibuildwheel and Makefile call are there."""
    callers = (".github/workflows/wheels.yml", "pyproject.toml", "Makefile")
    texts = [(ROOT / path).read_text("utf-8") for path in callers]
    named = set(re.findall(r"(?:packaging|requirements)/[\w./]+\w", "\n".join(texts)))
    assert {"packaging/first_lines.py", "requirements/oldest.txt"} <= named
    assert all((ROOT / path).exists() for path in named), named


# ---- the manual's page on installing -------------------------------------------------------------------


def test_the_manual_gives_each_dependency_its_reason_and_each_extra_its_use():
    """The tables of docs/install.md have the core's dependencies and the extras of users, no more and no fewer."""
    text = (ROOT / "docs/install.md").read_text("utf-8")
    core = re.search(r"<!-- sizes -->(.*)<!-- end of sizes -->", text, re.DOTALL)[1]
    rows = re.findall(r"^\| ([\w-]+) \| ([\d.]+) \| (.+?) \|", core, flags=re.MULTILINE)
    assert [name for name, _, _ in rows] == [*(name_of(each) for each in CORE), "rocking"]
    assert all(len(reason) > 10 for _, _, reason in rows)
    listed = re.findall(r"^\| `(\w+)` \| (.+?) \|(.*?)\|$", text, flags=re.MULTILINE)
    assert {name for name, _, _ in listed} == {*FOR_USERS, "all"}
    for name, _, brings in listed[:-1]:
        packages = {name_of(each) for each in EXTRAS[name] if not each.startswith("rocking[")}
        assert packages <= set(re.findall(r"[\w-]+", brings)), name
