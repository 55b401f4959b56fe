#include "app/reference.h"

#include <fmt/format.h>

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

}  // namespace irad::app
