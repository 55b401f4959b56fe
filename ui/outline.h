// The outline of the chosen object over the picture, to the pixel: all of it, faint where something is before it. It is
// no part of the picture: captures and exports do not have it.
#pragma once

#include <optional>

#include "gi/pipeline.h"
#include "renderer/resources.h"
#include "renderer/scene/scene.h"

namespace irad {

class Frame;
class ImGuiLayer;
struct Rect;
struct Session;

struct Outline {
  Image depth, picture;  ///< none where nothing is chosen
  Buffer camera;
  struct Of {
    const Pipeline* pipeline = nullptr;
    Revision revision;
    uint32_t object = 0;
    Camera camera;
    glm::uvec2 size{0};
    int reach = 0;
    bool surfaces = false;  ///< the picture's depth says what is before it
    bool operator==(const Of&) const = default;
  };
  std::optional<Of> of;  ///< what `picture` shows; none: nothing, or not yet
};

/// Draws it where it is not there yet. After the picture.
void drawOutline(Session& session, Frame& frame, float scale);
/// Puts it over the picture in the present ImGui window.
void showOutline(Session& session, ImGuiLayer& layer, const Rect& where);

}  // namespace irad
