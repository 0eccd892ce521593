"""`rocking simulate`: how a body rocks under a record or a pulse, or when let go."""

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import plausibility
from rocking.bodies import Body
from rocking.cli import options
from rocking.cli.exports import Export, Exports, picture
from rocking.cli.page import deliver
from rocking.cli.question import Words, hinted, parsed_sets, typed
from rocking.errors import InvalidValueError
from rocking.spec.document import ResponseDocument, ResponseTable
from rocking.spec.reading import CommandFiles, checked, is_response, located, tables_in
from rocking.spec.response import ResponseJob

if TYPE_CHECKING:
    from rocking.spec.response import ResponseProblem

_TABLES = ("body", "motion", "response", "restitution", "settings")


def _draw(answer: Any) -> Any:
    return answer.draw()


def _animate(answer: Any, path: Path) -> None:
    from rocking.plots.animation import animate_gif, animate_html, slowest_speed

    if path.suffix.lower() == ".html":
        animate_html(answer.response, path)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("frames")
        animate_gif(
            answer.response,
            path,
            speed=slowest_speed(answer.response),
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )


EXPORTS = {
    "picture": picture(_draw),
    "animation": Export((".html", ".gif"), _animate),
    "csv": Export((".csv",), lambda answer, path: answer.response.to_csv(path)),
    "mat": Export((".mat",), lambda answer, path: answer.response.to_mat(path)),
    "netcdf": Export((".nc",), lambda answer, path: answer.response.to_netcdf(path)),
}


def simulate(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    free: Annotated[float | None, options.key(ResponseTable, "free")] = None,
    restitution: options.Restitution = "ked",
    scale: options.Scale = 1.0,
    friction: Annotated[float | None, options.key(ResponseTable, "friction")] = None,
    bounce: Annotated[float | None, options.key(ResponseTable, "bounce")] = None,
    width: options.Width = None,
    height: options.Height = None,
    depth: options.Depth = None,
    density: options.Density = None,
    units: options.Units = None,
    sets: options.Set = None,
    out: Annotated[list[str] | None, options.out(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print how a body rocks under a ground motion, whether it overturns, and whether the model of impact decides."""
    from rocking.cli.responses import answer_of

    exports = Exports.of(out, EXPORTS)
    file = _document(context)
    if file is not None:
        units_typed = ("m", "m/s2")
        with located(str(file)):
            tables = {name: dict(table) for name, table in (tables_in(file) or {}).items() if isinstance(table, dict)}
            for name, keys in parsed_sets(sets, _TABLES).items():
                tables[name] = {**tables.get(name, {}), **keys}
            problem = ResponseJob.of(
                checked(ResponseDocument, {**(tables_in(file) or {}), **tables}), file.parent
            ).problem
    else:
        words = Words(context.params, _TABLES)
        units_typed = words.length or "m", words.acceleration or "m/s2"
        problem = _problem(words, context)
    if problem.mechanics != "rocking" and "animation" in exports.names:
        raise InvalidValueError(f"an animation is of pure rocking only, and this is {problem.mechanics}")
    deliver(answer_of(problem, *units_typed, listed=file is not None), exports, as_json=as_json)


def _document(context: typer.Context) -> Path | None:
    """Return the file that says everything, if the first word is one: TOML with a table [response]."""
    word = context.params.get("body")
    if word is None or not is_response(Path(word)):
        return None
    beside = {"body", "out", "as_json", "sets"}
    if stated := typed(context, [name for name in context.params if name not in beside]):
        raise InvalidValueError(
            f"{word} has a table [response] and says everything itself, so it takes no {', '.join(stated)}; "
            "--set changes a key"
        )
    return Path(word)


def _problem(words: Words, context: typer.Context) -> "ResponseProblem":
    asked, sets = words.options, words.sets
    body, motions = words.body_and_motions()
    free, scale = asked["free"], asked["scale"]
    if free is not None and motions:
        raise InvalidValueError(f"give a motion or --free, not both; got {motions[0][:100]!r}")
    stated = [*typed(context, ["scale"]), *(["--units"] if words.acceleration else [])]
    stated += [f"motion.{key}" for key in sets.get("motion", {})]
    if free is not None and stated:
        raise InvalidValueError(f"--free has no motion, so it takes no {', '.join(stated)}")
    if free is None and not motions and not words.solid:
        raise InvalidValueError(
            "what moves the ground? Give a record file, a pulse such as sine:amplitude=3,period=0.8, or --free 0.5"
        )
    start = {name: asked[name] for name in ("free", "friction", "bounce") if asked[name] is not None}
    with hinted(body, _file_of(motions)):
        tables: dict[str, Any] = {
            "body": words.body_table(body),
            "response": {**start, **sets.get("response", {})},
            "restitution": {"model": asked["restitution"], **sets.get("restitution", {})},
            "settings": sets.get("settings", {}),
        }
        if free is None:
            motion = words.components(motions) if words.solid else words.one_motion(motions)
            tables["motion"] = motion if scale == 1.0 else {**motion, "scale": scale}
        problem = ResponseJob.of(checked(ResponseDocument, tables), CommandFiles(Path())).problem
    if free is not None and isinstance(problem.body, Body):
        _check_share(problem.body, free)
    return problem


def _file_of(motions: list[str]) -> str | None:
    if not motions:
        return None
    axis, equals, rest = motions[0].partition("=")
    return rest if equals and axis in {"x", "y", "z"} else motions[0]


def _check_share(body: Body, free: float) -> None:
    """Refuse, or doubt, what looks like an angle in degrees in place of a share of the slenderness angle."""
    alpha = body.side("right" if free > 0.0 else "left").slenderness_angle
    if abs(free) * alpha >= 0.5 * math.pi:
        raise InvalidValueError(
            f"--free is a share of the slenderness angle, here {math.degrees(alpha):.3g} degrees, and 1 is where the "
            f"body balances; got {free:g}. An angle of {free:g} degrees is --free {math.radians(free) / alpha:.3g}"
        )
    if abs(free) > 1.0:
        plausibility.warn([
            f"let go at {free:g} slenderness angles, beyond where the body balances: it can only fall. An angle of "
            f"{free:g} degrees is --free {math.radians(free) / alpha:.3g}"
        ])  # fmt: skip
