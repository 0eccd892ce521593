"""What there is, as a table that prints well on a terminal and in a notebook."""

from collections.abc import Iterator, Mapping
from html import escape
from typing import get_args

from rocking import checks
from rocking.examples.table import EXAMPLES, Example, Kind


class Catalogue(Mapping[str, Example]):
    """Examples by name; it prints as a table.

    Parameters
    ----------
    examples : mapping of str to Example
        What it holds.
    """

    def __init__(self, examples: Mapping[str, Example]) -> None:
        self._examples = dict(examples)

    def __getitem__(self, name: str) -> Example:
        return self._examples[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._examples)

    def __len__(self) -> int:
        return len(self._examples)

    def __repr__(self) -> str:
        rows = [(each.name, each.kind, each.title) for each in self.values()]
        name, kind = (max((len(row[k]) for row in rows), default=0) for k in (0, 1))
        return "\n".join(f"{row[0]:<{name}}  {row[1]:<{kind}}  {row[2]}" for row in rows)

    def _repr_html_(self) -> str:
        rows = [("th", ("name", "kind", "what it is"))]
        rows += [("td", (each.name, each.kind, each.title)) for each in self.values()]
        lines = (
            "".join(f'<{tag} style="text-align: left">{escape(word)}</{tag}>' for word in words) for tag, words in rows
        )
        return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def catalogue(kind: str | None = None) -> Catalogue:
    """Return the examples of the package, or those of one kind.

    Parameters
    ----------
    kind : {"body", "motion", "list", "question", "job"}, optional
        Which ones; all if not given.

    Returns
    -------
    Catalogue
        By name, in the order in which they are shown.

    Raises
    ------
    InvalidValueError
        If there is no such kind.

    Examples
    --------
    >>> catalogue("motion")
    near-fault        motion  one long pulse of velocity, 0.9 m/s in 1.2 s, within ordinary shaking
    far-field         motion  as of magnitude 6.8 at 40 km on firm ground, scaled to 0.35 g
    long              motion  a minute of strong shaking, scaled to 0.35 g
    soft-soil         motion  a soft layer that swings at 0.8 Hz, scaled to 0.35 g
    three-components  motion  motions along x, y and z, scaled to 0.4 g, 0.35 g and 0.2 g upwards
    pulse             motion  a symmetric Ricker wavelet of 0.5 g and 1 s alone
    >>> list(catalogue("body"))
    ['statue', 'stele', 'pier', 'cabinet', 'transformer', 'rack', 'bust', 'column', 'showcase', 'bookshelf', 'cask',
     'drum', 'gravestone', 'barrel']
    """
    kind = None if kind is None else checks.one_of("kind", kind, get_args(Kind))
    return Catalogue({name: each for name, each in EXAMPLES.items() if kind in {None, each.kind}})
