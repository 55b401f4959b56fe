#include "app/facet_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "app/bench.h"
#include "app/device_session.h"
#include "app/interrupts.h"
#include "gi/check/frames_state.h"
#include "gi/lighting.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

/// Frames of so many rays; at least so many frames (their bias falls as frames^-3: docs/accuracy.md).
constexpr uint64_t kRaysOfAFrame = 128, kFewestFrames = 64;
constexpr uint32_t kSeeds[] = {2'000'001, 2'000'002};  ///< none of a point or of a truth of pictures

/// The settings with brute force in the place of whatever solver, rays and shortcuts they have; what says which facets
/// there are, what rays meet and how bright lights are stays.
Settings bruteForceOf(const Settings& settings, uint64_t rays) {
  const Settings usual;
  Settings out = settings;
  out.matrix.gpu.traversal = Traversal::dda;
  out.matrix.gpu.jitter = usual.matrix.gpu.jitter;
  out.matrix.emitterSampling = usual.matrix.emitterSampling;
  out.matrix.emitterSamples = usual.matrix.emitterSamples;
  const float lambda = settings.solver.gpu.lambda;
  out.solver = usual.solver;
  out.solver.gpu.lambda = lambda;
  out.solver.gpu.flush = 0;
  out.solver.method = SolverMethod::bruteForce;
  out.solver.tolerance = static_cast<float>(findSetting("solver.tolerance").range.min);
  // The mean over n frames has the variance of 5/9 n (docs/method.md 9).
  const uint64_t all = (rays * 9 + 4) / 5;
  out.matrix.gpu.rays = static_cast<uint32_t>(std::clamp<uint64_t>(all / kFewestFrames, 1, kRaysOfAFrame));
  out.solver.frames = static_cast<uint32_t>((all + out.matrix.gpu.rays - 1) / out.matrix.gpu.rays);
  return out;
}

/// All that H depends on but the seed and what the study's identity says.
std::string madeOf(const Settings& settings) {
  nlohmann::ordered_json made;
  for (const Setting& setting : settingTable())
    if (setting.redo <= Redo::Solve && std::string_view(setting.name) != "matrix.seed")
      made[setting.name] = setting.text(settings);
  return made.dump();
}

std::string fileNameOf(const std::string& made, const char* half) {
  const std::string hash = sha256({reinterpret_cast<const uint8_t*>(made.data()), made.size()});
  return fmt::format("{}.{}.state", hash.substr(0, 12), half);
}

}  // namespace

const FacetTruth& FacetTruths::of(const Settings& settings) {
  const Settings bruteForce = bruteForceOf(settings, rays_);
  const std::string made = madeOf(bruteForce);
  if (last_ && made_ == made) return *last_;
  last_.reset();
  FacetTruth truth{half(bruteForce, kSeeds[0], made, "a"), half(bruteForce, kSeeds[1], made, "b")};
  if (truth.first.size() != truth.second.size())
    throw InputError(fmt::format("{}: {} facets, {} has {}", (folder_ / fileNameOf(made, "a")).string(),
                                 truth.first.size(), fileNameOf(made, "b"), truth.second.size()));
  made_ = made;
  return last_.emplace(std::move(truth));
}

std::vector<glm::vec4> FacetTruths::half(Settings settings, uint32_t seed, const std::string& made, const char* name) {
  const fs::path file = folder_ / fileNameOf(made, name);
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    FramesState there = readFrames(file);
    if (there.made != made)
      throw InputError(fmt::format("{}: made of {} instead of {}", file.string(), there.made, made));
    return std::move(there.frames.indirect);
  }
  settings.matrix.gpu.seed = seed;
  const auto began = std::chrono::steady_clock::now();
  if (!light(settings)) return {};
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
  FramesState state{made, spent.count(), saveFrames(*session_.context, bench_.pipeline().lighting())};
  makeFolder(folder_);
  writeFrames(file, state);
  return std::move(state.frames.indirect);
}

bool FacetTruths::light(const Settings& settings) {
  Pipeline& pipeline = bench_.pipeline();
  pipeline.set(settings);
  bench_.prepare([&](const char*, float fraction) {
    throwIfStopped();
    return session_.progress("H of facets by brute force", fraction);
  });
  bench_.forget();
  for (const Finding& finding : pipeline.findings())
    if (finding.severity == Finding::Severity::Error) throw DeviceError(finding.text);
  return pipeline.lighting() && pipeline.lighting().report.frames > 0;
}

double FacetTruths::secondsMissing(const std::vector<Settings>& points) {
  constexpr uint32_t kTried = 4;  // frames, after as many that begin
  std::set<std::string> seen;
  double seconds = 0;
  for (const Settings& point : points) {
    Settings settings = bruteForceOf(point, rays_);
    const std::string made = madeOf(settings);
    if (!seen.insert(made).second) continue;
    std::error_code ignored;
    double halves = 0;
    for (const char* half : {"a", "b"}) halves += fs::exists(folder_ / fileNameOf(made, half), ignored) ? 0 : 1;
    if (halves == 0) continue;
    const double frames = halves * settings.solver.frames;
    try {
      settings.solver.frames = kTried;
      if (!light(settings)) continue;
      settings.solver.frames = 2 * kTried;
      const auto began = std::chrono::steady_clock::now();
      light(settings);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
      seconds += spent.count() / kTried * frames;
    } catch (const DeviceError&) {  // the point will have no truth of H, and say so
      session_.device->waitIdle();
      session_.timings.reset();
    }
  }
  return seconds;
}

}  // namespace irad::app
