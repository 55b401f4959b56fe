#version 460
#extension GL_GOOGLE_include_directive : require
// `irad check encodings`.
#include "shared/check.h"
#include "shared/normals.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { EncodePush p; };

void main() {
  uint i = irad_index();
  if (i >= p.count) return;
  p.decoded.at[i] = vec4(decodeNormal(encodeNormal(p.normals.at[i].xyz, p.encoding), p.encoding), 0.0f);
}
