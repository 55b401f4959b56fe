// Jacobi (METHOD sections 1 and 6, T 5.8): H <- F B, then B <- lambda (M + rho (D + H)).
#include "shaders/shared/solve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "gi/ray_kernel.h"
#include "renderer/error.h"

namespace irad {
namespace {

constexpr const char* kStage = "GI Solve";
constexpr const char* kEmittersStage = "GI Solve Emitters";  ///< F M, the emitters' first gather
constexpr uint32_t kBatch = 16;                              ///< sweeps per submission at most; the last one is watched
constexpr float kDark = 1e-6f;     ///< share of the last lit H below which an unlit scene is put out
constexpr uint32_t kPatience = 3;  ///< growing batches in a row that count as divergence

SolverKernel chooseKernel(const Device& device, SolverKernel asked) {
  if (asked != SolverKernel::automatic) return asked;
  // lavapipe loads lane by lane: reductions across lanes only add to it. GPUs want consecutive entries per subgroup.
  return device.isCpu ? SolverKernel::row : SolverKernel::subgroup;
}

class Sweep {
 public:
  Sweep(Context& context, const FacetList& facets, const FormFactors& matrix, SolverKernel asked)
      : facets_(facets), matrix_(matrix), kernel_(chooseKernel(context.device, asked)) {
    const uint32_t height = (facets.count + SOLVE_IMAGE_WIDTH - 1) / SOLVE_IMAGE_WIDTH;
    images_ = context.device.isCpu && kernel_ == SolverKernel::row && matrix.format == MatrixFormat::csr &&
              height <= context.device.limits.maxImageDimension2D;
    if (!images_) return;
    ImageDesc desc;
    desc.name = "solver vector";
    desc.subsystem = Subsystem::Solver;
    desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.width = SOLVE_IMAGE_WIDTH;
    desc.height = height;
    for (Image& image : vectors_) image = Image(context.device, desc);
  }

  /// Before the first record(): `input` is what it will be called with. Later ones take their predecessor's output.
  void begin(Frame& frame, const char* stage, const Buffer& input) {
    if (!images_) return;
    frame.pass(stage)
        .shader("gi/solve_image.comp")
        .read(input)
        .write(vectors_[0])
        .push(SolveImagePush{input.address, facets_.count, 0})
        .dispatch(facets_.count);
    current_ = 0;
  }

  void record(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
              const Lighting& light) {
    push.input_ = input.address;
    push.output_ = output.address;
    Pass pass = frame.pass(stage);
    pass.constant(0, matrix_.format == MatrixFormat::csr ? SOLVE_CSR : SOLVE_PADDED)
        .constant(1, work)
        .read(matrix_.record, matrix_.rowStart, matrix_.rowInfo, facets_.record, facets_.albedo, facets_.emission,
              light.direct, input)
        .write(output)
        .push(push);
    for (const Buffer& segment : matrix_.segments) pass.read(segment);
    if (light.correction) pass.read(light.correction);
    if (work != SOLVE_PRODUCT) pass.write(light.indirect);
    if (work == SOLVE_WATCH) pass.write(light.residual);
    switch (kernel_) {
      case SolverKernel::row:
        if (images_) {
          pass.read(vectors_[current_]).write(vectors_[1 - current_]);
          pass.shader("gi/solve_row_image.comp").dispatch(matrix_.rows);
          current_ = 1 - current_;
        } else {
          pass.shader("gi/solve_row.comp").dispatch(matrix_.rows);
        }
        break;
      case SolverKernel::tree: {
        const uint32_t x = std::min(matrix_.rows, 32768u);
        pass.shader("gi/solve_tree.comp").dispatchGroups(x, (matrix_.rows + x - 1) / x);
        break;
      }
      default:
        pass.shader("gi/solve_subgroup.comp").dispatch(uint64_t{matrix_.rows} * frame.context().device.subgroupSize);
    }
  }

  SolvePush push{};

 private:
  const FacetList& facets_;
  const FormFactors& matrix_;
  SolverKernel kernel_;
  bool images_ = false;           ///< the vectors as images too, see gi/solve.glsl
  std::array<Image, 2> vectors_;  ///< input and output, in turn
  uint32_t current_ = 0;
};

/// How far B may still be from its fixed point, and H from F times that: q contraction, |dB| the last change.
void judge(SolveReport& report, const SolveResidual& r, const SolverParams& params, float tolerance) {
  report.residual = std::bit_cast<float>(r.maxDelta);
  report.largestH = std::bit_cast<float>(r.maxH);
  report.largestGain = std::bit_cast<float>(r.maxGain);
  report.nonFinite = r.nonFinite;
  report.negative = r.negative;
  const float q = (1 - params.omega) + params.omega * report.largestGain;
  const float reach = q < 1 ? report.residual / (1 - q) : std::numeric_limits<float>::infinity();
  report.bound = report.residual == 0 ? 0 : q * reach;
  // H is one product behind B: its error is bounded by |dB| / (1 - q), row sums being <= 1.
  report.converged = report.nonFinite == 0 && (report.residual == 0 || reach <= tolerance * report.largestH);
}

/// Whether the emitters are few enough to be low-probability, high-energy (T 5.6).
bool sampleEmitters(const Settings& settings, const EmitterSource& source, uint32_t facets) {
  if (!source.emitters || source.emitters->count == 0) return false;
  if (settings.matrix.emitterSampling != EmitterSampling::automatic)
    return settings.matrix.emitterSampling == EmitterSampling::on;
  return source.emitters->count < facets / 10;
}

/// Compares the sums over all facets of F M by samples and by rays, and says whether the samples may stand in. They see
/// emissive facets alone, rays also a face's extension into voxels that other faces took: where a lamp's edges are a
/// good part of it, as in a strip along a wall, that is too much to lose.
bool agrees(Context& context, const FormFactors& matrix, const Emitters& emitters, Lighting& light) {
  constexpr double kLoss = 0.05;
  const auto sampled = downloadAs<glm::vec4>(context, light.emitted);
  const auto correction = downloadAs<glm::vec4>(context, light.correction);
  double bySamples = 0, byRays = 0;
  for (size_t i = 0; i < sampled.size(); ++i) {
    bySamples += luminance(sampled[i]);
    byRays += luminance(sampled[i] - correction[i]);
  }
  const double hits = byRays / emitters.brightest * matrix.rays;  // at least
  light.sampledShare = byRays > 0 ? static_cast<float>(bySamples / byRays) : 0;
  return std::abs(bySamples - byRays) <= byRays * (kLoss + 3 / std::sqrt(std::max(hits, 1.0)));
}

/// light.emitted becomes F M by samples, light.correction what that adds to F M by rays.
void recordSamples(Frame& frame, const FacetList& facets, const FormFactors& matrix, const EmitterSource& source,
                   const Settings& settings, Lighting& light) {
  const RayKernel kernel = rayKernel(facets, *source.field, settings.matrix.gpu);
  light.correction = Buffer(frame.context().device, "emitters' correction", Subsystem::Solver, 16ull * facets.count);
  SampleEmittersPush push{};
  push.matrix = matrix.record.address;
  push.facets = facets.record.address;
  push.chebyshev = kernel.chebyshev();
  push.emitters = source.emitters->record.address;
  push.emitted = light.emitted.address;
  push.correction = light.correction.address;
  push.dims = facets.grid.dims;
  push.jfaMax = source.field->jfaMax;
  push.samples = settings.matrix.emitterSamples;
  push.seed = settings.matrix.gpu.seed;
  Pass pass = frame.pass(kEmittersStage);
  kernel.configure(pass, frame.context().device, "sample_emitters")
      .constant(3, matrix.format == MatrixFormat::csr ? SOLVE_CSR : SOLVE_PADDED)
      .read(facets.record, facets.emission, matrix.record, matrix.rowStart, matrix.rowInfo, source.emitters->record,
            source.emitters->entries);
  for (const Buffer& segment : matrix.segments) pass.read(segment);
  pass.write(light.emitted).write(light.correction).push(push).dispatch(facets.count);
}

}  // namespace

SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps, const EmitterSource& source) {
  IRAD_CHECK_OP(matrix.rows, ==, facets.count);
  SolveReport report;
  if (facets.count == 0) {
    report.converged = true;
    return light.report = report;
  }
  const SolverParams& params = settings.solver.gpu;
  Sweep sweep(context, facets, matrix, settings.solver.kernel);
  sweep.push.matrix = matrix.record.address;
  sweep.push.facets = facets.record.address;
  sweep.push.direct = light.direct.address;
  sweep.push.indirect = light.indirect.address;
  sweep.push.residual = light.residual.address;
  sweep.push.lambda = params.lambda;
  sweep.push.omega = params.omega;
  sweep.push.flush = params.flush;

  if (!light.emittedCurrent) {
    light.correction = Buffer();
    light.sampledShare = 0;
    const auto byRays = [&] {
      Frame frame = context.begin();
      if (facets.hasEmission) {
        // M as a vector, in the spare half of B's double buffer; then one product.
        frame.pass(kEmittersStage)
            .shader("gi/emission.comp")
            .read(facets.record, facets.emission)
            .write(light.radiosityNext)
            .push(EmissionPush{facets.record.address, light.radiosityNext.address})
            .dispatch(facets.count);
        sweep.begin(frame, kEmittersStage, light.radiosityNext);
        sweep.record(frame, kEmittersStage, SOLVE_PRODUCT, light.radiosityNext, light.emitted, light);
      } else {
        frame.pass(kEmittersStage).fill(light.emitted, 0);
      }
      frame.submit();
    };
    byRays();
    if (sampleEmitters(settings, source, facets.count)) {
      Frame frame = context.begin();
      recordSamples(frame, facets, matrix, source, settings, light);
      frame.submitAndWait();
      const bool forced = settings.matrix.emitterSampling == EmitterSampling::on;
      if (!agrees(context, matrix, *source.emitters, light) && !forced) {
        light.correction = Buffer();
        byRays();
      }
    }
    light.emittedCurrent = true;
  }
  sweep.push.correction = light.correction.address;
  sweep.push.corrected = light.correction ? 1 : 0;

  // A CPU device sweeps slowly: short submissions. The first is short too, a warm start is often at its goal.
  const uint32_t longest = context.device.isCpu ? 4 : kBatch;
  uint32_t batch = std::min(2u, longest), growing = 0;
  float previous = std::numeric_limits<float>::infinity();
  while (report.sweeps < maxSweeps && !report.converged && report.nonFinite == 0 && !report.diverging) {
    const uint32_t count = std::min(batch, maxSweeps - report.sweeps);
    Frame frame = context.begin();
    frame.pass(kStage).fill(light.residual, 0);
    if (report.sweeps == 0) sweep.begin(frame, kStage, light.radiosity);
    for (uint32_t i = 0; i < count; ++i) {
      sweep.record(frame, kStage, i + 1 == count ? SOLVE_WATCH : SOLVE_SWEEP, light.radiosity, light.radiosityNext,
                   light);
      std::swap(light.radiosity, light.radiosityNext);
    }
    SolveResidual residual{};
    frame.readback(light.residual, 0, sizeof(residual),
                   [&](std::span<const uint8_t> b) { std::memcpy(&residual, b.data(), b.size()); });
    frame.submitAndWait();
    report.sweeps += count;
    judge(report, residual, params, settings.solver.tolerance);
    batch = longest;

    if (residual.maxSource != 0) {
      light.litH = report.largestH;
      sweep.push.flush = params.flush;
    } else {
      // Lights off: light decays by rho per sweep, and ends in exact zero once it is below what fp32 kept of it.
      light.litH = std::max(light.litH, report.largestH);
      sweep.push.flush = std::max(params.flush, kDark * light.litH);
    }
    const float q = (1 - params.omega) + params.omega * report.largestGain;
    growing = q >= 1 && report.residual > previous ? growing + 1 : 0;
    report.diverging = growing >= kPatience;
    previous = report.residual;
  }
  return light.report = report;
}

}  // namespace irad
