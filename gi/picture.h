// A rendered view as files: what `irad render` and the window's captures share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/views/views.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/scene.h"

namespace irad {

class Context;
struct Legend;
struct Settings;
struct Targets;
struct ViewInfo;

struct PictureFiles {
  std::vector<std::filesystem::path> paths;
  std::string bad;  ///< what findBadPixels says of it; the files are written all the same, they show where
};
/// What is in `targets` after Pipeline::render() of `view`: stem.png as shown, stem.exr linear
/// (renderer/base/image_io.h). `legend` and the lines of `notice` are drawn into the PNG.
PictureFiles writePicture(Context& context, const Targets& targets, const ViewInfo& view,
                          const std::filesystem::path& stem, const Legend* legend = nullptr,
                          const std::vector<std::string>& notice = {});
/// What the display picture of a view with a range was drawn with.
Legend legendOf(Context& context, const Targets& targets, const ViewInfo& view, const Settings& settings);

/// With what range and colours the display picture of a view with a range was drawn, for manifests (JSON): member
/// "picture" is `name`.
std::string rangeJson(Context& context, const Targets& targets, const ViewInfo& view, const Settings& settings,
                      const std::string& name);

/// A picture by others, which the views of group "Reference" show and compare with.
struct ReferencePicture {
  std::filesystem::path path;  ///< absolute; empty: it was made here, and is in no file
  std::string sha256;          ///< of the file
  LinearPicture picture;
  View of = VIEW_LIT;              ///< what it is a picture of: as the file says, else this
  std::optional<Camera> camera{};  ///< that it was made from, where the file says it
  std::string note{};              ///< what is odd about it, in words; empty: nothing
};
/// The camera that a picture says it was made from; none where it does not say. InputError, with the picture's `path`.
std::optional<Camera> cameraOf(const std::filesystem::path& path, const PictureSubject& subject);
/// In words, how the camera that a picture was made from differs from another in what is seen; empty: in nothing but
/// roundings, or it is not known.
std::string otherCamera(const std::optional<Camera>& made, const Camera& camera);
/// Integers (PNG, JPEG) are what screens show: decoded from sRGB. What that leaves in them, in words.
std::string decodeIntegers(const std::filesystem::path& path, std::span<glm::vec4> pixels);
/// As readLinear() does; integers are decoded, which `note` says. InputError.
ReferencePicture readReference(const std::filesystem::path& path);

}  // namespace irad
