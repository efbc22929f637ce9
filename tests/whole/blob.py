"""A small object for whole runs: a closed, bumpy ball with a waist, in metres, standing on z = 0."""

import math
import struct


def make_icosphere(levels):
    """Vertices on the unit sphere, and triangles, counter-clockwise seen from outside."""
    t = (1 + math.sqrt(5)) / 2
    vertices = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1),
                (-t, 0, 1)]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2),
                 (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(vertices)
                vertices.append(tuple((p + q) / 2 for p, q in zip(vertices[a], vertices[b])))
            return middles[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return [tuple(x / math.sqrt(sum(y * y for y in v)) for x in v) for v in vertices], triangles


def make_blob(height_m=0.12, levels=4):
    directions, triangles = make_icosphere(levels)
    vertices = []
    for x, y, z in directions:
        radius = 1 + 0.12 * math.sin(3 * math.atan2(y, x)) * (1 - z * z) - 0.25 * math.exp(-16 * z * z)
        vertices.append((0.75 * radius * x, 0.75 * radius * y, radius * z))
    low = min(v[2] for v in vertices)
    scale = height_m / (max(v[2] for v in vertices) - low)
    return [(scale * x, scale * y, scale * (z - low)) for x, y, z in vertices], triangles


def encode_ply(vertices, triangles):
    """Binary little-endian PLY."""
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    return (header.encode() + b"".join(struct.pack("<3f", *v) for v in vertices) + b"".join(struct.pack("<B3i", 3, *t) for t in triangles))
