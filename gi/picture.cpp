#include "gi/picture.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gi/legend.h"
#include "gi/views/views.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/base/sha256.h"
#include "renderer/frame/transfer.h"
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

ReferencePicture readReference(const std::filesystem::path& path) {
  LinearPicture picture = readLinear(path);
  std::string note;
  if (picture.integers) {
    for (glm::vec4& pixel : picture.pixels) pixel = {decodeSrgb(pixel.x), decodeSrgb(pixel.y), decodeSrgb(pixel.z), 1};
    note = fmt::format(
        "{} holds integers and is decoded from sRGB: what was brighter than white is lost, and any exposure and tone "
        "curve are still in it",
        path.string());
  }
  std::ifstream in(path, std::ios::binary);
  const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  return {std::filesystem::absolute(path).lexically_normal(), sha256(bytes), std::move(picture), VIEW_LIT,
          std::move(note)};
}

}  // namespace irad
