// Version and commit of this build.
#pragma once

namespace irad::app {
const char* versionNumber();
const char* versionCommit();  ///< git commit, "-dirty" appended where the tree had changes; "unknown" outside git
}  // namespace irad::app
