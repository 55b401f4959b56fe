// The interactive window: the same frames as the headless commands, the panels around them.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gi/manifest.h"
#include "gi/picture.h"
#include "gi/settings.h"
#include "gi/views/views.h"
#include "renderer/scene/scene.h"
#include "ui/presets.h"

namespace irad {

class Context;

struct WindowOptions {
  std::filesystem::path scene;
  LoadOptions load;                            ///< of it and those opened later; `lights` are its own
  std::vector<std::filesystem::path> builtIn;  ///< folders whose scenes have no sidecar
  Settings settings;
  bool exposes = false;  ///< scenes that are files of the user's get camera.auto_exposure
  Settings defaults;     ///< of this device class, for the reset buttons
  View view = 0;
  std::optional<ReferencePicture> reference;  ///< for the views that compare with one
  std::optional<glm::uvec3> inspect;          ///< voxel to begin with in the inspector
  std::string camera;                         ///< of the scene, by name; empty: `start`
  std::optional<Camera> start;                ///< to begin with; none: the scene's first
  glm::uvec2 size{1280, 720};
  float scale = 1;  ///< times the monitor's content scale
  std::filesystem::path captures = "out/captures";
  Program program;                    ///< for the captures' manifests
  std::filesystem::path preferences;  ///< file that remembers the layout; empty: none is read or written
  Presets presets;                    ///< the user's own
  std::filesystem::path shaders;      ///< sources for F5; empty: not at hand
  // For tests.
  uint32_t exitAfter = 0;            ///< > 0: end after so many frames in which nothing was left to do
  std::filesystem::path screenshot;  ///< of the whole window when it ends, .png
  std::filesystem::path controls;    ///< file with their places (ui/controls.h), written with every frame
  // For measurements: once nothing is left to do, so many frames follow each other, a picture in every fourth, and the
  // window ends.
  uint32_t measuredFrames = 0;
  std::vector<double>* uiMilliseconds = nullptr;  ///< CPU time of this thread for panels and their triangles, by frame
};

/// Runs until the user quits. Throws what stops the first scene from loading; later errors are shown in the window. The
/// context's device must have been made presentable.
void runWindow(Context& context, const WindowOptions& options);

}  // namespace irad
