#include "renderer/scene/nearest_triangle.h"

#include <algorithm>
#include <array>
#include <limits>

#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace irad {
namespace {

double squaredLength(const glm::dvec3& v) {
  return glm::dot(v, v);
}

/// Of a point to the segment from a to b.
double squaredToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length = squaredLength(along);
  const double share = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0.0;
  return squaredLength(p - (a + along * share));
}

/// Of a point to a triangle with this normal, of any length.
double squaredToTriangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& corner, const glm::dvec3& normal) {
  bool inside = true;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &from = corner[i], &to = corner[(i + 1) % 3];
    inside = inside && glm::dot(glm::cross(to - from, p - from), normal) >= 0;
  }
  if (inside) {
    const double above = glm::dot(p - corner[0], normal);
    return above * above / squaredLength(normal);
  }
  return std::min({squaredToSegment(p, corner[0], corner[1]), squaredToSegment(p, corner[1], corner[2]),
                   squaredToSegment(p, corner[2], corner[0])});
}

}  // namespace

TriangleFinder::TriangleFinder(const Scene& scene) {
  constexpr uint32_t kBlock = 3 * 64;  // indices; neighbours in a file are mostly neighbours in space
  for (const Draw& draw : scene.draws) {
    const uint32_t end = draw.firstIndex + draw.indexCount;
    for (uint32_t first = draw.firstIndex; first < end; first += kBlock) {
      Block block{glm::vec3(std::numeric_limits<float>::infinity()), glm::vec3(-std::numeric_limits<float>::infinity()),
                  first, std::min(first + kBlock, end), draw.material};
      for (uint32_t i = first; i < block.endIndex; ++i) {
        const glm::vec3 at = scene.positions[scene.indices[i]];
        block.low = glm::min(block.low, at);
        block.high = glm::max(block.high, at);
      }
      blocks_.push_back(block);
    }
  }
}

std::optional<uint32_t> TriangleFinder::nearest(const Scene& scene, const glm::dvec3& point,
                                                const glm::dvec3& normal) const {
  const glm::dvec3 local = point - scene.origin;
  std::optional<uint32_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto away = [&](const Block& block) {
    return squaredLength(local - glm::clamp(local, glm::dvec3(block.low), glm::dvec3(block.high)));
  };
  const auto look = [&](const Block& block) {
    const bool bothSides = scene.materials.at(block.material).doubleSided;
    for (uint32_t index = block.firstIndex; index < block.endIndex; index += 3) {
      std::array<glm::dvec3, 3> corner;
      for (uint32_t i = 0; i < 3; ++i) corner[i] = glm::dvec3(scene.positions[scene.indices[index + i]]);
      const glm::dvec3 facing = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
      if (!(squaredLength(facing) > 0) || (!bothSides && glm::dot(facing, normal) <= 0)) continue;
      const double distance = squaredToTriangle(local, corner, facing);
      // Of several at the same distance the first one of the scene.
      if (!(distance < least || (distance == least && nearest && index / 3 < *nearest))) continue;
      least = distance;
      nearest = index / 3;
    }
  };
  // The blocks that the point is in tell how near is near; then whatever may be nearer.
  for (const Block& block : blocks_)
    if (away(block) == 0) look(block);
  for (const Block& block : blocks_)
    if (const double distance = away(block); distance > 0 && distance <= least) look(block);
  return nearest;
}

std::optional<uint32_t> nearestTriangle(const Scene& scene, const glm::dvec3& point, const glm::dvec3& normal) {
  return TriangleFinder(scene).nearest(scene, point, normal);
}

uint32_t materialOf(const Scene& scene, uint32_t triangle) {
  for (const Draw& draw : scene.draws)
    if (3 * triangle >= draw.firstIndex && 3 * triangle < draw.firstIndex + draw.indexCount) return draw.material;
  IRAD_CHECK(false, "triangle {} is in no draw", triangle);
  return 0;
}

}  // namespace irad
