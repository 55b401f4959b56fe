// Triangles that lie where another one does and face its way, as files often hold some.
#pragma once

#include <cstdint>
#include <vector>

namespace irad {

class SceneOnDevice;

/// Of each triangle, counted from 1, the first in the same place (the same three positions in the same turn), if that
/// can stand for it: no mask cuts holes that this one fills, and it shows its back where this one does. 0: none, as of
/// all where the result is empty.
std::vector<uint32_t> repeatedTriangles(const SceneOnDevice& scene);

}  // namespace irad
