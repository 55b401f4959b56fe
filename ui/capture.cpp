#include "ui/capture.h"

#include <fmt/format.h>

#include "renderer/error.h"
#include "renderer/image_io.h"
#include "renderer/output_file.h"

namespace irad {

void captureView(Context& context, Session& session, const std::filesystem::path& folder) {
  if (!session.built || !session.targets.display) return;
  const char* view = "view";
  for (const ViewInfo& info : views())
    if (info.view == session.view) view = info.name;
  try {
    makeFolder(folder);
    std::filesystem::path stem;
    for (int number = 1;; ++number) {
      stem = folder / fmt::format("{}.{}.{:03}", session.pipeline->scene().path.stem().string(), view, number);
      if (!std::filesystem::exists(stem.string() + ".png")) break;
    }
    const std::vector<std::byte> display = download(context, session.targets.display);
    const std::vector<std::byte> linear = download(context, session.targets.linear);
    const glm::uvec2 size = session.targets.size;
    const size_t pixels = static_cast<size_t>(size.x) * size.y;
    const auto png = writeDisplay(stem.string(), size, {reinterpret_cast<const glm::u8vec4*>(display.data()), pixels});
    const auto exr = writeLinear(stem.string(), size, {reinterpret_cast<const glm::vec4*>(linear.data()), pixels});
    session.note(fmt::format("Saved {} and {}", png.string(), exr.filename().string()));
  } catch (const Error& error) {
    session.error(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    session.error(error.what());
  }
}

void saveScreenshot(Context& context, const Image& image, const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = download(context, image);
  std::filesystem::path stem = file;
  stem.replace_extension();
  writeDisplay(stem, {image.desc.width, image.desc.height},
               {reinterpret_cast<const glm::u8vec4*>(bytes.data()), bytes.size() / sizeof(glm::u8vec4)});
}

}  // namespace irad
