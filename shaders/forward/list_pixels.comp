// "RE Forward" by kernels: the visible pixels listed by material. Run twice: to count them, and, once
// forward/place_lists.comp has given every list its place, to write them there. Either time a workgroup adds to a list
// once, whatever its pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shared/constants.h"
#include "shared/passes.h"

const uint INVOCATIONS = 256u;
const uint NONE = 0xFFFFFFFFu;
layout(local_size_x = INVOCATIONS) in;
layout(constant_id = CONSTANT_LIST_PIXELS) const bool WRITE = false;
layout(push_constant, scalar) uniform PushBlock {
  PixelListPush push;
};

// A hash table of the materials in the workgroup's 16 x 16 pixels: as many slots as there can be materials.
shared uint materialAt[INVOCATIONS];
shared uint pixelsAt[INVOCATIONS];
shared uint placeAt[INVOCATIONS];

uint slotOf(uint material) {
  uint slot = material % INVOCATIONS;
  for (;;) {
    uint found = atomicCompSwap(materialAt[slot], NONE, material);
    if (found == NONE || found == material) return slot;
    slot = (slot + 1u) % INVOCATIONS;
  }
}

void main() {
  uint i = gl_LocalInvocationIndex;
  materialAt[i] = NONE;
  pixelsAt[i] = 0u;
  barrier();
  // Neighbours in a subgroup are neighbours in the picture: 8 x 4 pixels.
  uvec2 pixel = 16u * gl_WorkGroupID.xy + uvec2((i & 7u) | ((i >> 2) & 8u), ((i >> 3) & 3u) | ((i >> 4) & 12u));
  uint triangle = NONE;
  if (all(lessThan(pixel, push.size))) triangle = push.visible.at[pixel.y * push.size.x + pixel.x].x;
  uint slot, rank;
  if (triangle != NONE) {
    // The subgroup's materials one after the other: few atomics, each for all pixels of a material.
    uint material = push.scene.at[0].triangleMaterials.at[triangle];
    for (;;) {
      if (material != subgroupBroadcastFirst(material)) continue;
      uvec4 alike = subgroupBallot(true);
      if (subgroupElect()) {
        slot = slotOf(material);
        rank = atomicAdd(pixelsAt[slot], subgroupBallotBitCount(alike));
      }
      slot = subgroupBroadcastFirst(slot);
      rank = subgroupBroadcastFirst(rank) + subgroupBallotExclusiveBitCount(alike);
      break;
    }
  }
  barrier();
  if (materialAt[i] != NONE) {
    if (WRITE) placeAt[i] = atomicAdd(push.lists.at[materialAt[i]].end, pixelsAt[i]);
    else atomicAdd(push.lists.at[materialAt[i]].count, pixelsAt[i]);
  }
  if (!WRITE) return;
  barrier();
  if (triangle != NONE) push.listed.at[placeAt[slot] + rank] = uvec2(pixel.x | (pixel.y << 16), triangle);
}
