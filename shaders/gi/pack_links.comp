// The links that there are, one behind the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PackLinksPush push; };

void main() {
  uint facet = irad_index();
  if (facet >= push.count) return;
  uint place = push.firstLinks.at[facet];
  for (uint mask = push.masks.at[facet]; mask != 0u; mask &= mask - 1u)
    push.links.at[place++] = push.found.at[FACET_LINKS * facet + findLSB(mask)];
}
