// The path tracer's sums in a file, from which a later run goes on.
#pragma once

#include <filesystem>
#include <string>

#include "gi/check/path_tracer.h"

namespace irad {

/// 72 bytes per pixel and light: `lit`, `indirect`, what else there is.
struct SavedSums {
  std::string made;  ///< what they were made of, as JSON; theirs who write it
  TracedSums sums;
};
/// Appears whole or not at all; WorkError.
void writeSums(const std::filesystem::path& path, const SavedSums& saved);
/// InputError names the file and says what is wrong with it: every bit that was written is vouched for.
SavedSums readSums(const std::filesystem::path& path);

}  // namespace irad
