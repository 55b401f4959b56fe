#!/usr/bin/env python3
"""Writes arena.glb, a built-in scene after the thesis's Arena: a level in a desert. A canyon of broad simple zones, a
ruined ring of seats and columns, a fort, rocks, and a mountain with caves that only their entrances light.

Python's standard library only; the same bytes on every run and machine.

    make_arena.py [FOLDER]            write it (default: beside this script)
    make_arena.py --check [FOLDER]    verify that the file is what this script writes, and that it is sound

Axes: x to the right, y up, z towards the viewer; the sand is y = 0. Units: metres, W/m^2.
"""

import math

from gltf_writer import Scene, check_closed, extents, main
from shapes import (Shape, add, block, box, cross, cylinder, dot, lathe, loft, revolve, scale, sheet, smooth, sub,
                    surface, tube, turn_y, unit)

EXTENTS = (304.56, 79.18, 543.48)  # thesis Table 2
TRIANGLES = 5187                   # thesis Table 3
X, Z, GROUND = EXTENTS[0] / 2, EXTENTS[2] / 2, 9.0
TOP = EXTENTS[1] - GROUND
SUNK = -4.0  # how deep rocks stand in the ground, whose lower side is -GROUND

# The caves: chambers (middle, radii) and tunnels (from, to, radius). The first tunnel and the last lead outside.
CHAMBERS = {"hall": ((-4, 4, -136), (34, 24, 28)), "west": ((-58, 4, -166), (20, 18, 22)),
            "deep": ((34, 4, -194), (28, 22, 20))}
TUNNELS = (((36, 5, -30), (-4, 4, -136), 21),    # the mouth, towards the south
           ((-4, 4, -136), (-58, 4, -166), 10),
           ((-4, 4, -136), (34, 4, -194), 10),
           ((10, 4, -134), (120, 4, -122), 11))  # the eastern entrance


def wave(*numbers):
    """A smooth, uneven function between -1 and 1."""
    a = sum(math.sin(0.7 * k + f * n) for k, (f, n) in enumerate(zip((1.0, 1.37, 0.83), numbers)))
    return math.sin(1.3 * a + 0.6 * sum(numbers))


# ---- the mountain: a field that is negative inside ------------------------------------------------------------------


def rounded_box(p, middle, half, radius):
    q = tuple(abs(x - m) - h + radius for x, m, h in zip(p, middle, half))
    return math.hypot(*(max(c, 0) for c in q)) + min(max(q), 0) - radius


def ellipsoid(p, middle, radii):
    k = math.hypot(*((x - m) / r for x, m, r in zip(p, middle, radii)))
    return (k - 1) * min(radii)


def capsule(p, a, b, radius):
    along = sub(b, a)
    t = min(1.0, max(0.0, dot(sub(p, a), along) / dot(along, along)))
    return math.dist(p, add(a, scale(along, t))) - radius


def blend(a, b, width):
    """The smaller of two, rounded where they meet."""
    h = max(width - abs(a - b), 0) / width
    return min(a, b) - h * h * width / 4


def caves(p):
    inside = 1e9
    for middle, radii in CHAMBERS.values():
        inside = blend(inside, ellipsoid(p, middle, radii), 8)
    for a, b, radius in TUNNELS:
        inside = blend(inside, capsule(p, a, b, radius), 8)
    return inside


def mountain(p):
    """Three terraces, worn by waves; less the caves."""
    x, y, z = p
    wear = 4.0 * wave(x / 23, y / 19, z / 27) + 2.0 * wave(z / 11, x / 13, y / 9)
    rock = rounded_box(p, (-2, -20, -140), (92, 54, 88), 16)
    rock = blend(rock, rounded_box(p, (-28, -10, -156), (56, 66, 60), 14), 10)
    rock = blend(rock, rounded_box(p, (48, -10, -180), (36, 54, 36), 14), 10)
    return max(rock + wear, -caves(p))


def make_mountain():
    cell, low = 12.8, (-115.2, -12.8, -256.0)
    points, triangles = surface(mountain, low, (18, 7, 17), cell)
    # What lies in the ground is hidden.
    points = [(x, max(y, SUNK), z) for x, y, z in points]
    return smooth(points, [t for t in triangles if max(points[v][1] for v in t) > -1], crease=42)


# ---- rocks ----------------------------------------------------------------------------------------------------------


def cliff(along, length, stations, depth, height):
    """A wall of rock with a terrace along an edge of the level: `along` takes (across, up, way) to a point."""
    sections = []
    for k in range(stations + 1):
        way = length * (k / stations - 0.5)
        d, h = depth * (1 + 0.28 * wave(way / 31, depth)), height * (1 + 0.22 * wave(way / 43, height))
        sections.append([along(*p, way) for p in ((0, SUNK), (d, SUNK), (0.86 * d, 0.45 * h), (0.62 * d, 0.52 * h),
                                                  (0.50 * d, h), (0, h))])
    return loft(sections)


def hoodoo(height, radius, seed):
    """A column of rock that wind has worn, with a cap."""
    steps = 5
    profile = []
    for k in range(steps + 1):
        t = k / steps
        profile.append((radius * (0.95 - 0.5 * math.sin(math.pi * t) + 0.12 * wave(4 * t, seed) + 0.3 * t), height * t))
    foot = (1.1 * radius, SUNK)
    return lathe([[(0, SUNK), foot], [foot, *profile], [profile[-1], (0, height + 1.5)]], 8)


def boulder(radius, seed):
    sections = []
    for y, r in ((SUNK / 2, 0.8), (0.35 * radius, 1.0), (0.9 * radius, 0.7), (1.15 * radius, 0.3)):
        sections.append([(radius * r * (1 + 0.25 * wave(k, seed, y)) * math.sin(math.pi * k / 3.5), y,
                          radius * r * (1 + 0.25 * wave(k, seed, y)) * math.cos(math.pi * k / 3.5)) for k in range(7)])
    return loft(sections)


def dunes():
    """A field of dunes whose edges lie in the ground."""
    def top(s, t):
        x, z = 14 + 112 * s, 96 + 142 * (1 - t)
        hill = math.sin(math.pi * s) * math.sin(math.pi * t)
        return (x, -1.0 + hill * (4.5 + 3.5 * math.sin(0.085 * x + 0.06 * z + math.sin(0.04 * z))), z)

    def vertex(s, t, e=1e-4):
        return top(s, t), unit(cross(sub(top(s + e, t), top(s - e, t)), sub(top(s, t + e), top(s, t - e))))
    return Shape().grid(10, 11, vertex)


def make():
    s = Scene("Arena", "irad assets/make_arena.py", textured=False)
    sand = s.material("sand", (0.64, 0.49, 0.31))
    dune = s.material("dune sand", (0.70, 0.53, 0.33))
    sandstone = s.material("red sandstone", (0.60, 0.37, 0.23), roughness=0.95)
    limestone = s.material("limestone", (0.58, 0.51, 0.40), roughness=0.9)
    marble = s.material("worn marble", (0.64, 0.62, 0.57), roughness=0.4)
    brick = s.material("mud brick", (0.56, 0.39, 0.26))
    wood = s.material("grey wood", (0.36, 0.28, 0.20), roughness=0.85)
    canvas = s.material("blue canvas", (0.10, 0.25, 0.46))
    red_canvas = s.material("red canvas", (0.58, 0.08, 0.06))
    bronze = s.material("bronze", (0.72, 0.50, 0.28), roughness=0.35, metallic=1.0)
    copper = s.material("polished copper", (0.93, 0.60, 0.50), roughness=0.15, metallic=1.0)
    water = s.material("still water", (0.03, 0.10, 0.09), roughness=0.04)
    leaves = s.material("palm leaves", (0.16, 0.33, 0.09))

    put = s.put

    # The canyon.
    canyon = s.node("canyon")
    put("ground", canyon, sand, block((-X, -GROUND, -Z), (X, 0, Z)))
    put("dunes", canyon, dune, dunes())
    put("western cliff", canyon, sandstone, cliff(lambda d, y, w: (d - X, y, w), 2 * Z, 12, 30, 50))
    put("eastern cliff", canyon, sandstone, cliff(lambda d, y, w: (X - d, y, -w), 2 * Z, 12, 26, 46))
    put("northern cliff", canyon, sandstone, cliff(lambda d, y, w: (-w, y, d - Z), 2 * X, 6, 24, 46))
    put("mountain", canyon, sandstone, make_mountain())

    # Rocks: an arch, worn columns, boulders.
    rocks = s.node("rocks")

    def bow(t): return (-27 * math.cos(math.pi * t), SUNK + 30 * math.sin(math.pi * t), 0.0)
    put("arch", rocks, sandstone, tube(bow, lambda t: 7.5 - 2.5 * math.sin(math.pi * t) + 0.8 * wave(9 * t), 11, 7),
        at=(92, 0, 30), turn=turn_y(-35))
    tall, short = (s.mesh(f"{name} hoodoo", (hoodoo(height, radius, seed), sandstone))
                   for name, height, radius, seed in (("tall", 30, 7, 1), ("short", 17, 5.5, 2)))
    for k, (mesh, x, z) in enumerate(((tall, -100, -2), (short, -84, 8), (short, 118, 68))):
        s.node(f"hoodoo {k + 1}", rocks, at=(x, 0, z), turn=turn_y(50 * k), mesh=mesh)
    stone = s.mesh("boulder", (boulder(5, 3), sandstone))
    for k, (x, z) in enumerate(((-34, -24), (48, -18), (24, 128), (-96, 96))):
        s.node(f"boulder {k + 1}", rocks, at=(x, 0, z), turn=turn_y(77 * k), mesh=stone)

    # The arena: two arcs of seats, columns on their backs with pieces of the ring that they carried, an altar.
    arena = s.node("arena", at=(-14, 0, 72))
    seats = [(62, SUNK), (62, 17), (56, 17), (56, 12), (50, 12), (50, 7), (44, 7), (44, SUNK)]
    for name, start, end in (("eastern seats", 28, 152), ("western seats", 208, 332)):
        put(name, arena, limestone, revolve(seats, start, end, 10))
    shaft = lathe([[(2.0, 0), (1.9, 1.2), (1.45, 1.4)], [(1.45, 1.4), (1.2, 12)], [(1.2, 12), (2.0, 13.5)]], 7)
    stump = lathe([[(2.0, 0), (1.9, 1.2), (1.45, 1.4)], [(1.45, 1.4), (1.3, 6)], [(1.3, 6), (0, 7)]], 7)
    whole, broken = s.mesh("column", (shaft, marble)), s.mesh("broken column", (stump, marble))
    for k, degrees in enumerate((36, 57, 78, 102, 123, 144, 216, 237, 258, 282, 303, 324)):
        angle = math.radians(degrees)
        s.node(f"column {k + 1}", arena, at=(59 * math.sin(angle), 17, 59 * math.cos(angle)),
               mesh=broken if k in (2, 3, 8, 11) else whole)
    beam = [(60.6, 30.5), (60.6, 33), (57.4, 33), (57.4, 30.5)]
    for name, start, end, columns in (("beam 1", 34, 59, 3), ("beam 2", 121, 146, 3), ("beam 3", 214, 239, 3),
                                      ("beam 4", 280, 305, 3)):
        put(name, arena, marble, revolve(beam, start, end, columns))
    put("altar", arena, marble, cylinder(9, 1, 10), cylinder(6.5, 1, 10).moved((0, 1, 0)),
        box(4, 3, 4).moved((0, 2, 0)))
    bowl = lathe([[(0, 0), (1.2, 0)], [(1.2, 0), (3.4, 2.4)], [(3.4, 2.4), (3.0, 2.4)], [(3.0, 2.4), (0, 0.6)]], 10)
    put("bronze bowl", arena, bronze, bowl, at=(0, 5, 0))

    # The fort at the south: walls with a gate, towers, the tall one with a copper dome.
    fort = s.node("fort")
    front, back = Z, Z - 9
    put("fort wall", fort, brick, block((-X + 1, SUNK, back), (-12, 20, front)),
        block((12, SUNK, back), (X - 1, 20, front)), block((-12, 14, back + 1), (12, 20, front - 1)))
    merlon = s.mesh("merlon", (box(7, 4, 3), brick))
    for k in range(7):
        s.node(f"merlon {k + 1}", fort, at=(-96 + 32 * k, 20, back + 1.6), mesh=merlon)
    tower = s.mesh("gate tower", (cylinder(9, 30, 10) + cylinder(10.5, 4, 10).moved((0, 30, 0)), brick))
    for name, x in (("western gate tower", -21), ("eastern gate tower", 21)):
        s.node(name, fort, at=(x, SUNK, Z - 12), mesh=tower)
    minaret = s.node("minaret", fort, at=(-84, 0, 104))
    put("minaret foot", minaret, limestone, box(16, 14, 16))
    corners = [(0, 14), (5.5, 14), (4.2, 52), (6.4, 54), (6.4, 57), (0, 57)]
    put("minaret shaft", minaret, limestone, lathe(list(zip(corners, corners[1:])), 10))
    bulge = [(4.4, 57), (4.9, 59.5), (4.3, 62), (2.6, 64.5), (0.7, 66.5), (0.35, TOP - 1)]
    put("copper dome", minaret, copper, lathe([[(0, 57), bulge[0]], bulge, [bulge[-1], (0, TOP)]], 10))
    obelisk = s.mesh("obelisk", (loft([[(r * x, y, r * z) for x, z in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
                                       for y, r in ((SUNK, 2.4), (22, 1.5), (25, 0.1))]), marble))
    for k, (x, z) in enumerate(((-20, 160), (10, 160), (-20, 208), (10, 208))):
        s.node(f"obelisk {k + 1}", fort, at=(x - 8, 0, z), mesh=obelisk)

    # Thin things: a bridge with railings between the cliff and a worn column, awnings on poles.
    bridge = s.node("bridge", at=(-98, 15, 46))
    deck = box(50, 0.8, 6)
    posts = [box(0.4, 3.0, 0.4).moved((-24 + 8 * k, 0.8, z)) for k in range(7) for z in (-2.8, 2.8)]
    rails = [box(50, 0.3, 0.3).moved((0, y, z)) for y in (2.1, 3.5) for z in (-2.8, 2.8)]
    legs = [box(0.9, 19, 0.9).moved((x, -19, z)) for x in (-18, -2, 14, 23) for z in (-2.4, 2.4)]
    put("deck", bridge, wood, deck)
    put("railings", bridge, wood, *posts, *rails)
    put("trestles", bridge, wood, *legs)
    put("tower floor", bridge, wood, box(14, 0.8, 14).moved((32, 0, 0)))
    put("ladder tower", bridge, wood, *(box(0.9, 19, 0.9).moved((32 + x, -19, z)) for x in (-6, 6) for z in (-6, 6)))

    def sail(s, t): return (14 * (s - 0.5), 9 - 3.2 * math.sin(math.pi * s) * math.sin(math.pi * t), 12 * (0.5 - t))
    poles = [box(0.35, 13, 0.35).moved((7 * x, SUNK, 6 * z)) for x in (-1, 1) for z in (-1, 1)]
    for name, material, at, turn in (("blue awning", canvas, (44, 0, 196), 15),
                                     ("red awning", red_canvas, (-56, 0, 232), -20)):
        awning = s.node(name, at=at, turn=turn_y(turn))
        put(name + "'s sail", awning, material, sheet(4, 3, sail, 0.15))
        put(name + "'s poles", awning, wood, *poles)

    # An oasis.
    oasis = s.node("oasis", at=(-62, 0, 190))
    put("pool", oasis, water, cylinder(17, 0.5, 12))
    put("pool rim", oasis, limestone, lathe([[(19, SUNK), (19, 1)], [(19, 1), (17, 1)], [(17, 1), (17, SUNK)],
                                             [(17, SUNK), (19, SUNK)]], 12))
    trunk = s.mesh("palm trunk", (lathe([[(0.8, 0), (0.5, 11)]], 6), wood))
    crown = s.mesh("palm crown", (lathe([[(0, 0), (5.5, -1.5)], [(5.5, -1.5), (3.5, 1.2), (0, 2.6)]], 9), leaves))
    for k, (x, z) in enumerate(((-22, 4), (-14, -18), (16, -16))):
        palm = s.node(f"palm {k + 1}", oasis, at=(x, 0, z))
        s.node(f"palm trunk {k + 1}", palm, mesh=trunk)
        s.node(f"palm crown {k + 1}", palm, at=(0, 10.6, 0), mesh=crown)

    sun = (0.32, 0.48, 0.82)
    s.light("directional", "sun", scale(sun, 300), (0, 0, 0), (1.0, 0.93, 0.82), 5.0)
    s.camera("main", (50, 50, 258), (-12, -4, 60), 56, near=0.5, far=1000.0)
    s.camera("cave", (-6, 8, -128), (14, 9, -80), 76, near=0.5, far=1000.0)
    return s.glb()


# ---- checks ---------------------------------------------------------------------------------------------------------


def first_hit(origin, direction, triangles):
    """Distance along the ray, and whether it meets a front face; (inf, None) where it meets none."""
    nearest, front = math.inf, None
    for a, ab, ac in triangles:
        p = cross(direction, ac)
        det = dot(ab, p)
        if abs(det) < 1e-12:
            continue
        t = sub(origin, a)
        u = dot(t, p) / det
        if not 0 <= u <= 1:
            continue
        q = cross(t, ab)
        if not (0 <= dot(direction, q) / det and u + dot(direction, q) / det <= 1):
            continue
        distance = dot(ac, q) / det
        if 1e-6 < distance < nearest:
            nearest, front = distance, det > 0
    return nearest, front


def check_caves(scene, rays=80):
    """From within the chambers a ray meets the front of a rock or of the ground, or leaves by an entrance."""
    triangles = [(a, sub(b, a), sub(c, a)) for a, b, c in scene.triangles]
    for name, (middle, _) in CHAMBERS.items():
        outside = 0
        for k in range(rays):
            y = 1 - (2 * k + 1) / rays
            angle, r = 2.399963 * k, math.sqrt(1 - y * y)
            direction = (r * math.cos(angle), y, r * math.sin(angle))
            distance, front = first_hit(middle, direction, triangles)
            assert front is not False, (name, direction, "meets the back of a face")
            end = add(middle, scale(direction, min(distance, 500)))
            outside += caves(end) > 12  # no wall of a cave is there
        assert outside <= (0 if name == "deep" else 0.05 * rays), (name, "is open in", outside, "directions")


def check(scene):
    # These end in the ground or in others.
    check_closed(scene, except_for=("mountain", "dunes", "arch", "column", "broken column", "palm trunk"))
    check_caves(scene)
    assert all(abs(a - b) < 0.005 for a, b in zip(extents(scene), EXTENTS)), extents(scene)
    assert abs(len(scene.triangles) / TRIANGLES - 1) < 0.1, len(scene.triangles)


if __name__ == "__main__":
    main(__doc__, {"arena.glb": (make, check)})
