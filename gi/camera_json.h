// A camera as JSON: what --camera takes and manifests hold. Fields: name; position [x, y, z]; orientation [x, y, z, w]
// or target [x, y, z] with up; yfov (radians) or ymag (orthographic half height); aspect; znear; zfar. Numbers keep
// their bits.
#pragma once

#include <string>
#include <string_view>

#include "renderer/scene/scene.h"

namespace irad {

std::string cameraToJson(const Camera& camera);
/// UsageError names the field.
Camera cameraFromJson(std::string_view json);

}  // namespace irad
