"""Extract the messages of sources and page, update the catalogues, and compile them: `make messages`."""

import ast
import builtins
import html
import io
import re
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

ROOT = Path(__file__).parents[1]
SOURCE, WORKBENCH = ROOT / "src/rocking", ROOT / "workbench/src/rocking_workbench"
FOLDER, PAGE = SOURCE / "language", WORKBENCH / "static"
TEMPLATE = FOLDER / "messages.pot"
DATE = datetime(2000, 1, 1, tzinfo=UTC)  # of every compiled catalogue: files change with their messages alone
HEADER = 'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=UTF-8\\n"\n'
LABEL = (
    r'\b(?:aria-label|title|placeholder|alt|aria-description|aria-valuetext|label|help|caption|lead|text)="([^"\0]*)"'
)
"""Attributes of a template that are read."""
STRING = r'"((?:[^"\\\n]|\\.)*)"'  # of a script

# packages whose errors the page shows
OF_PAGE = {
    "bodies", "checks.py", "decision", "identification", "motions", "restitution", "spec",
    "studies",
}  # fmt: skip
REFUSALS = {"Busy", "NotFound", "Refused"}  # errors without "Error" in their name

Key = tuple[str, str, str]
"""A message: its text, its text where the count is not 1, and its context; the last two may be empty."""


@lru_cache(maxsize=1)
def _nodes(tree: ast.AST) -> list[ast.AST]:
    """Return all nodes of a tree, which several functions read one after the other."""
    return [*ast.walk(tree)]


def messages_of(tree: ast.AST) -> Iterator[Key]:
    """Yield the messages of a module: Message(text, facts, many, context), say(text, many)."""
    for call in _nodes(tree):
        if not isinstance(call, ast.Call) or not call.args:
            continue
        name = getattr(call.func, "id", getattr(call.func, "attr", ""))
        if name not in {"Message", "say"}:
            continue
        named = {keyword.arg: keyword.value for keyword in call.keywords}
        place = 2 if name == "Message" else 1
        many = named.get("many", call.args[place] if len(call.args) > place else None)
        for text in _texts(call.args[0]):
            yield text, next(_texts(many), ""), next(_texts(named.get("context") if name == "Message" else None), "")


def messages_of_errors(tree: ast.AST) -> Iterator[Key]:
    """Yield the messages of the errors of a module: SomeError(text, hint=text)."""
    for call in _nodes(tree):
        if not isinstance(call, ast.Call):
            continue
        name = getattr(call.func, "id", getattr(call.func, "attr", ""))
        if name in REFUSALS or (
            name.endswith("Error") and not name.startswith("Pydantic") and not hasattr(builtins, name)
        ):
            hints = [keyword.value for keyword in call.keywords if keyword.arg == "hint"]
            for node in [*call.args[:1], *hints]:
                yield from ((text, "", "") for text in _texts(node) if text)


def _texts(node: ast.AST | None) -> Iterator[str]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.IfExp):
        yield from (*_texts(node.body), *_texts(node.orelse))


def messages_of_script(text: str) -> Iterator[Key]:
    """Yield the messages of a script of the page: t("text"), t(["text", "text of many"])."""
    for single, first, many in re.findall(rf"\bt\((?:{STRING}|\[{STRING}, {STRING}\])", text):
        yield _unescaped(single or first), _unescaped(many), ""


def literals_of_script(text: str) -> Iterator[str]:
    """Yield the strings of a script or page, those put together with + as one, and the texts between its tags."""
    for string in re.findall(STRING, re.sub(r'"\s*\+\s*"', "", text)):
        yield _unescaped(string)
    for fragment in re.findall(r"[>}`]([^<>{}`$]+)(?=[<$`])", text):
        yield html.unescape(_unescaped(" ".join(fragment.split())))


def _unescaped(string: str) -> str:
    return (
        re.sub(r"\\u([0-9a-f]{4})", lambda code: chr(int(code[1], 16)), string).replace('\\"', '"').replace("\\n", "\n")
    )


LETTERS = {"ₚ": "_p", "\N{GREEK SMALL LETTER ALPHA}": "alpha", "π": "pi", "ω": "omega", "`": "", "_": " ", "-": " "}
"""Letters of the page by the words of the server."""


def texts_of_templates(script: str) -> Iterator[str]:
    """Yield the texts of the templates html`...` of a script: between tags and expressions, and labels of elements."""
    for start in re.finditer(r"\bhtml`", script):
        text, _ = _template(script, start.end())
        for label in re.findall(LABEL, text):
            yield " ".join(_unescaped(label).split())
        for fragment in re.split(r"<[^>]*>|\0", text):
            yield " ".join(_unescaped(fragment).split())


def _template(script: str, at: int) -> tuple[str, int]:
    """Return a template from a position, a zero in the place of each expression, and the position of its end."""
    text = ""
    while script[at] != "`":
        if script.startswith("${", at):
            text, at = text + "\0", _after_expression(script, at + 2)
        else:
            text, at = text + script[at], at + 1
    return text, at


def _after_expression(script: str, at: int) -> int:
    depth = 1
    while depth:
        if script[at] == "`":
            at = _template(script, at + 1)[1]
        elif string := re.compile(STRING).match(script, at):
            at = string.end() - 1
        depth += {"{": 1, "}": -1}.get(script[at], 0)
        at += 1
    return at


def plain(text: str) -> str:
    """Return a text as sources have it: no unit, no capitals, no marks at its ends, letters in words, no dashes."""
    text = re.sub(r"\s\[[^]]*\]", "", text)
    for letter, word in LETTERS.items():
        text = text.replace(letter, word)
    return " ".join(text.split()).strip(" .,:;").lower()


def names_of(tree: ast.AST) -> Iterator[str]:
    """Yield the names of fields and parameters of a module, which doors spell with spaces."""
    for node in _nodes(tree):
        if isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id


def descriptions_of(tree: ast.AST) -> Iterator[str]:
    """Yield the descriptions of a module: its docstrings' sentences and parameters, which the server sends."""
    for node in _nodes(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and (text := ast.get_docstring(node)):
            for section in re.split(r"\n\s*\n|\n(?=\w[\w, ]* : )", text):
                body = section.partition("\n    ")[2] or section
                yield from (sentence.removeprefix("Return ") for sentence in (body, *re.split(r"(?<=\.)\s", body)))


@lru_cache(maxsize=1)
def extracted() -> tuple[set[Key], set[str]]:
    """Return the messages of all sources, and every literal in them as `plain`, by which a message may be used."""
    messages, literals = set(), set()
    for path in [*SOURCE.rglob("*.py"), *WORKBENCH.rglob("*.py")]:
        tree = ast.parse(path.read_text("utf-8"))
        messages.update(messages_of(tree))
        if path.is_relative_to(WORKBENCH) or path.relative_to(SOURCE).parts[0] in OF_PAGE:
            messages.update(messages_of_errors(tree))
        literals.update((*names_of(tree), *descriptions_of(tree)))
        literals.update(
            node.value for node in _nodes(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
        )
    for path in [*PAGE.rglob("*.js"), *PAGE.rglob("*.html")]:
        if "vendor" not in path.parts:
            text = path.read_text("utf-8")
            messages.update(messages_of_script(text))
            literals.update(literals_of_script(text))
    return messages, {plain(literal) for literal in literals}


def unused() -> set[Key]:
    """Return the messages of the template that no source states."""
    messages, literals = extracted()
    return {key for key in keys(read(TEMPLATE)) - messages if key[2] or plain(key[0]) not in literals}


def keys(catalogue: Catalog) -> set[Key]:
    """Return the messages of a catalogue."""
    pairs = [(message, message.id) for message in catalogue if message.id]
    return {(*(text if isinstance(text, tuple) else (text, "")), message.context or "") for message, text in pairs}


def untranslated(catalogue: Catalog) -> list[str]:
    """Return the English texts of messages that have no translation."""
    forms = ((message, message.string) for message in catalogue if message.id)
    return [str(message.id) for message, form in forms if not all(form if isinstance(form, tuple) else [form])]


def read(path: Path, code: str | None = None) -> Catalog:
    """Return a catalogue, or the template."""
    with path.open("rb") as file:
        return read_po(file, locale=code)


def catalogues() -> dict[str, Catalog]:
    """Return the catalogues by the codes of their languages."""
    return {path.stem: read(path, path.stem) for path in sorted(FOLDER.glob("*.po"))}


def write(path: Path, catalogue: Catalog) -> None:
    """Write a catalogue, or the template, sorted by its messages."""
    for message in catalogue:
        message.flags -= {"python-format"}  # "95 % interval" is none
    text = io.BytesIO()
    write_po(text, catalogue, width=0, sort_output=True, omit_header=True, include_lineno=False)
    plurals = f'"Plural-Forms: {catalogue.plural_forms}\\n"\n' if catalogue.locale else ""
    path.write_text(f"{HEADER}{plurals}\n{text.getvalue().decode()}", "utf-8")


def compiled(catalogue: Catalog) -> bytes:
    """Return a catalogue as the standard library reads it."""
    catalogue.creation_date = catalogue.revision_date = DATE
    file = io.BytesIO()
    write_mo(file, catalogue)
    return file.getvalue()


def main() -> None:
    """Add new messages to the template, and bring the catalogues to the same messages."""
    template = read(TEMPLATE)
    for text, many, context in extracted()[0]:
        template.add((text, many) if many else text, context=context or None)
    write(TEMPLATE, template)
    for code, catalogue in catalogues().items():
        before = keys(catalogue)
        catalogue.update(template, no_fuzzy_matching=True)
        catalogue.obsolete.clear()
        write(FOLDER / f"{code}.po", catalogue)
        (FOLDER / f"{code}.mo").write_bytes(compiled(catalogue))
        new, empty = keys(catalogue) - before, untranslated(catalogue)
        print(f"{code}: {len(catalogue)} messages, {len(new)} new, {len(empty)} without translation")
    print(f"{len(unused())} messages are stated nowhere")


if __name__ == "__main__":
    main()
