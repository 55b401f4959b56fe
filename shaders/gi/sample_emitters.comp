// "GI Solve Emitters": F M of every facet by samples of the emitters in place of its rays (docs/method.md 5, after
// T 5.6's low-probability high-energy paths). A lamp that fills a hundredth of the hemisphere is met by one ray in a
// hundred; samples drawn in proportion to power all go there. Only the first gather is replaced: the solver adds the
// difference to F B, in which M cancels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/sampling.h"
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_MATRIX_FORMAT) const uint FORMAT = MATRIX_CSR;
layout(constant_id = CONSTANT_BY_HOST) const bool BY_HOST = false;
layout(push_constant, scalar) uniform Push { SampleEmittersPush p; };

#include "gi/emitter_point.glsl"
#include "gi/matrix_row.glsl"
#include "gi/seen_point.glsl"

/// A mean of what rays or samples bring, and the mean's variance were they independent, over the channels together.
struct Estimate {
  vec3 mean;
  float variance;
};
Estimate estimate(vec3 sum, float squares, float each) {
  vec3 mean = sum * each;
  return Estimate(mean, each * max(squares * each - dot(mean, mean), 0.0f));
}

/// F M of the nearby emitters among the row's entries.
Estimate nearEmitters(FacetArrays f, MatrixArrays m, uint row, uvec3 voxel) {
  Row r = openRow(m, row);
  vec3 sum = vec3(0.0f);
  float squares = 0.0f;
  for (uint i = 0u; i < r.count; ++i) {
    RowEntry e = rowEntry(r, m.columnBits, i);
    vec3 exitance = f.emission.at[e.column];
    if (exitance == vec3(0.0f) || !areNear(voxel, unpackVoxel(f.voxel.at[e.column]))) continue;
    if (TINTED) exitance *= openChannels(e.closed);
    sum += e.weight * exitance;
    squares += e.weight * dot(exitance, exitance);
  }
  return estimate(sum, squares, r.weight);
}

/// E = 1/n sum of M cos cos' / (pi r^2) / density, the density of points being luminance(M) / power.
Estimate sampled(EmitterTable table, FacetArrays f, TraceWorld world, SurfaceArrays surface, uint facet, uvec3 voxel,
                   uvec4 shifts) {
  vec3 sum = vec3(0.0f);
  float squares = 0.0f;
  for (uint k = 0u; k < p.samples; ++k) {
    float x;
    uint emitter = emitterFacet(table, shifts.x + (2u * k + 1u) * (0x80000000u / p.samples), x);
    if (areNear(voxel, unpackVoxel(f.voxel.at[emitter]))) continue;
    SurfelPoint to = liftedSurfel(surface, emitter, uint(x * float(FACET_SURFELS)));
    SurfelPoint from = liftedSurfel(surface, facet, raySurfel(k, shifts));
    vec3 way = to.position - from.position;
    float reach = length(way);
    vec3 direction = way / reach;
    float cosines = max(dot(from.facing, direction), 0.0f) * max(-dot(to.facing, direction), 0.0f);
    if (cosines == 0.0f) continue;
    if (!reaches(world, surface, from, direction, reach)) continue;
    vec3 exitance = f.emission.at[emitter];
    vec3 brought = exitance * letThrough() * (cosines * table.power / (luminance(exitance) * IRAD_PI * reach * reach));
    sum += brought;
    squares += dot(brought, brought);
  }
  return estimate(sum, squares, 1.0f / float(p.samples));
}

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  EmitterTable table = p.emitters.at[0];
  TraceWorld world = TraceWorld(f, p.chebyshev, p.dims, p.jfaMax);
  uint packedVoxel = f.voxel.at[facet];
  uvec3 voxel = unpackVoxel(packedVoxel);
  uvec4 shifts = rayShifts(packedVoxel, p.seed ^ EMITTERS_SEED, 1u);

  Estimate close = nearEmitters(f, p.matrix.at[0], facet, voxel);
  Estimate far;
  if (BY_HOST) {
    vec4 found = p.byHost.at[facet];
    far = Estimate(found.xyz, found.w);
  } else {
    far = sampled(table, f, world, p.surface.at[0], facet, voxel, shifts);
  }
  vec3 light = close.mean + far.mean;
  p.correction.at[facet] = vec4(light - p.emitted.at[facet].xyz, 0.0f);
  p.emitted.at[facet] = vec4(light, close.variance + far.variance);
}
