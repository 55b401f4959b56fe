#!/usr/bin/env python3
"""Writes box.glb, the first built-in scene: a Cornell-like room of 10.65^3 units, open towards +Z; and box-hard.glb,
the same room in hard light (thesis Fig. 22): the panel is dark, and all light comes from a small spot in a corner
behind the thin panel, which few rays find.

Python's standard library only; the same bytes on every run and machine.

    make_box.py [FOLDER]            write them (default: beside this script)
    make_box.py --check [FOLDER]    verify that the files are what this script writes, and that they are sound

Axes: x to the right, y up, z towards the viewer; the floor is y = 0. Units: glTF's metres; radiance of the panel in
W/(m^2 sr), intensity of the spot in W/sr (the engine reads 1 cd as 1 W/sr).
"""

import math

from gltf_writer import Scene, main, png, srgb
from shapes import Shape, box, knot, lathe, sphere, turn_y, unit

SIDE = 10.65  # the room, thesis Table 3 "Box"
HALF = SIDE / 2


def vase():
    """A hollow vase with a wall 0.07 thick: foot, belly and neck, rounded rim, inside, flat bottoms."""
    def belly(t):  # radius of the outer side at the height 2.3 t
        return 0.5 + 0.42 * math.sin(math.pi * min(1.0, t * 1.12) ** 0.85) ** 2 + 0.12 * max(0.0, t - 0.8) / 0.2
    wall, steps = 0.07, 16
    outer = [(belly(k / steps), 2.3 * k / steps) for k in range(steps + 1)]
    rim = [(belly(1.0) - wall * t, 2.3 + 0.05 * math.sin(math.pi * t)) for t in (0, 0.25, 0.5, 0.75, 1)]
    inner = [(r - wall, y) for r, y in reversed(outer[1::3])]
    return lathe([[(0.0, 0.0), outer[0]], outer, rim, inner, [inner[-1], (0.0, inner[-1][1])]], columns=28)


def tiles(x, y, size=128):
    """Two by two floor tiles of slightly different stone, with darker joints; linear reflectance about 0.5."""
    cell = size // 2
    u, v = x % cell, y % cell
    if min(u, v, cell - 1 - u, cell - 1 - v) < 1:
        return tuple(srgb(c) for c in (0.30, 0.28, 0.26))
    dark = (x // cell + y // cell) % 2
    grain = 0.03 * math.sin(0.31 * x + 1.7 * math.sin(0.17 * y)) * math.sin(0.23 * y + 0.9 * math.sin(0.29 * x))
    return tuple(srgb(c + grain) for c in ((0.42, 0.39, 0.35) if dark else (0.62, 0.59, 0.54)))


def ribs(x, y, size=64):
    """Normal map of rows of flat bumps, +Y up in texture space (OpenGL convention, as glTF asks)."""
    u, v = 2 * math.pi * x / size, 2 * math.pi * y / size
    slope_u = 0.45 * math.cos(2 * u) * (0.5 + 0.5 * math.cos(4 * v))
    slope_v = 0.45 * math.sin(4 * v) * (0.5 + 0.5 * math.sin(2 * u))
    n = unit((-slope_u, -slope_v, 1.0))
    return tuple(round(127.5 + 127.5 * c) for c in n)


def make(hard=False):
    s = Scene("Box", "irad assets/make_box.py")

    def spot(eye, target, intensity, inner, outer):
        cone = {"innerConeAngle": round(math.radians(inner), 6), "outerConeAngle": round(math.radians(outer), 6)}
        s.light("spot", "spot", eye, target, (1.0, 0.93, 0.82), intensity, spot=cone)

    stone, hammered = s.texture("floor tiles", png(128, tiles)), s.texture("vase bumps", png(64, ribs))
    white = s.material("white wall", (0.725, 0.71, 0.68))
    red = s.material("red wall", (0.65, 0.09, 0.07))
    green = s.material("green wall", (0.16, 0.48, 0.12))
    floor = s.material("floor tiles", (1, 1, 1), roughness=0.6, texture=stone)
    wood = s.material("oak", (0.50, 0.31, 0.16), roughness=0.7)
    blue = s.material("blue lacquer", (0.10, 0.22, 0.55), roughness=0.5)
    plaster = s.material("plaster", (0.73, 0.72, 0.70), roughness=0.95)
    ochre = s.material("ochre", (0.72, 0.52, 0.22), roughness=0.9)
    pearl = s.material("pearl", (0.74, 0.70, 0.72), roughness=0.9)
    metal = s.material("polished metal", (0.95, 0.88, 0.76), roughness=0.15, metallic=1.0)
    clay = s.material("rough clay", (0.62, 0.33, 0.22), roughness=0.8, normal=hammered)
    glow = s.material("light panel", (0.7, 0.7, 0.7), radiance=None if hard else (26.0, 24.0, 21.0))

    # The room: five squares facing inwards; seen from outside they are culled.
    room = s.node("room")
    walls = {
        "floor": (floor, Shape().quad((-HALF, 0, HALF), (SIDE, 0, 0), (0, 0, -SIDE), repeat=(5, 5))),
        "ceiling": (white, Shape().quad((-HALF, SIDE, -HALF), (SIDE, 0, 0), (0, 0, SIDE))),
        "back wall": (white, Shape().quad((-HALF, 0, -HALF), (SIDE, 0, 0), (0, SIDE, 0))),
        "left wall": (red, Shape().quad((-HALF, 0, HALF), (0, 0, -SIDE), (0, SIDE, 0))),
        "right wall": (green, Shape().quad((HALF, 0, -HALF), (0, 0, SIDE), (0, SIDE, 0))),
    }
    for name, (material, shape) in walls.items():
        s.node(name, room, mesh=s.mesh(name, (shape, material)))

    # Thin geometry: a screen of slats 0.05 thick between two posts, and a panel 0.04 thick on a foot.
    screen = s.node("slatted screen", at=(-3.25, 0, -2.5), turn=turn_y(32))
    post, slat = s.mesh("post", (box(0.12, 5.4, 0.30), wood)), s.mesh("slat", (box(3.0, 0.20, 0.05), wood))
    for name, x in (("left post", -1.56), ("right post", 1.56)):
        s.node(name, screen, at=(x, 0, 0), mesh=post)
    for k in range(15):
        s.node(f"slat {k + 1}", screen, at=(0, 0.25 + 0.34 * k, 0), mesh=slat)
    stand = s.node("thin panel", at=(3.85, 0, -1.6), turn=turn_y(-42))
    s.node("panel foot", stand, mesh=s.mesh("panel foot", (box(1.4, 0.10, 0.50), plaster)))
    s.node("panel sheet", stand, at=(0, 0.10, 0), mesh=s.mesh("panel sheet", (box(2.3, 3.7, 0.04), blue)))

    # A knot on a pedestal, a diffuse sphere, a metal sphere, a rough vase.
    ring = knot(radius=1.32, tube=0.32, columns=132, rows=8)
    lowest = min(p[1] for p, _, _ in ring.vertices)
    plinth = s.node("knot on pedestal", at=(0.6, 0, -2.4))
    s.node("pedestal", plinth, turn=turn_y(-20), mesh=s.mesh("pedestal", (box(2.2, 1.8, 2.2), plaster)))
    s.node("torus knot", plinth, at=(0, 1.8 - lowest, 0), mesh=s.mesh("torus knot", (ring, ochre)))
    s.node("metal sphere", at=(-2.1, 0, 1.3), mesh=s.mesh("metal sphere", (sphere(1.3, 32, 16), metal)))
    s.node("diffuse sphere", at=(0.95, 0, 2.3), mesh=s.mesh("diffuse sphere", (sphere(0.95, 28, 14), pearl)))
    s.node("rough vase", at=(3.35, 0, 1.7), turn=turn_y(15), mesh=s.mesh("rough vase", (vase(), clay)))

    # Light: a hanging panel whose lower face emits, and a spot from the ceiling at the right front.
    lamp = s.node("light panel", at=(0.4, 9.75, 0.2))
    x, z = 1.8, 1.3
    face = Shape().quad((-x, 0, -z), (2 * x, 0, 0), (0, 0, 2 * z))
    s.node("panel body", lamp, mesh=s.mesh("light panel", (box(2 * x, 0.14, 2 * z, skip_bottom=True), plaster),
                                           (face, glow)))
    rod = s.mesh("rod", (box(0.06, SIDE - 9.75 - 0.14, 0.06), plaster))
    for name, offset in (("left rod", -1.1), ("right rod", 1.1)):
        s.node(name, lamp, at=(offset, 0.14, 0), mesh=rod)
    if hard:
        spot((-4.5, 10.0, -3.0), (4.55, 1.2, -5.2), intensity=150000.0, inner=3, outer=4)
    else:
        spot((3.9, 10.3, 3.6), (-2.3, 1.2, -1.5), intensity=600.0, inner=15, outer=27)
    s.camera("main", (0, HALF, 20.0), (0, HALF, 0), 40)
    s.camera("close", (0.5, 2.5, 5.2), (-2.3, 1.75, -0.6), 45)
    return s.glb()


# ---- checks ---------------------------------------------------------------------------------------------------------


def check(scene):
    """Everything stands on the floor of the room, inside it, and by itself."""
    bounds = {name: b for name, b in scene.bounds.items() if name != "room"}
    low, high = scene.bounds["room"]
    assert max(abs(h - l - SIDE) for l, h in zip(low, high)) < 1e-5, (low, high)
    for name, (a, b) in bounds.items():
        assert all(x >= l - 1e-5 and y <= h + 1e-5 for x, y, l, h in zip(a, b, low, high)), (name, "leaves the room")
        assert name == "light panel" or abs(a[1]) < 1e-5, (name, "does not stand on the floor", a)
        for other, (c, d) in bounds.items():
            if other < name:
                apart = any(y <= w or z <= x for x, y, w, z in zip(a, b, c, d))
                assert apart, (name, other, "boxes overlap")


if __name__ == "__main__":
    main(__doc__, {"box.glb": (make, check), "box-hard.glb": (lambda: make(hard=True), check)})
