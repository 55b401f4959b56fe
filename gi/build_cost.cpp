#include "gi/build_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/pipeline.h"
#include "renderer/base/number_text.h"

namespace irad {
namespace {

/// Exponents of N and R between the ends of the table in docs/performance.md (N 64 to 192 with 128 rays, 64 to 384 rays
/// with N = 128): voxelization and list 363 -> 1,943 ms; the field, N^3 by its definition; the matrix 2,269 -> 18,870
/// and 4,106 -> 21,871 ms; gather 15 -> 87 ms; a sweep 9.2 -> 103.9 and 17.7 -> 66.2 ms; scatter 29 -> 225 ms. What
/// materials give the facets grows as these do.
struct Growth {
  double resolution, rays;
};
constexpr std::array<Growth, BuildTimes::kParts> kGrowth{
    {{1.5, 0}, {3, 0}, {1.93, 0.93}, {2, 0}, {1.6, 0}, {2.2, 0.74}, {1.87, 0}}};
constexpr double kEntriesByRays = 0.93;

constexpr double resolutionOf(const Settings& s) {
  return s.voxel.resolution;
}
constexpr double raysOf(const Settings& s) {
  return s.matrix.gpu.rays;
}

double grown(size_t part, double resolution, double rays) {
  return std::pow(resolution, kGrowth[part].resolution) * std::pow(rays, kGrowth[part].rays);
}

/// Whether a part is redone where `first` is the first stage that is. A build from the voxels on shades its facets as
/// it makes them. Settings of materials are read by what gathers from emission, too.
bool redone(BuildTimes::Part part, Redo first) {
  switch (part) {
    case BuildTimes::Part::Voxels:
      return first <= Redo::Voxels;
    case BuildTimes::Part::Field:
      return first <= Redo::Field;
    case BuildTimes::Part::Matrix:
      return first <= Redo::Matrix;
    case BuildTimes::Part::Materials:
      return first == Redo::Materials;
    case BuildTimes::Part::Gather:
      return first <= Redo::Gather;
    case BuildTimes::Part::Solve:
      return first <= Redo::Solve;
    case BuildTimes::Part::Scatter:
      return first <= Redo::Scatter;
  }
  return false;
}

}  // namespace

std::string durationText(double ms) {
  return ms < 950 ? fmt::format("{:.0f} ms", ms) : fmt::format("{:.1f} s", 1e-3 * ms);
}

std::string costText(const BuildCost& cost) {
  return fmt::format("{}, {:.0f} MiB", durationText(cost.ms), inMebibytes(cost.bytes));
}

BuildTimes::Part BuildTimes::partOf(const char* stage) {
  const std::string_view name(stage);
  if (name == "GI Voxelization") return Part::Voxels;
  if (name == "GI SDF") return Part::Field;
  if (name == "GI BuildMatrix") return Part::Matrix;
  if (name == "GI Materials") return Part::Materials;
  if (name == "GI Gather") return Part::Gather;
  if (name == "GI Scatter") return Part::Scatter;
  return Part::Solve;
}

double BuildTimes::growth(Part part, const Settings& from, const Settings& to) {
  return grown(static_cast<size_t>(part), resolutionOf(to) / resolutionOf(from), raysOf(to) / raysOf(from));
}

void BuildTimes::took(Part part, double ms, const Settings& settings) {
  seen_[static_cast<size_t>(part)] = Seen{ms, resolutionOf(settings), raysOf(settings)};
}

std::optional<double> BuildTimes::predict(const Settings& wanted, Redo first) const {
  double sum = 0;
  bool any = false;
  for (size_t i = 0; i < kParts; ++i) {
    if (!redone(static_cast<Part>(i), first)) continue;
    if (!seen_[i]) return std::nullopt;
    sum += seen_[i]->ms * grown(i, resolutionOf(wanted) / seen_[i]->resolution, raysOf(wanted) / seen_[i]->rays);
    any = true;
  }
  return any ? std::optional(sum) : std::nullopt;
}

void BuildWatch::runs(std::optional<BuildTimes::Part> part, double ms, double pipelineWaitMs) {
  if (part_ == part) return;
  const double now = ms - pipelineWaitMs;
  if (part_) {
    std::optional<double>& sum = ms_[static_cast<size_t>(*part_)];
    sum = sum.value_or(0) + now - since_;
  }
  since_ = now;
  part_ = part;
}

void BuildWatch::tell(BuildTimes& times, const Settings& settings) const {
  for (size_t i = 0; i < ms_.size(); ++i)
    if (ms_[i]) times.took(static_cast<BuildTimes::Part>(i), *ms_[i], settings);
}

uint64_t predictedBytes(const Pipeline& pipeline, uint64_t used, const Settings& wanted, Redo first) {
  const FacetList& facets = pipeline.facets();
  const FormFactors& matrix = pipeline.matrix();
  const MemoryCounts now = memoryCounts(facets, matrix);
  const double n = resolutionOf(wanted) / resolutionOf(pipeline.settings());
  const double r = raysOf(wanted) / raysOf(pipeline.settings());
  const auto grown = [](uint64_t count, double factor) {
    return static_cast<uint64_t>(std::llround(static_cast<double>(count) * factor));
  };
  MemoryCounts then = now;
  if (first <= Redo::Voxels) {
    then.facets = grown(now.facets, n * n);
    then.voxels = grown(now.voxels, n * n * n);
  }
  if (first <= Redo::Matrix) {
    then.rows = grown(now.rows, n * n);
    then.rays = grown(now.rays, r);
    then.entries = grown(now.entries, n * n * std::pow(r, kEntriesByRays));
  }
  const auto sum = [&](const MemoryCounts& counts) {
    uint64_t bytes = 0;
    for (const auto& [name, size] : predictMemory(facets, pipeline.field(), matrix, pipeline.lighting(), counts))
      bytes += size;
    return bytes;
  };
  return used + sum(then) - std::min(sum(now), used + sum(then));
}

}  // namespace irad
