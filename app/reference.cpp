#include "app/reference.h"

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

}  // namespace irad::app
