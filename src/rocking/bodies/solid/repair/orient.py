"""Consistent orientation of the faces of each connected piece."""

import numpy as np

from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.triangles import connected, neighbours
from rocking.conventions import BoolArray, IntArray
from rocking.messages import Message


def orient_faces(faces: IntArray, log: RepairLog) -> IntArray:
    """Return consistently oriented faces; in each connected piece, the smaller group of faces is reversed."""
    first, second, disagree = neighbours(faces)
    labels = connected(len(faces), first, second)
    flip = _parities(len(faces), first, second, disagree)
    minority = np.bincount(labels, weights=flip) > 0.5 * np.bincount(labels)
    turn = flip != minority[labels]
    if turn.any():
        log.add_repair(
            Message(
                "reversed {turned} of {faces} faces with an orientation opposite to their neighbours",
                {"turned": int(turn.sum()), "faces": len(faces)},
            )
        )
    return np.where(turn[:, None], faces[:, ::-1], faces)


def _parities(count: int, first: IntArray, second: IntArray, disagree: BoolArray) -> BoolArray:
    """Return True for faces with an orientation opposite to the first face of their piece, along a spanning tree."""
    # The graph has two nodes per face, original and reversed. Links connect consistent orientations of neighbours.
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    weights = np.where(disagree, 2.0, 1.0)
    tree = minimum_spanning_tree(coo_matrix((weights, (first, second)), shape=(count, count))).tocoo()
    parent, child, swapped = tree.row.astype(np.int64), tree.col.astype(np.int64), count * (tree.data > 1.5)
    sides = connected(2 * count, np.append(parent, parent + count), np.append(child + swapped, child + count - swapped))
    _, roots, piece = np.unique(connected(count, parent, child), return_index=True, return_inverse=True)
    differs: BoolArray = sides[:count] != sides[roots][piece]
    return differs
