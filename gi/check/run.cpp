#include "gi/check/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "gi/facets.h"
#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {
namespace {

/// Deviation over what is allowed; a tolerance of 0 allows none.
double strainOf(double deviation, double allowed) {
  if (std::isnan(deviation)) return std::numeric_limits<double>::infinity();
  if (deviation <= 0) return 0;
  return allowed > 0 ? deviation / allowed : std::numeric_limits<double>::infinity();
}

uint64_t nonFinite(float x) {
  return std::isfinite(x) ? 0 : 1;
}

}  // namespace

Settings CheckRun::small() const {
  Settings s = settings;
  s.voxel.resolution = 24;
  s.matrix.gpu.rays = 64;
  s.light.shadowResolution = 256;
  return s;
}

DeviceOptions CheckRun::sameDevice() const {
  DeviceOptions same;
  same.select = std::to_string(context.device.info.index);
  same.validate = context.device.options.validate;
  return same;
}

void CheckRun::near(std::string name, double value, double expected, double tolerance) {
  std::string mark = fmt::format("{:.6g}", expected);
  if (tolerance > 0) mark += fmt::format(" +- {:.3g}", tolerance);
  figures.push_back({std::move(name), value, std::move(mark), strainOf(std::abs(value - expected), tolerance)});
}

void CheckRun::atMost(std::string name, double value, double limit) {
  figures.push_back({std::move(name), value, fmt::format("<= {:.7g}", limit), strainOf(value, limit)});
}

void CheckRun::atLeast(std::string name, double value, double limit, double ideal) {
  figures.push_back({std::move(name), value, fmt::format(">= {:.6g}", limit), strainOf(ideal - value, ideal - limit)});
}

void CheckRun::none(std::string name, uint64_t differing) {
  figures.push_back(
      {std::move(name), static_cast<double>(differing), "0", strainOf(static_cast<double>(differing), 0)});
}

void CheckRun::info(std::string name, double value) {
  figures.push_back({std::move(name), value, "", 0});
}

std::unique_ptr<Pipeline> CheckRun::prepare(Scene scene, const Settings& chosen) const {
  // Cases read matrix and light, and put in light of their own: both are built whatever the scene holds.
  Settings whole = chosen;
  whole.effects.matrix = whole.effects.field = EffectMode::on;
  auto pipeline = std::make_unique<Pipeline>(context, std::move(scene), whole);
  pipeline->prepare();
  return pipeline;
}

std::vector<glm::vec3> CheckRun::read(const Pipeline& pipeline, const Buffer& perFacet) const {
  return irad::perFacet(context, pipeline.facets(), perFacet);
}

void CheckRun::setAlbedo(Pipeline& pipeline, const std::vector<glm::vec3>& albedo) const {
  IRAD_CHECK_OP(albedo.size(), ==, pipeline.facets().count);
  std::vector<glm::uvec2> packed;
  for (const glm::vec3& a : albedo) packed.push_back(packAlbedo(a));
  upload(context, pipeline.facets().albedo, std::as_bytes(std::span(packed)));
  pipeline.invalidate(Redo::Solve);
}

void CheckRun::setDirect(Pipeline& pipeline, const std::vector<glm::vec3>& direct) const {
  IRAD_CHECK_OP(direct.size(), ==, pipeline.facets().count);
  std::vector<glm::vec4> padded;
  for (const glm::vec3& d : direct) padded.emplace_back(d, 0.0f);
  upload(context, pipeline.lighting().direct, std::as_bytes(std::span(padded)));
  pipeline.invalidate(Redo::Solve);
}

CheckPicture CheckRun::picture(Pipeline& pipeline, const Camera& camera, View view, glm::uvec2 size) const {
  Targets targets(context, size);
  Frame frame = context.begin();
  pipeline.render(frame, camera, view, targets);
  frame.submitAndWait();
  const std::vector<std::byte> bytes = download(context, targets.linear);
  CheckPicture out{size, std::vector<glm::vec4>(size_t{size.x} * size.y)};
  IRAD_CHECK_OP(bytes.size(), ==, out.pixels.size() * sizeof(glm::vec4));
  std::memcpy(out.pixels.data(), bytes.data(), bytes.size());
  return out;
}

uint64_t countNonFinite(const std::vector<glm::vec3>& values) {
  uint64_t n = 0;
  for (const glm::vec3& v : values) n += nonFinite(v.x) + nonFinite(v.y) + nonFinite(v.z);
  return n;
}

uint64_t countNonFinite(const CheckPicture& picture) {
  uint64_t n = 0;
  for (const glm::vec4& p : picture.pixels) n += nonFinite(p.x) + nonFinite(p.y) + nonFinite(p.z) + nonFinite(p.w);
  return n;
}

uint64_t countDiffering(const CheckPicture& a, const CheckPicture& b) {
  if (a.size != b.size) return std::max(a.pixels.size(), b.pixels.size());
  uint64_t n = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) n += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(glm::vec4)) != 0;
  return n;
}

Spread spread(const std::vector<glm::vec3>& values) {
  Spread s;
  if (values.empty()) return s;
  std::vector<double> sorted;
  for (const glm::vec3& v : values) sorted.push_back(v.x);
  std::sort(sorted.begin(), sorted.end());
  const double n = static_cast<double>(sorted.size());
  for (const double v : sorted) s.mean += v / n;
  for (const double v : sorted) s.deviation += (v - s.mean) * (v - s.mean) / n;
  s.deviation = std::sqrt(s.deviation);
  s.least = sorted.front();
  s.most = sorted.back();
  s.percentile1 = sorted[sorted.size() / 100];
  return s;
}

}  // namespace irad
