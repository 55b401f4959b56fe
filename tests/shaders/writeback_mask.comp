// T eq. 25-28 at fragments that are given: distance and position, normal.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/writeback.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  Vec4Array at;  ///< position in voxels; w: distance from the camera
  Vec4Array normal;
  FloatArray score;
  WritebackParams params;
  uint count;
};
void main() {
  const uint i = irad_index();
  if (i >= count) return;
  vec4 p = at.at[i];
  score.at[i] = writebackScore(p.w, p.xyz, normal.at[i].xyz, params);
}
