#include <fmt/format.h>

#include <string_view>

#include "app/version.h"
#include "renderer/base/sha256.h"

namespace irad::app {

std::string programIdentity() {
  static const std::string identity = [] {
    const std::string_view commit = versionCommit();
    if (!commit.ends_with("-dirty") && commit != "unknown") return fmt::format("{} ({})", versionNumber(), commit);
    return fmt::format("{} ({}, executable {})", versionNumber(), commit, sha256File("/proc/self/exe").substr(0, 12));
  }();
  return identity;
}

}  // namespace irad::app
