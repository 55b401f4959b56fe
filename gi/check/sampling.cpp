// What rays and lookups are made of: encoded normals, sampled directions, traversals, half-precision volumes. Run on
// the device, whose arithmetic is what counts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <random>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "renderer/base/angle.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/check.h"
#include "shaders/shared/normals.h"
#include "shaders/shared/sampling.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

constexpr const char* kStage = "Check";

/// Runs a kernel over `count` elements. `push` makes its push constants for the pass.
template <class Push>
void runOver(Context& context, const char* shader, uint32_t count, const Push& push) {
  Frame frame = context.begin();
  Pass pass = frame.pass(kStage);
  pass.shader(shader).push(push(pass)).dispatch(count);
  frame.submitAndWait();
}

// ---- encodings ----

std::vector<glm::vec4> roundTrip(Context& context, const std::vector<glm::vec4>& normals, NormalEncoding encoding) {
  const Buffer in = makeBuffer<glm::vec4>(context, "normals", Subsystem::Staging, normals);
  const Buffer out(context.device, "decoded normals", Subsystem::Staging, 16 * normals.size());
  const auto count = static_cast<uint32_t>(normals.size());
  runOver(context, "check/encode.comp", count, [&](Pass& pass) {
    return EncodePush{pass.in(in), pass.out(out), count, encoding};
  });
  return downloadAs<glm::vec4>(context, out);
}

/// The 26 lattice directions, axes first.
std::vector<glm::vec4> latticeDirections() {
  std::vector<glm::vec4> out;
  for (int length = 1; length <= 3; ++length)
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 d = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
      if (d.x * d.x + d.y * d.y + d.z * d.z == length) out.emplace_back(glm::normalize(glm::vec3(d)), 0.0f);
    }
  return out;
}

void encodingsCase(CheckRun& run) {
  struct Known {
    NormalEncoding encoding;
    const char* name;
    double most;         ///< degrees; docs/method.md 2 to half its last digit
    bool axes, corners;  ///< the lattice's axes are exact; all 26 are
  };
  constexpr size_t kLattice = 26, kAxes = 6;
  std::vector<glm::vec4> normals = latticeDirections();
  IRAD_CHECK_OP(normals.size(), ==, kLattice);
  std::mt19937 engine(7);
  std::normal_distribution<float> gauss;
  while (normals.size() < kLattice + 1'000'000)
    normals.emplace_back(glm::normalize(glm::vec3(gauss(engine), gauss(engine), gauss(engine))), 0.0f);
  for (const Known& known : {Known{NormalEncoding::axis6, "axis6", 54.75, true, false},
                             Known{NormalEncoding::axis26, "axis26", 27.65, true, true},
                             Known{NormalEncoding::oct8, "oct8", 15.85, false, false},
                             Known{NormalEncoding::oct16, "oct16", 1, true, false}}) {
    const std::vector<glm::vec4> back = roundTrip(run.context, normals, known.encoding);
    double most = 0, sum = 0;
    uint64_t axes = 0, corners = 0, bad = 0;
    for (size_t i = 0; i < normals.size(); ++i) {
      const double error = degreesBetween(normals[i], back[i]);
      bad += !std::isfinite(error);
      most = std::max(most, error);
      sum += error;
      if (i < kAxes) axes += back[i] != normals[i];
      if (i < kLattice) corners += error > 1e-4;
    }
    const std::string name = known.name;
    run.atMost(name + " largest error, degrees", most, known.most);
    run.info(name + " mean error, degrees", sum / static_cast<double>(normals.size()));
    run.none(name + " not finite", bad);
    if (known.axes) run.none(name + " axes not exact", axes);
    if (known.corners) run.none(name + " lattice directions off", corners);
  }
}

// ---- sampler ----

struct Samples {
  std::vector<glm::vec4> coordinates, directions;
};
Samples sample(Context& context, const std::vector<glm::uvec4>& points, const glm::vec3& normal) {
  const Buffer in = makeBuffer<glm::uvec4>(context, "points", Subsystem::Staging, points);
  const Buffer u(context.device, "coordinates", Subsystem::Staging, 16 * points.size());
  const Buffer d(context.device, "directions", Subsystem::Staging, 16 * points.size());
  const auto count = static_cast<uint32_t>(points.size());
  runOver(context, "check/sample.comp", count, [&](Pass& pass) {
    return SamplePush{pass.in(in), pass.out(u), pass.out(d), normal, count};
  });
  return {downloadAs<glm::vec4>(context, u), downloadAs<glm::vec4>(context, d)};
}

/// Point k of n under the shifts of `voxels` voxels.
std::vector<glm::uvec4> points(uint32_t voxels, uint32_t k, uint32_t n, uint32_t seed) {
  std::vector<glm::uvec4> out;
  for (uint32_t voxel = 0; voxel < voxels; ++voxel) {
    const glm::uvec4 shifts = rayShifts(voxel, seed, /*jitter=*/1);
    out.emplace_back(k, n, shifts.x, shifts.y);
  }
  return out;
}

/// E[d] = 2/3 n, with variances 1/4, 1/4 across and 1/2 - 4/9 along the normal: the largest error of the mean, in
/// sigma.
double meanDirectionError(Context& context, const glm::vec3& normal) {
  const std::vector<glm::uvec4> drawn = points(200'000, 5, 64, 7);
  const double n = static_cast<double>(drawn.size());
  glm::dvec3 mean(0);
  for (const glm::vec4& d : sample(context, drawn, normal).directions) mean += glm::dvec3(d) / n;
  const glm::dvec3 x(toWorld({1, 0, 0}, normal)), y(toWorld({0, 1, 0}, normal)), z(normal);
  const double across = std::sqrt(0.25 / n), along = std::sqrt(1 / 18.0 / n);
  return std::max({std::abs(glm::dot(mean, x)) / across, std::abs(glm::dot(mean, y)) / across,
                   std::abs(glm::dot(mean, z) - 2 / 3.0) / along});
}

/// chi^2 of a 64 x 64 partition of the square, 100 expected per cell.
double chiSquare(Context& context) {
  constexpr uint32_t side = 64, expected = 100;
  std::vector<uint32_t> cells(side * side);
  for (const glm::vec4& u : sample(context, points(side * side * expected, 0, 1, 1), {0, 0, 1}).coordinates)
    ++cells.at(static_cast<uint32_t>(u.x * side) * side + static_cast<uint32_t>(u.y * side));
  double sum = 0;
  for (const double c : cells) sum += (c - expected) * (c - expected) / expected;
  return sum;
}

void samplerCase(CheckRun& run) {
  for (const glm::vec3 n :
       {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::normalize(glm::vec3(1, -2, -3))})
    run.atMost(fmt::format("mean direction about ({:.2g}, {:.2g}, {:.2g}), sigma", n.x, n.y, n.z),
               meanDirectionError(run.context, n), 3);
  constexpr double freedom = 4095;
  run.near("chi^2", chiSquare(run.context), freedom, 3 * std::sqrt(2 * freedom));

  // Shifts that carry points to both ends of the interval.
  std::vector<glm::uvec4> extreme;
  for (const uint32_t shift : {0u, 1u, 255u, 256u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFF00u, 0xFFFFFFFFu})
    for (const uint32_t n : {1u, 2u, 3u, 128u, 384u, 4096u})
      for (uint32_t k = 0; k < n; ++k) extreme.emplace_back(k, n, shift, ~shift);
  const Samples ends = sample(run.context, extreme, {0, 0, -1});
  uint64_t outside = 0, bad = 0, below = 0;
  double least = 1, most = 0, longest = 0;
  for (size_t i = 0; i < extreme.size(); ++i) {
    for (const double u : {ends.coordinates[i].x, ends.coordinates[i].y}) {
      outside += !(u > 0 && u < 1);
      least = std::min(least, u);
      most = std::max(most, u);
    }
    const glm::dvec3 d(ends.directions[i]);
    bad += !std::isfinite(glm::length(d));
    below += !(d.z < 0);
    longest = std::max(longest, std::abs(glm::length(d) - 1));
  }
  run.none("coordinates not inside (0, 1)", outside);
  run.none("directions not finite", bad);
  run.none("directions not above the surface", below);
  run.info("least coordinate", least);
  run.info("1 - greatest coordinate", 1 - most);
  run.info("largest | |d| - 1 |", longest);
}

// ---- traversal ----

void traversalCase(CheckRun& run) {
  Scene scene = furnishedRoom();
  const SceneOnDevice device(run.context, scene);
  Settings settings = run.settings;
  const FacetList facets = makeFacets(run.context, device, settings);
  settings.field.method = FieldMethod::chebyshev;
  const Field chebyshev = buildField(run.context, facets, settings);
  settings.field.method = FieldMethod::jfa;
  const Field jfa = buildField(run.context, facets, settings);

  MatrixParams params = settings.matrix.gpu;
  params.rays = 1 + 1'000'000 / facets.count;
  const auto hits = [&](uint32_t method) {
    const RayKernel kernel{method, params.hitRule, facets.encoding, facets, method == TRACE_JFA ? jfa : chebyshev};
    const Buffer met(run.context.device, "hits", Subsystem::Matrix, 4ull * facets.count * params.rays);
    Frame frame = run.context.begin();
    traceRows(frame, kernel, params, 0, facets.count, met);
    frame.submitAndWait();
    return downloadAs<uint32_t>(run.context, met);
  };
  const std::vector<uint32_t> dda = hits(TRACE_DDA_REVERSE);
  const auto differing = [&dda](const std::vector<uint32_t>& other) {
    uint64_t n = 0;
    for (size_t i = 0; i < dda.size(); ++i) n += dda[i] != other[i];
    return n;
  };
  const auto share = [&dda](uint64_t n) { return 1 - static_cast<double>(n) / static_cast<double>(dda.size()); };
  run.info("rays", static_cast<double>(dda.size()));
  run.info("of them that meet a facet", static_cast<double>(std::count_if(
                                            dda.begin(), dda.end(), [](uint32_t f) { return f <= TRACE_LAST_FACET; })));
  // The reverse map and the field's zero bytes are the same set: not one ray may differ.
  run.none("dda by the field's bytes, rays that differ", differing(hits(TRACE_DDA_FIELD)));
  run.atLeast("chebyshev, share of equal hits", share(differing(hits(TRACE_SKIP))), 0.9999);
  run.info("jfa-unorm8, share of equal hits", share(differing(hits(TRACE_JFA))));
}

// ---- half ----

/// A corridor lit from one end, so that B falls along it.
Scene corridor() {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
  b.box({lamp, m, m, m, m, m}, {-2, -0.5f, -0.5f}, {2, 0.5f, 0.5f}, /*inward=*/true);
  return b.finish("corridor");
}

/// B as the volume's half floats hold it, against the fp32 that was written there.
void halfCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.matrix.gpu.hitRule = HitRule::thesis;  // whose shading samples the volume
  const auto pipeline = run.prepare(corridor(), settings);
  const FacetList& list = pipeline->facets();
  const auto reverse = downloadAs<uint32_t>(run.context, list.reverse);
  for (const float rho : {0.5f, 0.8f, 0.9f, 0.95f, 0.99f}) {
    run.setAlbedo(*pipeline, std::vector<glm::vec3>(list.count, glm::vec3(rho)));
    pipeline->prepare();
    const std::vector<glm::vec3> b = run.read(*pipeline, pipeline->lighting().radiosity);
    const std::vector<std::byte> texels = download(run.context, pipeline->lighting().volume.image);
    IRAD_CHECK_OP(texels.size(), ==, 8 * reverse.size());
    double worst = 0;
    for (size_t v = 0; v < reverse.size(); ++v) {
      if (reverse[v] == NO_FACET) continue;
      uint16_t red;
      std::memcpy(&red, &texels[8 * v], sizeof(red));
      const double fp32 = b[firstFacet(reverse[v])].x;
      worst = std::max(worst, std::abs(glm::unpackHalf1x16(red) - fp32) / fp32);
    }
    run.atMost(fmt::format("largest relative error of B at rho {}", rho), worst, 0.005);
    const Spread range = spread(b);
    run.info(fmt::format("least B at rho {}", rho), range.least);
    run.info(fmt::format("greatest B at rho {}", rho), range.most);
  }
  run.none("voxels clamped", pipeline->lighting().report.clampedVoxels);
}

}  // namespace

std::vector<CheckCase> samplingCases() {
  return {
      {"encodings", "26 lattice directions and 10^6 random normals", "themselves",
       "oct16 <= 1 degree, axes exact; others <= their known maxima", encodingsCase},
      {"sampler", "directions of 200,000 voxels; sets shifted to both ends", "E[d] = 2/3 n, chi^2, u inside (0, 1)",
       "3 sigma, no NaN", samplerCase},
      {"traversal", "10^6 rays in a furnished room, each method against DDA", "the same hit",
       ">= 99.99 % (jfa-unorm8: figure only)", traversalCase, furnishedRoom},
      {"half", "fp16 volume of a corridor lit from one end, rho = .5 .8 .9 .95 .99", "fp32", "<= .5 %", halfCase,
       corridor},
  };
}

}  // namespace irad
