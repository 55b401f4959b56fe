// Pictures by Blender's Cycles and EEVEE, where `blender` and the script of ../shared/tools are there: rq1's truths.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "renderer/base/image_io.h"

namespace irad::app {

/// Why Blender makes no pictures here; empty: it does.
std::string whyNoBlender();

struct BlenderPicture {
  std::filesystem::path scene;
  std::string camera, engine;  ///< of the glTF file; "CYCLES", "EEVEE"
  glm::uvec2 size{0};
  uint32_t samples = 0;
};
struct NoPicture : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// What a view of ours is in Blender's passes, as linear radiance: lit, direct (with highlights, and what is
/// emitted), indirect (diffuse) or specular (indirect glossy). Made in `folder` where it is not there yet. NoPicture
/// where Blender fails.
LinearPicture blenderPart(const std::filesystem::path& folder, const BlenderPicture& picture, std::string_view view);

}  // namespace irad::app
