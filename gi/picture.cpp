#include "gi/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gi/legend.h"
#include "gi/views/views.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/base/sha256.h"
#include "renderer/frame/transfer.h"
#include "renderer/scene/camera_json.h"
#include "renderer/targets.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

/// IEC 61966-2-1, of codes of any depth on a scale of 0..1.
float decodeSrgb(float code) {
  const double c = code;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

}  // namespace

PictureFiles writePicture(Context& context, const Targets& targets, const ViewInfo& view,
                          const std::filesystem::path& stem, const Legend* legend,
                          const std::vector<std::string>& notice) {
  const std::vector<std::byte> linear = download(context, targets.linear);
  std::vector<std::byte> display = download(context, targets.display);
  const size_t pixels = size_t{targets.size.x} * targets.size.y;
  IRAD_CHECK_OP(linear.size(), ==, pixels * sizeof(glm::vec4));
  IRAD_CHECK_OP(display.size(), ==, pixels * sizeof(glm::u8vec4));
  const std::span values(reinterpret_cast<const glm::vec4*>(linear.data()), pixels);
  const std::span shown(reinterpret_cast<glm::u8vec4*>(display.data()), pixels);
  if (legend != nullptr) drawLegend(*legend, targets.size, shown);
  constexpr int kMargin = 8, kLine = 14;  // pixels
  for (size_t i = 0; i < notice.size(); ++i)
    drawText(targets.size, shown, {kMargin, kMargin + static_cast<int>(i) * (kLine + kMargin / 2)}, TextAlign::Left,
             kLine, notice[i], {230, 230, 230, 255});
  PictureFiles files;
  files.paths.push_back(writeDisplay(stem, targets.size, shown));
  files.paths.push_back(writeLinear(stem, targets.size, values));
  files.bad = findBadPixels(values, targets.size, view.toneMapped());
  return files;
}

Legend legendOf(Context& context, const Targets& targets, const ViewInfo& view, const Settings& settings) {
  return makeLegend(shownQuantity(view, settings), colorMapOf(view, settings),
                    downloadAs<ViewRange>(context, targets.viewRange).at(0));
}

std::string rangeJson(Context& context, const Targets& targets, const ViewInfo& view, const Settings& settings,
                      const std::string& name) {
  const ViewRange range = downloadAs<ViewRange>(context, targets.viewRange).at(0);
  const Quantity quantity = shownQuantity(view, settings);
  return nlohmann::ordered_json{{"picture", name},
                                {"quantity", quantity.name},
                                {"unit", quantity.unit},
                                {"color_map", colorMapName(colorMapOf(view, settings))},
                                {"low", range.low},
                                {"high", range.high},
                                {"nan_pixels", range.nan},
                                {"infinite_pixels", range.infinite},
                                {"negative_pixels", range.negative}}
      .dump();
}

std::optional<Camera> cameraOf(const std::filesystem::path& path, const PictureSubject& subject) {
  if (subject.camera.empty()) return std::nullopt;
  try {
    return cameraFromJson(subject.camera, path.string() + ": iradCamera");
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
}

std::string decodeIntegers(const std::filesystem::path& path, std::span<glm::vec4> pixels) {
  for (glm::vec4& pixel : pixels) pixel = {decodeSrgb(pixel.x), decodeSrgb(pixel.y), decodeSrgb(pixel.z), 1};
  return fmt::format(
      "{} holds integers and is decoded from sRGB: what was brighter than white is lost, and any exposure and tone "
      "curve are still in it",
      path.string());
}

ReferencePicture readReference(const std::filesystem::path& path) {
  LinearPicture picture = readLinear(path);
  std::string note;
  if (picture.integers) note = decodeIntegers(path, picture.pixels);
  std::optional<Camera> camera = cameraOf(path, picture.subject);
  const View of = findView(picture.subject.view).value_or(VIEW_LIT);
  return {std::filesystem::absolute(path).lexically_normal(),
          sha256File(path),
          std::move(picture),
          of,
          std::move(camera),
          std::move(note)};
}

std::string otherCamera(const std::optional<Camera>& made, const Camera& camera) {
  if (!made) return "";
  const auto apart = [](double a, double b) { return std::abs(a - b) > 1e-4 * std::max(std::abs(a), std::abs(b)); };
  // Cameras that have been turned by a window come back with roundings.
  const double most = 1e-5 * std::max(1.0, glm::length(made->position));
  if (glm::distance(made->position, camera.position) > most)
    return fmt::format("it stands at {:.4g} {:.4g} {:.4g}, not {:.4g} {:.4g} {:.4g}", made->position.x,
                       made->position.y, made->position.z, camera.position.x, camera.position.y, camera.position.z);
  const glm::quat& q = made->orientation;
  const glm::quat& r = camera.orientation;
  if (std::min(glm::length(q - r), glm::length(q + r)) > 1e-4f) {
    const glm::vec3 there = q * glm::vec3(0, 0, -1), here = r * glm::vec3(0, 0, -1);
    return fmt::format("it looks along {:.4f} {:.4f} {:.4f}, not {:.4f} {:.4f} {:.4f}{}", there.x, there.y, there.z,
                       here.x, here.y, here.z, glm::distance(there, here) < 1e-4f ? ", and is rolled" : "");
  }
  if (made->orthographic != camera.orthographic) return made->orthographic ? "it is orthographic" : "it is perspective";
  if (made->orthographic ? apart(made->ymag, camera.ymag) : apart(made->yfov, camera.yfov))
    return made->orthographic ? fmt::format("it shows {:.4g} m of height, not {:.4g}", 2 * made->ymag, 2 * camera.ymag)
                              : fmt::format("its vertical angle is {:.2f} degrees, not {:.2f}",
                                            glm::degrees(made->yfov), glm::degrees(camera.yfov));
  return "";
}

}  // namespace irad
