"""Vectors, rotations and shapes for the scripts that make the built-in scenes. Python's standard library only."""

import math

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


# ---- shapes: lists of vertices (position, normal, uv) and triangles, counter-clockwise from outside -----------------


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

    def triangle(self, a, b, c):
        n, first = unit(cross(sub(b, a), sub(c, a))), len(self.vertices)
        self.vertices += [(p, n, (0.0, 0.0)) for p in (a, b, c)]
        self.triangles.append((first, first + 1, first + 2))
        return self

    def moved(self, at, turn=(0.0, 0.0, 0.0, 1.0)):
        """A copy, turned and then moved."""
        copy = Shape()
        copy.vertices = [(add(rotate(turn, p), at), rotate(turn, n), uv) for p, n, uv in self.vertices]
        copy.triangles = list(self.triangles)
        return copy

    def __add__(self, other):
        both, first = Shape(), len(self.vertices)
        both.vertices = self.vertices + other.vertices
        both.triangles = self.triangles + [tuple(first + v for v in t) for t in other.triangles]
        return both

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


def block(low, high):
    """The box between two corners."""
    size = sub(high, low)
    return box(*size).moved(((low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2))


def cylinder(radius, height, columns):
    """Standing on y = 0, closed."""
    return lathe([[(0, 0), (radius, 0)], [(radius, 0), (radius, height)], [(radius, height), (0, height)]], columns)


def revolve(profile, start, end, columns):
    """A closed polygon of (radius, height), counter-clockwise seen with the axis on the left, turned from `start`
    to `end` degrees about the y axis, with its ends closed. All of the polygon is to be seen from its first corner."""
    shape = Shape()
    turn = math.radians(end - start)

    def place(r, y, s):
        angle = math.radians(start) + turn * s
        return (r * math.sin(angle), y, r * math.cos(angle))
    for (r, y), (q, w) in zip(profile, profile[1:] + profile[:1]):
        length = math.hypot(q - r, w - y)
        shape.grid(columns, 1, lambda s, t: (place(r + (q - r) * t, y + (w - y) * t, s),
                                             place((w - y) / length, (r - q) / length, s)))
    for s in (0, 1):
        corners = [place(r, y, s) for r, y in profile]
        for b, c in zip(corners[1:-1], corners[2:]):
            shape.triangle(corners[0], c, b) if s else shape.triangle(corners[0], b, c)
    return shape


def tube(curve, radius, columns, rows, closed=False):
    """Sweeps a circle of radius(s) along curve(s), s from 0 to 1; the curve lies in a plane z = constant."""
    def vertex(s, t):
        along = unit(sub(curve(s + 1e-5), curve(s - 1e-5)))
        side, angle = (0.0, 0.0, 1.0), 2 * math.pi * t
        n = add(scale(cross(side, along), math.cos(angle)), scale(side, -math.sin(angle)))
        return add(curve(0.0 if closed and s == 1 else s), scale(n, radius(s))), n
    return Shape().grid(columns, rows, vertex)


def sheet(columns, rows, top, thickness):
    """A thin curved sheet: top(s, t) -> position, (d/ds) x (d/dt) upwards."""
    def normal(s, t):
        e = 1e-4
        return unit(cross(sub(top(s + e, t), top(s - e, t)), sub(top(s, t + e), top(s, t - e))))

    def below(s, t): return sub(top(s, t), (0, thickness, 0))
    shape = Shape().grid(columns, rows, lambda s, t: (top(s, t), normal(s, t)))
    shape.grid(rows, columns, lambda t, s: (below(s, t), scale(normal(s, t), -1)))
    edges = [[(k / columns, 0) for k in range(columns + 1)], [(1, k / rows) for k in range(rows + 1)],
             [(1 - k / columns, 1) for k in range(columns + 1)], [(0, 1 - k / rows) for k in range(rows + 1)]]
    for edge in edges:
        for a, b in zip(edge, edge[1:]):
            shape.triangle(below(*a), below(*b), top(*b))
            shape.triangle(below(*a), top(*b), top(*a))
    return shape


def loft(sections, crease=35):
    """A solid through closed polygons of equally many corners, with its ends closed by fans about their middles."""
    n = len(sections[0])
    points = [p for section in sections for p in section]
    triangles = []
    for j in range(len(sections) - 1):
        for i in range(n):
            a, b = j * n + i, j * n + (i + 1) % n
            triangles += [(a, b, b + n), (a, b + n, a + n)]
    for first, flip in ((0, True), ((len(sections) - 1) * n, False)):
        points.append(scale(tuple(map(sum, zip(*points[first:first + n]))), 1 / n))
        for i in range(n):
            a, b = first + i, first + (i + 1) % n
            triangles.append((b, a, len(points) - 1) if flip else (a, b, len(points) - 1))
    return smooth(points, triangles, crease)


def smooth(points, triangles, crease):
    """Triangles with normals that are averaged over neighbours that turn by less than `crease` degrees."""
    shape, limit = Shape(), math.cos(math.radians(crease))
    faces = [cross(sub(points[b], points[a]), sub(points[c], points[a])) for a, b, c in triangles]
    keep = [k for k, f in enumerate(faces) if math.hypot(*f) > 1e-3]
    around = {}
    for k in keep:
        for v in triangles[k]:
            around.setdefault(v, []).append(k)
    known = {}
    for k in keep:
        n, corners = unit(faces[k]), []
        for v in triangles[k]:
            near = [faces[o] for o in around[v] if dot(unit(faces[o]), n) > limit]
            key = (v, tuple(round(c, 5) for c in unit(tuple(map(sum, zip(*near))))))
            if key not in known:
                known[key] = len(shape.vertices)
                shape.vertices.append((points[v], unit(key[1]), (0.0, 0.0)))
            corners.append(known[key])
        shape.triangles.append(tuple(corners))
    return shape


def surface(field, low, counts, cell):
    """The surface field(p) = 0 of what is inside where field < 0, by surface nets on counts[0..2] cubes from `low`: one
    point for each cube that the surface passes, two triangles for each edge that it cuts. Returns both,
    for smooth()."""
    nx, ny, nz = counts

    def node(i, j, k): return add(low, (cell * i, cell * j, cell * k))
    values = {(i, j, k): field(node(i, j, k)) for i in range(nx + 1) for j in range(ny + 1) for k in range(nz + 1)}
    axes = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    sides = [(c, tuple(add(c, a))) for c in corners for a in axes if max(add(c, a)) < 2]
    points, index = [], {}
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                cuts = []
                for a, b in sides:
                    p, q = add((i, j, k), a), add((i, j, k), b)
                    f, g = values[p], values[q]
                    if (f < 0) != (g < 0):
                        cuts.append(add(node(*p), scale(sub(node(*q), node(*p)), f / (f - g))))
                if cuts:
                    index[i, j, k] = len(points)
                    points.append(scale(tuple(map(sum, zip(*cuts))), 1 / len(cuts)))
    triangles = []
    for p, f in values.items():
        for axis in range(3):
            u, v = axes[(axis + 1) % 3], axes[(axis + 2) % 3]
            g = values.get(add(p, axes[axis]))
            around = [index.get(c) for c in (sub(sub(p, u), v), sub(p, v), p, sub(p, u))]
            if g is None or (f < 0) == (g < 0) or None in around:
                continue
            a, b, c, d = around if f < 0 else reversed(around)
            # Along the shorter diagonal.
            if math.dist(points[a], points[c]) <= math.dist(points[b], points[d]):
                triangles += [(a, b, c), (a, c, d)]
            else:
                triangles += [(b, c, d), (b, d, a)]
    return points, triangles
