// What every scene must satisfy before passes may index and divide without asking.
#include <cmath>
#include <limits>

#include "renderer/scene/gltf_document.h"
#include "renderer/scene/material_edits.h"

namespace irad {
namespace {

template <class Vector>
bool within(const Vector& v, double lo, double hi) {
  for (int c = 0; c < static_cast<int>(v.length()); ++c)
    if (!(v[c] >= lo && v[c] <= hi)) return false;
  return true;
}
template <class Vector>
bool finite(const Vector& v) {
  return within(v, -std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
}
template <class Vector>
bool unit(const Vector& v) {
  return std::abs(glm::length(v) - 1.0f) < 1e-4f;
}
template <class Vector>
bool position(const Vector& v, double limit = kMaxCoordinate) {
  return within(v, -limit, limit);
}
bool brightness(double value) {
  return value >= 0.0 && value <= static_cast<float>(kMaxLightOrEmission);
}

std::string ofVertices(const Scene& s) {
  const size_t n = s.positions.size();
  if (s.normals.size() != n || s.tangents.size() != n || s.uv0.size() != n || s.uv1.size() != n || s.colors.size() != n)
    return "vertex arrays of different lengths";
  if (!position(s.origin) || !position(s.boundsMin) || !position(s.boundsMax)) return "bounds that are not finite";
  for (size_t i = 0; i < n; ++i) {
    const glm::vec3 tangent(s.tangents[i]);
    if (!finite(s.positions[i])) return fmt::format("position {} is not finite", i);
    if (!unit(s.normals[i])) return fmt::format("normal {} is not unit", i);
    if (!unit(tangent)) return fmt::format("tangent {} is not unit", i);
    if (std::abs(s.tangents[i].w) != 1.0f) return fmt::format("the handedness of tangent {} is not +-1", i);
    if (!(std::abs(glm::dot(tangent, s.normals[i])) < 1e-3f)) return fmt::format("tangent {} is not orthogonal", i);
    if (!within(s.colors[i], 0.0, 1.0)) return fmt::format("vertex colour {} is out of range", i);
    if (!finite(s.uv0[i]) || !finite(s.uv1[i])) return fmt::format("texture coordinate {} is not finite", i);
  }
  return "";
}

std::string ofDraws(const Scene& s) {
  for (const uint32_t index : s.indices)
    if (index >= s.positions.size()) return fmt::format("index {} of {} vertices", index, s.positions.size());
  uint64_t next = 0;
  for (const Draw& draw : s.draws) {
    if (draw.firstIndex != next || draw.indexCount == 0 || draw.indexCount % 3 != 0 ||
        draw.material >= s.materials.size())
      return "a draw is out of range";
    next += draw.indexCount;
  }
  return next == s.indices.size() ? "" : "the draws do not cover the triangles";
}

/// After ofVertices and ofDraws.
std::string ofNodes(const Scene& s) {
  const size_t nodes = s.nodes.size(), vertices = s.positions.size();
  std::vector<uint32_t> above;  // that the next node may lie under
  for (uint32_t i = 0; i < nodes; ++i) {
    const SceneNode& node = s.nodes[i];
    while (!above.empty() && s.nodes[above.back()].end <= i) above.pop_back();
    const uint32_t parent = above.empty() ? SceneNode::kNoParent : above.back();
    const size_t most = above.empty() ? nodes : s.nodes[parent].end;
    if (node.name.empty() || node.parent != parent || node.end <= i || node.end > most)
      return fmt::format("node {} is out of place", i);
    above.push_back(i);
  }
  if (nodes == 0) return s.pieces.empty() && s.world.empty() ? "" : "pieces without nodes";
  if (s.world.size() != vertices) return "vertex arrays of different lengths";
  uint64_t vertex = 0, index = 0;
  size_t draw = 0;
  for (size_t i = 0; i < s.pieces.size(); ++i) {
    const Piece& piece = s.pieces[i];
    while (draw < s.draws.size() && index >= uint64_t{s.draws[draw].firstIndex} + s.draws[draw].indexCount) ++draw;
    const bool first = draw < s.draws.size() && index == s.draws[draw].firstIndex;
    if (draw == s.draws.size() || piece.node >= nodes || piece.firstVertex != vertex || piece.firstIndex != index ||
        piece.indexCount == 0 || piece.indexCount % 3 != 0 || vertex + piece.vertexCount > vertices ||
        index + piece.indexCount > uint64_t{s.draws[draw].firstIndex} + s.draws[draw].indexCount ||
        (!first && piece.node <= s.pieces[i - 1].node))
      return fmt::format("piece {} is out of range", i);
    vertex += piece.vertexCount;
    for (const uint64_t end = index + piece.indexCount; index < end; ++index)
      if (const uint32_t at = s.indices[index]; at < piece.firstVertex || at >= vertex || !position(s.world[at]))
        return fmt::format("index {} of piece {} is out of range", at, i);
  }
  return vertex == vertices && index == s.indices.size() ? "" : "the pieces do not cover the triangles";
}

std::string ofMaterials(const Scene& s) {
  if (s.materials.empty()) return "no material";
  for (const Material& m : s.materials)
    if (const std::string problem = unsound(m, s.images.size()); !problem.empty()) return problem;
  for (const SceneImage& image : s.images)
    if (image.width == 0 || image.height == 0 || image.width > gltf::kMaxImageExtent ||
        image.height > gltf::kMaxImageExtent || image.rgba.size() != uint64_t{image.width} * image.height * 4)
      return fmt::format("image \"{}\" of {} x {} pixels has {} bytes", image.name, image.width, image.height,
                         image.rgba.size());
  return "";
}

std::string ofLights(const Scene& s) {
  for (const Light& light : s.lights)
    if (const std::string problem = unsound(light); !problem.empty()) return problem;
  return "";
}

std::string ofCameras(const Scene& s) {
  if (s.cameras.empty()) return "no camera";
  for (const Camera& c : s.cameras) {
    const bool lens = c.orthographic ? c.ymag > 0.0f && std::isfinite(c.ymag) : c.yfov > 0.0f && c.yfov < 3.1416f;
    if (!position(c.position, /*a fitted one stands beyond the bounds:*/ 10.0 * kMaxCoordinate) ||
        !unit(c.orientation) || !lens || !within(glm::vec3(c.aspect, c.znear, c.zfar), 0.0, 1e30))
      return fmt::format("camera \"{}\" is out of range", c.name);
  }
  return "";
}

}  // namespace

std::string unsound(const Material& m, size_t images) {
  const glm::vec4 factors(m.metallic, m.roughness, m.occlusionStrength, m.transmission);
  if (!within(m.baseColor, 0.0, 1.0)) return fmt::format("material \"{}\": its base colour is out of range", m.name);
  if (!within(factors, 0.0, 1.0) || !std::isfinite(m.normalScale) || !std::isfinite(m.alphaCutoff))
    return fmt::format("material \"{}\": a factor is out of range", m.name);
  for (int c = 0; c < 3; ++c)
    if (!brightness(m.emission[c])) return fmt::format("material \"{}\": emits {}", m.name, m.emission[c]);
  for (const TextureUse* use : texturesOf(m))
    if (use->image < -1 || use->image >= static_cast<int>(images) || use->uvSet > 1 || !finite(use->transform[0]) ||
        !finite(use->transform[1]) || !finite(use->transform[2]))
      return fmt::format("material \"{}\": a texture is out of range", m.name);
  return "";
}

std::string unsound(const Light& light) {
  const auto is = [&](const auto& what) { return fmt::format("light \"{}\": {}", light.name, what); };
  const auto list = [](const auto& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); };
  if (!isLightKind(light.type))
    return is(fmt::format("its type {} is no kind of light", static_cast<uint32_t>(light.type)));
  if (!position(light.position)) return is(fmt::format("its position {} is out of range", list(light.position)));
  if (!unit(light.direction)) return is(fmt::format("its direction {} is not unit", list(light.direction)));
  if (!within(light.color, 0.0, kMaxLightOrEmission))
    return is(fmt::format("its color {} is not from 0 to {:g}", list(light.color), kMaxLightOrEmission));
  if (!brightness(light.intensity))
    return is(fmt::format("its intensity {} is not from 0 to {:g}", light.intensity, kMaxLightOrEmission));
  if (!(light.range >= 0.0f) || !std::isfinite(light.range))
    return is(fmt::format("its range {} is neither 0 nor a distance", light.range));
  if (!(light.innerCos >= light.outerCos && light.outerCos >= -1.0f && light.innerCos <= 1.0f))
    return is(fmt::format("its cone's cosines are {} inside and {} outside", light.innerCos, light.outerCos));
  if (!(light.angle >= 0.0f && light.angle <= kMaxLightAngle))
    return is(fmt::format("its angle {} is not from 0 to {:g} degrees", light.angle, kMaxLightAngle));
  if (!(light.radius >= 0.0f && light.radius <= kMaxCoordinate))
    return is(fmt::format("its radius {} is not from 0 to {:g} m", light.radius, kMaxCoordinate));
  return "";
}

std::string unsound(const Scene& scene) {
  for (const auto check : {ofVertices, ofMaterials, ofDraws, ofNodes, ofLights, ofCameras})
    if (const std::string problem = check(scene); !problem.empty()) return problem;
  return "";
}

}  // namespace irad
