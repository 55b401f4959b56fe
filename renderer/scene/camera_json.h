// A camera as JSON: what --camera takes, manifests and sidecars hold. Fields: name; position [x, y, z]; orientation
// [x, y, z, w] or target [x, y, z] with up; yfov (radians) or ymag (orthographic half height); aspect; znear; zfar.
// Numbers keep their bits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

std::string cameraToJson(const Camera& camera);
/// UsageError "LABEL: FIELD: ...".
Camera cameraFromJson(std::string_view json, const std::string& label = "camera");
/// For an array: "LABEL[2]: FIELD: ...".
std::vector<Camera> camerasFromJson(std::string_view json, const std::string& label);

}  // namespace irad
