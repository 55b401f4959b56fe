#include "renderer/image_io.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "renderer/error.h"
#include "renderer/output_file.h"

#ifdef IRAD_OIIO
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#endif

namespace irad {
namespace {

std::filesystem::path withExtension(const std::filesystem::path& stem, const char* extension) {
  return std::filesystem::path(stem.string() + extension);  // "camera.view" keeps its dot
}

template <class To, class From>
std::vector<To> firstThree(glm::uvec2 size, std::span<const From> pixels) {
  IRAD_CHECK_OP(pixels.size(), ==, static_cast<size_t>(size.x) * size.y);
  std::vector<To> out;
  out.reserve(pixels.size() * 3);
  for (const From& pixel : pixels) out.insert(out.end(), {pixel.x, pixel.y, pixel.z});
  return out;
}

#ifdef IRAD_OIIO
/// Encodes in memory, so that the only file operations are OutputFile's.
void encode(const std::filesystem::path& path, OIIO::ImageSpec spec, const void* pixels) {
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string(), &memory);
  if (!output) throw WorkError(fmt::format("cannot write {}: {}", path.string(), OIIO::geterror()));
  if (!output->open(path.string(), spec) || !output->write_image(spec.format, pixels) || !output->close())
    throw WorkError(fmt::format("cannot write {}: {}", path.string(), output->geterror()));
  writeFile(path, std::as_bytes(std::span(memory.buffer())));
}
#endif

}  // namespace

void writePfm(const std::filesystem::path& path, glm::uvec2 size, std::span<const glm::vec4> pixels) {
  const std::vector<float> rgb = firstThree<float>(size, pixels);
  OutputFile file(path);
  file.write(fmt::format("PF\n{} {}\n-1.0\n", size.x, size.y));  // a negative scale says little-endian
  const std::span<const float> all(rgb);
  for (uint32_t y = size.y; y-- > 0;)
    file.write(std::as_bytes(all.subspan(size_t{3} * size.x * y, size_t{3} * size.x)));
  file.commit();
}

std::filesystem::path writeLinear(const std::filesystem::path& stem, glm::uvec2 size,
                                  std::span<const glm::vec4> pixels) {
#ifdef IRAD_OIIO
  const std::filesystem::path path = withExtension(stem, ".exr");
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "    :  :     :  :  ");  // Exif's "unknown": else the file would hold the time of writing
  encode(path, spec, firstThree<float>(size, pixels).data());
#else
  const std::filesystem::path path = withExtension(stem, ".pfm");
  writePfm(path, size, pixels);
#endif
  return path;
}

std::filesystem::path writeDisplay(const std::filesystem::path& stem, glm::uvec2 size,
                                   std::span<const glm::u8vec4> pixels) {
  const std::vector<uint8_t> rgb = firstThree<uint8_t>(size, pixels);
#ifdef IRAD_OIIO
  const std::filesystem::path path = withExtension(stem, ".png");
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  encode(path, spec, rgb.data());
#else
  const std::filesystem::path path = withExtension(stem, ".npy");
  writeNpy<uint8_t>(path, {size.y, size.x, 3}, rgb);
#endif
  return path;
}

}  // namespace irad
