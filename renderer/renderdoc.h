// RenderDoc, where the program runs under it (or with ENABLE_VULKAN_RENDERDOC_CAPTURE=1): captures made by the program.
// In builds with IRAD_UI.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "renderer/device.h"

namespace irad {

struct RenderDocApi;

class RenderDoc {
 public:
  /// Looks for the library among those that are loaded; the Vulkan loader does that when the device is made. Takes its
  /// capture keys away from it: F12 is ours. None: not there.
  static std::optional<RenderDoc> find();
  /// Runs `work`; all that it submits to the device is one capture. Returns its file, STEM_capture.rdc or with a
  /// number. What `work` throws is thrown on, and no file stays; WorkError where RenderDoc made none.
  std::filesystem::path capture(const Device& device, const std::filesystem::path& stem,
                                const std::function<void()>& work) const;

 private:
  explicit RenderDoc(const RenderDocApi& api) : api_(&api) {}
  const RenderDocApi* api_;  ///< the library's own table
};

}  // namespace irad
