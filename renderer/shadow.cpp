#include "renderer/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/depth_pass.h"
#include "renderer/raster.h"
#include "shaders/shared/raster.h"

namespace irad {
namespace {

constexpr const char* kStage = "RE Shadow";

uint32_t channelsOf(const ShadowNeeds& needs) {
  return needs.tinted ? 3 : 1;
}

/// Maps of one scene at most; where lights are very many they are smaller.
constexpr uint64_t kMostBytes = uint64_t{1} << 30;

/// One picture of the scene from a light: its layer and its projection.
struct Face {
  bool cube;
  int layer;
  uint32_t channel;  ///< by which panes keep light off
  glm::mat4 matrix;
};

using Basis = std::array<glm::dvec3, 3>;  // right, up, forward

Basis basisAbout(const glm::dvec3& forward) {
  const glm::dvec3 f = glm::normalize(forward);
  const glm::dvec3 a = glm::abs(f);
  const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                          : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                   : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(f, axis));
  return {right, glm::cross(right, f), f};
}

/// The six faces of a cube map in Vulkan's layer order; t runs down, and targets are drawn with y up.
constexpr std::array<std::array<glm::vec3, 3>, 6> kCubeFaces{{{{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}},
                                                              {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},
                                                              {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
                                                              {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
                                                              {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                                              {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}}};

/// Rows are clip x, y, z, w.
glm::mat4 fromRows(const std::array<glm::dvec4, 4>& rows) {
  glm::mat4 m;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] = static_cast<float>(rows[r][c]);
  return m;
}

/// Depth is near / distance: reversed, so that fp32 keeps its relative precision at any distance.
glm::mat4 perspective(const Basis& basis, const glm::dvec3& eye, double tangent, double nearPlane) {
  const auto row = [&](const glm::dvec3& axis, double scale) {
    return glm::dvec4(axis * scale, -glm::dot(axis, eye) * scale);
  };
  return fromRows(
      {row(basis[0], 1.0 / tangent), row(basis[1], 1.0 / tangent), glm::dvec4(0, 0, 0, nearPlane), row(basis[2], 1.0)});
}

/// Near and far planes of a light at `eye`: from the scene's bounds (and the light's range), so that they scale with
/// it.
void fitPlanes(const Scene& scene, GpuLight& light) {
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 c((corner & 1) != 0 ? scene.boundsMax.x : scene.boundsMin.x,
                      (corner & 2) != 0 ? scene.boundsMax.y : scene.boundsMin.y,
                      (corner & 4) != 0 ? scene.boundsMax.z : scene.boundsMin.z);
    farthest = std::max(farthest, glm::distance(glm::dvec3(c), glm::dvec3(light.position)));
  }
  if (!(farthest > 0.0)) farthest = 1.0;
  if (light.range > 0.0f) farthest = std::min(farthest, static_cast<double>(light.range));
  const glm::dvec3 inside = glm::clamp(light.position, scene.boundsMin, scene.boundsMax);
  const double outside = glm::distance(inside, glm::dvec3(light.position));
  light.shadowFar = static_cast<float>(farthest * (1.0 + 1.0 / 1024.0));
  light.shadowNear = std::min(static_cast<float>(std::max(farthest / 256.0, outside * 0.5)), 0.5f * light.shadowFar);
}

/// Across a parallel light's way.
struct Box2 {
  glm::dvec2 lo{std::numeric_limits<double>::max()}, hi{std::numeric_limits<double>::lowest()};
  void add(const Box2& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
  }
  double longest() const { return std::max(hi.x - lo.x, hi.y - lo.y); }
};
using Outline = std::array<glm::dvec2, 3>;

/// Whether two triangles have more in common than a border, by the axes that could separate them.
bool overlap(const Outline& a, const Outline& b, double slack) {
  for (const Outline* of : {&a, &b})
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 edge = (*of)[(i + 1) % 3] - (*of)[i];
      const glm::dvec2 axis(-edge.y, edge.x);
      const auto along = [&](const Outline& t) {
        return std::minmax({glm::dot(axis, t[0]), glm::dot(axis, t[1]), glm::dot(axis, t[2])});
      };
      const auto [aLo, aHi] = along(a);
      const auto [bLo, bHi] = along(b);
      if (std::min(aHi, bHi) - std::max(aLo, bLo) <= slack * glm::length(axis)) return false;
    }
  return true;
}

/// Where one thing may lie behind another, as the light sees them: the box around all triangles but for some of the
/// largest that do not overlap each other. What these hide, or have hidden from them, is in it. So the ground
/// around a house, however far it goes, takes no texels from the house. `across`: the vertices.
Box2 whereShadowsFall(const Scene& scene, const std::vector<glm::dvec2>& across, const Box2& whole) {
  constexpr size_t kMost = 256;
  struct Large {
    double size;
    Outline outline;
    Box2 box;
  };
  std::vector<Large> large;
  Box2 rest;
  for (size_t i = 0; i + 2 < scene.indices.size(); i += 3) {
    Outline outline;
    Box2 box;
    for (size_t k = 0; k < 3; ++k) {
      outline[k] = across[scene.indices[i + k]];
      box.add({outline[k], outline[k]});
    }
    if (box.longest() > whole.longest() / 16.0)
      large.push_back({box.longest(), outline, box});
    else
      rest.add(box);
  }
  std::ranges::stable_sort(large, std::ranges::greater(), &Large::size);
  size_t left = 0;
  const auto overlaps = [&](const Large& one) {
    return std::any_of(large.begin(), large.begin() + static_cast<std::ptrdiff_t>(left),
                       [&](const Large& other) { return overlap(one.outline, other.outline, 1e-6 * whole.longest()); });
  };
  while (left < std::min(large.size(), kMost) && !overlaps(large[left])) ++left;
  for (size_t i = left; i < large.size(); ++i) rest.add(large[i].box);
  return rest.lo.x <= rest.hi.x ? rest : whole;
}

/// A parallel map encloses, in the light's own axes, all that is in the light's way, and of what is across it
/// what may lie in a shadow or its penumbra, tightly; a rim of 4 texels is left for the filter. Beside the map all is
/// lit (shaders/forward/shadow.glsl).
void fitParallel(const Scene& scene, GpuLight& light, uint32_t resolution) {
  const Basis basis = basisAbout(light.direction);
  glm::dvec3 lo(std::numeric_limits<double>::max()), hi(std::numeric_limits<double>::lowest());
  std::vector<glm::dvec2> across;
  across.reserve(scene.positions.size());
  for (const glm::vec3& p : scene.positions) {
    const glm::dvec3 q(glm::dot(basis[0], glm::dvec3(p)), glm::dot(basis[1], glm::dvec3(p)),
                       glm::dot(basis[2], glm::dvec3(p)));
    across.emplace_back(q);
    lo = glm::min(lo, q);
    hi = glm::max(hi, q);
  }
  if (scene.positions.empty()) lo = hi = glm::dvec3(0.0);
  const Box2 whole{lo, hi}, fall = whereShadowsFall(scene, across, whole);
  const double penumbra = light.size * (hi.z - lo.z);
  // Depths of a triangle much larger than the map are rounded to more than what the lookup's bias covers.
  const double least = whole.longest() / 2.0 / 64.0;
  lo = glm::dvec3(glm::max(glm::dvec2(lo), fall.lo - penumbra), lo.z);
  hi = glm::dvec3(glm::min(glm::dvec2(hi), fall.hi + penumbra), hi.z);
  const glm::dvec3 centre = 0.5 * (lo + hi);
  glm::dvec3 half = 0.5 * (hi - lo);
  double largest = std::max({half.x, half.y, half.z});
  if (!(largest > 0.0)) largest = 1.0;
  const double rim = static_cast<double>(resolution) / (resolution - 8.0);
  const double side = std::max({half.x, half.y, least, largest / 1024.0}) * rim;
  const double depth = std::max(half.z, largest / 1024.0) * (1.0 + 1.0 / 256.0);
  light.shadowTexel = static_cast<float>(2.0 * side / resolution);
  light.shadowNear = 0.0f;
  light.shadowFar = static_cast<float>(2.0 * depth);
  light.shadowMatrix =
      fromRows({glm::dvec4(basis[0] / side, -centre.x / side), glm::dvec4(basis[1] / side, -centre.y / side),
                glm::dvec4(-basis[2] / (2.0 * depth), 0.5 + centre.z / (2.0 * depth)), glm::dvec4(0, 0, 0, 1)});
}

/// A cone's map covers its outer cone and the filter's rim.
void fitCone(const Scene& scene, GpuLight& light, uint32_t resolution) {
  fitPlanes(scene, light);
  const double cosine = std::clamp(static_cast<double>(light.outerCos), 0.05, 0.99999);
  const double tangent = std::sqrt(1.0 - cosine * cosine) / cosine * resolution / (resolution - 8.0);
  light.shadowTexel = static_cast<float>(2.0 * tangent / resolution);
  light.shadowMatrix = perspective(basisAbout(light.direction), light.position, tangent, light.shadowNear);
}

Image mapArray(const Device& device, const char* name, VkFormat format, uint32_t size, uint32_t layers, bool cube,
               VkImageUsageFlags usage) {
  ImageDesc desc;
  desc.name = name;
  desc.subsystem = Subsystem::Shadow;
  desc.format = format;
  desc.width = desc.height = size;
  desc.layers = layers;
  desc.cube = cube;
  desc.array = !cube;
  desc.usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return Image(device, desc);
}

void drawByHardware(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& maps, const std::vector<Face>& faces,
                    const Buffer& projections, bool alphaTest) {
  for (size_t i = 0; i < faces.size(); ++i)
    drawDepth(frame, scene,
              {.stage = kStage,
               .target = faces[i].cube ? maps.cubes : maps.flat,
               .layer = faces[i].layer,
               .projections = projections,
               .offset = i * sizeof(Projection),
               .alphaTest = alphaTest,
               .screens = 1 + faces[i].channel});
}

/// Flat maps are stored by a kernel, layer by layer. Cubes are copied, all at once.
void drawByKernels(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& maps, const std::vector<Face>& faces,
                   const Buffer& projections, bool alphaTest) {
  const Device& device = frame.context().device;
  const auto texels = [](const Image& map) { return uint64_t{map.desc.width} * map.desc.height; };
  const Buffer queue = makeRasterQueue(device, Subsystem::Shadow, scene.scene.triangleCount());
  Buffer flat, cubes;
  if (maps.flat) flat = Buffer(device, "depths of a shadow map", Subsystem::Shadow, 4 * texels(maps.flat));
  if (maps.cubes) {
    cubes =
        Buffer(device, "depths of shadow cubes", Subsystem::Shadow, 4 * texels(maps.cubes) * maps.cubes.desc.layers);
    frame.pass(kStage).fill(cubes, 0);
  }
  for (size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    const Image& map = face.cube ? maps.cubes : maps.flat;
    if (!face.cube) frame.pass(kStage).fill(flat, 0);
    rasterScene(frame, scene,
                {.stage = kStage,
                 .shader = "raster/shadow.comp",
                 .projections = projections,
                 .offset = i * sizeof(Projection),
                 .target = face.cube ? cubes : flat,
                 .targetOffset = face.cube ? 4 * texels(map) * face.layer : 0,
                 .size = {map.desc.width, map.desc.height},
                 .queue = queue,
                 .alphaTest = alphaTest,
                 .channel = face.channel});
    if (face.cube) continue;
    Pass store = frame.pass(kStage);
    store.shader("raster/store_shadow.comp")
        .write(map)
        .push(StoreShadowPush{store.in(flat), face.layer, 0})
        .dispatch(glm::uvec2(map.desc.width, map.desc.height));
  }
  if (maps.cubes) frame.pass(kStage).copy(cubes, maps.cubes);
}

/// In place of depths, these and the filtered moments (ShadowFilter::vsm).
void addMoments(Frame& frame, ShadowMaps& maps, const std::vector<GpuLight>& lights, uint32_t taps, int channels) {
  const Device& device = frame.context().device;
  ShadowMaps depths = std::move(maps);
  maps = {};
  maps.sampler = depths.sampler;
  const auto make = [&](const Image& depth, Image& moments, const char* name, bool cube) {
    if (!depth) return;
    const uint32_t size = depth.desc.width;
    moments = mapArray(device, name, VK_FORMAT_R32G32B32A32_SFLOAT, size, depth.desc.layers, cube,
                       VK_IMAGE_USAGE_STORAGE_BIT);
    for (const GpuLight& light : lights) {
      if (light.shadowLayer < 0 || lightUsesCube(light.type, light.outerCos) != cube) continue;
      for (int face = 0; face < (cube ? 6 : 1) * channels; ++face)
        frame.pass(kStage)
            .shader(cube ? "raster/shadow_moments_cube.comp" : "raster/shadow_moments.comp")
            .sampleDepth(depth, depths.sampler, cube)
            .write(moments)
            .push(ShadowMomentsPush{.layer = light.shadowLayer + face / (cube ? 6 : 1),
                                    .face = cube ? face % 6 : 0,
                                    .taps = taps | 1u,
                                    // Depth in perspective is near / distance, else 1 - distance.
                                    .nearShare = lightKind(LightType{light.type}).has(LIGHT_DISTANT)
                                                     ? 0.0f
                                                     : light.shadowNear / light.shadowFar})
            .dispatch(glm::uvec2(size, size));
    }
  };
  make(depths.flat, maps.flat, "shadow moments", /*cube*/ false);
  make(depths.cubes, maps.cubes, "shadow moments of cubes", /*cube*/ true);
}

}  // namespace

uint64_t shadowTexelBytes(ShadowFilter filter) {
  return filter == ShadowFilter::vsm ? 16 : 4;
}

std::vector<int> shadowLayers(const Device& device, std::span<const GpuLight> lights, const ShadowNeeds& needs) {
  const uint32_t channels = channelsOf(needs);
  std::vector<int> layers(lights.size(), -1);
  for (const bool cube : {false, true}) {
    std::vector<size_t> chosen;
    for (size_t i = 0; i < lights.size(); ++i)
      if (needs.shines(lights[i]) && lightUsesCube(lights[i].type, lights[i].outerCos) == cube) chosen.push_back(i);
    const size_t most = device.limits.maxImageArrayLayers / (channels * (cube ? 6 : 1));
    if (chosen.size() > most) {
      // Distant lights reach everything.
      const auto strength = [&](size_t i) {
        const glm::vec3& intensity = lights[i].intensity;
        return std::pair(lightHas(lights[i].type, LIGHT_DISTANT), std::max({intensity.x, intensity.y, intensity.z}));
      };
      std::ranges::stable_sort(chosen, std::ranges::greater(), strength);
      chosen.resize(most);
      std::ranges::sort(chosen);
    }
    for (size_t k = 0; k < chosen.size(); ++k) layers[chosen[k]] = static_cast<int>(channels * k);
  }
  return layers;
}

ShadowMaps drawShadows(Context& context, const SceneOnDevice& scene, std::vector<GpuLight>& lights, uint32_t resolution,
                       const ShadowNeeds& needs) {
  const uint32_t channels = channelsOf(needs);
  const std::vector<int> layers = shadowLayers(context.device, lights, needs);
  uint32_t flats = 0, cubes = 0;
  for (size_t i = 0; i < lights.size(); ++i) {
    GpuLight& light = lights[i];
    light.shadowLayer = layers[i];
    light.shadowFilter = needs.filter;
    light.bleedReduction = needs.bleedReduction;
    light.points = std::max(needs.points, 1u);
    if (light.shadowLayer >= 0) (lightUsesCube(light.type, light.outerCos) ? cubes : flats) += channels;
  }

  // The largest sizes that the device and a bounded share of memory allow: the kind that takes more gives way first.
  uint32_t size = std::clamp(resolution, 16u, context.device.limits.maxImageDimension2D);
  uint32_t cubeSize = size / 2;
  const uint64_t texelBytes = shadowTexelBytes(needs.filter);
  const auto flatBytes = [&] { return texelBytes * size * size * flats; };
  const auto cubeBytes = [&] { return texelBytes * cubeSize * cubeSize * 6 * cubes; };
  while (flatBytes() + cubeBytes() > kMostBytes && std::max(size, cubeSize) > 64)
    (flatBytes() > cubeBytes() ? size : cubeSize) /= 2;

  ShadowMaps maps;
  if (flats > 0)
    maps.flat = mapArray(context.device, "shadow maps", needs.kernels ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_D32_SFLOAT,
                         size, flats, /*cube*/ false, needs.kernels ? VK_IMAGE_USAGE_STORAGE_BIT : 0);
  if (cubes > 0)
    maps.cubes = mapArray(context.device, "shadow cubes", VK_FORMAT_D32_SFLOAT, cubeSize, 6 * cubes, /*cube*/ true,
                          needs.kernels ? VK_IMAGE_USAGE_TRANSFER_DST_BIT : 0);
  maps.sampler = pointSampler(context.device);
  if (flats + cubes == 0) return maps;

  // Fit each light's projections to the scene.
  std::vector<Face> faces;
  for (GpuLight& light : lights) {
    if (light.shadowLayer < 0) continue;
    if (lightKind(LightType{light.type}).map == LIGHT_MAP_PARALLEL) {
      fitParallel(scene.scene, light, size);
    } else if (!lightUsesCube(light.type, light.outerCos)) {
      fitCone(scene.scene, light, size);
    } else {
      fitPlanes(scene.scene, light);
      light.shadowTexel = 2.0f / static_cast<float>(cubeSize);
      for (uint32_t c = 0; c < channels; ++c)
        for (int f = 0; f < 6; ++f) {
          const Basis basis{kCubeFaces[f][0], kCubeFaces[f][1], kCubeFaces[f][2]};
          faces.push_back({true, (light.shadowLayer + static_cast<int>(c)) * 6 + f, c,
                           perspective(basis, light.position, /*tangent*/ 1.0, light.shadowNear)});
        }
      continue;
    }
    for (uint32_t c = 0; c < channels; ++c)
      faces.push_back({false, light.shadowLayer + static_cast<int>(c), c, light.shadowMatrix});
  }

  // Draw. Every triangle casts a shadow, whichever side it shows; masked materials read their textures.
  std::vector<glm::mat4> matrices;
  for (const Face& face : faces) matrices.push_back(face.matrix);
  const Buffer projections =
      makeBuffer(context, "shadow projections", Subsystem::Shadow, std::span<const glm::mat4>(matrices));
  Frame frame = context.begin();
  (needs.kernels ? drawByKernels : drawByHardware)(frame, scene, maps, faces, projections, needs.alphaTest);
  if (needs.filter == ShadowFilter::vsm) addMoments(frame, maps, lights, needs.taps, static_cast<int>(channels));
  frame.submitAndWait();
  return maps;
}

ShadowMaps drawShadows(Context& context, SceneOnDevice& scene, uint32_t resolution, const ShadowNeeds& needs) {
  std::vector<GpuLight> lights = scene.lightValues;
  ShadowMaps maps = drawShadows(context, scene, lights, resolution, needs);
  scene.setLights(context, std::move(lights), needs.shines);
  return maps;
}

Pass& sampleShadows(Pass& pass, const ShadowMaps& maps) {
  return pass.sampleDepth(maps.flat, maps.sampler, /*cube*/ false).sampleDepth(maps.cubes, maps.sampler, /*cube*/ true);
}

void keepShadows(std::vector<GpuLight>& lights, std::span<const GpuLight> drawn) {
  IRAD_CHECK_OP(lights.size(), ==, drawn.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const glm::vec3 intensity = lights[i].intensity;
    const float innerCos = lights[i].innerCos, size = lights[i].size;
    lights[i] = drawn[i];
    lights[i].intensity = intensity;
    lights[i].innerCos = innerCos;
    lights[i].size = size;
  }
}

LightKinds kindsOf(std::span<const GpuLight> shining) {
  LightKinds kinds;
  for (const GpuLight& light : shining) {
    kinds[LightType{light.type}] = true;
    kinds.sizes |= light.size > 0;
    kinds.filters |= light.shadowFilter != ShadowFilter::pcf;
  }
  return kinds;
}

void specialize(Pass& pass, uint32_t first, const LightKinds& kinds, std::span<const GpuLight> shining) {
  const bool wideCone = std::any_of(shining.begin(), shining.end(), [](const GpuLight& light) {
    return lightKind(LightType{light.type}).map == LIGHT_MAP_CONE && lightUsesCube(light.type, light.outerCos);
  });
  bool flat = false, cube = false;
  for (const LightKind& kind : lightKinds()) {
    const bool shines = kinds[kind.type];
    pass.effect(first + static_cast<uint32_t>(kind.type), shines);
    flat |= shines && kind.map != LIGHT_MAP_CUBE;
    cube |= shines && (kind.map == LIGHT_MAP_CUBE || (kind.map == LIGHT_MAP_CONE && wideCone));
  }
  pass.effect(first + LIGHT_FLAT_MAPS, flat)
      .effect(first + LIGHT_CUBE_MAPS, cube)
      .effect(first + LIGHT_SIZES, kinds.sizes)
      .effect(first + LIGHT_FILTERS, kinds.filters);
}

}  // namespace irad
