// The frames of brute force in a file, from which a later run goes on.
#pragma once

#include <filesystem>
#include <string>

#include "gi/brute_force.h"

namespace irad {

/// 64 bytes per facet, with emissive ones 80.
struct FramesState {
  std::string made;  ///< what they were made of, as JSON; theirs who write it
  double seconds = 0;
  SavedFrames frames;
};
/// Appears whole or not at all; WorkError.
void writeFrames(const std::filesystem::path& path, const FramesState& state);
/// InputError names the file and says what is wrong with it.
FramesState readFrames(const std::filesystem::path& path);

}  // namespace irad
