// Which facets of the voxels around continue a facet's surface on the same side (docs/method.md 4): one of the same
// triangle, where nothing stands on it; or their normals are alike, and from a surfel near the voxels' common border to
// the nearest one of the other nothing is in between.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/links.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LinkFacetsPush push; };

// A workgroup takes some facets, and each of these the voxels around it: places. Most of them hold no facet whose way
// has to be looked at, so that all invocations take turns at those that do: one facet of each place a round. What is kept
// of a place is packed: the fewer bytes a workgroup has, the more of them there are at a time.
const uint PLACES = 27u * LINK_FACETS;
shared uint sides[LINK_FACETS];                        ///< triangle | SURFEL_BACK of each facet
shared vec3 facings[LINK_FACETS];
shared vec3 surfels[LINK_FACETS][FACET_SURFELS];       ///< their positions
shared uint entries[PLACES];
shared uint state[PLACES];                        ///< link, pair and next
shared uint wholeOrApart[PLACES];                 ///< before the rounds wholePiece(); in them apart
shared float best[PLACES];                        ///< apart, of the best so far
shared uint queue[PLACES];                        ///< places with a facet to look at in this round
shared uint likely[PLACES];                       ///< of these, those whose facet may continue the surface
shared uint queued[2], likelies[2];

/// The best facet so far, or NO_LINK.
uint linkOf(uint place) { return state[place] & 0xFFu; }
void setLink(uint place, uint facet) { state[place] = (state[place] & ~0xFFu) | facet; }
/// The facet to look at next.
uint nextOf(uint place) { return state[place] >> 16; }
void setNext(uint place, uint facet) { state[place] = (state[place] & 0xFFFFu) | (facet << 16); }
/// Of both facets the nearest surfels, own + FACET_SURFELS * other; apart: the square of their distance.
uint pairOf(uint place) { return (state[place] >> 8) & 0xFFu; }
void setPair(uint place, uint pair) { state[place] = (state[place] & ~0xFF00u) | (pair << 8); }
float apartOf(uint place) { return uintBitsToFloat(wholeOrApart[place]); }

/// Whether the facet's triangle goes on into the voxel at `step_`: nothing stands on it in any voxel of the block between
/// them, which is convex.
bool goesOn(uint own, ivec3 step_) {
  for (uint corner = 0u; corner < 8u; ++corner)
    if (wholeOrApart[27u * own + blockPlace(corner, step_)] == NO_LINK) return false;
  return true;
}

/// The next facet of a place whose normal is like the facet's own; facetsOf where there is none.
uint nextAlike(uint place, uint k) {
  uint entry = entries[place];
  for (; k < facetsOf(entry); ++k) {
    if (facesAlike(facings[place / 27u], push.facings.at[firstFacet(entry) + k])) break;
  }
  return k;
}

/// Which of the facet's surfels is nearest to a point.
uint ownSurfel(uint own, vec3 point) {
  uint nearest = 0u;
  float distance2 = 1e30;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    vec3 d = surfels[own][k] - point;
    if (dot(d, d) >= distance2) continue;
    distance2 = dot(d, d);
    nearest = k;
  }
  return nearest;
}

/// The same of another facet, and how far it is.
uint nearestOf(uint facet, vec3 point, out float distance2) {
  uint nearest = 0u;
  distance2 = 1e30;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    vec3 d = push.points.at[FACET_SURFELS * facet + k].xyz - point;
    if (dot(d, d) >= distance2) continue;
    distance2 = dot(d, d);
    nearest = k;
  }
  return nearest;
}

/// The facet to look at in this round.
uint otherFacet(uint place) { return firstFacet(entries[place]) + nextOf(place); }

/// Finds the surfels between which the way is to be, and whether there may be one that is nearer than the best.
bool findPair(SurfaceArrays surface, uint place) {
  uint own = place / 27u, facet = LINK_FACETS * irad_workgroup() + own;
  uint nearest = ownSurfel(own, borderTo(push.voxel.at[facet], stepTo(place % 27u)));
  float apart;
  uint other = nearestOf(otherFacet(place), surfels[own][nearest], apart);
  setPair(place, nearest + FACET_SURFELS * other);
  wholeOrApart[place] = floatBitsToUint(apart);
  return apart < best[place] &&
         mayContinue(surfelOf(surface, facet, nearest), surfelOf(surface, otherFacet(place), other));
}

SidePoint sidePoint(SurfaceArrays surface, uint facet, uint k) {
  return SidePoint(surfelOf(surface, facet, k), push.points.at[FACET_SURFELS * facet + k].w);
}

void lookAt(SurfaceArrays surface, uint place) {
  uint own = LINK_FACETS * irad_workgroup() + place / 27u;
  SidePoint from = sidePoint(surface, own, pairOf(place) % FACET_SURFELS);
  SidePoint to = sidePoint(surface, otherFacet(place), pairOf(place) / FACET_SURFELS);
  if (!continues(surface, push.reverse, push.dims, from, to)) return;
  best[place] = apartOf(place);
  setLink(place, nextOf(place));
}

void main() {
  uint lane = gl_LocalInvocationIndex, firstFacet_ = LINK_FACETS * irad_workgroup();
  if (firstFacet_ >= push.count) return;  // where groups make up several rows the last one has some too many
  uint count = min(LINK_FACETS, push.count - firstFacet_), places = 27u * count;
  SurfaceArrays surface = push.surface.at[0];
  for (uint i = lane; i < count; i += gl_WorkGroupSize.x) {
    sides[i] = surfelAt(surface, surfelsOf(surface, firstFacet_ + i), FACET_SURFELS / 2u).triangle;
    facings[i] = push.facings.at[firstFacet_ + i];
  }
  for (uint i = lane; i < FACET_SURFELS * count; i += gl_WorkGroupSize.x)
    surfels[i / FACET_SURFELS][i % FACET_SURFELS] = push.points.at[FACET_SURFELS * firstFacet_ + i].xyz;
  if (lane < 2u) queued[lane] = likelies[lane] = 0u;
  barrier();
  for (uint i = lane; i < places; i += gl_WorkGroupSize.x) {
    ivec3 voxel = ivec3(unpackVoxel(push.voxel.at[firstFacet_ + i / 27u]));
    entries[i] = entryOf(push.reverse, push.dims, voxel + stepTo(i % 27u));
    wholeOrApart[i] = wholePiece(surface, entries[i], sides[i / 27u]);
  }
  barrier();
  for (uint i = lane; i < places; i += gl_WorkGroupSize.x) {
    uint own = i / 27u, middle = 27u * own + OWN_VOXEL;
    uint inVoxel = firstFacet_ + own - firstFacet(entries[middle]);
    state[i] = NO_LINK;
    setNext(i, 0xFFFFu);
    best[i] = 1e30;
    if (i == middle) setLink(i, inVoxel);
    else if (entries[i] != NO_FACET) {
      if (wholeOrApart[middle] == inVoxel && goesOn(own, stepTo(i % 27u))) setLink(i, min(wholeOrApart[i], NO_LINK));
      if (linkOf(i) == NO_LINK) setNext(i, nextAlike(i, 0u));
    }
  }
  barrier();
  for (uint round = 0u;; ++round) {
    for (uint i = lane; i < places; i += gl_WorkGroupSize.x)
      if (nextOf(i) < facetsOf(entries[i])) queue[atomicAdd(queued[round & 1u], 1u)] = i;
    barrier();
    uint all_ = queued[round & 1u];
    if (all_ == 0u) break;
    if (lane == 0u) queued[(round + 1u) & 1u] = likelies[(round + 1u) & 1u] = 0u;
    for (uint i = lane; i < all_; i += gl_WorkGroupSize.x)
      if (findPair(surface, queue[i])) likely[atomicAdd(likelies[round & 1u], 1u)] = queue[i];
    barrier();
    all_ = likelies[round & 1u];
    for (uint i = lane; i < all_; i += gl_WorkGroupSize.x) lookAt(surface, likely[i]);
    barrier();
    for (uint i = lane; i < places; i += gl_WorkGroupSize.x)
      if (nextOf(i) < facetsOf(entries[i])) setNext(i, nextAlike(i, nextOf(i) + 1u));
  }
  for (uint i = lane; i < FACET_LINKS * count; i += gl_WorkGroupSize.x) {
    uint own = i / FACET_LINKS, at = i % FACET_LINKS;
    push.found.at[FACET_LINKS * firstFacet_ + i] = uint8_t(at < 27u ? linkOf(27u * own + at) : NO_LINK);
  }
  for (uint i = lane; i < count; i += gl_WorkGroupSize.x) {
    uint mask = 0u;
    for (uint at = 0u; at < 27u; ++at) mask |= at != OWN_VOXEL && linkOf(27u * i + at) != NO_LINK ? 1u << at : 0u;
    push.masks.at[firstFacet_ + i] = mask;
    push.counts.at[firstFacet_ + i] = bitCount(mask);
  }
}
