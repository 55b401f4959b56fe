#version 460
#extension GL_GOOGLE_include_directive : require
// What finitely many rays leave unknown of H (docs/method.md 7): the variance of what single rays bring, over the rays
// that a row has. One invocation per row.
#include "shared/constants.h"
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(push_constant, scalar) uniform Push { RowNoisePush p; };

void main() {
  uint row = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (row >= m.rows) return;
  // H holds the light of emitters by samples where those stand in for rays: it has a variance of its own.
  vec3 mean = p.indirect.at[row].xyz;
  float sampled = 0.0f;
  if (p.emittedGain != 0.0f) {
    vec4 emitted = p.emitted.at[row];
    mean -= p.emittedGain * emitted.xyz;
    sampled = p.emittedGain * p.emittedGain * emitted.w;
  }
  vec3 squares = p.squares.at[row].xyz;
  float variance = squares.x + squares.y + squares.z - dot(mean, mean);
  if (SKY) {
    vec4 sky = p.sky.at[row];
    variance += sky.w;
  }
  float perRay = uintBitsToFloat(m.rowInfo.at[row].y);  // 1 / rays that count
  p.error.at[row] = vec4(sqrt(ROW_NOISE_SHARE * (perRay * max(variance, 0.0f) + sampled)), 0.0f, 0.0f, 0.0f);
}
