#include "app/reference.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "renderer/scene/sha256.h"

namespace irad::app {
namespace fs = std::filesystem;

std::string Reference::json() const {
  return nlohmann::ordered_json{{"path", path.string()}, {"sha256", sha256}}.dump();
}

void ReferenceArgument::declare(Options& options) {
  options.value("--reference", "FILE", file,
                "Picture (linear EXR) that the views reference-picture and error compare with");
}

std::optional<Reference> ReferenceArgument::read(const Config& config, ProgressReport& progress) const {
  if (!file && !config.reference) return std::nullopt;
  const fs::path path = file ? fs::path(*file) : *config.reference;
  Reference reference{fs::absolute(path).lexically_normal(), {}, readLinear(path)};
  std::ifstream in(path, std::ios::binary);
  const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  reference.sha256 = sha256(bytes);
  if (!file && config.referenceSha256 && *config.referenceSha256 != reference.sha256)
    progress.note(fmt::format("warning: {} is not the file that {} names: SHA-256 {} instead of {}", path.string(),
                              config.path.string(), reference.sha256, *config.referenceSha256));
  return reference;
}

}  // namespace irad::app
