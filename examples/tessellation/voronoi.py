#!/usr/bin/env python3
"""Writes voronoi.tess, a Voronoi tessellation in the format of Neper.

    python3 voronoi.py > voronoi.tess

A stand-in for whatever program makes your cells: it needs Python alone. Points at random are spread out by Lloyd's rounds
(each goes to the centroid of its Voronoi cell). The domain is 1 x 2. STRETCH above 1 makes cells that are longer along x.
"""
import random

CELLS, ROUNDS, STRETCH, WIDTH, HEIGHT = 300, 8, 1.0, 1.0, 2.0
random.seed(7)


def clipped(polygon, nx, ny, d):
    """What lies at n . p <= d."""
    result = []
    for (px, py), (qx, qy) in zip(polygon, polygon[1:] + polygon[:1]):
        p, q = nx * px + ny * py - d, nx * qx + ny * qy - d
        if p <= 0:
            result.append((px, py))
        if (p <= 0) != (q <= 0):
            t = p / (p - q)
            result.append((px + t * (qx - px), py + t * (qy - py)))
    return result


def cell(i, points, width, height):
    x, y = points[i]
    polygon = [(0, 0), (width, 0), (width, height), (0, height)]
    for u, v in sorted((p for k, p in enumerate(points) if k != i), key=lambda p: (p[0] - x) ** 2 + (p[1] - y) ** 2)[:60]:
        polygon = clipped(polygon, u - x, v - y, 0.5 * (u * u + v * v - x * x - y * y))
    return polygon


def centroid(polygon):
    area = cx = cy = 0.0
    for (px, py), (qx, qy) in zip(polygon, polygon[1:] + polygon[:1]):
        c = px * qy - qx * py
        area, cx, cy = area + c, cx + c * (px + qx), cy + c * (py + qy)
    return cx / (3 * area), cy / (3 * area)


squeezed = WIDTH / STRETCH
points = [(random.uniform(0, squeezed), random.uniform(0, HEIGHT)) for _ in range(CELLS)]
for _ in range(ROUNDS):
    points = [centroid(cell(i, points, squeezed, HEIGHT)) for i in range(CELLS)]

vertices, edges, faces = {}, {}, []
for i in range(CELLS):
    corners = []
    for x, y in cell(i, points, squeezed, HEIGHT):
        at = (round(STRETCH * x, 9) + 0.0, round(y, 9) + 0.0)
        corner = vertices.setdefault(at, len(vertices) + 1)
        if not corners or corners[-1] != corner:
            corners.append(corner)
    if corners[0] == corners[-1]:
        corners.pop()
    around = []
    for a, b in zip(corners, corners[1:] + corners[:1]):
        around.append(-edges[b, a] if (b, a) in edges else edges.setdefault((a, b), len(edges) + 1))
    faces.append((corners, around))

places = list(vertices)
print(f"***tess\n **format\n   3.5\n **general\n   2 standard\n **cell\n  {CELLS}\n  *seed")
for i, (x, y) in enumerate(points):
    print(f"   {i + 1} {STRETCH * x:.9f} {y:.9f} 0 0")
print(f" **vertex\n  {len(places)}")
for i, (x, y) in enumerate(places):
    print(f"   {i + 1} {x:.9f} {y:.9f} 0 0")
print(f" **edge\n  {len(edges)}")
for i, (a, b) in enumerate(edges):
    print(f"   {i + 1} {a} {b} 0")
print(f" **face\n  {CELLS}")
for i, (corners, around) in enumerate(faces):
    print(f"   {i + 1} {len(corners)} {' '.join(map(str, corners))}\n     {len(around)} {' '.join(map(str, around))}\n     0 0 0 1\n     0 -1 0 0 0")
print(" **domain\n  *general\n   square\n  *vertex\n   4")
labels = [("x0y0", (0.0, 0.0)), ("x1y0", (WIDTH, 0.0)), ("x1y1", (WIDTH, HEIGHT)), ("x0y1", (0.0, HEIGHT))]
for i, (label, (x, y)) in enumerate(labels):
    print(f"   {i + 1} {x:.9f} {y:.9f} 0 {label}\n     1 {vertices[x, y]}")
print("  *edge\n   4")
for i, (label, axis, value) in enumerate([("y0", 1, 0.0), ("x1", 0, WIDTH), ("y1", 1, HEIGHT), ("x0", 0, 0.0)]):
    own = [e for (a, b), e in edges.items() if places[a - 1][axis] == value == places[b - 1][axis]]
    print(f"   {i + 1} 2 {i + 1} {(i + 1) % 4 + 1}\n     line\n     0\n     {label}\n     {len(own)} {' '.join(map(str, own))}")
print("***end")
