// Image decoding by OpenImageIO: from memory, straight alpha, 8 bits per channel, RGBA.
#ifdef IRAD_OIIO
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <fstream>
#include <mutex>

#include "renderer/scene/gltf_document.h"

namespace irad {
namespace {

/// The format by its first bytes: a file's MIME type and name may lie.
const char* sniff(std::span<const uint8_t> bytes) {
  const auto starts = [&](size_t at, std::string_view magic) {
    return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
  };
  if (starts(0, "\x89PNG\r\n\x1a\n")) return "png";
  if (starts(0, "\xff\xd8\xff")) return "jpeg";
  if (starts(0, "RIFF") && starts(8, "WEBP")) return "webp";
  return nullptr;
}

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

DecodeResult decodeImage(std::span<const uint8_t> bytes, uint64_t maxBytes, SceneImage& out) {
  const char* format = sniff(bytes);
  if (format == nullptr) return {false, "is neither PNG, JPEG nor WebP"};
  auto input = OIIO::ImageInput::create(format);
  if (!input) return {false, fmt::format("cannot be read: OpenImageIO has no {} reader", format)};
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<TemporaryFile> file;
  std::string name = std::string("memory.") + format;
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
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
      spec.width > static_cast<int>(gltf::kMaxImageExtent) || spec.height > static_cast<int>(gltf::kMaxImageExtent))
    return {false, fmt::format("is {} x {} pixels; at most {} a side are accepted", spec.width, spec.height,
                               gltf::kMaxImageExtent)};
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  if (pixels * 4 > maxBytes)
    return {false, fmt::format("needs {} MiB, more than is left for images", pixels * 4 >> 20)};
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
