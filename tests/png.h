// PNG files for comparisons with the screen.
#pragma once

#include <OpenImageIO/imageio.h>

#include "tests/virtual_screen.h"

namespace irad::test {

inline ScreenPart readPng(const std::filesystem::path& path) {
  const auto in = OIIO::ImageInput::open(path.string());
  if (!in) throw std::runtime_error("cannot read " + path.string() + ": " + OIIO::geterror());
  ScreenPart picture{in->spec().width, in->spec().height, {}};
  picture.rgb.resize(3 * static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
  in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.rgb.data());
  return picture;
}

inline void writePng(const std::filesystem::path& path, const ScreenPart& picture) {
  const OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  const auto out = OIIO::ImageOutput::create(path.string());
  if (!out || !out->open(path.string(), spec) || !out->write_image(OIIO::TypeDesc::UINT8, picture.rgb.data()) ||
      !out->close())
    throw std::runtime_error("cannot write " + path.string() + ": " + OIIO::geterror());
}

}  // namespace irad::test
