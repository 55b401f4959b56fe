// Image decoding by OpenImageIO: from memory, straight alpha, 8 bits per channel, RGBA.
#ifdef IRAD_OIIO
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fstream>
#include <mutex>

#include "renderer/scene/gltf_document.h"

namespace irad {
namespace {

/// OpenImageIO's WebP reader opens files only.
struct TemporaryFile {
  explicit TemporaryFile(std::span<const uint8_t> bytes)
      : path(std::filesystem::temp_directory_path() / OIIO::Filesystem::unique_path("irad-%%%%-%%%%-%%%%.webp")) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  std::filesystem::path path;
};

}  // namespace

DecodeResult decodeImage(std::span<const uint8_t> bytes, const ImageHeader& header, SceneImage& out) {
  auto input = OIIO::ImageInput::create(header.format);
  if (!input) return {false, fmt::format("cannot be read: OpenImageIO has no {} reader", header.format)};
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<TemporaryFile> file;
  std::string name = std::string("memory.") + header.format;
  if (input->supports("ioproxy")) {
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  } else {
    file = std::make_unique<TemporaryFile>(bytes);
    name = file->path.string();
  }
  const auto problem = [&] { return DecodeResult{false, fmt::format("cannot be decoded ({})", input->geterror())}; };
  {
    // One at a time: OpenImageIO 2.4's ICC reader fills its tables at first use without a lock.
    static std::mutex opening;
    const std::lock_guard lock(opening);
    if (!input->open(name, spec, config)) return problem();
  }
  if (spec.width != static_cast<int>(header.width) || spec.height != static_cast<int>(header.height) ||
      spec.depth > 1 || spec.nchannels < 1)
    return {false, fmt::format("states {} x {} pixels, but holds {} x {} x {} of {} channels", header.width,
                               header.height, spec.width, spec.height, spec.depth, spec.nchannels)};
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  const int channels = std::min(spec.nchannels, 4);
  std::vector<uint8_t> raw(pixels * static_cast<uint64_t>(channels));
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, raw.data())) return problem();
  out.width = static_cast<uint32_t>(spec.width);
  out.height = static_cast<uint32_t>(spec.height);
  if (channels == 4) {
    out.rgba = std::move(raw);
    return {true, ""};
  }
  out.rgba.resize(pixels * 4);
  for (uint64_t i = 0; i < pixels; ++i) {
    const uint8_t* from = raw.data() + i * static_cast<uint64_t>(channels);
    uint8_t* to = out.rgba.data() + i * 4;
    // One channel is grey, two are grey and alpha.
    for (int c = 0; c < 3; ++c) to[c] = from[channels >= 3 ? c : 0];
    to[3] = channels == 2 ? from[1] : 255;
  }
  return {true, ""};
}

}  // namespace irad
#endif
