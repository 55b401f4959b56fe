"""Builds .glb files with Python's standard library alone: vectors, shapes, PNG images, a glTF 2.0 writer and reader.

The bytes are the same on every run and machine: coordinates are rounded to 1e-6 before they become fp32, images are
stored uncompressed inside their PNG.
"""

import json
import math
import struct
import zlib

FLOAT, UINT16 = 5126, 5123
VERTEX_BUFFER, INDEX_BUFFER = 34962, 34963
REPEAT, LINEAR, LINEAR_MIPMAP_LINEAR = 10497, 9729, 9987


# ---- small vector arithmetic ----------------------------------------------------------------------------------------


def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def scale(a, s): return tuple(x * s for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return scale(a, 1 / math.sqrt(dot(a, a)))


def turn_y(degrees):
    """Quaternion (x, y, z, w) of a turn about the vertical."""
    half = math.radians(degrees) / 2
    return (0.0, math.sin(half), 0.0, math.cos(half))


def look(eye, target):
    """Quaternion that takes -Z to the direction from eye to target and keeps the horizon level."""
    x, y, z = unit(sub(target, eye))
    yaw, pitch = math.atan2(-x, -z) / 2, math.asin(y) / 2
    return (math.cos(yaw) * math.sin(pitch), math.sin(yaw) * math.cos(pitch),
            -math.sin(yaw) * math.sin(pitch), math.cos(yaw) * math.cos(pitch))


def rotate(q, v):
    u, w = q[:3], q[3]
    t = scale(cross(u, v), 2)
    return add(add(v, scale(t, w)), cross(u, t))


# ---- shapes: lists of vertices (position, normal, uv) and triangles, counter-clockwise from outside -------------------


class Shape:
    def __init__(self):
        self.vertices, self.triangles = [], []

    def quad(self, corner, u, v, repeat=(1.0, 1.0)):
        """The parallelogram corner + s u + t v, facing u x v; texture coordinates run from 0 to repeat."""
        n, first = unit(cross(u, v)), len(self.vertices)
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            position = add(corner, add(scale(u, s), scale(v, t)))
            self.vertices.append((position, n, (s * repeat[0], (1 - t) * repeat[1])))
        self.triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        return self

    def grid(self, columns, rows, vertex):
        """A surface over the unit square: vertex(s, t) -> (position, normal), (d/ds) x (d/dt) pointing outwards.
        Triangles that shrink to nothing (poles) are left out."""
        first = len(self.vertices)
        for j in range(rows + 1):
            for i in range(columns + 1):
                s, t = i / columns, j / rows
                self.vertices.append((*vertex(s, t), (s, 1 - t)))
        for j in range(rows):
            for i in range(columns):
                a = first + j * (columns + 1) + i
                b, c, d = a + 1, a + columns + 2, a + columns + 1
                for triangle in ((a, b, c), (a, c, d)):
                    p, q, r = (self.vertices[k][0] for k in triangle)
                    if math.hypot(*cross(sub(q, p), sub(r, p))) > 1e-7:
                        self.triangles.append(triangle)
        return self


def box(width, height, depth, skip_bottom=False):
    """Centred over the origin, standing on y = 0."""
    x, y, z = width / 2, height, depth / 2
    shape = Shape()
    shape.quad((-x, 0, z), (width, 0, 0), (0, y, 0))        # front
    shape.quad((x, 0, -z), (-width, 0, 0), (0, y, 0))       # back
    shape.quad((x, 0, z), (0, 0, -depth), (0, y, 0))        # right
    shape.quad((-x, 0, -z), (0, 0, depth), (0, y, 0))       # left
    shape.quad((-x, y, z), (width, 0, 0), (0, 0, -depth))   # top
    if not skip_bottom:
        shape.quad((-x, 0, -z), (width, 0, 0), (0, 0, depth))
    return shape


def sphere(radius, columns, rows):
    """Centred over the origin, standing on y = 0."""
    def vertex(s, t):
        longitude, latitude = 2 * math.pi * s, math.pi * (t - 0.5)
        n = (math.cos(latitude) * math.sin(longitude), math.sin(latitude), math.cos(latitude) * math.cos(longitude))
        return add(scale(n, radius), (0, radius, 0)), n
    return Shape().grid(columns, rows, vertex)


def knot(radius, tube, columns, rows):
    """A (2, 3) torus knot in the xy plane swept by a circle of radius `tube`; its lowest ring is found by the caller."""
    def curve(s):
        angle = 2 * math.pi * s
        reach = radius * (1 + 0.42 * math.cos(3 * angle))
        return (reach * math.sin(2 * angle), reach * math.cos(2 * angle), 0.62 * radius * math.sin(3 * angle))

    def vertex(s, t):
        centre, step = curve(s), 1e-5
        along = unit(sub(curve(s + step), curve(s - step)))
        side = unit(cross(along, centre))  # the curve never passes through the origin
        across = cross(side, along)
        angle = 2 * math.pi * t
        n = add(scale(across, math.cos(angle)), scale(side, -math.sin(angle)))
        return add(centre, scale(n, tube)), n
    return Shape().grid(columns, rows, vertex)


def lathe(profile, columns):
    """Turns smooth strips of (radius, height) about the y axis; every strip runs with its outer side on the right."""
    shape = Shape()
    for strip in profile:
        rows = len(strip) - 1

        def vertex(s, t, strip=strip, rows=rows):
            k = round(t * rows)
            before, after = strip[max(k - 1, 0)], strip[min(k + 1, rows)]
            dr, dy = after[0] - before[0], after[1] - before[1]
            length, angle = math.hypot(dr, dy), 2 * math.pi * s
            out = (math.sin(angle), 0.0, math.cos(angle))
            r, y = strip[k]
            return (out[0] * r, y, out[2] * r), (out[0] * dy / length, -dr / length, out[2] * dy / length)
        shape.grid(columns, rows, vertex)
    return shape


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

    def __init__(self, name, generator):
        self.binary = bytearray()
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
            indices = struct.pack(f"<{3 * len(shape.triangles)}H", *(i for t in shape.triangles for i in t))
            primitives.append({
                "attributes": {"POSITION": self.floats(positions, "VEC3", bounds=True),
                               "NORMAL": self.floats(normals, "VEC3"), "TEXCOORD_0": self.floats(uvs, "VEC2")},
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

    def glb(self):
        binary = bytes(self.binary) + bytes(-len(self.binary) % 4)
        text = json.dumps({**self.gltf, "buffers": [{"byteLength": len(binary)}]}, separators=(",", ":")).encode()
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
