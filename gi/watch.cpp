#include "gi/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/subsystems.h"
#include "renderer/base/number_text.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/energy.h"
#include "shaders/shared/grid.h"

namespace irad {
namespace {

constexpr std::array<const char*, 3> kWrong{"NaN", "infinite", "negative"};

/// Index in kWrong of the worst fault among these values.
std::optional<size_t> whatIsWrong(std::span<const float> values) {
  const auto any = [&](auto wrong) { return std::any_of(values.begin(), values.end(), wrong); };
  if (any([](float v) { return std::isnan(v); })) return 0;
  if (any([](float v) { return std::isinf(v); })) return 1;
  if (any([](float v) { return v < 0; })) return 2;
  return std::nullopt;
}

}  // namespace

std::optional<Defect> findDefect(Context& context, const FacetList& facets, const Lighting& light) {
  // In the order of the stages: what is bad in one spoils those after it.
  struct Product {
    const char *stage, *quantity;
    const Buffer& values;
    size_t stride, count;  ///< floats per facet; of those, to be looked at
  };
  const Product products[] = {
      {"GI CompactList", "emission", facets.emission, 3, 3},
      {"GI BuildMatrix", "row sum of form factors", light.rowSum, 1, 1},
      {"GI Gather", "direct irradiance", light.direct, 4, 3},
      {"GI Gather", "irradiance from the sky", light.sky, 4, 3},
      {"GI Writeback", "reflections written back", light.writeback.used, 4, 3},
      {"GI Solve Emitters", "irradiance from emitters", light.emitted, 4, 3},
      {"GI Solve", "indirect irradiance", light.indirect, 4, 3},
      {"GI Solve", "radiosity", light.radiosity, 4, 3},
  };
  for (const Product& p : products) {
    if ((&p.values == &light.sky || &p.values == &light.writeback.used) && !p.values) continue;
    if ((&p.values == &facets.emission || &p.values == &light.emitted) && !facets.hasEmission) continue;
    const auto values = downloadAs<float>(context, p.values);
    for (uint32_t i = 0; i < facets.count; ++i)
      if (const auto wrong = whatIsWrong(std::span(values).subspan(i * p.stride, p.count)))
        return Defect{p.stage, p.quantity, kWrong[*wrong], i,
                      unpackVoxel(downloadAs<uint32_t>(context, facets.voxel).at(i))};
  }
  return std::nullopt;
}

double EnergyBalance::imbalance() const {
  double worst = 0;
  for (int c = 0; c < 3; ++c) {
    const double share = entering[c] > 0 ? (absorbed[c] + escaped[c] - entering[c]) / entering[c] : 0;
    if (std::abs(share) > std::abs(worst)) worst = share;
  }
  return worst;
}

EnergyBalance balance(Context& context, const FacetList& facets, const Lighting& light) {
  const uint32_t invocations = (facets.count + ENERGY_FACETS - 1) / ENERGY_FACETS;
  const Buffer sums(context.device, "energy sums", Subsystem::Solver, sizeof(EnergySums) * uint64_t{invocations});
  EnergyBalance total;
  Frame frame = context.begin();
  Pass pass = frame.pass("GI Solve Energy");
  EnergyPush push{};
  push.facets = pass.in(facets.record);
  push.direct = pass.in(light.direct);
  push.indirect = pass.in(light.indirect);
  push.radiosity = pass.in(light.radiosity);
  push.area = pass.in(facets.area);
  push.rowSum = pass.inIfAny(light.rowSum);
  push.frames = pass.inIfAny(light.frameMean.standardError);
  push.sky = pass.inIfAny(light.sky);
  push.reflected = pass.inIfAny(light.writeback.used);
  push.sums = pass.out(sums);
  push.invocations = invocations;
  pass.shader("gi/energy.comp")
      .constant(CONSTANT_SKY, static_cast<bool>(light.sky))
      .constant(CONSTANT_REFLECTED, static_cast<bool>(light.writeback.used))
      .constant(CONSTANT_FRAMES, static_cast<bool>(light.frameMean.standardError))
      .push(push)
      .dispatch(invocations);
  frame.readback(sums, 0, sizeof(EnergySums) * uint64_t{invocations}, [&](std::span<const uint8_t> bytes) {
    for (size_t at = 0; at < bytes.size(); at += sizeof(EnergySums)) {
      EnergySums part;
      std::memcpy(&part, &bytes[at], sizeof(part));
      total.entering += glm::dvec3(part.entering);
      total.absorbed += glm::dvec3(part.absorbed);
      total.escaped += glm::dvec3(part.escaped);
    }
  });
  frame.submitAndWait();
  return total;
}

std::string describe(const EnergyBalance& energy, double edge) {
  const auto watts = [&](glm::dvec3 sum) { return (sum.x + sum.y + sum.z) * edge * edge; };
  return fmt::format("in {:.4g}, absorbed {:.4g}, escaped {:.4g} W, imbalance {:+.2f} %", watts(energy.entering),
                     watts(energy.absorbed), watts(energy.escaped), unsignedZero(100 * energy.imbalance(), 2));
}

std::vector<Finding> findings(const SolveReport& report, const Grid& grid, glm::dvec3 origin, uint64_t frame) {
  using enum Finding::Severity;
  std::vector<Finding> out;
  if (report.defect) {
    const Defect& d = *report.defect;
    const glm::dvec3 at = origin + double{grid.edge} * (glm::dvec3(d.voxel) + 0.5);
    out.push_back({Error, fmt::format("numerical watch: {}, frame {}: {} of facet {} (voxel {}, {}, {}; world {:.6g} "
                                      "{:.6g} {:.6g}) is {}; in B {} NaN, {} infinite, {} negative",
                                      d.stage, frame, d.quantity, d.facet, d.voxel.x, d.voxel.y, d.voxel.z, at.x, at.y,
                                      at.z, d.value, report.nan, report.nonFinite - report.nan, report.negative)});
  }
  if (report.diverging)
    out.push_back({Error, fmt::format("numerical watch: GI Solve, frame {}: diverging: the residual still grows by a "
                                      "factor of {:.3g} a sweep with omega damped to {:.3g}, largest row gain {:.3g}; "
                                      "stopped, the light from before is kept (lower solver.lambda)",
                                      frame, report.growth, report.omega, report.largestGain)});
  else if (report.damped)
    out.push_back(
        {Warning, fmt::format("GI Solve, frame {}: the residual grew for {} sweeps in a row, largest row gain "
                              "{:.3g}: damped to omega {:.3g}",
                              frame, DivergenceGuard::kPatience, report.largestGain, report.omega)});
  if (report.clampedVoxels > 0)
    out.push_back(
        {Warning, fmt::format("GI Scatter, frame {}: {} voxels hold more light than the volume's half floats: "
                              "clamped to 65504 W/m^2",
                              frame, report.clampedVoxels)});
  if (report.energy && !(std::abs(report.energy->imbalance()) <= kImbalance))
    out.push_back(
        {Warning, fmt::format("GI Solve, frame {}: absorbed and escaping light differ from the entering light "
                              "by {:+.2f} %",
                              frame, 100 * report.energy->imbalance())});
  return out;
}

std::string findBadPixels(std::span<const glm::vec4> linear, glm::uvec2 size, bool showsLight) {
  std::array<size_t, kWrong.size()> counts{};
  std::optional<size_t> first;
  for (size_t i = 0; i < linear.size(); ++i) {
    const auto wrong = whatIsWrong(std::span(&linear[i].x, 3));
    if (!wrong || (*wrong == 2 && !showsLight)) continue;
    ++counts[*wrong];
    if (!first) first = i;
  }
  if (!first) return {};
  return fmt::format("{} NaN, {} infinite, {} negative of {} pixels, the first at {}, {}", counts[0], counts[1],
                     counts[2], linear.size(), *first % size.x, *first / size.x);
}

}  // namespace irad
