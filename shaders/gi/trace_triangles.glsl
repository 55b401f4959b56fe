// Hit rule `triangles` (docs/method.md 5): a ray is met by the first triangle of the scene. Cells that hold none are
// stepped over; in a solid cell its pieces' triangles are asked. Included by gi/trace.glsl.
#include "gi/piece_cuts.h"
#include "gi/triangle_hit.h"
#include "gi/surface_point.h"
#include "shared/surface.h"

/// Ray k of a facet: from one of its surfels, lifted off the triangle.
struct FacetRay {
  SurfelPoint from;
  vec3 direction;
};

/// false: nothing lies outside the grid, and rays have no code for it.
layout(constant_id = CONSTANT_OUTER) const bool OUTER = true;
bool hasOuter(SurfaceArrays surface) { return OUTER && uint64_t(surface.outer) != 0ul; }

/// A point lifted off its triangle.
vec3 liftedOff(SurfaceArrays surface, uint triangle, vec3 position, vec3 facing) {
  if (!hasOuter(surface)) return liftedStart(position, facing);
  return liftedFar(position, facing, triangleAt(surface.corners, triangle));
}

/// A surfel of the facet, lifted off its triangle.
SurfelPoint liftedSurfel(SurfaceArrays surface, uint facet, uint k) {
  SurfelPoint p = surfelOf(surface, facet, k);
  p.position = liftedOff(surface, p.triangle, p.position, p.facing);
  return p;
}

FacetRay facetRay(SurfaceArrays surface, uint facet, uint packedVoxel, uint k, uint rays, uint seed, uint jitter) {
  uvec4 shifts = rayShifts(packedVoxel, seed, jitter);
  FacetRay ray;
  ray.from = liftedSurfel(surface, facet, raySurfel(k, shifts));
  ray.direction = rayDirection(ray.from.facing, k, rays, shifts);
  return ray;
}

/// What a ray meets first.
struct TriangleHit {
  uint triangle;      ///< NO_TRIANGLE: nothing
  uint piece, entry;  ///< in the voxel where it was found, whose entry of the reverse map
  bool front;
  float t;
  uint steps;  ///< cells visited
};
const uint NO_TRIANGLE = 0xFFFFFFFFu;

/// A ray on its way: the cell that it is in, and of the pieces there the next one to ask.
struct TriangleWalk {
  vec3 origin, direction, inverse;
  ShearedRay ray;
  uint own;  ///< the triangle that it leaves
  vec3 cell;
  float t, leave;  ///< where it enters the cell and where, if there are pieces, it leaves it
  uint piece, endPiece, entry;
  bool tinted;    ///< it has come upon a pane that has let some channels through
  bool collects;  ///< looks for such panes alone: closedChannels
  float nearest;  ///< at which the hit counts as met: its t, or later (backDelay)
  TriangleHit hit;
};

/// Of the last ray: the channels that panes on its way have kept off, as bits (openChannels).
uint closedChannels = 0u;
vec3 letThrough() { return TINTED ? openChannels(closedChannels) : vec3(1.0f); }

/// From inside the grid. Half a voxel before the grid's faces a ray has left all there is: the outermost cells are empty.
TriangleWalk startTriangles(uvec3 dims, vec3 origin, vec3 direction, uint own, float reach) {
  TriangleWalk w;
  w.origin = origin;
  w.direction = safeDirection(direction);
  w.inverse = 1.0f / w.direction;
  w.ray = shearedRay(origin, w.direction);
  w.own = own;
  w.cell = floor(origin);
  w.t = w.leave = 0.0f;
  w.piece = w.endPiece = 0u;
  w.entry = NO_FACET;
  w.tinted = w.collects = false;
  vec3 last = mix(vec3(0.5f), vec3(dims) - 0.5f, greaterThan(w.direction, vec3(0.0f)));
  vec3 bounds = (last - origin) * w.inverse;
  w.nearest = min(reach, min(bounds.x, min(bounds.y, bounds.z)));
  w.hit = TriangleHit(NO_TRIANGLE, 0u, 0u, false, reach, 0u);
  return w;
}

/// Whether a mask leaves the piece where the ray meets it: what has holes is there only where this cell's piece is.
bool leavesMask(SurfaceArrays surface, inout TriangleWalk w, uint triangle, float t) {
  if (!hasHoles(surface.corners, triangle)) return true;
  if (t < w.t || t > w.leave) return false;
  vec3 normal = facingOf(triangleAt(surface.corners, triangle), false);
  vec3 within = w.origin + w.direction * t - w.cell;
  if (isThere(surface, w.piece, normal, within)) return true;
  if (!TINTED || !isTinted(surface.corners, triangle)) return false;
  w.tinted = true;
  if (w.collects) closedChannels |= closedAt(surface, w.piece, normal, within);
  return false;
}

/// Where a meeting that is as near as the hit counts as met. What shows a side costs no further read.
float countsAt(TraceWorld world, SurfaceArrays surface, TriangleWalk w, uint triangle, float t, bool front) {
  if (front || showsBack(surface.corners, triangle)) return t;
  return t + backDelay(world.dims, dot(facingOf(triangleAt(surface.corners, triangle), false), w.direction));
}

/// Whether the ray passes through a box in its cell before its hit. The box's steps are put into the mantissas
/// of numbers from 1 to 2: GPUs convert integers at a quarter of their rate.
bool meetsBox(TriangleWalk w, uint box) {
  const uint STEP = 0x7C0000u, ONE = 0x3F800000u;
  vec3 low = uintBitsToFloat((uvec3(box << 18, box << 13, box << 8) & STEP) | ONE);
  vec3 high = uintBitsToFloat((uvec3(box << 3, box >> 2, box >> 7) & STEP) | ONE);
  vec3 base = (w.cell - 1.0f - w.origin) * w.inverse;
  vec3 a = low * w.inverse + base, b = high * w.inverse + (base + w.inverse * (1.0f / BOX_STEPS));
  vec3 enter = min(a, b), leave = max(a, b);
  return max(enter.x, max(enter.y, enter.z)) <= min(w.nearest, min(leave.x, min(leave.y, leave.z)));
}

/// Asks the next piece.
void askPiece(TraceWorld world, SurfaceArrays surface, inout TriangleWalk w) {
  uint triangle = triangleOf(surface.pieces, w.piece);
  float t;
  bool front;
  if (triangle == w.own || !meetsTriangle(w.ray, triangleAt(surface.corners, triangle), t, front) || t <= 0.0f ||
      t > w.nearest || !leavesMask(surface, w, triangle, t))
    return;
  if (TINTED && w.collects) return;
  float at = countsAt(world, surface, w, triangle, t, front);
  if (at > w.nearest || (at == w.nearest && triangle > w.hit.triangle)) return;
  w.nearest = at;
  w.hit = TriangleHit(triangle, w.piece, w.entry, front, t, w.hit.steps);
}

/// Where the ray leaves the cube of cells within `around` of its own, by axis.
vec3 exitsOf(TriangleWalk w, float around) {
  return (w.cell + step(vec3(0.0f), w.direction) - w.origin) * w.inverse + around * abs(w.inverse);
}

float least(vec3 v) { return min(v.x, min(v.y, v.z)); }

/// Steps out of that cube: by whole cells along the axis on which it is left, which is known; along the others to where
/// the ray is then.
void leaveCube(inout TriangleWalk w, vec3 exits, float around) {
  float exit = least(exits);
  vec3 along = clamp(floor(w.origin + exit * w.direction) - w.cell, vec3(-around), vec3(around));
  vec3 out_ = sign(w.direction) * (around + 1.0f);
  bool x = exits.x == exit, y = !x && exits.y == exit, z = !x && !y;
  w.cell += vec3(x ? out_.x : along.x, y ? out_.y : along.y, z ? out_.z : along.z);
  w.t = exit;
  ++w.hit.steps;
}

/// Finds the pieces of the solid cell that the ray is in and leaves by `exits`.
void lookUpPieces(TraceWorld world, SurfaceArrays surface, vec3 exits, inout TriangleWalk w) {
  w.entry = world.facets.reverse.at[traceIndex(w.cell, world.dims)];
  w.piece = surface.firstPiece.at[firstFacet(w.entry)];
  w.endPiece = surface.firstPiece.at[firstFacet(w.entry) + facetsOf(w.entry)];
  w.leave = least(exits);
}

/// Rays meet about three times as many cells as pieces whose box they meet, so that a turn takes one piece but several
/// cells, and rays side by side wait little for each other.
const int CELLS_A_TURN = 2;

/// Asks the next piece, or passes its group by, and goes on to the next cells that may hold one; false: the ray has met
/// what it meets.
bool stepTriangles(TraceWorld world, SurfaceArrays surface, inout TriangleWalk w) {
  if (w.piece < w.endPiece) {
    if ((w.endPiece - w.piece) % PIECE_GROUP == 0u && !meetsBox(w, surface.groups.at[groupPlace(w.piece)])) {
      w.piece += PIECE_GROUP;
    } else {
      if (meetsBox(w, surface.boxes.at[w.piece])) askPiece(world, surface, w);
      ++w.piece;
    }
    if (w.piece < w.endPiece) return true;
    if (!(w.leave < w.nearest)) return false;
    leaveCube(w, exitsOf(w, 0.0f), 0.0f);
  }
  for (int i = 0; i < CELLS_A_TURN; ++i) {
    // What was met beyond a cell's end waits until no cell before it is left.
    if (!(w.t < w.nearest)) return false;
    float clearance = traceClearance(world, w.cell), around = max(clearance - 1.0f, 0.0f);
    vec3 exits = exitsOf(w, around);
    if (clearance > 0.0f) {
      leaveCube(w, exits, around);
      continue;
    }
    lookUpPieces(world, surface, exits, w);
    // Every solid cell has pieces. Lanes of a picture's edge that Mesa's CPU driver runs without drawing them read 0
    // for everything, and would stay here until it ends the loops of all lanes beside them.
    return w.piece < w.endPiece;
  }
  return true;
}

/// The first triangle nearer than `reach` along a ray, but `own`, from which the ray starts. Where it has come upon a pane
/// that tints, as few have, it goes the same way once more: which channels are left is known only when the hit is.
TriangleHit firstTriangle(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own, float reach) {
  TriangleWalk w = startTriangles(world.dims, origin, direction, own, reach);
  while (stepTriangles(world, surface, w)) {}
  TriangleHit hit = w.hit;
  if (!TINTED || !w.tinted) return hit;
  w = startTriangles(world.dims, origin, direction, own, hit.t);
  w.collects = true;
  while (stepTriangles(world, surface, w)) {}
  return hit;
}

/// The facet that a ray has met; TRACE_ESCAPED, TRACE_BLOCKED at the back of a single-sided face and where panes have left
/// no channel, or TRACE_INVALID where it is not known which facet (PIECE_UNKNOWN).
TraceHit facetMet(SurfaceArrays surface, TriangleHit hit, vec3 origin, vec3 direction) {
  if (TINTED && closedChannels == TINT_NONE_LEFT) return TraceHit(TRACE_BLOCKED, hit.t, hit.steps);
  if (hit.triangle == NO_TRIANGLE) return TraceHit(TRACE_ESCAPED, 0.0f, hit.steps);
  uint found = classAt(surface, hit.piece, !hit.front, origin + direction * hit.t);
  uint facet = found < PIECE_UNKNOWN ? firstFacet(hit.entry) + found
                                     : (found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID);
  return TraceHit(facet, hit.t, hit.steps);
}

/// The same of the first triangle along a ray but `own`; closedChannels.
TraceHit traceTriangles(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own) {
  closedChannels = 0u;
  return facetMet(surface, firstTriangle(world, surface, origin, direction, own, 1e30f), origin, direction);
}
