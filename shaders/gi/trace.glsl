// Rays through the voxel grid, shared by the matrix build, emitter samples and specular tracing (docs/method.md 3, 5,
// 8). Everything is in voxel units: cell c spans [c, c + 1).
//
//   TraceWorld world = TraceWorld(facetRecord.at[0], chebyshev, dims, jfaMax);
//   TraceHit hit = traceRay(world, origin, direction, normal);
//
// `normal` is the geometric normal of the surface that the ray leaves (unit; direction . normal > 0 expected).
// hit.facet is a facet index, or one of TRACE_ESCAPED, TRACE_BLOCKED, TRACE_INVALID; hit.t the distance in voxels. The
// traversal, the hit rule and the encoding of normals are specialization constants. TRACE_JFA needs the variant of a
// shader that has TRACE_JFA_BINDING, where the distance volume is bound (shaders/CMakeLists.txt); without, that value
// behaves as TRACE_DDA_REVERSE. `#define TRACE_AHEAD n` lets cell-by-cell walks load n cells at once, for kernels in which few rays
// wait for them.
//
// Hit rule `robust`: the ray is met by facet planes, not by cells. A facet's plane is taken inside its own cell; a ray
// that meets none in a cell marked FACET_CORNER asks the cells around, whose surfaces may pass through unrecorded. A
// plane is met from the front only by rays that start in front of it. Backs of faces make the ray invalid or block it.
// Hit rule `thesis` (T 5.6): the first cell with a front face (d . n < 0), back faces let through.
#ifndef IRAD_TRACE_GLSL
#define IRAD_TRACE_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "shared/constants.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

layout(constant_id = CONSTANT_TRACE_METHOD) const uint TRACE_METHOD = TRACE_DDA_REVERSE;
layout(constant_id = CONSTANT_TRACE_HIT_RULE) const uint TRACE_HIT_RULE = HIT_RULE_ROBUST;
layout(constant_id = CONSTANT_NORMALS) const uint TRACE_NORMALS = NORMALS_OCT16;
layout(constant_id = CONSTANT_TRACE_MANY) const bool TRACE_MANY = true;  ///< a voxel may have more than two facets

struct TraceWorld {
  FacetArrays facets;
  ByteArray chebyshev;  ///< unread with TRACE_DDA_REVERSE and TRACE_JFA
  uvec3 dims;
  float jfaMax;  ///< voxels that 1.0 stands for in the UNORM8 volume; TRACE_JFA only
};

struct TraceHit {
  uint facet;
  float t;
  uint steps;  ///< cells visited
};

/// Where the ray is: the cell and the distance at which it entered it.
struct TraceWalk {
  vec3 origin, direction, inverse;
  vec3 forward;  ///< per axis 1 where the direction is positive, else 0
  vec3 cell;
  float t;
};

TraceWalk traceStart(vec3 origin, vec3 direction) {
  TraceWalk w;
  w.origin = origin;
  // A zero component would give 0 x inf below; 1e-9 moves the ray by 1e-6 voxels across the largest grid.
  w.direction = mix(direction, vec3(1e-9f), lessThan(abs(direction), vec3(1e-9f)));
  w.inverse = 1.0f / w.direction;
  w.forward = step(vec3(0.0f), w.direction);
  w.cell = floor(origin);
  w.t = 0.0f;
  return w;
}

bool traceInside(TraceWalk w, uvec3 dims) {
  return all(greaterThanEqual(w.cell, vec3(0.0f))) && all(lessThan(w.cell, vec3(dims)));
}

uint traceIndex(vec3 cell, uvec3 dims) {
  return voxelIndex(uvec3(cell), dims);
}

/// Distance at which the ray leaves the cube of cells within `k` - 1 of its cell (k = 1: the cell itself).
vec3 traceBounds(TraceWalk w, float k) {
  vec3 bound = w.cell + (1.0f - k) + w.forward * (2.0f * k - 1.0f);
  return (bound - w.origin) * w.inverse;
}

/// Steps out of that cube. The exit axis moves by whole cells; the others follow from the ray's position, held inside
/// the cube, so that hits equal those of the cell-by-cell walk (Amanatides and Woo 1987).
void traceAdvance(inout TraceWalk w, float k) {
  vec3 t = traceBounds(w, k);
  float exit = min(t.x, min(t.y, t.z));
  bvec3 axis = bvec3(t.x == exit, t.y == exit && t.x != exit, t.z == exit && t.x != exit && t.y != exit);
  vec3 along = clamp(floor(w.origin + exit * w.direction), w.cell - (k - 1.0f), w.cell + (k - 1.0f));
  w.cell = mix(along, w.cell + (w.forward * 2.0f - 1.0f) * k, axis);
  w.t = exit;
}

/// 0 where the cell is solid, else how many cells may be stepped over at once.
float traceClearance(TraceWorld world, vec3 cell) {
  uint index = traceIndex(cell, world.dims);
  if (TRACE_METHOD == TRACE_SKIP) return float(uint(world.chebyshev.at[index]));
  if (TRACE_METHOD == TRACE_DDA_FIELD) return uint(world.chebyshev.at[index]) == 0u ? 0.0f : 1.0f;
  return world.facets.reverse.at[index] == NO_FACET ? 1.0f : 0.0f;
}

#ifdef TRACE_JFA_BINDING
#include "thesis/trace_jfa.glsl"  // its traceToSolid
#else
/// Walks to the next solid cell, the present one included. False: left the grid.
bool traceToSolid(TraceWorld world, inout TraceWalk w, inout uint steps) {
#ifdef TRACE_AHEAD
  // In a cell-by-cell walk the next cells are known before their contents, so several are read at once.
  while (TRACE_METHOD != TRACE_SKIP && traceInside(w, world.dims)) {
    vec3 cell[TRACE_AHEAD];
    float t[TRACE_AHEAD], clearance[TRACE_AHEAD];
    bool inside[TRACE_AHEAD];
    [[unroll]] for (int i = 0; i < TRACE_AHEAD; ++i) {
      cell[i] = w.cell;
      t[i] = w.t;
      inside[i] = (i == 0 || inside[max(i - 1, 0)]) && traceInside(w, world.dims);
      clearance[i] = traceClearance(world, inside[i] ? w.cell : cell[0]);
      traceAdvance(w, 1.0f);
    }
    [[unroll]] for (int i = 0; i < TRACE_AHEAD; ++i) {
      if (inside[i] && clearance[i] > 0.0f) {
        ++steps;
        continue;
      }
      w.cell = cell[i];
      w.t = t[i];
      return inside[i];
    }
  }
#endif
  while (traceInside(w, world.dims)) {
    float k = traceClearance(world, w.cell);
    if (k <= 0.0f) return true;
    ++steps;
    traceAdvance(w, k);
  }
  return false;
}
#endif

struct TracePlane {
  vec3 normal;
  float start;  ///< signed distance of the ray's origin
  float slope;  ///< d . n
};

TracePlane tracePlane(TraceWorld world, TraceWalk w, vec3 cell, uint shape) {
  TracePlane p;
  p.normal = decodeNormal(shape & 0xFFFFu, TRACE_NORMALS);
  p.start = dot(p.normal, w.origin - (cell + 0.5f)) - facetOffset(shape);
  p.slope = dot(p.normal, w.direction);
  return p;
}

/// The first of the cells around `cell` that are set in `around` (FacetArrays::around).
vec3 cellAround(vec3 cell, uint around) {
  int i = findLSB(around);
  return cell + vec3(ivec3(i % 3, (i / 3) % 3, i / 9) - 1);
}

vec3 facetMiddle(vec3 cell, vec3 normal, uint shape) {
  return cell + 0.5f + normal * facetOffset(shape);
}

/// Whether a ray starts behind a face, from the signed distances of its origin and of the middle of the facet that it
/// leaves: where the planes are too uncertain to tell, the origin is on the side of that middle.
bool startsBehind(float start, float middle) {
  return start < (middle < -TRACE_BEHIND ? TRACE_BEHIND : -TRACE_BEHIND);
}

/// The plane of `p` as x, y, z, w of n . x + w = 0, in voxel units; through the origin of a ray that starts in front of
/// it within what planes are known to.
vec4 planeEquation(TracePlane p, TraceWalk w, bool behind) {
  return vec4(p.normal, (behind ? p.start : max(p.start, 0.0f)) - dot(p.normal, w.origin));
}

/// How far the extension of a face around, whose middle is given, is taken beyond its end where the ray crosses it: it
/// ends at the plane of the face recorded here, beyond which its middle does not lie. Voxels; <= 0: it still exists.
float overrun(vec4 recorded, vec3 middle, vec3 crossing) {
  float side = dot(recorded.xyz, middle) + recorded.w;
  float here = dot(recorded.xyz, crossing) + recorded.w;
  return side < 0.0f ? here : -here;
}

/// Whether a face has ended before `crossing`, a point of its plane in its cell: it lies in front of a face that meets
/// it convexly. `around`: FacetArrays::around of a corner's facet, else 0.
bool cutOff(TraceWorld world, vec3 cell, uint around, vec3 normal, vec3 crossing) {
  uint convex = around >> AROUND_CONVEX_SHIFT;
  around &= AROUND_VOXELS;
  for (; convex != 0u; convex >>= 1) {
    if ((convex & 1u) != 0u) {
      vec3 at = cellAround(cell, around);
      uint entry = world.facets.reverse.at[traceIndex(at, world.dims)];
      uint other = firstFacet(entry);
      uint shape = world.facets.shape.at[other];
      vec3 facing = decodeNormal(shape & 0xFFFFu, TRACE_NORMALS);
      bool own = dot(facing, normal) >= TRACE_OWN_NORMAL;
      while (own) {  // the facets before it are in the own plane
        shape = world.facets.shape.at[++other];
        facing = decodeNormal(shape & 0xFFFFu, TRACE_NORMALS);
        own = TRACE_MANY && dot(facing, normal) >= TRACE_OWN_NORMAL;
      }
      if (dot(facing, crossing - facetMiddle(at, facing, shape)) > TRACE_ON_PLANE) return true;
    }
    around &= around - 1u;
  }
  return false;
}

/// A face's own cell is asked first. Where FACET_CORNER says so and none of its faces was met, those of cells around
/// (FacetArrays::around) are asked whether their planes, extended, cross this cell. `clear`: how far around the
/// origin's cell there is only the own plane. `ownMiddle`: the middle of the facet that the ray leaves, else the
/// origin.
TraceHit traceRobust(TraceWorld world, TraceWalk w, vec3 ownNormal, vec3 ownMiddle, uint clear) {
  TraceHit hit = TraceHit(TRACE_ESCAPED, 0.0f, 0u);
  uint passed = TRACE_ESCAPED;  // last face passed closely in front of, for rays that slip through a joint
  float passedAt = 0.0f;
  if (clear > 0u) traceAdvance(w, float(clear) + 1.0f);
  while (traceToSolid(world, w, hit.steps)) {
    vec3 bounds = traceBounds(w, 1.0f);
    float leave = min(bounds.x, min(bounds.y, bounds.z));
    uint entry = world.facets.reverse.at[traceIndex(w.cell, world.dims)];
    uint facet = firstFacet(entry);
    uint left = facetsOf(entry);
    vec3 at = w.cell;
    bool recorded = true;  // in this cell; later: in those around
    uint ask = 0u;         // neighbouring cells that may know of more faces
    float nearest = 1e30f;
    uint met = TRACE_ESCAPED;
    float back = 1e30f;  // the same for faces met from behind
    uint backMet = TRACE_ESCAPED;
    vec2 backPlane = vec2(0.0f);
    vec4 planes[4] = vec4[4](vec4(0.0f), vec4(0.0f), vec4(0.0f), vec4(0.0f));  // of the recorded faces
    uint over = 0u;
    for (;;) {
      if (left > 0u) {
        uint shape = world.facets.shape.at[facet];
        TracePlane p = tracePlane(world, w, at, shape);
        float enterS = p.start + p.slope * w.t;
        float leaveS = p.start + p.slope * leave;
        float cross = -p.start / p.slope;
        float alike = dot(p.normal, ownNormal);
        vec3 middle = facetMiddle(at, p.normal, shape);
        float rise = dot(ownNormal, middle - w.origin);  // of the face's middle above the own plane
        bool own = alike > TRACE_OWN_NORMAL && abs(p.start) < TRACE_OWN_PLANE;
        bool behind = startsBehind(p.start, dot(p.normal, ownMiddle - middle));
        uint around = 0u;
        if (recorded) {
          // On the own plane: nothing around can be met as far as this facet's plane is clear.
          if (alike > 0.99999f && abs(p.start) < TRACE_ON_PLANE) over = facetClear(shape);
          if ((shape & FACET_CORNER) != 0u) around = world.facets.around.at[facet];
          ask |= around & AROUND_VOXELS & ~AROUND_SELF;
          if (TRACE_MANY) {
            planes[3] = planes[2];
            planes[2] = planes[1];
          }
          planes[1] = planes[0];
          planes[0] = planeEquation(p, w, behind);
        }
        // A face that looks back at this one, but does not stand clearly in front of it, is the own sheet's other side.
        bool otherSide = alike < -TRACE_OWN_NORMAL && min(rise, p.start) < TRACE_ON_PLANE;
        // A plane crossed before this cell, by more than the surface's joints gape, was passed beside the surface. A
        // plane crossed after this cell is left to the next cell, or ends before it.
        bool front = p.slope < 0.0f && !behind && !otherSide;
        float slack = recorded ? TRACE_PLANE + facetJoint(shape) : TRACE_ON_PLANE;
        bool crosses = front ? leaveS <= min(slack, TRACE_PLANE) && enterS >= -slack
                             : p.slope > 0.0f && !own && recorded && enterS < -TRACE_ON_PLANE &&
                                   leaveS > TRACE_ON_PLANE && cross < back;
        float beyond = 0.0f;
        if (crosses) {
          // Where a ray starts on both planes, a point a little ahead tells the side.
          vec3 crossing = w.origin + clamp(max(cross, TRACE_PLANE), w.t, leave) * w.direction;
          if (!recorded) {
            beyond = max(overrun(planes[0], middle, crossing), overrun(planes[1], middle, crossing));
            if (TRACE_MANY)
              beyond = max(beyond, max(overrun(planes[2], middle, crossing), overrun(planes[3], middle, crossing)));
          }
          crosses = recorded ? !cutOff(world, at, around, p.normal, crossing) : beyond <= TRACE_ON_PLANE;
        }
        if (crosses && front) {
          // Of two extensions of one plane, on both sides of a wall, prefer the one that does not pass the wall.
          cross += max(beyond, 0.0f);
          if (cross < nearest) {
            nearest = cross;
            met = facet;
          }
        } else if (crosses) {
          back = cross;
          backPlane = vec2(p.start, p.slope);
          backMet = (shape & FACET_DOUBLE_SIDED) != 0u ? facet : (cross < TRACE_NEAR ? TRACE_INVALID : TRACE_BLOCKED);
        } else if (front && recorded && leaveS <= TRACE_JOINT && enterS > 0.0f) {
          passed = facet;
          passedAt = leave;
        }
        --left;
        ++facet;
      }
      if (left == 0u) {
        // The back of a sheet whose front is met in the same cell lies in the same plane: only one well in front
        // counts.
        if (recorded && backMet != TRACE_ESCAPED &&
            (met == TRACE_ESCAPED || backPlane.x + backPlane.y * nearest > TRACE_JOINT)) {
          met = backMet;
          nearest = back;
        }
        if (ask == 0u || (recorded && met != TRACE_ESCAPED)) break;
        recorded = false;
        at = cellAround(w.cell, ask);
        ask &= ask - 1u;
        uint other = world.facets.reverse.at[traceIndex(at, world.dims)];
        facet = firstFacet(other);
        left = facetsOf(other);
      }
    }
    if (met != TRACE_ESCAPED) {
      hit.facet = met;
      hit.t = max(nearest, 0.0f);
      break;
    }
    traceAdvance(w, 1.0f + float(over));
    ++hit.steps;
  }
  // Left the grid, or met a back, right after passing closely in front of a face: it slipped through a joint.
  if (hit.facet > TRACE_LAST_FACET && passed != TRACE_ESCAPED) {
    float end = hit.facet == TRACE_ESCAPED ? w.t : hit.t;
    if (end - passedAt < TRACE_NEAR) {
      hit.facet = passed;
      hit.t = passedAt;
    }
  }
  return hit;
}

#include "thesis/trace_hit.glsl"  // traceThesis
#include "gi/trace_triangles.glsl"

TraceHit traceRay(TraceWorld world, vec3 origin, vec3 direction, vec3 normal) {
  TraceWalk w = traceStart(origin, direction);
  if (TRACE_HIT_RULE == HIT_RULE_THESIS) return traceThesis(world, w);
  return traceRobust(world, w, normal, origin, 0u);
}

/// The faces that `around` of a facet names, one after the other.
struct FacesAround {
  uint around, convex;
  uint next;  ///< of the first voxel's
};
FacesAround facesAround(uint around) {
  return FacesAround(around & AROUND_VOXELS, around >> AROUND_CONVEX_SHIFT, 0u);
}
uint nextAround(TraceWorld world, vec3 voxel, inout FacesAround list, out vec3 at, out bool convex) {
  at = cellAround(voxel, list.around);
  convex = (list.convex & 1u) != 0u;
  uint entry = world.facets.reverse.at[traceIndex(at, world.dims)];
  uint facet = firstFacet(entry) + list.next;
  if (++list.next == facetsOf(entry)) {
    list.next = 0u;
    list.around &= list.around - 1u;
    list.convex >>= 1;
  }
  return facet;
}

/// Whether a point of a facet, jittered over its voxel, lies beyond a wall that meets the facet there: behind a face
/// that rises in front of the own plane, not convexly, and not in front of another side of the same solid or sheet (one
/// whose middle is behind that face, or that is its other side; not one that the wall stands on, which goes on behind
/// it).
bool startsInside(TraceWorld world, vec3 voxel, vec3 origin, uint own, vec3 ownNormal, vec3 ownMiddle,
                  uint around) {
  FacesAround walls = facesAround(around);
  while (walls.around != 0u) {
    vec3 at;
    bool convex;
    uint face = nextAround(world, voxel, walls, at, convex);
    if (face == own || convex) continue;
    uint shape = world.facets.shape.at[face];
    vec3 normal = decodeNormal(shape & 0xFFFFu, TRACE_NORMALS);
    vec3 middle = facetMiddle(at, normal, shape);
    if (!startsBehind(dot(normal, origin - middle), dot(normal, ownMiddle - middle)) ||
        dot(ownNormal, middle - origin) < TRACE_CONCAVE || dot(normal, ownNormal) > TRACE_OWN_NORMAL)
      continue;
    bool outside = false;
    vec3 wallVoxel = at;
    FacesAround sides = facesAround(around);
    while (sides.around != 0u && !outside) {
      face = nextAround(world, voxel, sides, at, convex);
      if (face == own) continue;
      shape = world.facets.shape.at[face];
      vec3 facing = decodeNormal(shape & 0xFFFFu, TRACE_NORMALS);
      vec3 other = facetMiddle(at, facing, shape);
      bool opposed = dot(facing, normal) < -TRACE_OWN_NORMAL;
      // The wall stands on this one, which goes on behind it.
      if (!opposed && dot(facing, wallVoxel + 0.5f - other) > voxelExtent(facing) - TRACE_BEHIND) continue;
      float nearSide = opposed ? TRACE_ON_PLANE : -TRACE_ON_PLANE;
      outside = dot(facing, origin - other) > -TRACE_ON_PLANE && dot(normal, other - middle) < nearSide;
    }
    if (!outside) return true;
  }
  return false;
}

/// The same for a ray that starts on a facet (its shape word is `shape`), whose surroundings are known.
TraceHit traceFacetRay(TraceWorld world, vec3 origin, vec3 direction, vec3 normal, uvec3 voxel, uint facet,
                       uint shape) {
  TraceWalk w = traceStart(origin, direction);
  if (TRACE_HIT_RULE == HIT_RULE_THESIS) return traceThesis(world, w);
  vec3 middle = facetMiddle(vec3(voxel), normal, shape);
  if ((shape & FACET_CORNER) != 0u &&
      startsInside(world, vec3(voxel), origin, facet, normal, middle, world.facets.around.at[facet]))
    return TraceHit(TRACE_INVALID, 0.0f, 0u);
  return traceRobust(world, w, normal, middle, w.cell == vec3(voxel) ? facetClear(shape) : 0u);
}

#endif
