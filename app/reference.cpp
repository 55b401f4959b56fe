#include "app/reference.h"

#include <fmt/format.h>

#include "app/progress.h"
#include "gi/check/check.h"
#include "renderer/base/error.h"

namespace irad::app {
namespace fs = std::filesystem;

void ReferenceArgument::declare(Options& options) {
  options.value("--reference", "FILE", file,
                "Picture (linear EXR) that the views reference-picture and error compare with");
}

std::optional<ReferencePicture> ReferenceArgument::read(const Config& config, ProgressReport& progress) const {
  if (!file && !config.reference) return std::nullopt;
  const fs::path path = file ? fs::path(*file) : *config.reference;
  ReferencePicture reference = readReference(path);
  if (!reference.note.empty()) progress.note("warning: " + reference.note);
  if (!file) warnIfOther(progress, config, path, reference.sha256, config.referenceSha256);
  return reference;
}

void requireSubject(const ReferencePicture& reference, const Camera& camera, View view) {
  if (const std::string why = otherCamera(reference.camera, camera); !why.empty())
    throw UsageError(fmt::format("{}: made from another camera: {}", reference.path.string(), why));
  if (!reference.picture.subject.view.empty() && reference.of != view)
    throw UsageError(fmt::format("{}: a picture of {}, not of {}", reference.path.string(),
                                 reference.picture.subject.view, viewInfo(view)->name));
}

void requireInput(const ViewInfo& view, bool reference, const fs::path& scene) {
  if (view.isFrom(FROM_PICTURE) && !reference)
    throw UsageError(
        fmt::format("--view {}: there is no picture to show or compare with: --reference FILE", view.name));
  if (view.isFrom(FROM_ORACLE) && !isCheckScene(scene))
    throw UsageError(fmt::format(
        "--view {}: only the scenes of irad check have an oracle (check:NAME; irad check --list), {} has none",
        view.name, scene.string()));
}

void requireSize(const ReferencePicture& reference, glm::uvec2 size) {
  const glm::uvec2 its = reference.picture.size;
  if (its != size)
    throw UsageError(fmt::format("--reference {}: {} x {} pixels, the pictures have {} x {}: --size {}x{}",
                                 reference.path.string(), its.x, its.y, size.x, size.y, its.x, its.y));
}

}  // namespace irad::app
