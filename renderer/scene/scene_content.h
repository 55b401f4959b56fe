// What a scene is, as one number: all that pictures of it may depend on, by whatever renderer.
#pragma once

#include <string>

namespace irad {

struct Scene;

/// SHA-256, as hex, of everything that was loaded but what says where it came from: paths, the file's own hash, names,
/// warnings, cameras (a picture has one of its own), and the file's lights and materials where others took their place.
/// The same on every run and machine.
std::string sceneContent(const Scene& scene);

}  // namespace irad
