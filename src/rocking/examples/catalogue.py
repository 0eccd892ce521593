"""Catalogue of examples, printed as a table on a terminal and in a notebook."""

from collections.abc import Iterator, Mapping
from html import escape
from typing import get_args

from rocking import checks
from rocking.examples.table import EXAMPLES, Example, Kind


class Catalogue(Mapping[str, Example]):
    """Examples by name, printed as a table.

    Parameters
    ----------
    examples : mapping of str to Example
        Examples of the catalogue.
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
        rows = [(example.name, example.kind, example.title) for example in self.values()]
        name, kind = (max((len(row[k]) for row in rows), default=0) for k in (0, 1))
        return "\n".join(f"{row[0]:<{name}}  {row[1]:<{kind}}  {row[2]}" for row in rows)

    def _repr_html_(self) -> str:
        rows = [("th", ("name", "kind", "title"))]
        rows += [("td", (example.name, example.kind, example.title)) for example in self.values()]
        lines = (
            "".join(f'<{tag} style="text-align: left">{escape(word)}</{tag}>' for word in texts) for tag, texts in rows
        )
        return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def catalogue(kind: str | None = None) -> Catalogue:
    """Return the examples of the package, or those of one kind.

    Parameters
    ----------
    kind : {"body", "motion", "list", "input", "job"}, optional
        Kind of examples; the default is all.

    Returns
    -------
    Catalogue
        Examples by name, in the order of tables.

    Raises
    ------
    InvalidValueError
        If the kind is unknown.

    Examples
    --------
    >>> catalogue("motion")
    near-fault        motion  a long velocity pulse, 0.9 m/s in 1.2 s, in an ordinary motion
    far-field         motion  magnitude 6.8 at 40 km on firm ground, scaled to 0.35 g
    long              motion  one minute of strong motion, scaled to 0.35 g
    soft-soil         motion  a soft layer of 0.8 Hz, scaled to 0.35 g
    three-components  motion  motions along x, y and z, scaled to 0.4 g, 0.35 g and 0.2 g upwards
    pulse             motion  a symmetric Ricker wavelet of 0.5 g and 1 s
    >>> list(catalogue("body"))
    ['statue', 'stele', 'pier', 'cabinet', 'transformer', 'rack', 'bust', 'column', 'showcase', 'bookshelf', 'cask',
     'drum', 'gravestone', 'barrel']
    """
    kind = None if kind is None else checks.one_of("kind", kind, get_args(Kind))
    return Catalogue({name: example for name, example in EXAMPLES.items() if kind in {None, example.kind}})
