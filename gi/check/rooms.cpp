// Families of rooms by seed, each at N = 32, 64, 128 (or at the resolution that was asked for alone): sealed ones
// against 0, lit ones against the path tracer.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <span>

#include "gi/check/balance.h"
#include "gi/check/cases.h"
#include "gi/check/families.h"
#include "gi/check/path_tracer.h"
#include "gi/check/pictures.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "shaders/shared/surface.h"

namespace irad {
namespace {

constexpr glm::uvec2 kRoomPicture(64, 64);
constexpr uint32_t kJudged = 128;  ///< the resolution that lit families are judged at

/// A member of a family with its light.
struct Lit {
  const FamilyMember& member;
  Pipeline& pipeline;
  uint32_t resolution;
  std::string name;  ///< of its figures: "N 64, seed 1"
};

void judgeSealed(CheckRun& run, const Lit& lit) {
  const HostFacets facets = run.facets(lit.pipeline);
  const std::vector<glm::vec3> d = run.read(lit.pipeline, lit.pipeline.lighting().direct),
                               h = run.read(lit.pipeline, lit.pipeline.lighting().indirect);
  // A facet is inside where any of its surfels is: what stands for both sides of a wall is found, too. Planes have
  // none: a tenth of a voxel in front of one is its side.
  const auto isInside = [&](const glm::dvec3& p) {
    return std::ranges::any_of(lit.member.sealed, [&](const Room& room) { return room.contains(p); });
  };
  const auto hasInside = [&](size_t i) {
    const double edge = facets.grid.edge;
    if (facets.surfels.empty()) return isInside(facets.position[i] + facets.normal[i] * (0.1 * edge));
    const auto surfels = std::span(facets.surfels).subspan(FACET_SURFELS * i, FACET_SURFELS);
    return std::ranges::any_of(surfels,
                               [&](const glm::dvec3& p) { return isInside(p + facets.normal[i] * (1e-3 * edge)); });
  };
  double outside = 0, mostD = 0, mostH = 0;
  uint64_t reached = 0, inside = 0;
  for (size_t i = 0; i < facets.count(); ++i) {
    outside = std::max(outside, double{d[i].x});
    if (!hasInside(i)) continue;
    mostD = std::max(mostD, double{d[i].x});
    mostH = std::max(mostH, double{h[i].x});
    reached += h[i].x > 0;
    ++inside;
  }
  double pixel = 0;
  for (const Camera& camera : lit.member.scene.cameras)
    for (const glm::vec4& p : run.picture(lit.pipeline, camera, VIEW_LIT, kRoomPicture).pixels)
      pixel = std::max({pixel, double{p.x}, double{p.y}, double{p.z}});
  const auto judge = [&](const char* what, double value) {
    const double share = value / outside;
    lit.resolution >= 64 ? run.near(lit.name + what, share, 0, 0) : run.atMost(lit.name + what, share, 1e-7);
  };
  judge(": most H inside / most D outside", mostH);
  judge(": brightest pixel inside x pi / most D outside", pixel * std::numbers::pi);
  run.info(lit.name + ": most D inside / most D outside", mostD / outside);
  run.info(lit.name + ": share of the facets inside that light reaches",
           static_cast<double>(reached) / static_cast<double>(inside));
}

/// What emissive facets send out over what their triangles do, red channel; none where nothing emits. A facet's area is
/// its plane's inside the voxel, however little of that the lamp fills.
std::optional<double> emittedShare(const Scene& scene, const HostFacets& facets) {
  double truth = 0, ours = 0;
  for (const Draw& draw : scene.draws) {
    const Material& m = scene.materials[draw.material];
    const double exitance = std::numbers::pi * double{m.emission.x} * (m.doubleSided ? 2 : 1);
    for (uint32_t i = draw.firstIndex; exitance > 0 && i < draw.firstIndex + draw.indexCount; i += 3) {
      const glm::dvec3 a(scene.positions[scene.indices[i]]), b(scene.positions[scene.indices[i + 1]]),
          c(scene.positions[scene.indices[i + 2]]);
      truth += 0.5 * glm::length(glm::cross(b - a, c - a)) * exitance;
    }
  }
  for (size_t i = 0; i < facets.count(); ++i) ours += facets.area[i] * double{facets.emission[i].x};
  return truth > 0 ? std::optional(ours / truth) : std::nullopt;
}

void judgeLit(CheckRun& run, const Lit& lit) {
  const Scene& scene = lit.member.scene;
  const bool judged = lit.resolution >= kJudged;
  if (const auto share = emittedShare(scene, run.facets(lit.pipeline)))
    run.info(lit.name + ": emitted by facets / by triangles", *share);
  const auto tracer = makePathTracer(scene);
  const TraceOptions options{.samples = run.samples(judged ? 1024 : 256), .centred = true};
  for (size_t c = 0; c < scene.cameras.size(); ++c) {
    const Camera& camera = scene.cameras[c];
    const TracedPicture truth = tracer->render(camera, kRoomPicture, options);
    const std::string seen = fmt::format("{}, camera {}: ", lit.name, c);
    const TruthError all = compare(run.picture(lit.pipeline, camera, VIEW_LIT, kRoomPicture), truth.lit),
                     indirect = compare(run.picture(lit.pipeline, camera, VIEW_INDIRECT, kRoomPicture), truth.indirect);
    if (judged) {
      run.near(seen + "mean / truth", all.ratio, 1, 0.05);
      run.atMost(seen + "relMSE", all.relMse, 0.02);
    } else {
      run.info(seen + "mean / truth", all.ratio);
      run.info(seen + "relMSE", all.relMse);
    }
    run.info(seen + "indirect mean / truth", indirect.ratio);
    run.info(seen + "indirect relMSE", indirect.relMse);
    run.info(seen + "truth's standard error / mean", all.uncertainty);
  }
}

/// `lit`: with voxels where scene.region = auto puts them, against as many for the whole.
void judgeOutside(CheckRun& run, const Lit& lit) {
  const Scene& scene = lit.member.scene;
  Settings settings = lit.pipeline.settings();
  settings.scene.region.mode = RegionMode::whole;
  const auto whole = run.prepare(scene, settings);
  run.atMost(lit.name + ": voxel's edge, auto / whole", lit.pipeline.facets().grid.edge / whole->facets().grid.edge,
             0.75);
  const auto tracer = makePathTracer(scene);
  for (size_t c = 0; c < scene.cameras.size(); ++c) {
    const Camera& camera = scene.cameras[c];
    const TracedPicture truth = tracer->render(camera, kRoomPicture, {.samples = run.samples(512), .centred = true});
    const auto error = [&](Pipeline& of, View view) {
      return compare(run.picture(of, camera, view, kRoomPicture), view == VIEW_LIT ? truth.lit : truth.indirect);
    };
    for (const View view : {VIEW_LIT, VIEW_INDIRECT}) {
      const std::string seen = fmt::format("{}, camera {}, {}: ", lit.name, c, view == VIEW_LIT ? "lit" : "indirect");
      const TruthError ours = error(lit.pipeline, view), theirs = error(*whole, view);
      run.info(seen + "mean / truth, auto", ours.ratio);
      run.info(seen + "mean / truth, whole", theirs.ratio);
      run.info(seen + "relMSE, whole", theirs.relMse);
      run.atMost(seen + "relMSE, auto", ours.relMse, 1.02 * theirs.relMse);
    }
  }
}

void judgeFamily(CheckRun& run, const Family& family) {
  if (!family.dark && !hasPathTracer())
    throw WorkError("could not be judged: this build has no path tracer (IRAD_EMBREE)");
  std::vector<uint32_t> resolutions{32, 64, 128};
  if (run.options.quick) resolutions = {32, 128};
  Settings usual;
  applyCheckSizes(usual);
  if (run.settings.voxel.resolution != usual.voxel.resolution) resolutions = {run.settings.voxel.resolution};
  if (family.outside) resolutions = {run.options.quick ? 32u : 64u};
  const uint32_t seeds = run.options.seeds != 0 ? run.options.seeds : run.options.quick ? 1 : 3;
  for (const uint32_t resolution : resolutions)
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
      Settings settings = run.settings;
      settings.voxel.resolution = resolution;
      if (family.outside) settings.scene.region.mode = RegionMode::automatic;
      const FamilyMember member = familyMember(family, seed, resolution);
      const auto pipeline = run.prepare(member.scene, settings);
      const Lit lit{member, *pipeline, resolution, fmt::format("N {}, seed {}", resolution, seed)};
      (family.dark ? judgeSealed : family.outside ? judgeOutside : judgeLit)(run, lit);
      run.near(lit.name + ": (absorbed + escaped) / emitted", energyShares(run, *pipeline).accounted, 1, 0.02);
    }
}

template <size_t index>
void familyCase(CheckRun& run) {
  judgeFamily(run, families()[index]);
}

template <size_t... index>
std::vector<CheckCase> casesOf(std::index_sequence<index...>) {
  std::vector<CheckCase> cases;
  const auto add = [&](const Family& family, void (*work)(CheckRun&)) {
    cases.push_back({.name = family.name,
                     .setup = family.setup,
                     .oracle = family.dark ? "inside 0" : "a path tracer on the triangles",
                     .mark = family.outside ? "relMSE with scene.region = auto <= 1.02 x with whole; energy 2 %"
                             : family.dark  ? "0 at N >= 64, <= 1e-7 at 32; energy 2 %"
                                            : "N = 128: mean 5 %, relMSE .02; energy 2 %",
                     .run = work,
                     .family = &family});
  };
  (add(families()[index], familyCase<index>), ...);
  return cases;
}

}  // namespace

std::vector<CheckCase> roomCases() {
  constexpr size_t kFamilies = 10;
  IRAD_CHECK_OP(families().size(), ==, kFamilies);
  return casesOf(std::make_index_sequence<kFamilies>());
}

}  // namespace irad
