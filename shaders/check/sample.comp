#version 460
#extension GL_GOOGLE_include_directive : require
// `irad check sampler`.
#include "shared/check.h"
#include "shared/sampling.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SamplePush p; };

void main() {
  uint i = irad_index();
  if (i >= p.count) return;
  uvec4 point = p.points.at[i];
  vec2 u = hammersley(point.x, point.y, point.zw);
  p.coordinates.at[i] = vec4(u, 0.0f, 0.0f);
  p.directions.at[i] = vec4(toWorld(cosineDirection(u), p.normal), 0.0f);
}
