"""Scans as they come: a body of known shape, and what scanners, programs and people do to its surface."""

import numpy as np

HEIGHT = 0.9


def statue(rings=40, around=48):
    """An asymmetric standing figure: leaning rings of no symmetry with a lump at one side.

    Returns vertices [m], faces of the sides and top, faces of the bottom; its base lies on z = 0.
    """
    share = np.arange(rings) / rings
    angle = 2.0 * np.pi * np.arange(around) / around
    profile = 0.16 * (1.0 - 0.55 * share + 0.25 * np.sin(7.0 * share) ** 2 * (1.0 - share))
    lump = 0.3 * np.exp(-((angle - 1.0) ** 2) / 0.3 - (share[:, None] - 0.5) ** 2 / 0.02)
    radius = profile[:, None] * (1.0 + lump + 0.1 * np.cos(2.0 * angle))
    x = 0.05 * share[:, None] ** 2 + radius * np.cos(angle)
    y = -0.03 * share[:, None] + radius * np.sin(angle)
    z = np.broadcast_to(HEIGHT * share[:, None], x.shape)
    side = np.stack([x, y, z], axis=-1)
    ends = np.array([side[-1].mean(axis=0), side[0].mean(axis=0)])
    ends[0, 2] += 0.02
    vertices = np.concatenate([side.reshape(-1, 3), ends])
    a = np.arange(around * (rings - 1)).reshape(rings - 1, around)
    b = np.roll(a, -1, axis=1)
    first = np.stack([a, b, b + around], axis=-1).reshape(-1, 3)
    second = np.stack([a, b + around, a + around], axis=-1).reshape(-1, 3)
    last, ring = (rings - 1) * around + np.arange(around), np.arange(around)
    top = np.stack([last, np.roll(last, -1), np.full(around, rings * around)], axis=1)
    bottom = np.stack([np.roll(ring, -1), ring, np.full(around, rings * around + 1)], axis=1)
    return vertices, np.concatenate([first, second, top]), bottom


def volume_and_centre(vertices, faces):
    """Volume [m3] and centre [m] under a closed surface, by tetrahedra to the origin: none of the package's code."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    sixths = np.linalg.det(np.stack([a, b, c], axis=1))
    return sixths.sum() / 6.0, (sixths[:, None] * (a + b + c)).sum(axis=0) / (4.0 * sixths.sum())


def scattered(vertices, faces, count, seed=0):
    """Points spread evenly at random over a surface."""
    generator = np.random.default_rng(seed)
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = generator.choice(len(faces), count, p=area / area.sum())
    return np.einsum("kc,kci->ki", generator.dirichlet((1.0, 1.0, 1.0), count), vertices[faces[chosen]])


def cubes(count, side, generator):
    """Closed specks beside the body."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
                      (2, 4, 6), (1, 3, 5), (3, 7, 5)])  # fmt: skip
    places = generator.uniform(-0.3, 0.3, (count, 3)) + np.array([0.6, 0.0, 0.4])
    vertices = (places[:, None] + side * corners).reshape(-1, 3)
    return vertices, np.concatenate([faces + 8 * i for i in range(count)])
