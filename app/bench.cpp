#include "app/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "renderer/base/error.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/bench.h"

namespace irad::app {

Bench::Bench(Context& context, Scene scene, const Settings& settings, glm::uvec2 size, View view, const Camera& camera)
    : context_(context),
      pipeline_(context, std::move(scene), settings),
      targets_(context, size),
      view_(view),
      camera_(camera) {}

std::vector<StageSamples> Bench::samples() const {
  std::vector<StageSamples> out = stageSamples(frames_);
  for (size_t k = 0; k < kWorkKinds.size(); ++k) {
    StageSamples wall{static_cast<WorkKind>(k), "wall", {}};
    for (const FrameSample& call : frames_)
      if (call.kind == wall.kind) wall.ms.push_back(call.cpuMs);
    if (!wall.ms.empty()) out.push_back(std::move(wall));
  }
  return out;
}

void Bench::collect(WorkKind kind) {
  // One sample per stage and call: a stage that ran in several submissions counts once, with their sum.
  std::map<WorkKind, FrameSample> calls;
  for (const FrameSample& group : context_.timings.frames()) {
    // A rebuild ends with the relight that it makes necessary; the pipeline marks which is which.
    const WorkKind own = kind == WorkKind::Setup && group.kind != WorkKind::Setup ? WorkKind::Cold : kind;
    const auto [call, fresh] = calls.try_emplace(own, group);
    if (!fresh) call->second.add(group);
    call->second.kind = own;
  }
  for (auto& [own, call] : calls) {
    for (const auto& [stage, ms] : call.stages)
      if (stage == "GI Solve") {
        solveMs_ += ms;
        sweeps_ += pipeline_.lighting().report.sweeps;
      }
    frames_.push_back(std::move(call));
  }
  context_.timings.reset();
}

void Bench::prepare(const Progress& progress) {
  pipeline_.prepare(progress ? progress : watch_);
  collect(WorkKind::Setup);
}

void Bench::rebuild() {
  pipeline_.invalidate(Redo::Voxels);
  pipeline_.prepare(watch_);
  collect(WorkKind::Setup);
}

void Bench::relight() {
  // Up and down in turn, so that the solver always has equally far to go.
  const float factor = relights_++ % 2 == 0 ? 1.02f : 1.0f / 1.02f;
  for (GpuLight& light : pipeline_.device().lightValues) light.intensity *= factor;
  pipeline_.lightsChanged();
  pipeline_.prepare(watch_);
  collect(WorkKind::Relight);
}

void Bench::settle() {
  pipeline_.settleReflections(camera_, targets_, watch_);
  context_.timings.reset();
}

void Bench::cameraFrame() {
  draw();
  collect(WorkKind::Camera);
}

void Bench::draw() {
  const auto start = std::chrono::steady_clock::now();
  Frame frame = context_.begin(frame_);
  pipeline_.render(frame, camera_, view_, targets_);
  frame.submitAndWait();
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  context_.timings.endFrame(frame_++, /*setup=*/false, wall.count());
}

TickWork Bench::ticks(Moving moving, uint32_t count, bool redraws) {
  const Camera camera = camera_;
  const std::vector<Light> lights = pipeline_.scene().lights;
  const Scene& scene = pipeline_.scene();
  const double extent = glm::length(glm::dvec3(scene.boundsMax - scene.boundsMin));
  pipeline_.prepare();
  settle();
  draw();
  context_.finish();
  context_.timings.reset();
  const Counters before = context_.counters();
  for (uint32_t i = 0; i < count; ++i) {
    // Once around a small circle: another place in every tick.
    const double angle = 2 * std::numbers::pi * (i + 1) / count;
    const glm::dvec3 step = 0.005 * glm::dvec3(std::cos(angle), std::sin(angle), 0);
    if (moving == Moving::Camera) camera_.position = camera.position + glm::dquat(camera.orientation) * (extent * step);
    if (moving == Moving::Lights) {
      std::vector<Light> moved = lights;
      for (Light& light : moved) {
        light.position += extent * step;
        light.direction = glm::normalize(light.direction + glm::vec3(step));
      }
      pipeline_.setLights(std::move(moved));
    }
    bool changed = redraws || moving != Moving::Nothing;
    if (!pipeline_.asleep()) {
      pipeline_.prepare({}, pipeline_.settings().solver.sweepsPerFrame);
      changed = true;
    }
    if (changed) draw();
  }
  context_.finish();
  const Counters work = context_.counters().since(before);
  TickWork out{.dispatches = work.dispatches, .draws = work.draws};
  for (const FrameSample& group : context_.timings.frames()) out.gpuMs += group.gpuMs();
  context_.timings.reset();
  camera_ = camera;
  if (moving == Moving::Lights) pipeline_.setLights(lights);
  return out;
}

std::vector<glm::vec4> Bench::pictures(std::span<const View> views, const std::function<void()>& whileLit) {
  std::vector<glm::vec4> pixels;
  pipeline_.solvedAfresh(watch_, [&] {
    pipeline_.settleReflections(camera_, targets_, watch_);
    pixels = picturesAsLit(views);
    if (whileLit) whileLit();
  });
  context_.timings.reset();
  return pixels;
}

std::vector<glm::vec4> Bench::picturesAsLit(std::span<const View> views) {
  std::vector<glm::vec4> pixels;
  for (const View view : views) {
    Frame frame = context_.beginUntimed();
    pipeline_.render(frame, camera_, view, targets_);
    frame.submitAndWait();
    const std::vector<std::byte> bytes = download(context_, targets_.linear);
    const size_t before = pixels.size();
    pixels.resize(before + bytes.size() / sizeof(glm::vec4));
    std::memcpy(&pixels[before], bytes.data(), bytes.size());
  }
  return pixels;
}

void Bench::forget() {
  frames_.clear();
  solveMs_ = 0;
  sweeps_ = 0;
}

void Bench::warmUp(const Progress& progress, uint64_t pictures) {
  prepare(progress);
  relight();
  for (uint64_t i = 0; i < pictures; ++i) cameraFrame();
  forget();
}

double Bench::gpuMs(WorkKind kind) const {
  std::vector<double> ms;
  for (const FrameSample& call : frames_)
    if (call.kind == kind) ms.push_back(call.gpuMs());
  return statistics(ms).p50;
}

void measureInTurn(std::span<Bench* const> benches, uint64_t rebuilds, uint64_t frames, const Progress& progress) {
  const auto repeat = [&](const char* what, uint64_t times, void (Bench::*act)()) {
    for (uint64_t i = 0; i < times; ++i) {
      progress(what, static_cast<float>(i) / static_cast<float>(times));
      for (Bench* bench : benches) (bench->*act)();
    }
  };
  repeat("rebuilds", rebuilds, &Bench::rebuild);
  repeat("relights", frames, &Bench::relight);
  repeat("camera frames", frames, &Bench::cameraFrame);
}

double Bench::megaRaysPerSecond() const {
  double ms = 0;
  for (const StageSamples& s : samples())
    if (s.kind == WorkKind::Setup && s.stage.starts_with("GI BuildMatrix")) ms += statistics(s.ms).p50;
  return ms > 0 ? static_cast<double>(pipeline_.matrix().stats.rays) * 1e-3 / ms : 0;
}

uint64_t Bench::sweepBytes() const {
  const FormFactors& matrix = pipeline_.matrix();
  const uint64_t entry = matrix.format == MatrixFormat::csr ? 4 : 8, gathered = 16;
  const uint64_t row =
      (matrix.format == MatrixFormat::csr ? 4 : 0) + 8 + 8 + 16 + (pipeline_.facets().hasEmission ? 12 : 0) + 16 + 32;
  // A padded row holds one entry per hit, unmerged.
  const uint64_t entries = matrix.format == MatrixFormat::csr ? matrix.stats.entries : matrix.stats.hits;
  return entries * (entry + gathered) + matrix.rows * row;
}

double Bench::sweepGigabytesPerSecond() const {
  return sweepMilliseconds() > 0 ? static_cast<double>(sweepBytes()) * 1e-6 / sweepMilliseconds() : 0;
}

double copyBandwidth(Context& context) {
  // Far larger than any cache; as large as memory and the device's largest allocation allow.
  const Allocator& memory = context.device.memory();
  const uint64_t available = memory.budget() > memory.used() ? memory.budget() - memory.used() : 0;
  uint64_t bytes = context.device.isCpu ? uint64_t{256} << 20 : uint64_t{2} << 30;
  if (context.device.maxAllocation) bytes = std::min<uint64_t>(bytes, context.device.maxAllocation / 2);
  while (bytes > (1 << 20) && 2 * bytes > available / 2) bytes /= 2;
  bytes &= ~uint64_t{15};
  const Buffer from(context.device, "copy source", Subsystem::Staging, bytes);
  const Buffer to(context.device, "copy target", Subsystem::Staging, bytes);

  // The driver's copy and a kernel's in turn: either may take a slow path.
  std::vector<double> transfer, kernel;
  context.timings.reset();
  for (int i = 0; i < 6; ++i) {
    Frame frame = context.begin(0);
    if (i == 0) frame.pass("Fill").fill(from, 0x3F800000u);
    frame.pass("Transfer").copy(from, to, bytes);
    Pass pass = frame.pass("Kernel");
    const CopyPush push{pass.in(from), pass.out(to), static_cast<uint32_t>(bytes / sizeof(glm::uvec4)), 0};
    pass.shader("bench/copy.comp").push(push).dispatch(push.count);
    frame.submitAndWait();
    context.timings.endFrame(0, /*setup=*/true, 0);
    if (i == 0) continue;  // first touch of the pages
    for (const auto& [stage, ms] : context.timings.frames().back().stages) {
      if (stage == "Transfer") transfer.push_back(ms);
      if (stage == "Kernel") kernel.push_back(ms);
    }
  }
  context.timings.reset();
  const double ms = std::min(statistics(transfer).p50, statistics(kernel).p50);
  return ms > 0 ? 2.0 * static_cast<double>(bytes) * 1e-6 / ms : 0;
}

}  // namespace irad::app
