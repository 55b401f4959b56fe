#version 460
#extension GL_GOOGLE_include_directive : require
// "GI CompactList", last step: which facets share their voxel with surfaces that only the voxels around record, and how
// far around a facet there is nothing but its own plane.
#include "shared/constants.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_NORMALS) const uint NORMALS = NORMALS_OCT16;
layout(push_constant, scalar) uniform Push { FacetCornersPush p; };

const int SEARCH = 3;      // voxels
const float SAME = 0.02f;  // voxels: planes of one code this near are one plane
const float REACH = 0.9f;  // voxels: half a cell's diagonal and what planes are known to

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  uint shape = f.shape.at[facet];
  uint code = shape & 0xFFFFu;
  vec3 normal = decodeNormal(code, NORMALS);
  vec3 point = normal * facetOffset(shape);  // of the own plane, from the voxel's centre
  ivec3 voxel = ivec3(unpackVoxel(f.voxel.at[facet]));
  // Where one of more than two slots is free, all faces that cross the voxel's middle are recorded (gi/voxelize.comp),
  // and neighbouring faces that look against this one end before it.
  bool complete = p.slots > 2u && facetsOf(f.reverse.at[voxelIndex(uvec3(voxel), p.dims)]) < p.slots;
  uint around = 0u;
  float joint = 0.0f;
  // One voxel per plane is enough to ask: the one that stands highest above the own plane, or where the planes meet
  // convexly (most of the other stands below) the own voxel.
  uint planes = 0u;
  int keptPlace[4];
  float keptRise[4];
  float keptSum[4];
  bool keptSelf[4];
  bool keptBefore[4];  // a voxel wholly in front of the own plane has it: the two do not end where they meet
  uint keptCode[4];
  float keptDistance[4];
  int other_ = SEARCH + 1;  // distance of the nearest face of another plane
  bool slab = false;        // the voxel's other face is the other side of something thin
  for (int radius = 0; radius <= SEARCH && (radius < other_ || (radius == 1 && !slab)); ++radius) {
    int width = 2 * radius + 1;
    for (int i = 0; i < width * width * width; ++i) {
      ivec3 step_ = ivec3(i % width, (i / width) % width, i / (width * width)) - radius;
      ivec3 away = abs(step_);
      ivec3 at = voxel + step_;
      if (max(away.x, max(away.y, away.z)) != radius) continue;  // only voxels of this shell
      if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, ivec3(p.dims)))) continue;
      uint entry = f.reverse.at[voxelIndex(uvec3(at), p.dims)];
      if (entry == NO_FACET) continue;
      uint first = firstFacet(entry);
      for (uint other = first; other < first + facetsOf(entry); ++other) {
        // Neighbours may be setting their own bits meanwhile; the bits read here do not change.
        uint otherShape = f.shape.at[other];
        vec3 otherNormal = decodeNormal(otherShape & 0xFFFFu, NORMALS);
        float centre = -dot(otherNormal, vec3(step_)) - facetOffset(otherShape);  // of the own voxel, from its plane
        float distance_ = centre + dot(otherNormal, point);
        float alike = dot(normal, otherNormal);
        bool same = (otherShape & 0xFFFFu) == code && abs(distance_) < SAME;
        bool back = alike < -0.999f && distance_ < SAME;
        if (!same && !back) other_ = min(other_, radius);
        if (radius == 0 && alike < OPPOSED_COSINE) slab = true;
        if (radius == 1 && alike >= TRACE_OWN_NORMAL) {
          // Where the two faces join, about half-way between their middles.
          vec3 across = 0.5f * (vec3(step_) + otherNormal * facetOffset(otherShape) - point);
          float gap = abs(dot(normal + otherNormal, across));
          if (gap < TRACE_JOINT) joint = max(joint, gap);
        }
        if (radius == 1 && complete && alike < OPPOSED_COSINE) continue;
        if (radius > 1 || back || (radius == 0 && slab) || alike >= TRACE_OWN_NORMAL || abs(centre) >= REACH) continue;
        float rise = dot(normal, vec3(step_) + otherNormal * facetOffset(otherShape) - point);
        int place = (step_.x + 1) + 3 * (step_.y + 1) + 9 * (step_.z + 1);
        uint k = 0u;
        while (k < planes && (keptCode[k] != (otherShape & 0xFFFFu) || abs(keptDistance[k] - centre) >= SAME)) ++k;
        if (k == 4u) {
          around |= 1u << place;
          continue;
        }
        if (k == planes) {
          ++planes;
          keptCode[k] = otherShape & 0xFFFFu;
          keptDistance[k] = centre;
          keptSum[k] = 0.0f;
          keptSelf[k] = radius == 0;
          keptBefore[k] = false;
          keptRise[k] = rise - 1.0f;
        }
        keptSum[k] += rise;
        keptBefore[k] = keptBefore[k] || dot(normal, vec3(step_) - point) > voxelExtent(normal) + SAME;
        if (rise <= keptRise[k]) continue;
        keptPlace[k] = place;
        keptRise[k] = rise;
      }
    }
  }
  uint convex = 0u;  // places
  for (uint k = 0u; k < planes; ++k) {
    bool meets = keptSum[k] < 0.0f && !keptBefore[k];
    if (meets && keptSelf[k]) keptPlace[k] = 13;
    around |= 1u << keptPlace[k];
    if (meets) convex |= 1u << keptPlace[k];
  }
  // Places that hold more than that face are left out: nothing says which face would end the own plane.
  uint flags = 0u;
  uint listed = around;
  for (uint n = 0u; n < 5u && listed != 0u; ++n) {
    int i = findLSB(listed);
    listed &= listed - 1u;
    if ((convex & (1u << i)) == 0u) continue;
    ivec3 step_ = ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    uint entry = f.reverse.at[voxelIndex(uvec3(voxel + step_), p.dims)];
    uint first = firstFacet(entry);
    uint others = 0u;
    for (uint other = first; other < first + facetsOf(entry); ++other)
      if (dot(normal, decodeNormal(f.shape.at[other] & 0xFFFFu, NORMALS)) < TRACE_OWN_NORMAL) ++others;
    if (others == 1u) flags |= 1u << n;
  }
  around |= flags << AROUND_CONVEX_SHIFT;
  // Voxels next to a face of another plane may be corners: they are not stepped over.
  uint bits = packFacetJoint(joint) | uint(max(other_ - 2, 0)) << FACET_CLEAR_SHIFT;
  if (around != 0u) bits |= FACET_CORNER;
  f.around.at[facet] = around;
  if (bits != 0u) atomicOr(f.shape.at[facet], bits);
}
