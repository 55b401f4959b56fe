// The truth of H that studies hold facets against: brute force on the facets of each point, twice, with independent
// rays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gi/settings.h"

namespace irad::app {

class Bench;
struct DeviceSession;

/// Rays per facet, of each of the two: fewer have too few frames for the first ones to be forgotten, more too many.
constexpr uint64_t kFewestFacetRays = 1000, kMostFacetRays = 7'000'000;

/// H per facet in matrix order, W/m^2, from two independent sets of rays.
struct FacetTruth {
  std::vector<glm::vec4> first, second;
};

class FacetTruths {
 public:
  /// `folder`: where they are kept, so that a study that goes on reads them. `rays`: per facet, that count.
  FacetTruths(DeviceSession& session, Bench& bench, std::filesystem::path folder, uint64_t rays)
      : session_(session), bench_(bench), folder_(std::move(folder)), rays_(rays) {}
  /// Of the facets and lights of these settings, whatever their solver; made where there is none yet, with the bench's
  /// pipeline, which then has other settings. DeviceError where the device has no memory for it.
  const FacetTruth& of(const Settings& settings);
  /// What those take that these settings lack, by a trial of few frames each.
  double secondsMissing(const std::vector<Settings>& points);

 private:
  /// Light by brute force; false: there is none, or no facets.
  bool light(const Settings& settings);
  std::vector<glm::vec4> half(Settings settings, uint32_t seed, const std::string& made, const char* name);
  DeviceSession& session_;
  Bench& bench_;
  std::filesystem::path folder_;
  uint64_t rays_;
  std::string made_;  ///< what last_ is of
  std::optional<FacetTruth> last_;
};

}  // namespace irad::app
