// Pictures of skies: .pfm by the reader that every build has, .hdr and .exr where OpenImageIO reads them.
#include <cmath>
#include <cstring>

#include "renderer/base/image_io.h"
#include "renderer/scene/sky_image.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::sky(Bytes bytes) {
  const auto begins = [&](const char* magic) {
    return bytes.size() >= std::strlen(magic) && std::memcmp(bytes.data(), magic, std::strlen(magic)) == 0;
  };
  const bool pfm = begins("PF");
  const std::filesystem::path path = scratchFile(pfm ? "sky.pfm" : begins("#?") ? "sky.hdr" : "sky.exr", bytes);
  const SkyImage image = skyOf(path, pfm ? readPfm(path) : readLinear(path));
  for (const auto& sky : {image.whole, image.texels}) {
    if (sky->size.x == 0 || sky->size.x > kMostSkyWidth || sky->size.x != 2 * sky->size.y ||
        sky->texels.size() != size_t{sky->size.x} * sky->size.y)
      throw Unsound("a sky of the wrong size");
    for (const glm::vec3& t : sky->texels)
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(t[c]) || t[c] < 0) throw Unsound("a texel that is no light");
  }
  if (image.sun)
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(image.sun->towards[c]) || !std::isfinite(image.sun->irradiance[c]) ||
          image.sun->irradiance[c] < 0)
        throw Unsound("a sun that is no light");
}
