// What specular rays record, filtered (gi/specular.cpp) or as in the thesis (gi/thesis/pixel_specular.cpp).
#pragma once

#include "gi/views/draw.h"
#include "shaders/shared/indirect.h"

namespace irad {

class Pass;

inline constexpr const char* kSpecularStage = "RE Specular";

/// A picture with everything that its reflections need.
struct SpecularPicture {
  Frame& frame;
  const ViewInputs& inputs;
  const Buffer& camera;
  const Settings& settings;
  Targets& targets;
  SpecularPush push;  ///< what all passes have in common
  uint32_t method;    ///< TRACE_*
};
/// Lists the pixels that trace in targets.glossy; the others have their reflection with this step. `filtered`: which
/// ones these are stands in targets.linear, for the filter.
void listGlossy(SpecularPicture& picture, bool filtered);
/// What shaders with specular/trace.glsl need, their first images among it. After their others comes sampleField().
Pass& addRays(const SpecularPicture& picture, Pass& pass, const Emitters* emitters = nullptr);
/// The field as an image, where it is one: shaders "NAME_jfa".
Pass& sampleField(const SpecularPicture& picture, Pass& pass);
inline bool fieldIsImage(const SpecularPicture& picture) {
  return picture.method == TRACE_JFA;
}

}  // namespace irad
