#include "app/blender_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/named_experiment.h"
#include "gi/check/process.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

fs::path script() {
  return sharedFolder() / "tools/cycles_reference.py";
}

fs::path blender() {
  return findProgram("blender");
}

struct Part {
  const char *light, *color;  ///< passes that are multiplied; no colour: the light as it is
};
struct Parts {
  std::string_view view;
  std::vector<Part> sum;
};
/// Our direct light has highlights of lights in it, and what surfaces emit.
const Parts kParts[] = {{"lit", {{"combined", nullptr}}},
                        {"direct", {{"diffdir", "diffcol"}, {"glossdir", "glosscol"}, {"emit", nullptr}}},
                        {"indirect", {{"diffind", "diffcol"}}},
                        {"specular", {{"glossind", "glosscol"}}}};

}  // namespace

std::string whyNoBlender() {
  std::error_code ignored;
  if (blender().empty()) return "Blender is not installed";
  if (!fs::exists(script(), ignored)) return fmt::format("{}: no such file", script().string());
  return "";
}

LinearPicture blenderPart(const fs::path& folder, const BlenderPicture& picture, std::string_view view) {
  const auto* const parts = std::ranges::find(kParts, view, &Parts::view);
  IRAD_CHECK(parts != std::end(kParts), "a view that Blender's passes give");
  const std::string stem = fmt::format("{}.{}.{}.{}x{}.{}", picture.scene.stem().string(), picture.camera,
                                       picture.engine, picture.size.x, picture.size.y, picture.samples);
  const fs::path done = folder / stem;  // all passes, or it is not there
  const auto fileOf = [&](const char* pass) { return done / fmt::format("picture_{}.pfm", pass); };
  std::error_code ignored;
  if (!fs::exists(done, ignored)) {
    const fs::path made = folder / (stem + ".made"), log = folder / (stem + ".log");
    fs::remove_all(made, ignored);
    makeFolder(made);
    Process run(blender().string(),
                {"-b",
                 "--factory-startup",
                 "--python-exit-code",
                 "1",
                 "--python",
                 fs::absolute(script()).string(),
                 "--",
                 "--in",
                 fs::absolute(picture.scene).string(),
                 "--out",
                 fs::absolute(made / "picture").string(),
                 "--res",
                 std::to_string(picture.size.x),
                 std::to_string(picture.size.y),
                 "--spp",
                 std::to_string(picture.samples),
                 "--camera",
                 picture.camera,
                 "--engine",
                 picture.engine,
                 "--split",
                 "--pfm"},
                log, log);
    if (const int status = run.wait(); status != 0)
      throw NoPicture(fmt::format("blender ended with status {}: see {}", status, log.string()));
    fs::rename(made, done);
  }
  const auto read = [&](const char* pass) {
    if (!fs::exists(fileOf(pass), ignored)) throw NoPicture(fmt::format("{} gives no pass {}", picture.engine, pass));
    LinearPicture out = readPfm(fileOf(pass));
    if (out.size != picture.size)
      throw NoPicture(fmt::format("{}: {} x {} pixels", fileOf(pass).string(), out.size.x, out.size.y));
    return out;
  };
  LinearPicture out{picture.size, std::vector<glm::vec4>(size_t{picture.size.x} * picture.size.y, {0, 0, 0, 1})};
  for (const Part& part : parts->sum) {
    const LinearPicture light = read(part.light);
    const std::optional<LinearPicture> color = part.color ? std::optional(read(part.color)) : std::nullopt;
    for (size_t i = 0; i < out.pixels.size(); ++i) {
      const glm::vec3 tint = color ? glm::vec3(color->pixels[i]) : glm::vec3(1);
      out.pixels[i] += glm::vec4(glm::vec3(light.pixels[i]) * tint, 0);
    }
  }
  return out;
}

}  // namespace irad::app
