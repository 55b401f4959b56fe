// Rays side by side take numbers of turns that differ much, and a subgroup takes as many as the longest of its rays. So
// the last few of a subgroup wait, and fill others in a later dispatch (Wald 2011, "Active Thread Compaction for GPU Path
// Tracing", does so between bounces). What a ray meets is the same. After gi/trace.glsl.
#extension GL_KHR_shader_subgroup_ballot : require

/// The rays of a subgroup wait when so many are left.
layout(constant_id = CONSTANT_FEW_RAYS) const uint FEW_RAYS = 0u;
/// Turns that a ray takes before it waits: to put it on the list and to take it up again costs several.
const uint LEAST_TURNS = 8u;

/// Puts a ray on a list; false where that has no room left. (`most` is not read from memory: that costs a twentieth of all.)
bool putOnList(WaitingRays list, uint most, uint ray, TriangleWalk w) {
  uvec4 together = subgroupBallot(true);
  uint place = 0u;
  if (subgroupElect()) {
    uint count = subgroupBallotBitCount(together);
    place = atomicAdd(list.head.count, count);
    atomicMax(list.head.groups.x, (min(place + count, most) + WAITING_GROUP - 1u) / WAITING_GROUP);
  }
  place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(together);
  if (place >= most) return false;
  bool met = w.hit.triangle != NO_TRIANGLE;
  list.at[place] = WaitingRay(ray, packVoxel(uvec3(w.cell)), w.t, w.piece < w.endPiece ? w.piece : NOT_LOOKED_UP,
                              met ? (w.hit.piece + 1u) | (w.hit.front ? WAITING_FRONT : 0u) : 0u, w.hit.entry, w.hit.t,
                              w.nearest);
  return true;
}

/// Brings a ray that has just been started to where it waited.
void takeUp(TraceWorld world, SurfaceArrays surface, WaitingRay waiting, inout TriangleWalk w) {
  w.cell = vec3(unpackVoxel(waiting.cell));
  w.t = waiting.t;
  w.nearest = waiting.nearest;
  if (waiting.hitPiece != 0u) {
    uint piece = (waiting.hitPiece & ~WAITING_FRONT) - 1u;
    w.hit = TriangleHit(triangleOf(surface.pieces, piece), piece, waiting.hitEntry,
                        (waiting.hitPiece & WAITING_FRONT) != 0u, waiting.hitT, 0u);
  }
  if (waiting.piece == NOT_LOOKED_UP) return;
  lookUpPieces(world, surface, exitsOf(w, 0.0f), w);
  w.piece = waiting.piece;
}
