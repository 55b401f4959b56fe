#include "gi/picture.h"

#include "gi/watch.h"
#include "renderer/error.h"
#include "renderer/image_io.h"

namespace irad {

PictureFiles writePicture(Context& context, const Targets& targets, const ViewInfo& view,
                          const std::filesystem::path& stem) {
  const std::vector<std::byte> linear = download(context, targets.linear);
  const std::vector<std::byte> display = download(context, targets.display);
  const size_t pixels = size_t{targets.size.x} * targets.size.y;
  IRAD_CHECK_OP(linear.size(), ==, pixels * sizeof(glm::vec4));
  IRAD_CHECK_OP(display.size(), ==, pixels * sizeof(glm::u8vec4));
  const std::span values(reinterpret_cast<const glm::vec4*>(linear.data()), pixels);
  PictureFiles files;
  files.paths.push_back(
      writeDisplay(stem, targets.size, {reinterpret_cast<const glm::u8vec4*>(display.data()), pixels}));
  files.paths.push_back(writeLinear(stem, targets.size, values));
  files.bad = findBadPixels(values, targets.size, view.toneMapped);
  return files;
}

}  // namespace irad
