#include "gi/study/truths.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>

#include "gi/check/path_tracer.h"
#include "gi/sky.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/camera_json.h"

namespace irad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Raised when the path tracer gives other samples.
constexpr int kTracer = 1;

std::string hashOf(std::span<const std::byte> bytes) {
  return sha256({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

/// Letters that a file's name may have everywhere, 40 at most.
std::string plain(const std::string& text, const char* otherwise) {
  std::string out;
  for (const char c : text.substr(0, 40))
    out += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ? c : '_';
  return out.empty() ? otherwise : out;
}

/// All of it but its name, which is no part of a picture. (Members are taken apart as in
/// renderer/scene/scene_content.cpp: a further one does not compile until it is here.)
Json cameraJson(const Camera& camera) {
  const auto& [name, position, orientation, orthographic, yfov, ymag, aspect, znear, zfar] = camera;
  (void)name;
  return {{"position", {position.x, position.y, position.z}},
          {"orientation", {orientation.x, orientation.y, orientation.z, orientation.w}},
          {"orthographic", orthographic},
          {"yfov", yfov},
          {"ymag", ymag},
          {"aspect", aspect},
          {"znear", znear},
          {"zfar", zfar}};
}

std::string texelsHash(const SkyTexels* sky) {
  if (!sky) return "none";
  const auto& [size, texels] = *sky;
  return fmt::format("{}x{} {}", size.x, size.y, hashOf(std::as_bytes(std::span(texels))));
}

Json skyJson(const Sky& sky) {
  const auto& [texels, whole, turn, scale, most, sun, model, ground] = sky;
  (void)most;  // of the texels
  Json out{{"texels", texelsHash(texels.get())},
           {"whole", texelsHash(whole.get())},
           {"turn", turn},
           {"scale", {scale.x, scale.y, scale.z}},
           {"model", {model.x, model.y, model.z, model.w}}};
  if (sun) {
    const auto& [towards, irradiance] = *sun;
    out["sun"] = {towards.x, towards.y, towards.z, irradiance.x, irradiance.y, irradiance.z};
  }
  const auto& [albedo, groundSun] = ground;
  out["ground"] = {albedo, groundSun.x, groundSun.y, groundSun.z};
  return out;
}

Json commonJson(const TruthSubject& subject, const char* by) {
  return {{"by", by},
          {"program", subject.program},
          {"scene", subject.scene},
          {"camera", cameraJson(subject.camera)},
          {"size", {subject.size.x, subject.size.y}},
          {"view", subject.view}};
}

TruthRecipe recipeOf(const TruthSubject& subject, const Json& made) {
  return {fmt::format("{}-{}-{}", plain(subject.sceneName, "scene"), plain(subject.camera.name, "camera"),
                      plain(subject.view, "view")),
          jsonText(made)};
}

const char* const kHalves[] = {"a", "b"};
const char* const kPictures = "pictures";

}  // namespace

std::string TruthRecipe::name() const {
  return fmt::format("{}-{}", label, hashOf(std::as_bytes(std::span(made))).substr(0, 10));
}

TruthRecipe tracedTruth(const TruthSubject& subject, const Sky& sky, const TraceOptions& options) {
  Json made = commonJson(subject, "path tracer");
  const auto& [samples, seed, centred, threads, glossy, glossySeen, bounces, strategy] = options;
  (void)threads;  // no bit depends on it
  made["tracer"] = kTracer;
  made["sky"] = skyJson(sky);
  made["samples"] = samples, made["seed"] = seed, made["centred"] = centred;
  made["glossy"] = glossy, made["glossy_seen"] = glossySeen, made["bounces"] = bounces;
  made["strategy"] = static_cast<int>(strategy);
  return recipeOf(subject, made);
}

TruthRecipe drawnTruth(const TruthSubject& subject, const Settings& settings, const std::string& device) {
  Json made = commonJson(subject, "own pictures");
  made["device"] = device;
  made["half_seeds"] = kHalfSeeds;
  made["settings"] = Json::parse(settingsToJson(settings));
  return recipeOf(subject, made);
}

fs::path TruthStore::stem(const TruthRecipe& recipe, int half) const {
  return folder_ / fmt::format("{}.{}", recipe.name(), kHalves[half]);
}

fs::path TruthStore::stateFile(const TruthRecipe& recipe) const {
  return folder_ / (recipe.name() + ".state");
}

namespace {

/// NAME.json, which must be of this recipe; none where there is no such file.
std::optional<Json> vouchers(const fs::path& file, const TruthRecipe& recipe) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  Json json = readJsonFile(file);
  if (!json.contains("made") || !json.contains(kPictures) || !json[kPictures].is_object())
    throw InputError(fmt::format("{}: not what says of which recipe a truth is; remove it", file.string()));
  if (json["made"] != Json::parse(recipe.made))
    throw InputError(fmt::format("{}: made of {} instead of {}", file.string(), json["made"].dump(), recipe.made));
  return json;
}

}  // namespace

std::optional<fs::path> TruthStore::whole(const TruthRecipe& recipe, int half, std::string* spoilt) const {
  const std::optional<Json> json = vouchers(folder_ / (recipe.name() + ".json"), recipe);
  if (!json || !(*json)[kPictures].contains(kHalves[half])) return std::nullopt;
  const fs::path file = stem(recipe, half).string() + linearExtension();
  std::error_code ignored;
  const bool there = fs::exists(file, ignored);
  if (there && (*json)[kPictures][kHalves[half]] == sha256File(file)) return file;
  if (spoilt) *spoilt = fmt::format("{}: {}", file.string(), there ? "not the picture that was written" : "is gone");
  return std::nullopt;
}

std::optional<LinearPicture> TruthStore::find(const TruthRecipe& recipe, int half, std::string* spoilt) const {
  const std::optional<fs::path> file = whole(recipe, half, spoilt);
  return file ? std::optional(readLinear(*file)) : std::nullopt;
}

bool TruthStore::has(const TruthRecipe& recipe) const {
  return whole(recipe, 0, nullptr) && whole(recipe, 1, nullptr);
}

void TruthStore::keep(const TruthRecipe& recipe, int half, glm::uvec2 size, const std::vector<glm::vec4>& pixels,
                      const PictureSubject& subject) const {
  makeFolder(folder_);
  const fs::path file = folder_ / (recipe.name() + ".json");
  const PictureLayer layer{"", pixels};
  const std::vector<fs::path> written = writeLayers(stem(recipe, half), size, {&layer, 1}, subject);
  Json json = vouchers(file, recipe).value_or(Json{{"made", Json::parse(recipe.made)}, {kPictures, Json::object()}});
  json[kPictures][kHalves[half]] = sha256File(written.front());
  writeFile(file, jsonText(json, 2));
}

}  // namespace irad
