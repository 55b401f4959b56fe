#include "gi/check/frames_state.h"

#include <fmt/format.h>

#include <array>

#include "gi/check/state_file.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

static_assert(sizeof(glm::vec4) == 16);

constexpr const char* kFramesKind = "irad reference frames 1";
constexpr uint64_t kMostFacets = uint64_t{1} << 31, kMostFrames = 100'000;

template <class Frames>
auto arraysOfFrames(Frames& frames) {
  return std::array{&frames.next, &frames.radiosity, &frames.indirect, &frames.error, &frames.emitted};
}

}  // namespace

void writeFrames(const std::filesystem::path& path, const FramesState& state) {
  const SavedFrames& frames = state.frames;
  nlohmann::ordered_json json;
  json["facets"] = frames.indirect.size();
  json["emitted"] = !frames.emitted.empty();
  json["frames"] = frames.frames;
  json["mean"] = frames.meanH;
  json["standard_error"] = frames.standardError;
  json["largest"] = frames.largestH;
  json["seconds"] = state.seconds;
  json["made"] = nlohmann::ordered_json::parse(state.made);
  std::vector<std::span<const std::byte>> arrays;
  for (const auto* values : arraysOfFrames(frames)) arrays.push_back(std::as_bytes(std::span(*values)));
  writeState(path, kFramesKind, json, arrays);
}

FramesState readFrames(const std::filesystem::path& path) {
  FramesState state;
  SavedFrames& frames = state.frames;
  uint64_t facets = 0;
  bool emitted = false;
  const auto bytes = [&](const nlohmann::ordered_json& json) {
    facets = wholeOf(json, path, "facets", kMostFacets);
    frames.frames = static_cast<uint32_t>(wholeOf(json, path, "frames", kMostFrames));
    if (facets < 1 || frames.frames < 1)
      throw InputError(fmt::format("{}: {} frames of {} facets", path.string(), frames.frames, facets));
    emitted = json.at("emitted").get<bool>();
    frames.meanH = json.at("mean").get<double>();
    frames.standardError = json.at("standard_error").get<float>();
    frames.largestH = json.at("largest").get<float>();
    state.seconds = json.at("seconds").get<double>();
    state.made = json.at("made").dump();
    return facets * sizeof(glm::vec4) * (emitted ? 5 : 4);
  };
  readState(path, kFramesKind, bytes, [&] {
    std::vector<std::span<std::byte>> arrays;
    for (auto* values : arraysOfFrames(frames)) {
      values->resize(values == &frames.emitted && !emitted ? 0 : facets);
      arrays.push_back(std::as_writable_bytes(std::span(*values)));
    }
    return arrays;
  });
  return state;
}

}  // namespace irad
