#include "gi/outer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/ray_kernel.h"
#include "gi/region.h"
#include "gi/sky.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/gpu_scene.h"
#include "renderer/scene/srgb.h"
#include "renderer/shadow.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

/// Steps of a lattice are this share of the grid's longest axis, or a 64th of the triangle's longest edge where that
/// is longer.
constexpr float kStep = 1.0f / 8;
constexpr uint32_t kMostEdges = 64;
/// More points than this make the lattices coarser; single points remain.
constexpr uint32_t kManyPoints = 1u << 15;

struct Box {
  glm::vec3 lo{std::numeric_limits<float>::max()}, hi{-std::numeric_limits<float>::max()};
  void add(const glm::vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
};

struct TreeMaker {
  const std::vector<glm::vec3>& corners;
  std::vector<uint32_t>& order;
  std::vector<OuterNode> nodes;

  glm::vec3 middle(uint32_t t) const {
    return (corners[3 * size_t{t}] + corners[3 * size_t{t} + 1] + corners[3 * size_t{t} + 2]) / 3.0f;
  }
  void make(uint32_t first, uint32_t end) {
    Box box, middles;
    for (uint32_t k = first; k < end; ++k) {
      for (uint32_t i = 0; i < 3; ++i) box.add(corners[3 * size_t{order[k]} + i]);
      middles.add(middle(order[k]));
    }
    const auto at = static_cast<uint32_t>(nodes.size());
    // A little too large: rays test the box in fp32.
    const glm::vec3 slack = 1e-5f * glm::max(glm::abs(box.lo), glm::abs(box.hi)) + 1e-4f;
    nodes.push_back({box.lo - slack, 0, box.hi + slack, 0});
    if (end - first <= OUTER_LEAF) {
      nodes[at].leaf = first << OUTER_LEAF_BITS | (end - first);
    } else {
      const glm::vec3 size = middles.hi - middles.lo;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
      const uint32_t half = (first + end) / 2;
      std::nth_element(order.begin() + first, order.begin() + half, order.begin() + end, [&](uint32_t a, uint32_t b) {
        const float x = middle(a)[axis], y = middle(b)[axis];
        return x != y ? x < y : a < b;
      });
      make(first, half);
      make(half, end);
    }
    nodes[at].next = static_cast<uint32_t>(nodes.size());
  }
};

float longestEdge(const glm::vec3* c) {
  return std::max({glm::distance(c[0], c[1]), glm::distance(c[1], c[2]), glm::distance(c[2], c[0])});
}

/// Linear mean of an image's texels.
glm::vec3 meanOf(const SceneImage& image) {
  glm::dvec3 sum(0);
  const size_t texels = image.rgba.size() / 4;
  for (size_t i = 0; i < texels; ++i)
    for (int c = 0; c < 3; ++c) {
      const uint8_t code = image.rgba[4 * i + static_cast<size_t>(c)];
      sum[c] += image.srgb ? double{linearFromSrgb(code)} : code / 255.0;
    }
  return glm::vec3(sum / std::max(1.0, static_cast<double>(texels)));
}

}  // namespace

std::vector<OuterNode> outerTree(const std::vector<glm::vec3>& corners, std::vector<uint32_t>& order) {
  TreeMaker maker{corners, order, {}};
  order.resize(corners.size() / 3);
  std::iota(order.begin(), order.end(), 0u);
  if (!order.empty()) maker.make(0, static_cast<uint32_t>(order.size()));
  return std::move(maker.nodes);
}

Outer makeOuter(Context& context, const SceneOnDevice& onDevice, const SceneRegion& region, const Grid& grid,
                const std::vector<uint32_t>& repeated) {
  const Scene& scene = onDevice.scene;
  std::vector<uint32_t> outside = trianglesOutside(scene, region);
  std::erase_if(outside, [&](uint32_t t) { return !repeated.empty() && repeated[t] != 0; });
  Outer outer;
  if (outside.empty()) return outer;
  std::vector<glm::vec3> corners;
  for (const uint32_t t : outside)
    for (uint32_t i = 0; i < 3; ++i)
      corners.push_back((scene.positions[scene.indices[3 * size_t{t} + i]] - grid.origin) * grid.inverseEdge);
  std::vector<uint32_t> order;
  const std::vector<OuterNode> nodes = outerTree(corners, order);
  for (uint32_t& t : order) t = outside[t];

  std::vector<bool> bothSides(scene.triangleCount());
  for (const Draw& draw : scene.draws)
    for (uint32_t i = draw.firstIndex; i < draw.firstIndex + draw.indexCount; i += 3)
      bothSides[i / 3] = (onDevice.materialValues.at(draw.material).flags & MATERIAL_DOUBLE_SIDED) != 0;
  const auto sides = [&](size_t k) { return bothSides[outside[k]] ? 2u : 1u; };
  const float longest = static_cast<float>(std::max({grid.dims.x, grid.dims.y, grid.dims.z}) - 2);
  std::vector<uint32_t> edges(outside.size());
  for (float step = kStep * longest;; step *= 1.5f) {
    uint64_t points = 0, coarsest = 0;
    for (size_t k = 0; k < outside.size(); ++k) {
      const float parts = std::ceil(longestEdge(&corners[3 * k]) / step);
      edges[k] = parts > 1 ? static_cast<uint32_t>(std::min(parts, float{kMostEdges})) : 0;
      points += uint64_t{sides(k)} * latticePoints(edges[k]);
      coarsest += sides(k);
    }
    if (points <= std::max<uint64_t>(kManyPoints, coarsest)) break;
  }
  outer.lattices.assign(scene.triangleCount(), {NO_LATTICE, 0});
  std::vector<OuterPoint> points;
  for (size_t k = 0; k < outside.size(); ++k) {
    outer.lattices[outside[k]] = {static_cast<uint32_t>(points.size()), edges[k]};
    for (uint32_t side = 0; side < sides(k); ++side)
      for (uint32_t j = 0; j <= edges[k]; ++j)
        for (uint32_t i = 0; i + j <= edges[k]; ++i)
          points.push_back({outside[k] | (side != 0 ? SURFEL_BACK : 0), i | j << 16});
  }
  if (points.size() > MOST_OUTER_POINTS)
    throw UsageError(
        fmt::format("scene.region: {} triangles lie outside of it, which need {} points; at most {} can be",
                    outside.size(), points.size(), MOST_OUTER_POINTS));
  outer.count = static_cast<uint32_t>(points.size());
  for (size_t k = 0; k < outside.size(); ++k) {
    const glm::vec3* c = &corners[3 * k];
    outer.areas.push_back(0.5f * static_cast<float>(sides(k)) * glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
  }
  outer.triangles = outside;
  const auto make = [&]<class T>(const char* name, const std::vector<T>& values) {
    return makeBuffer<T>(context, name, Subsystem::Facets, std::span<const T>(values));
  };
  outer.nodes = make("outside: tree", nodes);
  outer.order = make("outside: triangles", order);
  outer.lattice = make("outside: lattices", outer.lattices);
  outer.points = make("outside: points", points);
  const auto room = [&](const char* name, uint64_t bytes) {
    return Buffer(context.device, name, Subsystem::Facets, bytes);
  };
  outer.albedo = room("outside: albedo", 12ull * scene.triangleCount());
  outer.exitance = room("outside: exitance", 12ull * scene.triangleCount());
  outer.irradiance = room("outside: irradiance", 16ull * outer.count);
  outer.bins = room("sky by bins, and points outside", 16ull * (SKY_BINS + outer.count));
  RecordMaker maker(context, "outside record", Subsystem::Facets, sizeof(OuterArrays));
  OuterArrays arrays{};
  arrays.nodes = maker.of(outer.nodes);
  arrays.order = maker.of(outer.order);
  arrays.lattice = maker.of(outer.lattice);
  arrays.points = maker.of(outer.points);
  arrays.albedo = maker.of(outer.albedo);
  arrays.exitance = maker.of(outer.exitance);
  arrays.irradiance = maker.of(outer.irradiance);
  arrays.bins = maker.of(outer.bins);
  arrays.nodeCount = static_cast<uint32_t>(nodes.size());
  arrays.pointCount = outer.count;
  outer.record = maker.make(arrays);
  shadeOuter(context, onDevice, outer);
  Frame frame = context.begin();
  frame.pass("GI CompactList").fill(outer.bins, 0);
  frame.pass("GI CompactList").fill(outer.irradiance, 0);
  frame.submit();
  return outer;
}

void shadeOuter(Context& context, const SceneOnDevice& onDevice, Outer& outer) {
  if (!outer) return;
  const Scene& scene = onDevice.scene;
  const auto mean = [&](const TextureUse& use, bool used) {
    if (use.image < 0 || !used) return glm::vec3(1);
    const auto [at, fresh] = outer.means.try_emplace(use.image);
    if (fresh) at->second = meanOf(scene.images.at(static_cast<size_t>(use.image)));
    return at->second;
  };
  std::vector<glm::vec3> albedo(scene.triangleCount()), exitance(scene.triangleCount());
  for (const Draw& draw : scene.draws) {
    const GpuMaterial& m = onDevice.materialValues.at(draw.material);
    const Material& material = scene.materials.at(draw.material);
    bool any = false;
    for (uint32_t i = draw.firstIndex; !any && i < draw.firstIndex + draw.indexCount; i += 3)
      any = outer.lattices[i / 3].first != NO_LATTICE;
    if (!any) continue;
    const glm::vec3 base =
        glm::vec3(m.baseColor) * mean(material.baseColorTexture, (m.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0);
    // glTF: metallic is the texture's blue.
    const float metallic =
        m.metallic * mean(material.metallicRoughnessTexture, (m.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0).b;
    const glm::vec3 emitted = std::numbers::pi_v<float> * m.emission *
                              mean(material.emissiveTexture, (m.flags & MATERIAL_EMISSIVE_TEXTURE) != 0);
    for (uint32_t i = draw.firstIndex; i < draw.firstIndex + draw.indexCount; i += 3) {
      glm::vec3 color(0);
      for (uint32_t k = 0; k < 3; ++k) color += glm::vec3(scene.colors[scene.indices[i + k]]) / 3.0f;
      albedo[i / 3] = glm::clamp(color * base * (1 - metallic), glm::vec3(0), glm::vec3(0.98f));
      exitance[i / 3] = emitted;
    }
  }
  upload(context, outer.albedo, std::as_bytes(std::span(albedo)));
  upload(context, outer.exitance, std::as_bytes(std::span(exitance)));
  std::vector<glm::vec3> emitted;
  for (const uint32_t t : outer.triangles) emitted.push_back(exitance[t]);
  outer.emitters = listEmitters(context, outer.triangles, emitted, outer.areas);
}

const Buffer& binsOf(const Outer& outer, const SkyOnDevice& sky) {
  return outer ? outer.bins : sky.bins;
}

namespace {

/// What the points get from emitters far away.
void lightFromEmitters(Frame& frame, const FacetList& facets, const Emitters& inGrid, const Field& field) {
  const Outer& outer = facets.outer;
  Pass pass = frame.pass("GI Gather");
  OuterEmittersPush push{};
  push.facets = facets.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
  push.surface = pass.in(facets.surface.record);
  push.chebyshev = pass.inIfAny(field.chebyshev);
  push.byFacets = pass.inIfAny(inGrid.record);
  push.byTriangles = pass.inIfAny(outer.emitters.record);
  push.irradiance = pass.out(outer.irradiance);
  push.dims = facets.grid.dims;
  push.count = outer.count;
  push.hasFacets = inGrid.count > 0;
  push.power = inGrid.power + outer.emitters.power;
  mayMeet(pass.shader("gi/outer_emitters.comp"), facets)
      .constant(CONSTANT_TRACE_METHOD, exactTraversal(field))
      .push(push)
      .dispatch(outer.count);
}

}  // namespace

void lightOuter(Frame& frame, const SceneOnDevice& scene, const FacetList& facets, const Emitters& emitters,
                const Field& field, const SkyOnDevice& sky) {
  const Outer& outer = facets.outer;
  if (!outer) return;
  const float power = emitters.power + outer.emitters.power;
  if (power > 0)
    lightFromEmitters(frame, facets, emitters, field);
  else
    frame.pass("GI Gather").fill(outer.irradiance, 0);
  if (sky.bins)
    frame.pass("GI Gather").copy(sky.bins, outer.bins, sky.bins.bytes);
  else
    frame.pass("GI Gather").fill(outer.bins, 0);
  Pass pass = frame.pass("GI Gather");
  OuterLightPush push{};
  push.scene = pass.in(scene.record);
  push.facets = facets.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
  push.surface = pass.in(facets.surface.record);
  push.chebyshev = pass.inIfAny(field.chebyshev);
  push.irradiance = pass.out(outer.irradiance);
  push.bins = pass.out(outer.bins);
  push.origin = facets.grid.origin;
  push.edge = facets.grid.edge;
  push.dims = facets.grid.dims;
  push.count = outer.count;
  push.emitterPower = power;
  mayMeet(pass.shader("gi/outer_light.comp"), facets).constant(CONSTANT_TRACE_METHOD, exactTraversal(field));
  specialize(pass, GATHER_LIGHTS, kindsOf(scene.shining), scene.shining);
  pass.push(push).dispatch(outer.count);
}

}  // namespace irad
