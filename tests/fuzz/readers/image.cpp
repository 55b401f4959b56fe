// Images of textures: PNG, JPEG, WebP.
#include "renderer/scene/gltf_document.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::image(Bytes bytes) {
  const std::optional<ImageHeader> header = readImageHeader(bytes);
  if (!header) throw InputError("is neither PNG, JPEG nor WebP");
  if (const std::string why = imageTooLarge(*header); !why.empty()) throw InputError(why);
  SceneImage image;
  const DecodeResult result = decodeImage(bytes, *header, image);
  if (!result.ok) throw InputError(result.why);
  if (image.width == 0 || image.height == 0 || image.rgba.size() != size_t{4} * image.width * image.height)
    throw Unsound("an image of the wrong size");
}
