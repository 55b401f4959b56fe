// Rays through the voxel grid, shared by the matrix build, emitter samples and specular tracing (docs/method.md 3, 5,
// 8). Everything is in voxel units: cell c spans [c, c + 1).
//
//   TraceWorld world = TraceWorld(facetRecord.at[0], chebyshev, dims, jfaMax);
//   TraceHit hit = traceTriangles(world, surfaceRecord.at[0], origin, direction, ownTriangle);
//   TraceHit hit = traceThesis(world, traceStart(origin, direction));
//
// hit.facet is a facet index, or one of TRACE_ESCAPED, TRACE_BLOCKED, TRACE_INVALID; hit.t the distance in voxels. The
// traversal, the hit rule and the encoding of normals are specialization constants. TRACE_JFA needs the variant of a
// shader that has TRACE_JFA_BINDING, where the distance volume is bound (shaders/CMakeLists.txt); without, that value
// behaves as TRACE_DDA_REVERSE. `#define TRACE_AHEAD n` lets cell-by-cell walks load n cells at once, for kernels in
// which few rays wait for them.
#ifndef IRAD_TRACE_GLSL
#define IRAD_TRACE_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "gi/tinted.glsl"
#include "shared/constants.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

layout(constant_id = CONSTANT_TRACE_METHOD) const uint TRACE_METHOD = TRACE_DDA_REVERSE;
layout(constant_id = CONSTANT_TRACE_HIT_RULE) const uint TRACE_HIT_RULE = HIT_RULE_TRIANGLES;
layout(constant_id = CONSTANT_NORMALS) const uint TRACE_NORMALS = NORMALS_OCT16;

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

/// A zero component would give 0 x inf below; 1e-9 moves the ray by 1e-6 voxels across the largest grid.
vec3 safeDirection(vec3 direction) {
  return mix(direction, vec3(1e-9f), lessThan(abs(direction), vec3(1e-9f)));
}

TraceWalk traceStart(vec3 origin, vec3 direction) {
  TraceWalk w;
  w.origin = origin;
  w.direction = safeDirection(direction);
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

#include "thesis/trace_hit.glsl"  // traceThesis
#include "gi/trace_triangles.glsl"
#include "gi/trace_outer.glsl"

#endif
