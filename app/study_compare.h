// `irad study compare`: a picture against a reference, layer by layer.
#pragma once

#include <filesystem>
#include <optional>

namespace irad::app {

/// Prints the metrics of each layer that the pictures share. UsageError where they are of different cameras or sizes.
void comparePictures(const std::filesystem::path& picture, const std::filesystem::path& reference,
                     const std::optional<std::filesystem::path>& second);

}  // namespace irad::app
