#include <fmt/format.h>

#include <string_view>

#include "app/version.h"
#include "renderer/base/sha256.h"

namespace irad::app {

std::string programIdentity(const std::filesystem::path& program) {
  const std::string_view commit = versionCommit();
  if (!commit.ends_with("-dirty") && commit != "unknown") return fmt::format("{} ({})", versionNumber(), commit);
  return fmt::format("{} ({}, executable {})", versionNumber(), commit, sha256File(program).substr(0, 12));
}

}  // namespace irad::app
