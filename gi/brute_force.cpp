#include "gi/brute_force.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "gi/acceleration.h"
#include "gi/facets.h"
#include "gi/hits_on_host.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix_build.h"
#include "gi/ray_kernel.h"
#include "gi/settings.h"
#include "gi/sky.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/transfer.h"
#include "shaders/shared/brute_force.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/sampling.h"

namespace irad {
namespace {

constexpr const char* kBruteForceStage = "GI BruteForce";
/// Frames before the standard error may end it: fewer say too little of their spread.
constexpr uint32_t kFewestFrames = 16;

/// What a frame's passes have in common.
class FrameTracer {
 public:
  FrameTracer(Context& context, const FacetList& facets, const Field& field, const SkyOnDevice& sky, Lighting& light,
              const Settings& settings)
      : context_(context),
        facets_(facets),
        sky_(sky),
        light_(light),
        settings_(settings),
        kernel_(rayKernel(facets, field, settings.matrix.gpu)) {
    if (facets.surface.tinted) kernel_.tintShift = TINT_SHIFT_FRAMES;
    const Device& device = context.device;
    FrameMean& mean = light.frameMean;
    const uint64_t rays = settings.matrix.gpu.rays;
    chunk_ = static_cast<uint32_t>(std::clamp<uint64_t>(raysPerSubmission(device) / rays, 1, facets.count));
    const uint64_t bytes = 4 * chunk_ * rays;
    if (mean.hits.bytes != bytes)
      mean.hits = Buffer(device, "brute force: hits of some facets", Subsystem::Solver, bytes,
                         device.isCpu ? Access::Readback : Access::Device);
    host_ = hostTraceIfAny(context, facets, settings.matrix.gpu, kBruteForceStage);
  }

  /// D, and B for the rays of the first frame.
  void start() {
    Frame frame = context_.begin();
    for (uint32_t first = 0; first < facets_.count; first += chunk_) record(frame, first, /*rays=*/0);
    frame.submit();
    std::swap(light_.radiosityNext, light_.frameMean.next);
  }

  /// The next frame; what it reduces, and the means by area of H and of its standard error.
  struct Reduced {
    SolveResidual residual;
    double meanH = 0, meanError = 0;
  };
  Reduced next() {
    FrameMean& mean = light_.frameMean;
    const MatrixParams params = raysOfFrame(settings_.matrix.gpu, mean.weights.frames());
    const float errorBefore = mean.weights.errorOfVariance();
    toVariance_ = errorBefore > 0 ? 1 / errorBefore : 0;
    FrameWeights weights = mean.weights;
    weights.add();
    share_ = weights.share();
    toError_ = weights.errorOfVariance();
    mean.weights = {};  // should this frame fail, what it leaves is no mean

    for (uint32_t first = 0; first < facets_.count; first += chunk_) {
      const uint32_t rows = std::min(chunk_, facets_.count - first);
      if (context_.device.isCpu)
        traceMapped(context_, kernel_, host_, params, first, rows, mean.hits, sky(), kBruteForceStage);
      Frame frame = context_.begin();
      if (first == 0) frame.pass(kBruteForceStage).fill(light_.residual, 0);
      if (!context_.device.isCpu) traceRows(frame, kernel_, params, first, rows, mean.hits, sky(), kBruteForceStage);
      record(frame, first, params.rays);
      if (context_.device.isCpu)
        frame.submitAndWait();  // before the host writes the next hits
      else
        frame.submit();
    }
    std::swap(light_.radiosityNext, mean.next);
    Reduced out;
    Frame frame = context_.begin();
    frame.readback(light_.residual, 0, sizeof(out.residual),
                   [&](std::span<const uint8_t> b) { std::memcpy(&out.residual, b.data(), b.size()); });
    recordMean(frame, kBruteForceStage, facets_, light_.indirect, light_.sums, out.meanH);
    recordMean(frame, kBruteForceStage, facets_, mean.standardError, light_.sums, out.meanError);
    frame.submitAndWait();
    mean.weights = weights;
    return out;
  }

 private:
  bool sky() const { return static_cast<bool>(binsOf(facets_.outer, sky_)); }

  void record(Frame& frame, uint32_t first, uint32_t rays) {
    const FrameMean& mean = light_.frameMean;
    const SolverParams& solver = settings_.solver.gpu;
    Pass pass = frame.pass(kBruteForceStage);
    BruteForcePush push{};
    push.facets = pass.in(facets_.record);
    push.hits = pass.in(mean.hits);
    push.bins = pass.inIfAny(binsOf(facets_.outer, sky_));
    push.direct = pass.in(light_.direct);
    push.from = pass.in(light_.radiosityNext);
    push.to = pass.out(mean.next);
    push.indirect = pass.out(light_.indirect);
    push.emitted = pass.outIfAny(light_.emitted);
    push.radiosity = pass.out(light_.radiosity);
    push.standardError = pass.out(mean.standardError);
    push.residual = pass.out(light_.residual);
    push.firstFacet = first;
    push.count = std::min(chunk_, facets_.count - first);
    push.rays = rays;
    push.lambda = solver.lambda;
    push.omega = light_.guard.omega;
    push.flush = solver.flush;
    push.share = share_;
    push.toVariance = toVariance_;
    push.toError = toError_;
    pass.shader("gi/brute_force.comp")
        .constant(CONSTANT_SKY, sky())
        .constant(CONSTANT_EMITTED, static_cast<bool>(light_.emitted))
        .constant(CONSTANT_TINTED, facets_.surface.tinted)
        .push(push)
        .dispatch(uint64_t{push.count} * context_.device.subgroupSize);
  }

  Context& context_;
  const FacetList& facets_;
  const SkyOnDevice& sky_;
  Lighting& light_;
  const Settings& settings_;
  RayKernel kernel_;
  const HostTrace* host_ = nullptr;  ///< what traces rays on CPU devices, or null
  uint32_t chunk_ = 1;               ///< facets whose rays are traced together
  float share_ = 1, toVariance_ = 0, toError_ = 0;
};

}  // namespace

MatrixParams raysOfFrame(const MatrixParams& params, uint32_t frame) {
  MatrixParams rays = params;
  if (frame == 0) return rays;
  rays.seed = hashUint(hashUint(frame) ^ params.seed);
  rays.jitter = 1;
  return rays;
}

void FrameWeights::add() {
  ++frames_;
  last_ = static_cast<double>(frames_) * frames_;
  sum_ += last_;
  squares_ += last_ * last_;
}

float FrameWeights::errorOfVariance() const {
  if (frames_ < 2) return 0;
  const double q = squares_ / (sum_ * sum_);
  return static_cast<float>(q / (1 - q));
}

SavedFrames saveFrames(Context& context, const Lighting& light) {
  const auto of = [&](const Buffer& buffer) {
    return buffer ? downloadAs<glm::vec4>(context, buffer) : std::vector<glm::vec4>();
  };
  return {.frames = light.frameMean.weights.frames(),
          .meanH = light.frameMean.meanH,
          .standardError = light.report.standardError,
          .largestH = light.report.largestH,
          .next = of(light.radiosityNext),
          .radiosity = of(light.radiosity),
          .indirect = of(light.indirect),
          .error = of(light.frameMean.standardError),
          .emitted = of(light.emitted)};
}

void restoreFrames(Context& context, Lighting& light, const SavedFrames& saved) {
  IRAD_CHECK(light.guard.lambda <= 1 && light.frameMean.weights.frames() > 0, "no light to go on with");
  const auto put = [&](const Buffer& buffer, const std::vector<glm::vec4>& values) {
    IRAD_CHECK_OP(values.size() * sizeof(glm::vec4), ==, buffer ? buffer.bytes : 0);
    if (buffer) upload(context, buffer, std::as_bytes(std::span(values)));
  };
  put(light.radiosityNext, saved.next);
  put(light.radiosity, saved.radiosity);
  put(light.indirect, saved.indirect);
  put(light.frameMean.standardError, saved.error);
  put(light.emitted, saved.emitted);
  FrameMean& mean = light.frameMean;
  mean.weights = {};
  for (uint32_t k = 0; k < saved.frames; ++k) mean.weights.add();
  mean.meanH = saved.meanH;
  SolveReport& report = light.report;
  report.frames = saved.frames;
  report.meanH = static_cast<float>(saved.meanH);
  report.standardError = saved.standardError;
  report.largestH = saved.largestH;
  report.converged = report.atMostFrames = false;
  if (!report.dark) light.litH = report.largestH;
}

SolveReport bruteForce(Context& context, const FacetList& facets, const Field& field, const SkyOnDevice& sky,
                       Lighting& light, const Settings& settings, uint32_t frames, bool restarts,
                       const std::function<bool(float)>& progress) {
  SolveReport report;
  if (facets.count == 0) {
    report.converged = true;
    return light.report = report;
  }
  const SolverSettings& solver = settings.solver;
  FrameMean& mean = light.frameMean;
  const SolverParams& params = solver.gpu;
  FrameTracer tracer(context, facets, field, sky, light, settings);
  const float litBefore = light.litH;
  if (restarts || light.report.nonFinite > 0 || mean.weights.frames() == 0 || mean.weights.frames() > solver.frames ||
      light.guard.lambda != params.lambda || light.guard.asked != params.omega) {
    beginSolve(context, facets, light, params);
    mean.weights = {};
    light.gain = {params.lambda, params.lambda};
    mean.meanH = 0;
    tracer.start();
  } else {
    report = light.report;
    report.sweeps = 0;
    report.converged = report.atMostFrames = false;
    report.energy.reset();
  }
  const auto judge = [&] {
    report.frames = mean.weights.frames();
    report.allowed = solver.tolerance * report.meanH;
    report.converged = report.dark || (report.nonFinite == 0 && report.frames >= kFewestFrames &&
                                       report.standardError <= report.allowed);
    report.atMostFrames = report.frames >= solver.frames;
  };
  if (mean.weights.frames() > 0) judge();
  while (frames > 0 && !report.settled()) {
    --frames;
    if (progress && !progress(static_cast<float>(mean.weights.frames()) / static_cast<float>(solver.frames)))
      throw WorkError("cancelled");
    const FrameTracer::Reduced r = tracer.next();
    ++report.sweeps;
    // The mean over the facets hardly knows the noise of single ones.
    watchSolve(report, r.residual, static_cast<float>(std::abs(r.meanH - mean.meanH)), light.guard);
    report.omega = light.guard.omega;
    report.dark = r.residual.maxSource == 0 && !sky && !facets.outer;
    mean.meanH = r.meanH;
    report.meanH = static_cast<float>(r.meanH);
    report.standardError = static_cast<float>(r.meanError);
    if (!report.dark) light.litH = report.largestH;
    judge();
    light.report = report;
  }
  endSolve(context, facets, light, report, litBefore);
  if (report.diverging) mean.weights = {};
  if (report.settled()) mean.hits = Buffer();
  // What a sky brings is in H and nowhere by itself.
  if (report.converged && params.lambda == 1 && !sky && !facets.outer && !facets.surface.tinted)
    report.energy = balance(context, facets, light);
  return light.report = report;
}

}  // namespace irad
