// Where a light that is added begins.
#pragma once

#include "renderer/scene/light_kind.h"
#include "renderer/scene/scene.h"

namespace irad {

/// A light of this kind on the line of sight through the middle of the camera's picture, inside the scene's bounds,
/// half-way to the first surface (before a surface that is the scene's outside: close to it); it shines where the
/// camera looks, so that a white surface there, facing it, has radiance 1. Where the camera looks past the scene: in
/// the middle of it. Looks at every triangle.
Light newLight(const LightKind& kind, const Scene& scene, const Camera& camera);

}  // namespace irad
