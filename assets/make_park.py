#!/usr/bin/env python3
"""Writes park.glb, a built-in scene after the thesis's Abstract Park: a walled court of many flat surfaces, matte and
reflecting, with thin pergolas, railings and louvres, curves, trees, and one sun through the open part of its roof.

Python's standard library only; the same bytes on every run and machine.

    make_park.py [FOLDER]            write it (default: beside this script)
    make_park.py --check [FOLDER]    verify that the file is what this script writes, and that it is sound

Axes: x to the right, y up, z towards the viewer; the ground is y = 0. Units: metres, W/m^2, W/(m^2 sr).
"""

import math

from gltf_writer import Scene, check_closed, extents, main
from shapes import Shape, block, box, cylinder, lathe, revolve, scale, sphere, tube, turn_y

EXTENTS = (45.52, 27.44, 45.52)  # thesis Table 2
TRIANGLES = 3820                 # thesis Table 3
HALF, WALL, GROUND = EXTENTS[0] / 2, 0.8, 0.8
TOP = EXTENTS[1] - GROUND
INNER = HALF - WALL


def dome(radius, thickness, height, columns=16, rows=4):
    """A hemispherical shell, open at its top by a round hole, standing on `height`."""
    hole = 0.22

    def arc(r): return [(r * math.cos(a), height + r * math.sin(a))
                        for a in (math.pi / 2 * (1 - hole) * k / rows for k in range(rows + 1))]
    outer, inner = arc(radius), list(reversed(arc(radius - thickness)))
    return lathe([outer, [outer[-1], inner[0]], inner, [inner[-1], outer[0]]], columns)


def make():
    s = Scene("Abstract Park", "irad assets/make_park.py", textured=False)
    concrete = s.material("concrete", (0.56, 0.55, 0.53), roughness=0.9)
    plaster = s.material("white plaster", (0.74, 0.73, 0.70), roughness=0.95)
    terracotta = s.material("terracotta plaster", (0.66, 0.26, 0.17), roughness=0.95)
    ochre = s.material("ochre plaster", (0.74, 0.53, 0.20), roughness=0.95)
    red = s.material("matte red", (0.62, 0.06, 0.05), roughness=0.9)
    blue = s.material("matte blue", (0.07, 0.19, 0.52), roughness=0.9)
    lawn = s.material("lawn", (0.18, 0.36, 0.09))
    gravel = s.material("gravel", (0.62, 0.57, 0.48))
    leaves = s.material("leaves", (0.16, 0.38, 0.12), roughness=0.8)
    bark = s.material("bark", (0.26, 0.17, 0.11))
    oak = s.material("oak", (0.50, 0.31, 0.16), roughness=0.7)
    granite = s.material("polished granite", (0.07, 0.07, 0.08), roughness=0.12)
    water = s.material("still water", (0.02, 0.07, 0.08), roughness=0.03)
    travertine = s.material("honed travertine", (0.68, 0.60, 0.48), roughness=0.45)
    marble = s.material("polished green marble", (0.08, 0.24, 0.16), roughness=0.15)
    steel = s.material("mirror steel", (0.88, 0.89, 0.90), roughness=0.04, metallic=1.0)
    gold = s.material("polished gold", (1.0, 0.76, 0.33), roughness=0.15, metallic=1.0)
    copper = s.material("satin copper", (0.93, 0.60, 0.50), roughness=0.3, metallic=1.0)
    bronze = s.material("brushed bronze", (0.72, 0.50, 0.28), roughness=0.45, metallic=1.0)
    iron = s.material("painted iron", (0.10, 0.11, 0.12), roughness=0.5)
    glow = s.material("lamp", (0.8, 0.8, 0.8), radiance=(14.0, 11.5, 8.0))

    put = s.put

    # The court: ground, four walls, a roof along the left, louvres over the back.
    court = s.node("court")
    put("ground", court, concrete, block((-HALF, -GROUND, -HALF), (HALF, 0, HALF)))
    put("back wall", court, plaster, block((-HALF, 0, -HALF), (HALF, TOP, -INNER)))
    put("left wall", court, terracotta, block((-HALF, 0, -INNER), (-INNER, TOP, HALF)))
    put("right wall", court, ochre, block((INNER, 0, -INNER), (HALF, TOP, HALF)))
    put("front wall", court, plaster, block((-INNER, 0, INNER), (INNER, 9, HALF)))
    put("roof", court, plaster, block((-INNER, TOP - WALL, -INNER), (-13, TOP, HALF)))
    louvre = s.mesh("louvre", (block((-13, -0.7, -0.12), (INNER, 0, 0.12)), plaster))
    for k in range(7):
        s.node(f"louvre {k + 1}", court, at=(0, TOP, -19 + 3 * k), mesh=louvre)

    # Flat zones on the ground.
    zones = s.node("zones")
    put("plaza", zones, granite, block((-7, 0, -6), (9, 0.15, 8)))
    put("pool", zones, water, block((-19, 0, -4.5), (-8.6, 0.12, 1.5)))
    put("pool rim", zones, travertine, block((-19.4, 0, -4.9), (-8.2, 0.3, -4.5)),
        block((-19.4, 0, 1.5), (-8.2, 0.3, 1.9)), block((-19.4, 0, -4.5), (-19, 0.3, 1.5)),
        block((-8.6, 0, -4.5), (-8.2, 0.3, 1.5)))
    put("lawn", zones, lawn, block((-INNER, 0, 4), (-8, 0.1, INNER)))
    put("back lawn", zones, lawn, block((-INNER, 0, -INNER), (-5, 0.1, -7)))
    put("gravel", zones, gravel, block((10.5, 0, -4), (17.5, 0.08, 18)))

    # Standing slabs, with and without reflections.
    slabs = s.node("slabs")
    for name, material, size, at, turn in (
            ("gold slab", gold, (5.0, 8.0, 0.6), (-4.6, 0, -8.2), -18),
            ("steel slab", steel, (4.4, 6.6, 0.6), (7.4, 0, -7.0), -34),
            ("copper slab", copper, (2.4, 12.0, 0.7), (3.2, 0, -11.5), -12),
            ("bronze slab", bronze, (3.2, 4.2, 0.5), (-18.0, 0, 3.2), 68),
            ("granite slab", granite, (3.0, 10.0, 0.7), (-9.6, 0, -17.5), 8),
            ("red slab", red, (6.0, 7.2, 0.7), (-1.2, 0, -16.8), -6),
            ("blue slab", blue, (4.6, 4.6, 0.6), (13.6, 0.08, 1.0), -64),
            ("low white slab", plaster, (9.0, 1.6, 0.6), (2.0, 0, -7.6), 0)):
        put(name, slabs, material, box(*size), at=at, turn=turn_y(turn))

    # A pavilion of planes: podium with steps, thin cross columns, a wall of marble, a roof with a lamp under it.
    pavilion = s.node("pavilion", at=(12.6, 0, -13.8))
    put("podium", pavilion, travertine, block((-6.5, 0, -6.5), (6.5, 0.6, 5)), block((-3, 0, 5), (3, 0.4, 5.6)),
        block((-3, 0, 5.6), (3, 0.2, 6.2)))
    column = s.mesh("cross column", (box(0.32, 4.8, 0.08) + box(0.08, 4.8, 0.32), steel))
    for k, (x, z) in enumerate((x, z) for x in (-5, 0, 5) for z in (-4.6, 3.4)):
        s.node(f"column {k + 1}", pavilion, at=(x, 0.6, z), mesh=column)
    put("marble wall", pavilion, marble, block((-3.4, 0.6, -2.4), (3.4, 5.4, -2.0)))
    put("side wall", pavilion, travertine, block((5.4, 0.6, -6), (5.8, 5.4, 2)))
    put("pavilion roof", pavilion, plaster, block((-6.2, 5.4, -6.2), (6.2, 5.9, 4.6)))
    face = Shape().quad((-2.6, 0, -1.2), (5.2, 0, 0), (0, 0, 2.4))
    s.node("pavilion lamp", pavilion, at=(0, 5.28, 0.3),
           mesh=s.mesh("pavilion lamp", (box(5.2, 0.12, 2.4, skip_bottom=True), plaster), (face, glow)))

    # A round temple: steps, columns, a ring, a dome with a hole.
    temple = s.node("temple", at=(-14.8, 0, -13.6))
    put("temple steps", temple, travertine, cylinder(5.6, 0.35, 20), cylinder(5.0, 0.35, 20).moved((0, 0.35, 0)))
    shaft = s.mesh("temple column", (lathe([[(0.36, 0), (0.28, 5.2)]], 8), plaster))
    for k in range(8):
        angle = math.radians(45 * k + 22.5)
        s.node(f"temple column {k + 1}", temple, at=(4.3 * math.sin(angle), 0.7, 4.3 * math.cos(angle)), mesh=shaft)
    corners = [(4.8, 5.9), (4.8, 6.7), (3.8, 6.7), (3.8, 5.9), (4.8, 5.9)]
    put("temple ring", temple, plaster, lathe(list(zip(corners, corners[1:])), 20))
    put("temple dome", temple, copper, dome(4.5, 0.35, 6.7))

    # A thin pergola over a path at the left, its slats 0.08 thick.
    pergola = s.node("pergola", at=(-14.6, 0, 13.4))
    post = s.mesh("pergola post", (box(0.22, 3.6, 0.22), oak))
    beam = s.mesh("pergola beam", (box(0.14, 0.3, 12.4), oak))
    slat = s.mesh("pergola slat", (box(5.6, 0.26, 0.08), oak))
    for x in (-2.4, 2.4):
        for z in (-5.6, 0, 5.6):
            s.node(f"post {x:g} {z:g}", pergola, at=(x, 0, z), mesh=post)
        s.node(f"beam {x:g}", pergola, at=(x, 3.6, 0), mesh=beam)
    for k in range(13):
        s.node(f"slat {k + 1}", pergola, at=(0, 3.9, -6 + k), mesh=slat)

    # A gallery along the right wall: stairs, a thin deck, railings.
    gallery = s.node("gallery")
    put("deck", gallery, concrete, block((18.4, 5.0, -6), (INNER, 5.3, 9.2)))
    put("deck columns", gallery, concrete, *(block((18.7, 0, z - 0.2), (19.1, 5.0, z + 0.2)) for z in (-5, 1.6, 8.2)))
    put("stairs", gallery, concrete, *(block((19.2, 0, 9.2 + 0.9 * k), (21.6, 5.3 - 0.53 * (k + 1), 10.1 + 0.9 * k))
                                       for k in range(9)))
    put("railing", gallery, iron, *(block((18.44, 5.3 + y, -6), (18.52, 5.38 + y, 9.2)) for y in (0.55, 1.0)),
        *(block((18.45, 5.3, z - 0.03), (18.51, 6.3, z + 0.03)) for z in (-5.9 + 1.88 * k for k in range(9))))

    # Curves: a bench around the plaza's front, a ring on a plinth, a stone ball.
    curves = s.node("curves")
    seat, foot = [(9.5, 0.45), (9.5, 0.55), (8.6, 0.55), (8.6, 0.45)], [(9.3, 0), (9.3, 0.45), (8.8, 0.45), (8.8, 0)]
    put("bench seat", curves, oak, revolve(seat, -52, 38, 14), at=(1, 0, 2.4))
    put("bench wall", curves, plaster, revolve(foot, -50, 36, 14), at=(1, 0, 2.4))
    put("plinth", curves, travertine, box(2.4, 1.1, 2.4), at=(1.6, 0.15, -0.8), turn=turn_y(20))

    def circle(t): return (1.7 * math.sin(2 * math.pi * t), 2.0 - 1.7 * math.cos(2 * math.pi * t), 0.0)
    put("ring", curves, steel, tube(circle, lambda t: 0.32, 24, 7, closed=True), at=(1.6, 1.25, -0.8), turn=turn_y(38))
    put("stone ball", curves, terracotta, sphere(1.3, 16, 8), at=(-4.6, 0.15, 4.4))

    # Trees of three shapes, and lamps.
    trees = s.node("trees")
    trunk = s.mesh("trunk", (lathe([[(0.22, 0), (0.14, 3.0)]], 6), bark))
    round_crown = s.mesh("round crown", (sphere(1.9, 12, 7), leaves))
    pointed_crown = s.mesh("pointed crown", (lathe([[(0, 0), (1.5, 0)], [(1.5, 0), (1.1, 2.4), (0, 6.2)]], 10), leaves))
    for k, (crown, x, z) in enumerate((
            (round_crown, -19.0, 7.2), (pointed_crown, -10.0, 18.6), (round_crown, -19.8, 19.4),
            (pointed_crown, -20.0, -7.6), (pointed_crown, 15.2, 5.4), (round_crown, 15.4, 15.6),
            (pointed_crown, -7.0, -20.2))):
        tree = s.node(f"tree {k + 1}", trees, at=(x, 0.05, z))
        s.node(f"trunk {k + 1}", tree, mesh=trunk)
        s.node(f"crown {k + 1}", tree, at=(0, 2.6, 0), mesh=crown)
    lamps = s.node("lamps")
    pole = s.mesh("lamp pole", (box(0.12, 3.4, 0.12), iron))
    globe = s.mesh("lamp globe", (sphere(0.34, 10, 6), glow))
    for k, (x, z) in enumerate(((10.0, 9.6), (-7.4, 9.4), (10.0, -5.6), (-7.4, -6.6))):
        lamp = s.node(f"lamp {k + 1}", lamps, at=(x, 0, z))
        s.node(f"pole {k + 1}", lamp, mesh=pole)
        s.node(f"globe {k + 1}", lamp, at=(0, 3.4, 0), mesh=globe)

    sun = (0.30, 0.62, 0.72)
    s.light("directional", "sun", scale(sun, 40), (0, 0, 0), (1.0, 0.95, 0.87), 4.2)
    s.camera("main", (3.6, 6.4, 21.2), (-1.6, 4.6, -8), 62)
    s.camera("slabs", (-1.2, 2.0, 10.4), (-1.0, 3.6, -8), 56)
    return s.glb()


def check(scene):
    # The ends of columns and trunks are inside others; the lamp is a body and its shining face.
    check_closed(scene, except_for=("temple column", "trunk", "pavilion lamp"))
    assert all(abs(a - b) < 0.005 for a, b in zip(extents(scene), EXTENTS)), extents(scene)
    assert abs(len(scene.triangles) / TRIANGLES - 1) < 0.1, len(scene.triangles)


if __name__ == "__main__":
    main(__doc__, {"park.glb": (make, check)})
