"""Attacks by what a request holds, from somebody who is signed in or whom it tricks: refused, or inert."""

import csv
import io
import json
import os
import re
import tomllib
import zipfile

import pytest
from web_clients import new_application, script_of

pytestmark = pytest.mark.verifies("damage", room="doors")

BLOCK = {"units": "m", "width": 1.0, "height": 4.0}
SINE = {"pulse": "sine:amplitude=3,period=0.8"}
GOOD = {"body": BLOCK, "motion": SINE, "restitution": {"models": ["ked"]}}
REFUSED = range(400, 500)


@pytest.fixture(scope="module")
def secret(tmp_path_factory):
    """Return a file that nobody may read through the application; it would be a body, a record or a model."""
    path = tmp_path_factory.mktemp("secret") / "secret.py"
    marker = path.with_suffix(".ran").as_posix()
    path.write_text(f"import pathlib\nTOPSECRET = pathlib.Path({marker!r}).touch()\nclass Model: ...\n")
    return path


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    return script_of(new_application(tmp_path_factory.mktemp("data")))


def job(**tables):
    campaign = {"name": "attack", "kind": "histories"}
    return {"name": "attack", "job": {"campaign": campaign, "body": BLOCK, "motions": SINE, **tables}}


def region(**source):
    return {"units": "m", "section": {"region": [source]}}


PLACES = {
    "absolute path": "{secret}",
    "path by dots": "../../../../../..{secret}",
    "path in the data folder": "api-key",
    "file address": "file://{secret}",
    "web address": "http://127.0.0.1:1/record.csv",
    "cloud address": "http://169.254.169.254/latest/meta-data/",
    "network share": "\\\\127.0.0.1\\share\\record.csv",
    "device": "/dev/zero",
    "pipe": "|cat /etc/passwd",
    "hash and dots": "a" * 64 + "/../../api-key",
    "hash in capitals": "A" * 64,
    "hash and a line": "a" * 64 + "\n",
    "hash that nobody uploaded": "a" * 64,
}
READERS = {
    "record of a motion": ("/api/motion", lambda word: {"motion": {"record": word}}),
    "record of a response": ("/api/response", lambda word: {**GOOD, "motion": {"record": word}}),
    "record of a table": ("/api/table/motion.csv", lambda word: {**GOOD, "motion": {"record": word}}),
    "record of a bundle": ("/api/inputs.zip", lambda word: {**GOOD, "motion": {"record": word}}),
    "record of a study": ("/api/studies", lambda word: job(motions={"records": [word]})),
    "file of a body": ("/api/body", lambda word: {"body": {"units": "m", "file": word}}),
    "drawing of a body": ("/api/body", lambda word: {"body": region(dxf=word)}),
    "map of a body": ("/api/impact", lambda word: {"body": region(geojson=word)}),
    "text of a body": ("/api/response", lambda word: {**GOOD, "body": region(wkt=word)}),
    "file of a study's body": ("/api/studies", lambda word: job(body={"file": word})),
    "drawing of a study's body": ("/api/studies", lambda word: job(body=region(dxf=word))),
    "body of a study by name": ("/api/studies", lambda word: job(body=word)),
    "model": ("/api/response", lambda word: {**GOOD, "restitution": {"model": f"{word}:Model"}}),
    "model of a study": ("/api/studies", lambda word: job(restitution={"model": f"{word}:Model"})),
    "format of a record": ("/api/motion", lambda word: {"motion": {"record": "a" * 64, "format": word}}),
    "pulse": ("/api/motion", lambda word: {"motion": {"pulse": word}}),
    "family": ("/api/motion", lambda word: {"motion": {"synthetic": word}}),
}


@pytest.mark.verifies(control="test_secret_would_be_opened_elsewhere")
@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("place", PLACES)
def test_no_word_opens_a_file(client, secret, reader, place):
    """No path, address or module in any place of a document is opened, read, fetched or run."""
    path, document = READERS[reader]
    answer = client.post(path, json=document(PLACES[place].replace("{secret}", str(secret))))
    assert answer.status_code in REFUSED
    assert "TOPSECRET" not in answer.text
    assert "Traceback" not in answer.text
    assert not secret.with_suffix(".ran").exists()


@pytest.mark.verifies("negative control", "the command line, which is the user's own")
def test_secret_would_be_opened_elsewhere(secret, tmp_path):
    """Negative control: on the command line, which is the user's own, the same words open files."""
    from rocking.bodies.formats import read_body
    from rocking.cli.restitution import _model

    drawing = secret.with_name("body.wkt")
    drawing.write_text("POLYGON ((0 0, 1 0, 1 4, 0 4, 0 0))")
    assert read_body(drawing, units="m", density=1.0)
    with pytest.raises(Exception, match=r"Model|model"):
        _model(f"{secret}:Model")
    assert secret.with_suffix(".ran").exists()
    secret.with_suffix(".ran").unlink()


NUMBERS = {
    "width of infinity": ("/api/body", '{"body": {"units": "m", "width": Infinity, "height": 1}}'),
    "width of 1e999": ("/api/body", '{"body": {"units": "m", "width": 1e999, "height": 1}}'),
    "width of NaN": ("/api/body", '{"body": {"units": "m", "width": NaN, "height": 1}}'),
    "width as text": ("/api/body", {"body": {**BLOCK, "width": "1"}}),
    "width as yes": ("/api/body", {"body": {**BLOCK, "width": True}}),
    "width twice": ("/api/body", '{"body": {"units": "m", "width": 1, "width": 2, "height": 1}}'),
    "width of 400 digits": ("/api/body", '{"body": {"units": "m", "width": 1' + "0" * 400 + ', "height": 1}}'),
    "width of 1e308": ("/api/impact", {"body": {**BLOCK, "width": 1e308}}),
    "width of nothing": ("/api/impact", {"body": {**BLOCK, "width": 5e-324}}),
    "polygon without end": ("/api/body", {"body": {"units": "m", "regular_polygon": {"sides": 10**9, "radius": 1.0}}}),
    "brackets without end": ("/api/body", {"body": region(wkt="POLYGON" + "(" * 100_000)}),
    "steps without end": ("/api/response", {**GOOD, "settings": {"longest_step": 1e-12}}),
    "gravity of nothing": ("/api/response", {**GOOD, "settings": {"gravity": 1e-300}}),
    "order of a billion": ("/api/response", {**GOOD, "settings": {"order": 10**9}}),
    "scale of 1e300": ("/api/response", {**GOOD, "motion": {**SINE, "scale": 1e300}}),
    "pulse of a nanosecond": ("/api/motion", {"motion": {"pulse": "sine:amplitude=3,period=1e-9"}}),
    "pulse of nan": ("/api/motion", {"motion": {"pulse": "sine:amplitude=nan,period=1"}}),
    "samples of a nanosecond": ("/api/motion", {"motion": {"synthetic": "pulse-like", "time_step": 1e-9}}),
    "member of a billion": ("/api/motion", {"motion": {"synthetic": "pulse-like", "member": 10**9}}),
    "points of a billion": ("/api/response", {**GOOD, "points": 10**9}),
    "points below nothing": ("/api/response", {**GOOD, "points": -1}),
    "models without end": ("/api/response", {**GOOD, "restitution": {"models": ["ked"] * 2000}}),
    "rotation of 1e308": ("/api/response", {**GOOD, "motion": None, "response": {"initial_rotation": 1e308}}),
    "study of ten million": ("/api/studies", job(motions={"synthetic": "pulse-like", "count": 10_000_000})),
    "chunk of a billion": ("/api/studies", job(campaign={"name": "a", "kind": "histories", "chunk": 10**9})),
    "key of nobody": ("/api/body", {"body": {**BLOCK, "__class__": "x"}}),
    "prototype": ("/api/response", {**GOOD, "__proto__": {"signed_in": True}}),
    "list for a table": ("/api/response", [GOOD]),
    "text for a table": ("/api/response", '"body"'),
    "nothing": ("/api/response", "null"),
    "deep table": ("/api/response", '{"body":' * 500 + "1" + "}" * 500),
    "NUL in a name": ("/api/body", {"body": {**BLOCK, "name": "a\0b"}}),
    "a lone surrogate": ("/api/body", '{"body": {"units": "m", "width": 1, "height": 4, "name": "\\ud800"}}'),
    "JSON in a file": ("/api/inputs/read", b'{"body": 1}'),
    "bomb in a record": ("/api/records?name=bomb.gz", b"\x1f\x8b\x08\x00" + b"\x00" * 1000),
    "archive for a record": ("/api/records?name=a.zip", b"PK\x03\x04" + b"\x00" * 1000),
    "nothing for a record": ("/api/records?name=a.at2", b""),
    "entities in a drawing": ("/api/body/file?name=a.dxf&units=m", b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]>'),
    "body file that names a file": ("/api/body/file?name=a.toml", b'units="m"\n[[section.region]]\ndxf="/etc"\n'),
    "inputs that name a file": ("/api/inputs/read", b'[body]\nfile = "/etc/passwd"\n'),
    "TOML without end": ("/api/body/file?name=a.toml", b"a=" + b"[" * 100_000),
    "GeoJSON without end": ("/api/body/file?name=a.geojson&units=m", b'{"coordinates":' + b"[" * 100_000),
}  # fmt: skip


@pytest.mark.parametrize("name", NUMBERS)
def test_senseless_content_is_refused(client, name):
    """Numbers, tables and files that mean no good are refused in one sentence."""
    path, content = NUMBERS[name]
    if isinstance(content, bytes):
        answer = client.post(path, content=content, headers={"Content-Type": "application/octet-stream"})
    else:
        text = content if isinstance(content, str) else json.dumps(content)
        answer = client.post(path, content=text, headers={"Content-Type": "application/json"})
    assert answer.status_code in REFUSED
    assert answer.json()["error"]["message"]
    assert len(answer.text) < 1000
    assert "Traceback" not in answer.text


NAMES = {
    "formula": "=cmd|' /C calc'!A0",
    "plus": "+1+cmd|'x'!A1",
    "at": "@SUM(1+1)*cmd|'x'!A1",
    "tab before a formula": "\t=1+1",
    "new line before a formula": "\r\n=HYPERLINK(\"http://evil.example\")",
    "script": "<script>alert(1)</script>",
    "image": '"><img src=x onerror=alert(1)>',
    "SVG": "<svg onload=alert(1)><a href='javascript:alert(1)'>",
    "end of CDATA": "]]><script>alert(1)</script>",
    "entity": "&xxe;&#60;script&#62;",
    "template": "{{7*7}}${7*7}#{7*7}<%= 7*7 %>",
    "typesetting": '#read("/etc/passwd") $x$ *b* @ref \\',
    "mathematics of a picture": "$\\frac{1}{0}$ $\\input{/etc/passwd}$ $",
    "dots": "../../../../etc/cron.d/evil",
    "device": "CON",
    "header": 'a"\r\nSet-Cookie: rocking-8765=x\r\n\r\n<html>',
    "written backwards": "report\u202egpj.exe",
    "shell": "$(touch /tmp/evil); `id`; rm -rf ~",
    "TOML": '"\n[settings]\ngravity = 1.0\n#',
    "style": "</style><style>*{background:url(http://evil.example)}",
    "very long": "x" * 500,
}  # fmt: skip
EXPORTS = [
    "table/coefficients.csv", "table/body.csv", "table/coefficients.xlsx", "inputs.toml", "inputs.zip",
    "animation.html", "report.pdf",
]  # fmt: skip


SLOW = {
    "report.pdf": ("typesetting", "SVG", "mathematics of a picture"),
    "animation.html": ("script", "end of CDATA", "style"),
}  # fmt: skip
"""Tried with the names that could do something there; with ROCKING_CAMPAIGN=1 with all."""


def inert_csv(text):
    for row in csv.reader(io.StringIO(text.removeprefix("\ufeff"))):
        for cell in row:
            assert not re.match(r"[=+@\t\r]|-(?![\d.])", cell), cell


def inert(kind, data, name):
    """Assert that a file does nothing when it is opened."""
    if kind == "csv":
        inert_csv(data.decode("utf-8"))
    elif kind == "toml":
        assert "gravity" not in tomllib.loads(data.decode()).get("settings", {})
    elif kind == "zip":
        with zipfile.ZipFile(io.BytesIO(data)) as bundle:
            assert all(re.fullmatch(r"[A-Za-z0-9._-]{1,80}", each) for each in bundle.namelist())
    elif kind == "html":
        text = data.decode("utf-8").lower()
        assert "<script>alert" not in text
        assert "<img" not in text
        assert "<svg onload" not in text
        assert "</style><style>" not in text
    elif kind == "xlsx":
        import openpyxl

        for sheet in openpyxl.load_workbook(io.BytesIO(data)):
            assert not [cell for row in sheet.iter_rows() for cell in row if cell.data_type == "f"], name


@pytest.mark.verifies(control="test_the_judge_sees_what_is_not_inert")
@pytest.mark.parametrize("export", EXPORTS)
def test_hostile_names_are_inert(client, export):
    """No name of a body does anything in any export, nor to the name of the file and its head; or it is refused."""
    made = 0
    every = os.environ.get("ROCKING_CAMPAIGN") == "1"
    names = [NAMES[name] for name in (NAMES if every else SLOW.get(export, NAMES))]
    for name in names:
        answer = client.post(f"/api/{export}", json={**GOOD, "body": {**BLOCK, "name": name}})
        assert answer.status_code in {200, 422}, (name, answer.text[:300])
        assert "Set-Cookie" not in answer.headers
        if answer.status_code != 200:
            continue
        made += 1
        assert re.fullmatch(r'attachment; filename="[A-Za-z0-9._-]{1,80}"', answer.headers["Content-Disposition"])
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        inert(export.rpartition(".")[2], answer.content, name)
    assert made > len(names) / 2


@pytest.mark.verifies("negative control", "names pasted as they are")
@pytest.mark.parametrize("kind", ["csv", "html", "toml"])
def test_the_judge_sees_what_is_not_inert(kind):
    """Negative control: files in which a name was pasted as it is do not pass."""
    pasted = {
        "csv": NAMES["formula"].encode(),
        "html": f"<p>{NAMES['script']}</p>".encode(),
        "toml": f'[body]\nname = "{NAMES["TOML"]}'.encode(),
    }
    with pytest.raises(AssertionError):
        inert(kind, pasted[kind], "")


@pytest.mark.parametrize("name", NAMES)
def test_hostile_file_names_are_not_kept(client, name):
    """A record under a hostile name is kept by its hash, and its name is shown as plain letters."""
    record = b"time [s],acceleration [m/s2]\n" + b"".join(b"%g,%g\n" % (0.01 * i, i % 5) for i in range(200))
    head = {"Content-Type": "application/octet-stream"}
    answer = client.post("/api/records", params={"name": NAMES[name]}, content=record, headers=head)
    assert answer.status_code in {200, 414, 422}
    if answer.status_code == 200:
        assert re.fullmatch(r"[A-Za-z0-9._-]{1,80}", answer.json()["file_name"])
        assert re.fullmatch(r"[0-9a-f]{64}", answer.json()["record"])


@pytest.mark.verifies("behaviour")
def test_there_are_enough():
    """Places times readers, numbers, names: more than a hundred attacks, each with a name."""
    assert len(PLACES) * len(READERS) + len(NUMBERS) + len(NAMES) >= 250
