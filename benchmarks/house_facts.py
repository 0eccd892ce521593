"""Facts that are stated more than once: keys of answers, widths of a body, sentences that are read, names of modules.

All counts are of syntax trees; those of scripts are of their text.
"""

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

_ANSWERS = {"Answer", "AnswerRows"}
_METHODS = {"answer", "outcome_answer", "_values", "_last_state", "_tables"}
# what takes a sentence apart, and results and errors that are sentences
_SPLITS = {
    "partition", "rpartition", "split", "rsplit", "startswith", "endswith", "removeprefix", "removesuffix", "match",
    "search", "fullmatch", "findall", "sub",
}  # fmt: skip
_SENTENCES = {
    "assumed", "not_sampled", "warnings", "doubts", "sentences", "verdict", "summary", "message", "advice", "notes",
}  # fmt: skip
_SIZES = {"width", "height"}


@cache
def nodes(tree: ast.AST) -> list[ast.AST]:
    """Return all nodes of a module, which many functions read one after the other."""
    return [*ast.walk(tree)]


def last_name(node: ast.AST) -> str:
    """Return the last name of an expression such as ``a.b``."""
    return str(getattr(node, "attr", getattr(node, "id", "")))


def keys_of_answers(trees: Mapping[str, ast.Module]) -> dict[str, str]:
    """Return the keys that are typed in answers, each with one place: module and line."""
    keys = {}
    for name, tree in trees.items():
        for node in nodes(tree):
            is_call = isinstance(node, ast.Call) and last_name(node.func) in _ANSWERS
            if is_call or (isinstance(node, ast.FunctionDef) and node.name in _METHODS):
                keys |= {key.value: f"{name}:{key.lineno}" for key in _keys(node)}
    return keys


def _keys(node: ast.AST) -> Iterator[ast.Constant]:
    for child in ast.walk(node):
        if isinstance(child, ast.Dict):
            yield from (key for key in child.keys if isinstance(key, ast.Constant) and isinstance(key.value, str))


def sentences_read(trees: Mapping[str, ast.Module]) -> list[str]:
    """Return where a sentence of a result or an error is taken apart, or searched by a regular expression.

    Sentences of errors of other libraries, as far as a handler names them, are none of ours.
    """
    own = {node.name for tree in trees.values() for node in nodes(tree) if isinstance(node, ast.ClassDef)}
    return [
        f"{name}:{call.lineno}"
        for name, tree in trees.items()
        for foreign in [_foreign(tree, own)]
        for spoken, child in _spoken(tree)
        for call in ast.walk(child)
        if isinstance(call, ast.Call) and id(call) not in foreign
        and last_name(call.func) in _SPLITS and _reads(call, spoken)
    ]  # fmt: skip


def _foreign(tree: ast.AST, own: set[str]) -> set[int]:
    """Return the nodes in which an error is handled, or taken, that is not stated to be of a class of ours."""
    kinds = [(node, node.type) for node in nodes(tree) if isinstance(node, ast.ExceptHandler)]
    functions = [node for node in nodes(tree) if isinstance(node, ast.FunctionDef)]
    kinds += [
        (node, argument.annotation) for node in functions for argument in node.args.args if argument.arg == "error"
    ]
    return {
        id(inner)
        for node, kind in kinds if kind is not None and not own & {last_name(child) for child in ast.walk(kind)}
        for inner in ast.walk(node)
    }  # fmt: skip


def _spoken(tree: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """Yield the names of sentences with their code: variables over lists of sentences, caught errors.

    An empty name means an explicit expression, such as ``result.verdict`` or ``str(error)``.
    """
    yield "", tree
    for node in nodes(tree):
        loops = (
            node.generators if isinstance(node, ast.GeneratorExp | ast.ListComp | ast.SetComp | ast.DictComp) else ()
        )
        for loop in (*loops, *([node] if isinstance(node, ast.For) else [])):
            if isinstance(loop.iter, ast.Attribute) and loop.iter.attr in _SENTENCES:
                yield last_name(loop.target), node


def _reads(call: ast.Call, spoken: str) -> bool:
    texts = [call.func.value, *call.args] if isinstance(call.func, ast.Attribute) else call.args
    return any(_is_sentence(text, spoken) for text in texts)


def _is_sentence(text: ast.AST, spoken: str) -> bool:
    if spoken:
        return last_name(text) == spoken
    if isinstance(text, ast.Call) and last_name(text.func) == "str" and text.args:
        return "error" in last_name(text.args[0])
    return isinstance(text, ast.Attribute) and text.attr in _SENTENCES


def modules_named(trees: Mapping[str, ast.Module]) -> list[str]:
    """Return strings that name a module of ours, or from which such a name is made and imported.

    A name after ``-m`` starts a process, and one of ``getLogger`` is that of a log.
    """
    locations = []
    for name, tree in trees.items():
        started = {
            id(after) for node in nodes(tree) if isinstance(node, ast.List)
            for before, after in zip(node.elts, node.elts[1:], strict=False)
            if isinstance(before, ast.Constant) and before.value == "-m"
        }  # fmt: skip
        logs = [node for node in nodes(tree) if isinstance(node, ast.Call) and last_name(node.func) == "getLogger"]
        started |= {id(argument) for node in logs for argument in node.args}
        for node in nodes(tree):
            is_name = isinstance(node, ast.Constant) and "." in str(node.value) and node.value in trees
            is_import = (
                isinstance(node, ast.Call) and last_name(node.func) == "import_module" and _is_ours(node.args[0])
            )
            if (is_name and id(node) not in started) or is_import:
                locations.append(f"{name}:{node.lineno}")
    return locations


def _is_ours(argument: ast.AST) -> bool:
    """Return whether the name of a module is put together from a package of ours."""
    parts = argument.values if isinstance(argument, ast.JoinedStr) else []
    return any(
        "rocking." in str(getattr(argument, "value", "")) or "__package__" in ast.dump(argument) for argument in parts
    )


def widths(trees: Mapping[str, ast.Module], scripts: Iterable[Path]) -> list[str]:
    """Return the modules and scripts that declare the width of a block.

    That is a class with the fields, a table or a list of five keys or more, or an option of a command, of width and
    height; the tables of the page list names with labels or units. Values of a block, sides of an object alone and
    pictures are no declarations.
    """
    drawn = {name for name in trees if ".plots." in name}
    names = [name for name, tree in trees.items() if name not in drawn and any(map(_declares, nodes(tree)))]
    listed = re.compile(r"""\["width", "|"width", "height",""")
    kept = [path for path in scripts if path.parent.name not in {"charts", "drawing"}]
    return names + [path.name for path in kept if listed.search(path.read_text("utf-8"))]


def _declares(node: ast.AST) -> bool:
    if isinstance(node, ast.ClassDef):
        return {
            last_name(statement.target) for statement in node.body if isinstance(statement, ast.AnnAssign)
        } >= _SIZES
    if isinstance(node, ast.arguments):
        options = {
            argument.arg
            for argument in (*node.args, *node.kwonlyargs)
            if "Option" in ast.dump(argument.annotation or argument)
        }
        return options >= _SIZES
    if isinstance(node, ast.Dict):
        pairs = zip(node.keys, node.values, strict=True)
        described = {getattr(key, "value", None) for key, value in pairs if _is_described(value)}
        return described >= _SIZES
    if isinstance(node, ast.Tuple | ast.Set | ast.List):
        names = [getattr(element, "value", None) for element in node.elts]
        return set(names) >= _SIZES and len(names) > 4
    return False


def _is_described(value: ast.AST) -> bool:
    is_text = isinstance(value, ast.Constant) and isinstance(value.value, str)
    return is_text or isinstance(value, ast.Call | ast.Tuple | ast.Dict)
