// "RE Forward" with sample.gated off: indirect light from the volume `indirectVolume` (T 5.10, eq. 24), which the
// including shader binds.
#include "shared/grid.h"
#include "shared/gi_params.h"

/// The thesis's lookups in the RGBA16F volume at `p` (voxel units): the texel, the hardware's trilinear filter, or 3 x
/// 3 x 3 trilinear taps half a voxel apart. Where presence is below 1/256 the nearest solid texel of the 3 x 3 x 3
/// around p is taken instead of dividing by it.
vec3 volumeIndirect(Grid grid, SampleParams sampling, vec3 p, vec3 n) {
  vec3 q = p + n * sampling.normalOffset;
  vec3 size = vec3(grid.dims);
  vec4 c = vec4(0.0);
  if (sampling.filter_ == FILTER_NEAREST) {
    c = texelFetch(indirectVolume, clamp(ivec3(floor(q)), ivec3(0), ivec3(grid.dims) - 1), 0);
  } else if (sampling.filter_ == FILTER_LINEAR) {
    c = textureLod(indirectVolume, q / size, 0.0);
  } else {
    for (int i = 0; i < 27; ++i)
      c += textureLod(indirectVolume, (q + 0.5 * (vec3(i % 3, (i / 3) % 3, i / 9) - 1.0)) / size, 0.0) / 27.0;
  }
  if (sampling.premultiplied == 0u) return c.rgb;
  if (c.a >= 1.0 / 256.0) return c.rgb / c.a;  // T eq. 24
  float nearest = 1e9;
  vec3 found = vec3(0.0);
  for (int i = 0; i < 27; ++i) {
    ivec3 v = ivec3(floor(p)) + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(grid.dims)))) continue;
    vec4 texel = texelFetch(indirectVolume, v, 0);
    vec3 d = q - (vec3(v) + 0.5);
    if (texel.a >= 1.0 / 256.0 && dot(d, d) < nearest) {
      nearest = dot(d, d);
      found = texel.rgb / texel.a;
    }
  }
  return found;
}
