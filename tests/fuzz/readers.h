// The readers of files and texts that strangers make, as the fuzzer and the replay of its seeds call them.
//
// What each must hold: it returns, or throws irad::Error. Anything else is a finding: another exception, an unsound
// result (Unsound below), a sanitizer's report, a leak, more than 10 s or 2 GiB.
//
// A new reader is one file, readers/NAME.cpp, one row in the list, and its seeds in seeds/NAME/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>

namespace irad::fuzz {

using Bytes = std::span<const uint8_t>;

#define IRAD_FUZZ_READERS(ROW) \
  ROW(camera_json)             \
  ROW(capture)                 \
  ROW(config)                  \
  ROW(gltf)                    \
  ROW(image)                   \
  ROW(path_state)              \
  ROW(scene_cache)             \
  ROW(settings)                \
  ROW(sidecar)                 \
  ROW(sky)

#define IRAD_FUZZ_DECLARE(name) void name(Bytes bytes);
IRAD_FUZZ_READERS(IRAD_FUZZ_DECLARE)
#undef IRAD_FUZZ_DECLARE

/// What was accepted breaks its own promises.
struct Unsound : std::logic_error {
  using std::logic_error::logic_error;
};

/// A file of these bytes in a folder of this process, overwritten by the next call; beside it lie the files that seeds
/// refer to: data.bin (bytes 0 to 255) and image.png.
std::filesystem::path scratchFile(const char* name, Bytes bytes);

}  // namespace irad::fuzz
