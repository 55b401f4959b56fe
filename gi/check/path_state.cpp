#include "gi/check/path_state.h"

#include <fmt/format.h>

#include "gi/check/state_file.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

static_assert(sizeof(glm::dvec3) == 24);

constexpr const char* kKind = "irad reference sums 1";
constexpr uint64_t kMostPixels = uint64_t{1} << 28, kMostBounces = 1024;
constexpr size_t kArrays = 3;  ///< of a light

/// Of each light: the two halves, the squares.
template <class Sums>
auto arraysOf(Sums& sums) {
  std::vector<decltype(&sums.lit.squares)> arrays;
  const auto add = [&](auto& light) { arrays.insert(arrays.end(), {&light.half[0], &light.half[1], &light.squares}); };
  add(sums.lit);
  add(sums.indirect);
  if (!sums.specular.squares.empty()) add(sums.specular);
  for (auto& light : sums.bounces) add(light);
  return arrays;
}

}  // namespace

void writeSums(const std::filesystem::path& path, const SavedSums& saved) {
  const TracedSums& sums = saved.sums;
  nlohmann::ordered_json json;
  json["width"] = sums.size.x;
  json["height"] = sums.size.y;
  json["samples"] = sums.samples;
  json["rays"] = sums.rays;
  json["seconds"] = sums.seconds;
  if (!sums.specular.squares.empty()) json["specular"] = true;
  if (!sums.bounces.empty()) json["bounces"] = sums.bounces.size();
  json["made"] = nlohmann::ordered_json::parse(saved.made);
  std::vector<std::span<const std::byte>> arrays;
  for (const auto* values : arraysOf(sums)) arrays.push_back(std::as_bytes(std::span(*values)));
  writeState(path, kKind, json, arrays);
}

SavedSums readSums(const std::filesystem::path& path) {
  SavedSums saved;
  TracedSums& sums = saved.sums;
  bool specular = false;
  uint64_t pixels = 0;
  const auto bytes = [&](const nlohmann::ordered_json& json) {
    const auto whole = [&](const char* name, uint64_t most) { return wholeOf(json, path, name, most); };
    sums.size = {whole("width", kMostPixels), whole("height", kMostPixels)};
    sums.samples = static_cast<uint32_t>(whole("samples", UINT32_MAX));
    sums.rays = whole("rays", UINT64_MAX);
    sums.seconds = json.at("seconds").get<double>();
    specular = json.contains("specular") && json.at("specular").get<bool>();
    if (json.contains("bounces")) sums.bounces.resize(whole("bounces", kMostBounces));
    saved.made = json.at("made").dump();
    pixels = uint64_t{sums.size.x} * sums.size.y;
    if (pixels < 1 || pixels > kMostPixels || sums.samples < 1)
      throw InputError(
          fmt::format("{}: {} x {} pixels of {} samples", path.string(), sums.size.x, sums.size.y, sums.samples));
    return pixels * kArrays * sizeof(glm::dvec3) * (2 + (specular ? 1 : 0) + sums.bounces.size());
  };
  readState(path, kKind, bytes, [&] {
    if (specular) sums.specular.squares.resize(1);
    std::vector<std::span<std::byte>> arrays;
    for (auto* values : arraysOf(sums)) {
      values->resize(pixels);
      arrays.push_back(std::as_writable_bytes(std::span(*values)));
    }
    return arrays;
  });
  return saved;
}

}  // namespace irad
