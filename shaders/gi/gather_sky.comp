#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Gather" from the sky (docs/method.md 6): pi x the share of a facet's rays that escape into each bin of directions x
// the bin's mean radiance; and the mean of the squares of what its rays bring from there, over the channels together, for
// the noise of H. One invocation per row.
#include "gi/tinted.glsl"
#include "shared/sky.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { GatherSkyPush p; };

void main() {
  uint row = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (row >= m.rows) return;
  uvec2 info = m.rowInfo.at[row];
  UintArray segment = m.segments.at[row >> m.segmentShift];
  uint start = m.rowStart.at[row] + rowEntries(info), count = m.rowSky.at[row];
  vec3 sum = vec3(0.0f);
  float squares = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    uint entry = segment.at[start + i];
    float hits = float(entry >> SKY_BIN_BITS);
    uint bin = entry & ((1u << SKY_BIN_BITS) - 1u);
    vec3 radiance;
    if (TINTED) radiance = openChannels(bin >> TINT_SHIFT_SKY) * p.bins.at[bin & ((1u << TINT_SHIFT_SKY) - 1u)].xyz;
    else radiance = p.bins.at[bin].xyz;
    sum += hits * radiance;
    squares += hits * dot(radiance, radiance);
  }
  float weight = uintBitsToFloat(info.y);
  p.sky.at[row] = vec4(sum * (weight * IRAD_PI), squares * (weight * IRAD_PI * IRAD_PI));
}
