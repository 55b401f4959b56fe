#include "gi/picture.h"

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

PictureFiles writePicture(Context& context, const Targets& targets, const ViewInfo& view,
                          const std::filesystem::path& stem, const Legend* legend) {
  const std::vector<std::byte> linear = download(context, targets.linear);
  std::vector<std::byte> display = download(context, targets.display);
  const size_t pixels = size_t{targets.size.x} * targets.size.y;
  IRAD_CHECK_OP(linear.size(), ==, pixels * sizeof(glm::vec4));
  IRAD_CHECK_OP(display.size(), ==, pixels * sizeof(glm::u8vec4));
  const std::span values(reinterpret_cast<const glm::vec4*>(linear.data()), pixels);
  const std::span shown(reinterpret_cast<glm::u8vec4*>(display.data()), pixels);
  if (legend != nullptr) drawLegend(*legend, targets.size, shown);
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
  return {std::filesystem::absolute(path).lexically_normal(), sha256File(path), std::move(picture), VIEW_LIT};
}

}  // namespace irad
