#!/usr/bin/env python3
"""Writes scenes by seed that share nothing with the families of `irad check`: for measuring how accurate the program
is where it was never tuned (docs/accuracy.md). They are not built in.

Python's standard library only; the same bytes on every run and machine.

    make_strangers.py FOLDER SEED...          KIND + SEED + .glb of every kind
    make_strangers.py FOLDER SEED... -- FILE.glb...   those files, turned as scenes of these seeds are

Seeds divisible by three stand upright, the next ones are turned about the vertical, the others about any axis. The
truth of "church" is 0 inside: its windows are closed by opaque panes and the sun is outside. Units: metres, W/m^2.
"""

import json
import math
import random
import struct
import sys
from pathlib import Path

from gltf_writer import Scene
from shapes import Shape, block, box, cross, cylinder, dot, lathe, sphere, sub, turn_y, unit


def wall(axis, at, thickness, low, high, holes=()):
    """Blocks of a wall across `axis` (0: x, 2: z) from `at` on. `low`, `high`: (along, up); holes: (along, up, along,
    up)."""
    alongs = sorted({low[0], high[0], *(h[i] for h in holes for i in (0, 2))})
    ups = sorted({low[1], high[1], *(h[i] for h in holes for i in (1, 3))})
    rectangles = []
    for a, b in zip(alongs, alongs[1:]):
        run = None
        for c, d in zip(ups, ups[1:]):
            middle = ((a + b) / 2, (c + d) / 2)
            if any(h[0] < middle[0] < h[2] and h[1] < middle[1] < h[3] for h in holes):
                if run:
                    rectangles.append((a, run[0], b, run[1]))
                run = None
            else:
                run = (run[0] if run else c, d)
        if run:
            rectangles.append((a, run[0], b, run[1]))
    if axis == 0:
        return [block((at, v0, u0), (at + thickness, v1, u1)) for u0, v0, u1, v1 in rectangles]
    return [block((u0, v0, at), (u1, v1, at + thickness)) for u0, v0, u1, v1 in rectangles]


def colour(r, low=.25, high=.8):
    return tuple(r.uniform(low, high) for _ in range(3))


def sun(s, eye, target):
    s.light("directional", "sun", eye, target, (1, .95, .85), 10)


def room(s, r, width, height, depth, t, holes):
    """A room of blocks that run into each other at its corners. `holes`: of the walls "x-", "x+", "z-", "z+"."""
    floor = s.material("floor", colour(r))
    ceiling = s.material("ceiling", colour(r, .5, .85))
    walls = s.material("walls", colour(r, .4, .8))
    s.put("floor", None, floor, block((-t, -t, -t), (width + t, 0, depth + t)))
    s.put("ceiling", None, ceiling, block((-t, height, -t), (width + t, height + t, depth + t)))
    low, high = -t * .5, height + t * .5
    s.put("walls", None, walls,
          *wall(0, -t, t, (-t, low), (depth + t, high), holes.get("x-", [])),
          *wall(0, width, t, (-t, low), (depth + t, high), holes.get("x+", [])),
          *wall(2, -t, t, (-t, low), (width + t, high), holes.get("z-", [])),
          *wall(2, depth, t, (-t, low), (width + t, high), holes.get("z+", [])))


def kitchen(s, r):
    """The sun through a barred window, on a table with thin legs, cups on thin shelves, a curtain of one sheet."""
    width, height, depth = r.uniform(4, 6), r.uniform(2.4, 3), r.uniform(3, 5)
    t = r.choice([.02, .06, .15, .3])
    u0 = r.uniform(.5, 1.2)
    u1 = u0 + r.uniform(.8, 1.6)
    v0, v1 = r.uniform(.8, 1.1), r.uniform(1.8, 2.2)
    room(s, r, width, height, depth, t, {"x-": [(u0, v0, u1, v1)]})

    frame, bars = s.material("frame", colour(r, .6, .85)), []
    panes = r.randint(1, 4)
    for i in range(panes + 1):
        u = u0 + (u1 - u0) * i / panes
        bars.append(block((-t * .6 - .01, v0 - .03, u - .015), (-t * .3, v1 + .03, u + .015)))
    for i in range(3):
        v = v0 + (v1 - v0) * i / 2
        bars.append(block((-t * .6, v - .015, u0 - .03), (-t * .3 + .005, v + .015, u1 + .03)))
    s.put("frame", None, frame, *bars)

    wood = s.material("wood", colour(r))
    long, deep = r.uniform(1, 1.8), r.uniform(.7, 1)
    x, z = width * .5, depth * .5
    table = [block((x - long / 2, .72, z - deep / 2), (x + long / 2, .76, z + deep / 2))]
    for i in (-1, 1):
        for k in (-1, 1):
            leg = (x + i * (long / 2 - .06), z + k * (deep / 2 - .06))
            table.append(block((leg[0] - .02, 0, leg[1] - .02), (leg[0] + .02, .73, leg[1] + .02)))
    s.put("table", None, wood, *table)
    for i in range(r.randint(1, 3)):
        at = (x + r.uniform(-1.2, 1.2), 0, z + r.choice([-1, 1]) * r.uniform(.6, .9))
        turn = r.uniform(0, 360)
        chair = [block((-.2, .43, -.2), (.2, .46, .2)), block((-.2, .46, .18), (.2, .95, .2))]
        for j in (-1, 1):
            for k in (-1, 1):
                chair.append(block((j * .18 - .015, 0, k * .18 - .015), (j * .18 + .015, .44, k * .18 + .015)))
        s.put(f"chair {i}", None, s.material(f"chair {i}", colour(r)), *chair, at=at, turn=turn_y(turn))

    shelf = s.material("shelf", colour(r))
    low = r.uniform(1.3, 1.6)
    s.put("shelf", None, shelf,
          *[block((.3, low + .35 * i, depth - .3), (width - .5, low + .35 * i + .018, depth)) for i in range(2)],
          block((.3, low, depth - .3), (.318, low + .4, depth)),
          block((width - .518, low, depth - .3), (width - .5, low + .4, depth)))
    cup = lathe([[(0, 0), (.035, 0)], [(.035, 0), (.04, .03), (.042, .09)], [(.042, .09), (.039, .09)],
                 [(.039, .09), (.037, .03), (.0, .008)]], 24)
    china = s.material("cup", colour(r, .5, .9))
    for i in range(14):
        s.put(f"cup {i}", None, china, cup,
              at=(.45 + (width - 1.2) * r.random(), low + .018 + .35 * r.randint(0, 1), depth - r.uniform(.06, .24)))
    vase = lathe([[(0, 0)] + [(.12 * math.sin(math.pi * i / 60), .15 * (1 - math.cos(math.pi * i / 60)))
                              for i in range(1, 60)]], 200)
    s.put("vase", None, s.material("vase", colour(r)), vase, at=(x, .76, z))
    s.put("fridge", None, s.material("fridge", (.8, .8, .82)), block((width - .7, .02, .05), (width - .05, 1.8, .7)))
    s.put("cupboards", None, s.material("cupboards", colour(r)),
          *[block((.02 + .62 * i, .1, depth - .6), (.02 + .62 * i + .6, .85, depth))
            for i in range(int((width - .6) / .62))],
          block((0, .85, depth - .62), (width - .5, .89, depth)))
    shade = s.material("shade", colour(r, .6, .9))
    s.put("shade", None, shade, lathe([[(.2, 0), (.06, .18)], [(.055, .18), (.195, 0)]], 32), at=(x, height - .75, z))
    s.put("cord", None, shade, cylinder(.006, .6, 8), at=(x, height - .58, z))

    def sheet(a, b): return (.06 + .03 * math.sin(25 * a), v1 + .1 - (v1 - v0 + .3) * b, u0 - .35 + .45 * a)

    def curtain(a, b, e=1e-4):
        along, down = sub(sheet(a + e, b), sheet(a - e, b)), sub(sheet(a, b + e), sheet(a, b - e))
        return sheet(a, b), unit(cross(along, down))
    cloth = s.material("curtain", colour(r, .5, .8))
    s.gltf["materials"][cloth]["doubleSided"] = True
    s.put("curtain", None, cloth, Shape().grid(40, 6, curtain))
    sun(s, (-6, r.uniform(4, 8), depth / 2 + r.uniform(-3, 3)), (width * .3, 0, depth * .5))
    s.camera("a", (width - .3, 1.6, .9), (.5, .9, depth * .6), 70)
    s.camera("b", (.5, 1.5, depth - .9), (width - 1, .8, .5), 70)


def church(s, r, closed=True):
    """A nave under a vault of strips, with pillars, ribs and pews, opaque panes in its windows; in the open one a
    window has no pane."""
    length, width, height = r.uniform(14, 24), r.uniform(6, 9), r.uniform(5, 8)
    t, bays = r.choice([.15, .3, .6]), r.randint(3, 6)
    windows = [(length * (i + .35) / bays, 1.5, length * (i + .65) / bays, height - 1) for i in range(bays)]
    stone, floor = s.material("stone", colour(r, .5, .8)), s.material("floor", colour(r))
    s.put("floor", None, floor, block((-t, -.4, -t), (length + t, 0, width + t)))
    s.put("walls", None, stone,
          *wall(2, -t, t, (-t, -.2), (length + t, height + .2), windows),
          *wall(2, width, t, (-t, -.2), (length + t, height + .2), windows),
          *wall(0, -t, t, (-t, -.2), (width + t, height + width / 2 + t)),
          *wall(0, length, t, (-t, -.2), (width + t, height + width / 2 + t), [(width * .4, .0, width * .6, 2.4)]))

    strips, radius, vault = r.choice([12, 16, 24]), width / 2, Shape()
    for i in range(strips):
        def corner(k, at, x):
            angle = math.pi * k / strips
            return (x, height + at * math.sin(angle), width / 2 - at * math.cos(angle))
        for at, outside in ((radius, False), (radius + t, True)):
            origin = corner(i, at, -t)
            u, v = sub(corner(i + 1, at, -t), origin), sub(corner(i, at, length + t), origin)
            inward = dot(cross(u, v), sub((origin[0], height, width / 2), origin)) > 0
            vault.quad(origin, *((u, v) if inward != outside else (v, u)))
    s.put("vault", None, s.material("vault", colour(r, .5, .8)), vault)

    pane, thin, panes = s.material("pane", colour(r, .3, .6)), r.choice([.004, .01, .03]), []
    without = None if closed else r.randrange(bays)
    for i, (a, v0, b, v1) in enumerate(windows):
        for z in (-t * .5, width + t * .4):
            if z < 0 or i != without:
                panes.append(block((a - .02, v0 - .02, z), (b + .02, v1 + .02, z + thin)))
    panes.append(block((length + t * .3, -.1, width * .4 - .05), (length + t * .3 + .05, 2.5, width * .6 + .05)))
    s.put("panes", None, pane, *panes)
    pillar = s.material("pillar", colour(r, .5, .8))
    for i in range(bays + 1):
        for z in (width * .22, width * .78):
            s.put("pillar", None, pillar, cylinder(.18, height + radius * .9, 20), at=(length * i / bays, -.1, z))
    for i in range(bays + 1):
        x = length * i / bays
        s.put("rib", None, stone, block((x - .1, -.1, -t - .8), (x + .1, height * .8, -t * .3)),
              block((x - .1, -.1, width + t * .3), (x + .1, height * .8, width + t + .8)))
    for i in range(8):
        x = 2 + i * .9
        s.put("pew", None, floor, block((x, 0, width * .3), (x + .05, .9, width * .7)),
              block((x, .42, width * .3), (x + .4, .46, width * .7)))
    sun(s, (length / 2 + r.uniform(-8, 8), r.uniform(8, 16), width + 14), (length / 2, 2, width / 2))
    s.camera("a", (1, 1.7, width / 2 + .2), (length, height * .6, width / 2), 75)
    s.camera("b", (length - 1.2, 1.6, width * .35), (length * .3, height * .5, width * .9), 75)


def church_open(s, r):
    church(s, r, closed=False)


def stairs(s, r):
    """Open treads and thin railings in a tall room, the sun through a window high up."""
    width, height, depth, t = 4.2, r.uniform(6, 8), 5.5, r.choice([.1, .25])
    room(s, r, width, height, depth, t,
         {"z-": [(.4, height - 2.2, width - .4, height - .6)], "x+": [(2, 0, 3, 2.1)]})
    tread, rail = s.material("tread", colour(r)), s.material("rail", colour(r, .2, .7))
    thin, steps, treads, rails = r.choice([.012, .03]), 16, [], []
    for i in range(steps):
        x, y = .3 + .22 * i, .18 * (i + 1)
        treads.append(block((x, y - .04, .4), (x + .27, y, 1.5)))
        rails.append(cylinder(thin, .95, 8).moved((x + .13, y, 1.45)))
    x, y = .3 + .22 * steps, .18 * steps
    treads.append(block((x, y - .2, 0), (width, y, depth)))
    rails += [cylinder(thin, .95, 8).moved((x + .05, y, 1.6 + i * .16)) for i in range(24)]
    rails.append(block((x + .02, y + .95, 1.5), (x + .08, y + 1, depth)))
    s.put("treads", None, tread, *treads)
    s.put("rails", None, rail, *rails)
    for i in range(3):
        s.put(f"picture {i}", None, s.material(f"picture {i}", colour(r)),
              block((.8 + i, 1.4, depth - .015), (1.5 + i, 2.1, depth)))
    sun(s, (width / 2 + r.uniform(-2, 2), height + r.uniform(2, 5), -7), (width / 2, height * .3, depth * .6))
    s.camera("a", (.4, 1.6, depth - .4), (3.6, 2.2, .4), 80)
    s.camera("b", (width - .3, y + 1.5, depth - .5), (.5, 1, .6), 80)


def street(s, r):
    """Houses with balconies, bars of 1 to 2.5 cm and awnings of one sheet, trees; the sun from aside."""
    ground = s.material("ground", colour(r, .2, .5))
    s.put("ground", None, ground, block((-20, -.5, -30), (20, 0, 30)))
    rail, awning = s.material("rail", colour(r, .1, .5)), s.material("awning", colour(r, .4, .8))
    s.gltf["materials"][awning]["doubleSided"] = True
    for side in (-1, 1):
        z = -24
        while z < 22:
            length, height, deep = r.uniform(5, 9), r.uniform(6, 14), r.uniform(5, 8)
            x, house = side * 5, s.material("house", colour(r, .3, .85))
            near, far = sorted((x, x + side * deep))
            s.put("house", None, house, block((near, -.2, z), (far, height, z + length - r.choice([0, 0, .8]))))
            for level in range(1, int(height / 3)):
                y, wide, from_z = 3 * level, r.uniform(1.5, length - 1), z + .3
                near, far = sorted((x, x - side * 1.1))
                s.put("balcony", None, house, block((near, y - .12, from_z), (far, y, from_z + wide)))
                thin, edge = r.choice([.012, .025]), x - side * 1.07
                s.put("bars", None, rail,
                      *[block((edge - thin, y, from_z + .03 + .14 * i - thin),
                              (edge + thin, y + 1, from_z + .03 + .14 * i + thin)) for i in range(int(wide / .14))],
                      block((edge - .03, y + 1, from_z), (edge + .03, y + 1.04, from_z + wide)))
            if r.random() < .6:
                s.put("awning", None, awning,
                      Shape().quad((x, 2.7, z + .5), (-side * 1.6, -.5, 0), (0, 0, min(3, length - 1))))
            z += length
    for _ in range(6):
        x, z = r.uniform(-4, 4), r.uniform(-20, 20)
        leaf = s.material("leaf", colour(r, .1, .5))
        s.put("tree", None, leaf, sphere(r.uniform(.6, 1.2), 24, 12), at=(x, 2.2, z))
        s.put("trunk", None, rail, cylinder(.1, 2.4, 10), at=(x, 0, z))
    sun(s, (r.uniform(6, 16), 14, r.uniform(-9, 9)), (0, 0, 0))
    s.camera("a", (.5, 1.7, -22), (-1, 3, 10), 70)
    s.camera("b", (-3.5, 1.7, 12), (4, 4.5, -3), 75)


def attic(s, r):
    """Under a pitched roof with rafters and a skylight, on planks with gaps of 8 mm."""
    width, depth, knee, t = r.uniform(5, 7), r.uniform(6, 9), .8, r.choice([.03, .12])
    pitch = math.radians(r.uniform(35, 50))
    rise = math.tan(pitch) * width / 2
    plank = s.material("plank", colour(r, .4, .75))
    plaster, beam = s.material("plaster", colour(r, .5, .85)), s.material("beam", colour(r, .3, .6))
    s.put("floor", None, plank,
          *[block((i * width / 30 + .004, -.03, 0), ((i + 1) * width / 30 - .004, 0, depth)) for i in range(30)],
          block((-.3, -.3, -.3), (width + .3, -.05, depth + .3)))
    s.put("knee walls", None, plaster, block((-t, -.3, -t), (0, knee + .05, depth + t)),
          block((width, -.3, -t), (width + t, knee + .05, depth + t)))
    window = (width / 2 - .4, .9, width / 2 + .4, 2.0)
    s.put("gables", None, plaster, *wall(2, -t, t, (-t, -.3), (width + t, knee + rise + t), [window]),
          *wall(2, depth, t, (-t, -.3), (width + t, knee + rise + t)))
    slope = width / 2 / math.cos(pitch) + .3
    for side in (-1, 1):
        turn = (0, 0, -side * math.sin(pitch / 2), math.cos(pitch / 2))
        at = (0, knee, 0) if side < 0 else (width, knee, 0)
        x0, x1 = (-.3, slope) if side < 0 else (-slope, .3)
        if side < 0:
            roof = [block((x0, 0, -t - .2), (x1, t, depth + t + .2))]
        else:  # around the skylight
            roof = [block((x0, 0, -t - .2), (x1, t, 2.0)), block((x0, 0, 3.2), (x1, t, depth + t + .2)),
                    block((x0, 0, 2.0), (-2.2, t, 3.2)), block((-1.2, 0, 2.0), (x1, t, 3.2))]
        s.put("roof", None, plank, *roof, at=at, turn=turn)
        rafters = [.5 + .8 * i for i in range(int(depth / .8))]
        s.put("rafters", None, beam,
              *[block((x0 + .2, -.16, z - .04), (x1 - .25, .02, z + .04))
                for z in rafters if side < 0 or not 2.0 < z < 3.2], at=at, turn=turn)
    for i in range(int(depth / 1.6)):
        s.put("tie", None, beam, block((0, 2.1, .9 + 1.6 * i), (width, 2.2, 1.0 + 1.6 * i)))
    for _ in range(5):
        s.put("crate", None, s.material("crate", colour(r)),
              box(r.uniform(.3, .8), r.uniform(.3, .7), r.uniform(.3, .8)),
              at=(r.uniform(.8, width - .8), 0, r.uniform(2, depth - .8)), turn=turn_y(r.uniform(0, 90)))
    sun(s, (width + 5, 9, r.uniform(-2, 4)), (width * .45, 0, 3))
    s.camera("a", (width / 2, 1.5, depth - .4), (width / 2 - .3, 1.2, 0), 80)
    s.camera("b", (1, 1.4, .6), (width - 1, 1, depth), 80)


def office(s, r):
    """Lamps and tiles of 15 mm in a suspended ceiling, thin partitions, desks, a blind before a wall, a point light."""
    width, height, depth, t = r.uniform(8, 12), 2.8, r.uniform(6, 9), r.choice([.05, .2])
    room(s, r, width, height + .4, depth, t, {})
    tile, lamp = s.material("tiles", colour(r, .6, .85)), s.material("lamp", (.8, .8, .8), radiance=(12, 11, 9))
    edge = r.uniform(.6, 1.2)
    columns, rows, tiles, lamps = int(width / edge), int(depth / edge), [], []
    for i in range(columns):
        for k in range(rows):
            x, z = i * width / columns, k * depth / rows
            one = block((x + .01, height, z + .01), (x + width / columns - .01, height + .015, z + depth / rows - .01))
            (lamps if r.random() < .12 or (i, k) == (1, 1) else tiles).append(one)
    s.put("tiles", None, tile, *tiles)
    s.put("lamps", None, lamp, *lamps)
    partition = s.material("partition", colour(r))
    for i in range(r.randint(2, 4)):
        x = width * (i + 1) / 5
        s.put("partition", None, partition,
              block((x, .05, 0), (x + .02, r.uniform(1.3, 2.5), depth * r.uniform(.4, .75))))
    desk = s.material("desk", colour(r))
    for _ in range(6):
        x, z = r.uniform(.8, width - .8), r.uniform(.6, depth - .6)
        s.put("desk", None, desk, block((-.7, .7, -.35), (.7, .73, .35)), block((-.68, 0, -.33), (-.65, .71, .33)),
              block((.65, 0, -.33), (.68, .71, .33)), block((-.3, .8, -.1), (.3, 1.2, -.08)),
              at=(x, 0, z), turn=turn_y(r.uniform(0, 360)))
    blind = s.material("blind", colour(r, .5, .8))
    s.put("blind", None, blind,
          *[block((.02, .9 + .05 * i, depth * .2), (.045, .902 + .05 * i, depth * .8)) for i in range(28)])
    s.light("point", "bulb", (width * .8, 2, depth * .8), (width * .8, 0, depth * .8 + .1), (1, .8, .6), 3)
    s.camera("a", (.4, 1.6, depth - .4), (width, 1, .5), 80)
    s.camera("b", (width - .4, 1.5, depth * .5), (0, 1.4, depth * .45), 80)


KINDS = {make.__name__: make for make in (kitchen, church_open, church, stairs, street, attic, office)}


def quaternion(r, seed):
    if seed % 3 == 0:
        return None
    axis = (0, 1, 0) if seed % 3 == 1 else unit(tuple(r.gauss(0, 1) for _ in range(3)))
    angle = r.uniform(0, 2 * math.pi)
    return [c * math.sin(angle / 2) for c in axis] + [math.cos(angle / 2)]


def turned(glb, rotation):
    """The file with everything below one node that turns it."""
    if rotation is None:
        return glb
    length = struct.unpack_from("<I", glb, 12)[0]
    gltf, rest = json.loads(glb[20:20 + length]), glb[20 + length:]
    scene = gltf["scenes"][0]
    gltf["nodes"].append({"name": "turn", "rotation": rotation, "children": scene["nodes"]})
    scene["nodes"] = [len(gltf["nodes"]) - 1]
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    return header + struct.pack("<I4s", len(text), b"JSON") + text + rest


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    words, _, files = " ".join(arguments[1:]).partition("--")
    folder, seeds = Path(arguments[0]), [int(word) for word in words.split()]
    folder.mkdir(parents=True, exist_ok=True)
    for seed in seeds:
        for kind, make in KINDS.items() if not files else ():
            r, s = random.Random(kind + str(seed)), Scene(kind, "irad assets/make_strangers.py", textured=False)
            make(s, r)
            glb = s.glb()
            (folder / f"{kind}{seed}.glb").write_bytes(turned(glb, quaternion(r, seed)))
        for file in map(Path, files.split()):
            r = random.Random(file.stem + str(seed))
            (folder / f"{file.stem}{seed}.glb").write_bytes(turned(file.read_bytes(), quaternion(r, seed)))


if __name__ == "__main__":
    main(sys.argv[1:])
