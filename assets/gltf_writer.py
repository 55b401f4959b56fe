"""Builds .glb files with Python's standard library alone: PNG images, a glTF 2.0 writer and reader, checks.

The bytes are the same on every run and machine: coordinates are rounded to 1e-6 before they become fp32, images are
stored uncompressed inside their PNG.
"""

import json
import math
import struct
import sys
import zlib
from pathlib import Path
from types import SimpleNamespace

from shapes import add, cross, dot, look, rotate, sub, unit

FLOAT, UINT16 = 5126, 5123
VERTEX_BUFFER, INDEX_BUFFER = 34962, 34963
REPEAT, LINEAR, LINEAR_MIPMAP_LINEAR = 10497, 9729, 9987


# ---- images ---------------------------------------------------------------------------------------------------------


def png(size, pixel):
    """An RGB image, pixel(x, y) -> three values of 0..255. Stored blocks: no two zlibs differ in them."""
    rows = b"".join(b"\0" + bytes(c for x in range(size) for c in pixel(x, y)) for y in range(size))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 0)) + chunk(b"IEND", b"")


def srgb(linear):
    """IEC 61966-2-1, to 8 bits."""
    value = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return round(255 * value)


# ---- the file -------------------------------------------------------------------------------------------------------


class Scene:
    """Collects glTF objects and one binary buffer."""

    def __init__(self, name, generator, textured=True):
        self.binary, self.textured = bytearray(), textured
        self.gltf = {
            "asset": {"version": "2.0", "generator": generator},
            "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
            "scene": 0, "scenes": [{"name": name, "nodes": []}],
            "nodes": [], "meshes": [], "materials": [], "cameras": [], "textures": [], "images": [], "samplers": [],
            "accessors": [], "bufferViews": [], "extensions": {"KHR_lights_punctual": {"lights": []}},
        }

    def append(self, kind, value):
        self.gltf[kind].append(value)
        return len(self.gltf[kind]) - 1

    def view(self, data, **more):
        self.binary += bytes(-len(self.binary) % 4)
        offset = len(self.binary)
        self.binary += data
        return self.append("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **more})

    def floats(self, rows, kind, bounds=False):
        rows = [[round(c, 6) + 0.0 for c in row] for row in rows]
        flat = struct.pack(f"<{sum(map(len, rows))}f", *(c for row in rows for c in row))
        accessor = {"bufferView": self.view(flat, target=VERTEX_BUFFER), "componentType": FLOAT, "count": len(rows),
                    "type": kind}
        if bounds:  # of the values as stored
            stored = list(struct.iter_unpack(f"<{len(rows[0])}f", flat))
            accessor["min"] = [min(column) for column in zip(*stored)]
            accessor["max"] = [max(column) for column in zip(*stored)]
        return self.append("accessors", accessor)

    def texture(self, name, data):
        image = self.append("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(data)})
        if not self.gltf["samplers"]:
            self.append("samplers", {"magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT,
                                     "wrapT": REPEAT})
        return {"index": self.append("textures", {"name": name, "source": image, "sampler": 0})}

    def material(self, name, colour, roughness=1.0, metallic=0.0, texture=None, normal=None, radiance=None):
        pbr = {"baseColorFactor": [*colour, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if texture:
            pbr["baseColorTexture"] = texture
        if normal:
            material["normalTexture"] = normal
        if radiance:
            strength = max(radiance)
            material["emissiveFactor"] = [c / strength for c in radiance]
            material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        return self.append("materials", material)

    def mesh(self, name, *parts):
        primitives = []
        for shape, material in parts:
            assert len(shape.vertices) < 65536
            positions, normals, uvs = zip(*shape.vertices)
            attributes = {"POSITION": self.floats(positions, "VEC3", bounds=True),
                          "NORMAL": self.floats(normals, "VEC3")}
            if self.textured:
                attributes["TEXCOORD_0"] = self.floats(uvs, "VEC2")
            indices = struct.pack(f"<{3 * len(shape.triangles)}H", *(i for t in shape.triangles for i in t))
            primitives.append({
                "attributes": attributes,
                "indices": self.append("accessors", {
                    "bufferView": self.view(indices, target=INDEX_BUFFER), "componentType": UINT16,
                    "count": 3 * len(shape.triangles), "type": "SCALAR"}),
                "material": material, "mode": 4})
        return self.append("meshes", {"name": name, "primitives": primitives})

    def node(self, name, parent=None, at=None, turn=None, **content):
        node = {"name": name, **content}
        if at:
            node["translation"] = [round(c, 6) for c in at]
        if turn:
            node["rotation"] = [round(c, 7) for c in turn]
        index = self.append("nodes", node)
        siblings = self.gltf["nodes"][parent].setdefault("children", []) if parent is not None \
            else self.gltf["scenes"][0]["nodes"]
        siblings.append(index)
        return index

    def put(self, name, parent, material, *shapes, at=None, turn=None):
        """The shapes as one object."""
        whole = shapes[0]
        for shape in shapes[1:]:
            whole = whole + shape
        return self.node(name, parent, at=at, turn=turn, mesh=self.mesh(name, (whole, material)))

    def light(self, kind, name, eye, target, colour, intensity, **more):
        """A sun (`directional`, W/m^2), point or spot light (W/sr) at `eye`, turned to `target`."""
        lights = self.gltf["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"name": name, "type": kind, "color": list(colour), "intensity": intensity, **more})
        self.node(name, at=eye, turn=look(eye, target),
                  extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def camera(self, name, eye, target, degrees, near=0.1, far=100.0):
        index = self.append("cameras", {"name": name, "type": "perspective", "perspective": {
            "aspectRatio": 1.0, "yfov": round(math.radians(degrees), 6), "znear": near, "zfar": far}})
        self.node(name, at=eye, turn=look(eye, target), camera=index)

    def glb(self):
        gltf = {key: value for key, value in self.gltf.items() if value != []}  # glTF allows no empty lists
        binary = bytes(self.binary) + bytes(-len(self.binary) % 4)
        text = json.dumps({**gltf, "buffers": [{"byteLength": len(binary)}]}, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def read(data):
    length, = struct.unpack_from("<I", data, 12)
    gltf, binary = json.loads(data[20:20 + length]), data[20 + length + 8:]

    def accessor(index):
        a = gltf["accessors"][index]
        count = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[a["type"]]
        view = gltf["bufferViews"][a["bufferView"]]
        form = f"<{count}{'f' if a['componentType'] == FLOAT else 'H'}"
        assert struct.calcsize(form) * a["count"] == view["byteLength"], f"accessor {index}: length"
        rows = list(struct.iter_unpack(form, binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]))
        if "min" in a:
            assert a["min"] == [min(c) for c in zip(*rows)] and a["max"] == [max(c) for c in zip(*rows)], "min/max"
        return rows
    return gltf, accessor


# ---- checks ---------------------------------------------------------------------------------------------------------


def inspect(data):
    """Asserts that a file is sound. Returns its glTF, the triangles as placed in the scene, also by object, how many
    vertices there are, and the bounds of each object that is a child of the scene."""
    gltf, accessor = read(data)
    triangles, vertices, bounds, parts = [], 0, {}, []

    def visit(index, group, placements):
        nonlocal vertices
        node = gltf["nodes"][index]
        placements = placements + [(node.get("rotation", (0, 0, 0, 1)), node.get("translation", (0, 0, 0)))]
        for primitive in gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            positions, normals, *uvs = map(accessor, primitive["attributes"].values())
            indices = [i for i, in accessor(primitive["indices"])]
            assert all(len(a) == len(positions) for a in (normals, *uvs)), node["name"]
            assert set(indices) <= set(range(len(positions))), node["name"]
            for n in normals:
                assert abs(math.sqrt(dot(n, n)) - 1) < 1e-5, (node["name"], "normal", n)
            placed = []
            for p in positions:
                for turn, at in reversed(placements):
                    p = add(rotate(turn, p), at)
                placed.append(p)
                low, high = bounds.get(group, (p, p))
                bounds[group] = (tuple(map(min, low, p)), tuple(map(max, high, p)))
            for k in range(0, len(indices), 3):
                a, b, c = indices[k:k + 3]
                face = cross(sub(positions[b], positions[a]), sub(positions[c], positions[a]))
                assert dot(face, face) > 0, (node["name"], "triangle without area", k // 3)
                for v in (a, b, c):
                    assert dot(unit(face), normals[v]) > 0.5, (node["name"], "winding against normal", k // 3)
                triangles.append((placed[a], placed[b], placed[c]))
            vertices += len(positions)
            parts.append((node["name"], triangles[-len(indices) // 3:]))
        for child in node.get("children", ()):
            visit(child, group, placements)

    for root in gltf["scenes"][0]["nodes"]:
        visit(root, gltf["nodes"][root]["name"], [])
    for kind in ("nodes", "meshes", "materials", "cameras", "images", "textures"):
        assert all(item.get("name") for item in gltf.get(kind, ())), kind
    return SimpleNamespace(gltf=gltf, triangles=triangles, vertices=vertices, bounds=bounds, parts=parts)


def check_closed(scene, except_for=()):
    """Asserts that every object is a closed surface with its faces outwards, but for those whose names begin so."""
    for name, triangles in scene.parts:
        edges, volume = {}, 0.0
        for t in triangles:
            corners = [tuple(round(c, 3) for c in p) for p in t]
            volume += dot(t[0], cross(t[1], t[2])) / 6
            for a, b in zip(corners, corners[1:] + corners[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
        assert volume > 0 or name.startswith(except_for), (name, "is inside out", volume)
        unpaired = sum(n != edges.get((b, a), 0) for (a, b), n in edges.items())
        assert unpaired == 0 or name.startswith(except_for), (name, "is not closed:", unpaired, "edges")


def extents(scene):
    low, high = (tuple(map(f, zip(*(b[k] for b in scene.bounds.values())))) for k, f in ((0, min), (1, max)))
    return sub(high, low)


def main(usage, scenes):
    """A script's command line. `scenes` gives, by the file's name, what makes its bytes and what checks it further."""
    arguments = sys.argv[1:]
    checking = "--check" in arguments
    folders = [a for a in arguments if a != "--check"]
    if len(folders) > 1 or any(a.startswith("-") for a in folders):
        sys.exit(usage)
    folder = Path(folders[0]) if folders else Path(__file__).resolve().parent
    for name, (make, check) in scenes.items():
        data, path = make(), folder / name
        if checking:
            assert path.read_bytes() == data, f"{path} is not what this script writes"
        else:
            path.write_bytes(data)
        scene = inspect(data)
        check(scene)
        print(f"{name}: {' x '.join(f'{e:.2f}' for e in extents(scene))}, {len(scene.triangles)} triangles, "
              f"{scene.vertices} vertices, {len(scene.gltf['materials'])} materials, {len(data)} bytes")
