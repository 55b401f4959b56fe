// Version and commit of this build.
#pragma once

#include <filesystem>
#include <string>

namespace irad::app {
const char* versionNumber();
const char* versionCommit();  ///< git commit, "-dirty" appended where the tree had changes; "unknown" outside git
/// "0.1.0 (commit)". Where that names no one program, of a tree with changes or outside git, with the beginning of the
/// SHA-256 of `program`, the executable: for results that are of one program only.
std::string programIdentity(const std::filesystem::path& program);
}  // namespace irad::app
