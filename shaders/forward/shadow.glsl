// Visibility of the analytic lights through the shadow maps: one definition for shading and for passes that gather direct
// light. The including shader binds the maps; by default they are set 0, bindings 0 and 1.
#ifndef IRAD_FORWARD_SHADOW_GLSL
#define IRAD_FORWARD_SHADOW_GLSL
#include "forward/light.glsl"
#include "forward/project.glsl"

#ifndef IRAD_SHADOW_SET
#define IRAD_SHADOW_SET 0
#endif
#ifndef IRAD_SHADOW_FLAT_BINDING
#define IRAD_SHADOW_FLAT_BINDING 0
#endif
#ifndef IRAD_SHADOW_CUBE_BINDING
#define IRAD_SHADOW_CUBE_BINDING 1
#endif
layout(constant_id = IRAD_LIGHT_CONSTANTS + LIGHT_FLAT_MAPS) const bool FLAT_MAPS = true;
layout(constant_id = IRAD_LIGHT_CONSTANTS + LIGHT_CUBE_MAPS) const bool CUBE_MAPS = true;
layout(constant_id = IRAD_LIGHT_CONSTANTS + LIGHT_FILTERS) const bool FILTERS = true;
layout(set = IRAD_SHADOW_SET, binding = IRAD_SHADOW_FLAT_BINDING) uniform sampler2DArray shadowFlat;
layout(set = IRAD_SHADOW_SET, binding = IRAD_SHADOW_CUBE_BINDING) uniform samplerCubeArray shadowCubes;

bool hasCubeMap(GpuLight light) {
  return CUBE_MAPS && (!FLAT_MAPS || lightUsesCube(light.type, light.outerCos));
}

/// Depths are reversed (1 near, 0 far; near / distance in perspective), so that fp32 is precise everywhere: `reference <=
/// stored` is blocked. Maps are compared here: kernels write them as colour (renderer/raster.h), and with SHADOW_VSM there is
/// more in them than depth.

/// Whether a flat map covers a point, but for half of its rim, over which filters reach. Beside the map of a distant light
/// nothing is in its way (renderer/shadow.cpp); cones shine nowhere beside theirs.
bool onFlatMap(vec3 ndc) {
  return max(abs(ndc.x), abs(ndc.y)) <= 1.0 - 4.0 / float(textureSize(shadowFlat, 0).x);
}

/// The flat maps. Every tap compares with the depth that the receiver's own plane has at the tap (the plane's depth is
/// affine in the map for both projections), so that the normal offset need only cover one bilinear footprint.
float flatVisibility(GpuLight light, vec3 p, vec3 n, float cosine, float offset, float texel, uint pcf) {
  precise vec3 lifted = p + n * offset;
  vec4 clip = project(light.shadowMatrix, lifted);
  if (!(clip.w > 0.0)) return 1.0;
  vec3 ndc = clip.xyz / clip.w;
  if (!onFlatMap(ndc)) return 1.0;
  // Two directions in the plane, carried through the projection, give d depth / d (x, y).
  vec3 a = abs(n);
  vec3 axis = a.x < a.y ? (a.x < a.z ? vec3(1, 0, 0) : vec3(0, 0, 1)) : (a.y < a.z ? vec3(0, 1, 0) : vec3(0, 0, 1));
  precise vec3 t = preciseNormalize(preciseCross(n, axis)) * texel;
  vec3 b = preciseCross(n, t);
  vec4 ct = projectDirection(light.shadowMatrix, t);
  vec4 cb = projectDirection(light.shadowMatrix, b);
  vec3 dt = (ct.xyz - ndc * ct.w) / clip.w;
  vec3 db = (cb.xyz - ndc * cb.w) / clip.w;
  float det = dt.x * db.y - dt.y * db.x;
  vec2 slope = vec2(0.0);
  if (det != 0.0) {
    slope = vec2(dt.z * db.y - dt.y * db.z, dt.x * db.z - dt.z * db.x) / det;
    slope *= min(1.0, 20.0 * cosine);  // grazing light: a steeper plane than 1 : 20 is not followed
  }
  // pcf x pcf bilinear comparisons one texel apart weigh (pcf + 1)^2 texels by 1 - f, 1, ..., 1, f along each axis; they
  // are fetched in blocks of four, each with the plane's depth at the block's middle.
  float size = float(textureSize(shadowFlat, 0).x);
  vec2 at = (ndc.xy * vec2(0.5, -0.5) + 0.5) * size;
  vec2 first = floor(at - 0.5 * float(pcf));
  vec2 f = at - 0.5 * float(pcf) - first;
  vec2 perTexel = slope * vec2(2.0, -2.0) / size;
  precise float sum = 0.0;
  for (uint y = 0u; y <= pcf; y += 2u)
    for (uint x = 0u; x <= pcf; x += 2u) {
      vec2 middle = first + vec2(x, y) + 1.0;
      vec2 away = perTexel * (middle - at);
      precise float depth = clamp(ndc.z + (away.x + away.y), 1e-30, 1.0);
      vec4 stored = textureGather(shadowFlat, vec3(middle / size, float(light.shadowLayer)));
      vec4 blocked = vec4(lessThanEqual(vec4(depth), stored));
      vec2 low = vec2(x == 0u ? 1.0 - f.x : 1.0, y == 0u ? 1.0 - f.y : 1.0);
      vec2 high = vec2(x + 1u == pcf ? f.x : 1.0, y + 1u == pcf ? f.y : 1.0);
      vec4 shares = blocked * vec4(low.x * high.y, high.x * high.y, high.x * low.y, low.x * low.y);
      sum += (shares.x + shares.y) + (shares.z + shares.w);
    }
  return max(1.0 - sum / float(pcf * pcf), 0.0);  // rounding may take the share above 1
}

float cubeVisibility(GpuLight light, vec3 p, vec3 n, float offset, uint pcf) {
  precise vec3 d = p + n * offset - light.position;
  vec3 a = abs(d);
  float major = max(a.x, max(a.y, a.z));
  if (!(major > 0.0)) return 1.0;
  // Taps step along the two other axes of the face; the receiver's plane n.x = n.d gives each its depth.
  vec3 u = major == a.x ? vec3(0, 1, 0) : vec3(1, 0, 0);
  vec3 v = major == a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  float texel = light.shadowTexel * major;
  float height = preciseDot(n, d);
  // Weights as in the flat maps, texel by texel: a sampler's weights have eight bits, and the last of them shows.
  precise vec2 at = (vec2(dot(u, d), dot(v, d)) / major * 0.5 + 0.5) * float(textureSize(shadowCubes, 0).x);
  vec2 first = floor(at - 0.5 * float(pcf));
  vec2 f = at - 0.5 * float(pcf) - first;
  precise float lit = 0.0;
  for (uint y = 0u; y <= pcf; ++y)
    for (uint x = 0u; x <= pcf; ++x) {
      vec2 away = first + vec2(x, y) + 0.5 - at;
      precise vec3 tap = d + (u * away.x + v * away.y) * texel;
      float along = preciseDot(n, tap);
      float ratio = height < 0.0 && along < 0.0 ? clamp(height / along, 0.8, 1.25) : 1.0;
      vec3 met = abs(tap) * ratio;
      precise float depth = light.shadowNear / max(met.x, max(met.y, met.z));
      float share = (x == 0u ? 1.0 - f.x : x == pcf ? f.x : 1.0) * (y == 0u ? 1.0 - f.y : y == pcf ? f.y : 1.0);
      float stored = textureLod(shadowCubes, vec4(tap, float(light.shadowLayer)), 0.0).r;
      lit += share - share * float(clamp(depth, 1e-30, 1.0) <= stored);
    }
  return min(lit / float(pcf * pcf), 1.0);  // rounding may take the share above 1
}

/// What a light's map holds on the way to `p`, and by how much that is nearer to the light, the gap: metres along a distant
/// light; of the others the distance between the two as a share of that from the light to the nearer. A light's size
/// times it is what the light's disc comes to at p, seen through a hole there. <= 0: nothing is nearer.
struct MapGap {
  float gap, widest;  ///< widest: of what is as near to the light as its map begins
};
MapGap mapGap(GpuLight light, vec3 p) {
  float axial, stored;
  if (hasCubeMap(light)) {
    vec3 d = p - light.position, a = abs(d);
    axial = max(a.x, max(a.y, a.z));
    if (!(axial > 0.0)) return MapGap(0.0, 0.0);
    stored = textureLod(shadowCubes, vec4(d, float(light.shadowLayer)), 0.0).r;
  } else {
    vec4 clip = project(light.shadowMatrix, p);
    axial = clip.w;
    if (!(axial > 0.0)) return MapGap(0.0, 0.0);
    vec3 ndc = clip.xyz / clip.w;
    stored = textureLod(shadowFlat, vec3(ndc.xy * vec2(0.5, -0.5) + 0.5, float(light.shadowLayer)), 0.0).r;
    if (!onFlatMap(ndc)) stored = 0.0;
    if (lightHas(light, LIGHT_DISTANT))
      return MapGap((stored - ndc.z) * light.shadowFar, (1.0 - ndc.z) * light.shadowFar);
  }
  return MapGap(axial * stored / light.shadowNear - 1.0, axial / light.shadowNear - 1.0);
}

const float WIDEST_GAP = 7.0;  ///< penumbrae of what is nearer to a lamp than an eighth of the way are no wider

/// A light with a size: percentage-closer soft shadows (Fernando 2005). What lies between the point and the light's disc
/// gives the penumbra's width, and that is what is averaged over. Both steps leave out what the light's disc does not
/// reach behind: the map shows it beside the point, but it is not in the light's way.
float penumbraVisibility(GpuLight light, vec3 p, vec3 n, float lift, float texel, uint pcf) {
  precise vec3 start = p + n * lift;
  vec3 towards = lightDirection(light, start);
  bool distant = lightHas(light, LIGHT_DISTANT);
  float away = distant ? 1.0 : length(light.position - start);
  float cosine = max(dot(n, towards), 0.05);  // grazing light: a steeper plane than 1 : 20 is not followed
  float least = 0.5 * float(pcf) * texel;     // as wide as the filter of a light without a size
  float widest = mapGap(light, start).widest;
  widest = light.size * (distant ? widest : min(widest, WIDEST_GAP));
  uvec3 bits = floatBitsToUint(start);
  uint hash = hashUint(bits.x ^ hashUint(bits.y ^ hashUint(bits.z)));
  uvec2 shift = uvec2(hash, hashUint(hash));

  float width = widest, sum = 0.0;
  uint blocked = 0u;
  for (uint step = 0u; step < 2u; ++step) {
    blocked = 0u;
    for (uint k = 0u; k < light.points; ++k) {
      vec2 u = hammersley(k, light.points, shift);
      // The search is densest in the middle, since the width is not known; the average is over a disc.
      float r = (step == 0u ? u.x * sqrt(u.x) : sqrt(u.x)) * width;
      float phi = 2.0 * IRAD_PI * u.y;
      vec3 aside = toWorld(vec3(r * cos(phi), r * sin(phi), 0.0), towards);
      float along = -dot(n, aside) / cosine;  // on the point's plane
      float gap = mapGap(light, start + aside + towards * along).gap;
      if (gap <= 0.0) continue;
      // Above the point itself. From a lamp's place the plane's point at `along` is seen further aside than r.
      float further = distant ? 1.0 : away / (away - along);
      if (further < 0.0) continue;  // beyond the lamp
      gap = distant ? gap + along : (1.0 + gap) * further - 1.0;
      if (r * further > light.size * gap + least) continue;
      ++blocked;
      sum += gap;
    }
    if (blocked == 0u) return 1.0;
    if (step == 0u) width = clamp(light.size * sum / float(blocked), least, max(widest, least));
  }
  return 1.0 - float(blocked) / float(light.points);
}

/// Chebyshev's inequality bounds the share of a map's texels that are not nearer than the point, from their mean
/// distance and its variance; what is below light.bleedReduction is dark, and the rest stretched (Lauritzen 2007, "Summed-Area
/// Variance Shadow Maps", GPU Gems 3, 8.4.3): where one blocker stands before another, the bound is too large.
float varianceVisibility(GpuLight light, vec3 p) {
  vec4 first, second;  // moments of the four texels around
  vec2 f;
  float distance;
  if (hasCubeMap(light)) {
    vec3 d = p - light.position, a = abs(d);
    float major = max(a.x, max(a.y, a.z));
    if (!(major > 0.0)) return 1.0;
    distance = major / light.shadowFar;
    vec3 u = major == a.x ? vec3(0, 1, 0) : vec3(1, 0, 0);
    vec3 v = major == a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    vec2 at = (vec2(dot(u, d), dot(v, d)) / major * 0.5 + 0.5) * float(textureSize(shadowCubes, 0).x) - 0.5;
    f = at - floor(at);
    for (uint k = 0u; k < 4u; ++k) {
      vec2 off = (vec2(float(k & 1u), float(k >> 1)) - f) * light.shadowTexel * major;
      vec4 texel = textureLod(shadowCubes, vec4(d + u * off.x + v * off.y, float(light.shadowLayer)), 0.0);
      first[k] = texel.g;
      second[k] = texel.b;
    }
  } else {
    vec4 clip = project(light.shadowMatrix, p);
    if (!(clip.w > 0.0)) return 1.0;
    vec3 ndc = clip.xyz / clip.w;
    if (!onFlatMap(ndc)) return 1.0;
    distance = lightHas(light, LIGHT_DISTANT) ? 1.0 - ndc.z : clip.w / light.shadowFar;
    float size = float(textureSize(shadowFlat, 0).x);
    vec2 at = (ndc.xy * vec2(0.5, -0.5) + 0.5) * size - 0.5;
    f = at - floor(at);
    vec3 middle = vec3((floor(at) + 1.0) / size, float(light.shadowLayer));
    first = textureGather(shadowFlat, middle, 1).wzxy;
    second = textureGather(shadowFlat, middle, 2).wzxy;
  }
  vec4 share = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  float mean = dot(share, first);
  float behind = min(distance, 1.0) - mean;
  if (behind <= 0.0) return 1.0;
  float variance = max(dot(share, second) - mean * mean, 2e-7);  // the roundings of a difference between numbers up to 1
  float bound = variance / (variance + behind * behind);
  return clamp((bound - light.bleedReduction) / (1.0 - light.bleedReduction), 0.0, 1.0);
}

/// By the light's size and its map's filter; `p` is not yet lifted.
float mapVisibility(GpuLight light, vec3 p, vec3 n, float lift, float texel, uint pcf) {
  if (hasSize(light)) return penumbraVisibility(light, p, n, lift, texel, pcf);
  precise vec3 lifted = p + n * lift;
  if (light.shadowFilter == SHADOW_VSM) return varianceVisibility(light, lifted);
  return mapGap(light, lifted).gap > 0.0 ? 0.0 : 1.0;
}
bool readsMapItself(GpuLight light) { return hasSize(light) || (FILTERS && light.shadowFilter != SHADOW_PCF); }

/// Share of the light that reaches a point of a surface, 0..1: by SHADOW_PCF pcf x pcf bilinear comparisons one texel
/// apart, else as mapVisibility() has it. The point is lifted off the surface along its normal by `biasTexels` texels
/// times the sine between the normal and the map's axis, which is what the surface's slope inside one texel needs;
/// nothing here has a length of its own, so the scene's scale does not matter.
float shadowVisibility(GpuLight light, vec3 localPosition, vec3 normal, float biasTexels, uint pcf) {
  if (light.shadowLayer < 0) return 1.0;
  pcf |= 1u;  // odd
  if (hasCubeMap(light)) {
    vec3 a = abs(localPosition - light.position);
    float major = max(a.x, max(a.y, a.z));
    float along = a.x == major ? normal.x : (a.y == major ? normal.y : normal.z);
    // A penumbra may reach over to a face that the surface is slanted in.
    float sine = hasSize(light) ? 1.0 : sqrt(max(0.0, 1.0 - along * along));
    precise float lift = biasTexels * max(sine, 0.2) * light.shadowTexel * major;
    if (readsMapItself(light))
      return mapVisibility(light, localPosition, normal, lift, light.shadowTexel * major, pcf);
    return cubeVisibility(light, localPosition, normal, lift, pcf);
  }
  float cosine = preciseDot(normal, lightDirection(light, localPosition));
  float along = preciseDot(normal, light.direction);
  precise float texel = light.shadowTexel;
  if (lightHas(light, LIGHT_CONE)) texel *= preciseDot(localPosition - light.position, light.direction);
  precise float lift = biasTexels * max(sqrt(max(0.0, 1.0 - along * along)), 0.2) * texel;
  if (readsMapItself(light)) return mapVisibility(light, localPosition, normal, lift, texel, pcf);
  return flatVisibility(light, localPosition, normal, max(cosine, 0.0), lift, texel, pcf);
}

#endif
