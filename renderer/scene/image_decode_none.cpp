// Without OpenImageIO no image format can be read: scenes come as .irscene caches with decoded images.
#include "renderer/scene/gltf_document.h"

#ifndef IRAD_OIIO
namespace irad {

DecodeResult decodeImage(std::span<const uint8_t>, const ImageHeader&, SceneImage&) {
  return {false, "this build has no image decoder (use an .irscene cache written by the full build)"};
}

}  // namespace irad
#endif
