#include "app/reference.h"

#include <fmt/format.h>

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
  if (!file && config.referenceSha256 && *config.referenceSha256 != reference.sha256)
    progress.note(fmt::format("warning: {} is not the file that {} names: SHA-256 {} instead of {}", path.string(),
                              config.path.string(), reference.sha256, *config.referenceSha256));
  return reference;
}

}  // namespace irad::app
