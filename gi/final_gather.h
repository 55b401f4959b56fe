// Irradiance at the very points that pixels see, by rays of the host from there to the facets: what looking H up
// between facets is held against. Hit rule `triangles`, builds with Embree.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace irad {

class Context;
struct Camera;
struct FacetList;
struct Sky;

/// What a pixel sees: a triangle of the scene, with the unit normal that it is shaded by.
struct SeenPoint {
  uint32_t triangle = 0;
  glm::vec3 normal{0};
};

struct GatherTask {
  glm::uvec2 size{0};
  std::span<const std::optional<SeenPoint>> seen;  ///< by pixel, top row first
  bool byFace = false;                             ///< about the triangle's own normal in the place of the shaded one
  std::span<const glm::dvec3> radiosity;           ///< per facet, W/m^2: what rays bring
  const Sky* sky = nullptr;                        ///< what those bring that escape
  uint32_t rays = 256;                             ///< per pixel, cosine-weighted
  uint32_t seed = 0;
  std::function<void()> watch;  ///< called now and then by the thread that called; what it throws ends the work
};
/// W/m^2 by pixel; none where nothing is seen, or where of no ray it is known what it meets. `origin`: Scene::origin.
/// The same on any number of threads, to the bit.
std::vector<std::optional<glm::dvec3>> gatherAtPixels(Context& context, const FacetList& facets, const Camera& camera,
                                                      const glm::dvec3& origin, const GatherTask& task);

}  // namespace irad
