#include "renderer/base/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

#ifdef IRAD_OIIO
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
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

const char* const kCameraAttribute = "iradCamera";
const char* const kViewAttribute = "iradView";

OIIO::ImageSpec exrSpec(glm::uvec2 size, size_t channels) {
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), static_cast<int>(channels),
                       OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "    :  :     :  :  ");  // Exif's "unknown": else the file would hold the time of writing
  return spec;
}

/// Where R, G and B are among the channels: by their plain names, else those of the first layer that has all three,
/// else the first three (or the only one, as grey).
std::array<int, 3> colorChannels(const OIIO::ImageSpec& spec) {
  std::vector<std::string> names{"R"};
  names.insert(names.end(), spec.channelnames.begin(), spec.channelnames.end());
  for (const std::string& red : names) {
    if (red != "R" && !red.ends_with(".R")) continue;
    const std::string layer = red.substr(0, red.size() - 1);
    const std::array<int, 3> found{spec.channelindex(red), spec.channelindex(layer + "G"),
                                   spec.channelindex(layer + "B")};
    if (found[0] >= 0 && found[1] >= 0 && found[2] >= 0) return found;
  }
  return spec.nchannels >= 3 ? std::array{0, 1, 2} : std::array{0, 0, 0};
}

/// OpenEXR makes room for as many bytes as an attribute of the header says, before it looks for them: gigabytes where a
/// damaged file says so.
void checkExrHeader(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<uint8_t, 8> start{};  // magic number, version and flags
  if (!in.read(reinterpret_cast<char*>(start.data()), start.size()) || start[0] != 0x76 || start[1] != 0x2f ||
      start[2] != 0x31 || start[3] != 0x01)
    return;
  const bool severalParts = (start[5] & 0x10) != 0;
  const uint64_t bytes = std::filesystem::file_size(path);
  for (std::string name, type; std::getline(in, name, '\0');) {
    if (name.empty()) {  // a header's end
      if (!severalParts || in.peek() == 0) return;
      continue;
    }
    std::array<uint8_t, 4> size{};
    if (!std::getline(in, type, '\0') || !in.read(reinterpret_cast<char*>(size.data()), size.size())) return;
    const uint64_t length = size[0] | size[1] << 8 | size[2] << 16 | uint64_t{size[3]} << 24;
    if (length > bytes - static_cast<uint64_t>(in.tellg()))
      throw InputError(
          fmt::format("{}: ends before an attribute of its header does, which has {} bytes", path.string(), length));
    in.seekg(static_cast<std::streamoff>(length), std::ios::cur);
  }
}
#endif

constexpr uint64_t kMostPixels = uint64_t{1} << 28;

void checkSize(const std::filesystem::path& path, int64_t width, int64_t height) {
  if (width < 1 || height < 1 || static_cast<uint64_t>(width) > kMostPixels / static_cast<uint64_t>(height))
    throw InputError(fmt::format("{}: {} x {} pixels; at most 2^28 are read", path.string(), width, height));
}

}  // namespace

LinearPicture readPfm(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string kind;
  int64_t width = 0, height = 0;
  double scale = 0;
  if (!(in >> kind >> width >> height >> scale) || kind != "PF" || !(scale < 0))
    throw InputError(fmt::format("{}: not a little-endian colour .pfm", path.string()));
  checkSize(path, width, height);
  in.get();  // the one white space after the scale
  // Before there is memory for what a few bytes may promise.
  const std::streamoff start = in.tellg(), end = in.seekg(0, std::ios::end).tellg();
  if (end - start < 12 * width * height)
    throw InputError(fmt::format("{}: ends before its {} x {} pixels do", path.string(), width, height));
  in.seekg(start);
  LinearPicture picture{{static_cast<uint32_t>(width), static_cast<uint32_t>(height)}, {}};
  picture.pixels.resize(static_cast<size_t>(width * height));
  for (int64_t y = height; y-- > 0;)
    for (int64_t x = 0; x < width; ++x) {
      std::array<float, 3> rgb;
      if (!in.read(reinterpret_cast<char*>(rgb.data()), sizeof rgb))
        throw InputError(fmt::format("{}: cannot be read", path.string()));
      picture.pixels[static_cast<size_t>(y * width + x)] = {rgb[0], rgb[1], rgb[2], 1};
    }
  return picture;
}

#ifdef IRAD_OIIO
namespace {

/// Opened, and found to be a picture of a size that can be read.
std::unique_ptr<OIIO::ImageInput> openPicture(const std::filesystem::path& path) {
  checkExrHeader(path);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
  if (!input) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), OIIO::geterror()));
  const OIIO::ImageSpec spec = input->spec();
  checkSize(path, spec.width, spec.height);
  // Before there is memory for what a few bytes may promise: large pictures take more than a byte for 1,024 pixels.
  constexpr uint64_t kLarge = uint64_t{1} << 20, kMostPixelsPerByte = 1024;
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  if (pixels > kLarge && pixels / kMostPixelsPerByte > std::filesystem::file_size(path))
    throw InputError(fmt::format("{}: ends before its {} x {} pixels do", path.string(), spec.width, spec.height));
  if (spec.depth > 1 || spec.nchannels < 1)
    throw InputError(fmt::format("{}: {} channels, {} deep: not a picture", path.string(), spec.nchannels, spec.depth));
  return input;
}

std::vector<glm::vec4> readChannels(const std::filesystem::path& path, OIIO::ImageInput& input,
                                    const std::array<int, 3>& channels) {
  std::vector<glm::vec4> pixels(static_cast<size_t>(input.spec().width) * static_cast<size_t>(input.spec().height),
                                glm::vec4(1));
  for (int c = 0; c < 3; ++c)
    if (!input.read_image(0, 0, channels[c], channels[c] + 1, OIIO::TypeDesc::FLOAT, &pixels[0][c], sizeof(glm::vec4)))
      throw InputError(fmt::format("{}: cannot be read: {}", path.string(), input.geterror()));
  return pixels;
}

glm::uvec2 exrSizeOf(const OIIO::ImageSpec& spec) {
  return {static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height)};
}
PictureSubject exrSubjectOf(const OIIO::ImageSpec& spec) {
  return {std::string(spec.get_string_attribute(kCameraAttribute)),
          std::string(spec.get_string_attribute(kViewAttribute))};
}

}  // namespace
#endif

LinearPicture readLinear(const std::filesystem::path& path) {
#ifdef IRAD_OIIO
  const std::unique_ptr<OIIO::ImageInput> input = openPicture(path);
  const OIIO::ImageSpec spec = input->spec();
  return {exrSizeOf(spec), readChannels(path, *input, colorChannels(spec)), !spec.format.is_floating_point(),
          exrSubjectOf(spec)};
#else
  if (path.extension() != ".pfm")
    throw InputError(fmt::format("{}: this build reads no pictures but .pfm", path.string()));
  return readPfm(path);
#endif
}

LayeredPicture readLayers(const std::filesystem::path& path) {
  LayeredPicture out;
#ifdef IRAD_OIIO
  if (path.extension() != ".pfm") {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path);
    const OIIO::ImageSpec spec = input->spec();
    out.size = exrSizeOf(spec), out.subject = exrSubjectOf(spec);
    out.integers = !spec.format.is_floating_point();
    out.layers.push_back({"", readChannels(path, *input, colorChannels(spec))});
    for (const std::string& red : spec.channelnames) {
      if (!red.ends_with(".R")) continue;
      const std::string name = red.substr(0, red.size() - 2);
      const std::array<int, 3> channels{spec.channelindex(red), spec.channelindex(name + ".G"),
                                        spec.channelindex(name + ".B")};
      if (channels[1] >= 0 && channels[2] >= 0) out.layers.push_back({name, readChannels(path, *input, channels)});
    }
    return out;
  }
#endif
  LinearPicture first = readLinear(path);
  out.size = first.size;
  out.layers.push_back({"", std::move(first.pixels)});
  const std::string prefix = path.stem().string() + ".";
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::absolute(path).parent_path()))
    if (entry.path().extension() == ".pfm" && entry.path().stem().string().starts_with(prefix))
      others.push_back(entry.path());
  std::ranges::sort(others);
  for (const std::filesystem::path& other : others)
    if (LinearPicture layer = readPfm(other); layer.size == out.size)
      out.layers.push_back({other.stem().string().substr(prefix.size()), std::move(layer.pixels)});
  return out;
}

bool canDrawText() {
#ifdef IRAD_OIIO
  return true;
#else
  return false;
#endif
}

void drawText([[maybe_unused]] glm::uvec2 size, [[maybe_unused]] std::span<glm::u8vec4> pixels,
              [[maybe_unused]] glm::ivec2 at, [[maybe_unused]] TextAlign align, [[maybe_unused]] int height,
              [[maybe_unused]] const std::string& text, [[maybe_unused]] glm::u8vec4 color) {
#ifdef IRAD_OIIO
  if (text.empty()) return;
  IRAD_CHECK_OP(pixels.size(), ==, static_cast<size_t>(size.x) * size.y);
  const auto font =
      std::find_if(kTextFonts.begin(), kTextFonts.end(), [](const char* f) { return std::filesystem::exists(f); });
  if (font == kTextFonts.end())
    throw WorkError(fmt::format("text cannot be drawn: there is neither {} nor {}", kTextFonts[0], kTextFonts[1]));
  using Align = OIIO::ImageBufAlgo::TextAlignX;
  const Align x = align == TextAlign::Left ? Align::Left : align == TextAlign::Middle ? Align::Center : Align::Right;
  OIIO::ImageBuf picture(OIIO::ImageSpec(static_cast<int>(size.x), static_cast<int>(size.y), 4, OIIO::TypeDesc::UINT8),
                         pixels.data());
  const glm::vec4 ink = glm::vec4(color) / 255.0f;
  if (!OIIO::ImageBufAlgo::render_text(picture, at.x, at.y, text, height, *font, {ink.x, ink.y, ink.z, ink.w}, x,
                                       OIIO::ImageBufAlgo::TextAlignY::Top, /*shadow=*/0, {}, /*nthreads=*/1))
    throw WorkError(fmt::format("text cannot be drawn: {}", picture.geterror()));
#else
  throw WorkError("text cannot be drawn: this build has no OpenImageIO");
#endif
}

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
  encode(path, exrSpec(size, 3), firstThree<float>(size, pixels).data());
#else
  const std::filesystem::path path = withExtension(stem, ".pfm");
  writePfm(path, size, pixels);
#endif
  return path;
}

const char* linearExtension() {
#ifdef IRAD_OIIO
  return ".exr";
#else
  return ".pfm";
#endif
}

std::vector<std::filesystem::path> writeLayers(const std::filesystem::path& stem, glm::uvec2 size,
                                               std::span<const PictureLayer> layers,
                                               [[maybe_unused]] const PictureSubject& subject) {
#ifdef IRAD_OIIO
  const std::filesystem::path path = withExtension(stem, ".exr");
  const size_t channels = 3 * layers.size();
  OIIO::ImageSpec spec = exrSpec(size, channels);
  if (!subject.camera.empty()) spec.attribute(kCameraAttribute, subject.camera);
  if (!subject.view.empty()) spec.attribute(kViewAttribute, subject.view);
  spec.channelnames.clear();
  std::vector<float> values(size_t{size.x} * size.y * channels);
  for (size_t l = 0; l < layers.size(); ++l) {
    IRAD_CHECK_OP(layers[l].pixels.size(), ==, size_t{size.x} * size.y);
    for (int c = 0; c < 3; ++c) {
      spec.channelnames.push_back((layers[l].name.empty() ? "" : layers[l].name + ".") + "RGB"[c]);
      for (size_t i = 0; i < layers[l].pixels.size(); ++i)
        values[i * channels + 3 * l + static_cast<size_t>(c)] = layers[l].pixels[i][c];
    }
  }
  encode(path, spec, values.data());
  return {path};
#else
  std::vector<std::filesystem::path> paths;
  for (const PictureLayer& layer : layers) {
    paths.push_back(withExtension(stem, (layer.name.empty() ? ".pfm" : "." + layer.name + ".pfm").c_str()));
    writePfm(paths.back(), size, layer.pixels);
  }
  return paths;
#endif
}

std::filesystem::path writeDisplay(const std::filesystem::path& stem, glm::uvec2 size,
                                   std::span<const glm::u8vec4> pixels) {
  const std::vector<uint8_t> rgb = firstThree<uint8_t>(size, pixels);
#ifdef IRAD_OIIO
  const std::filesystem::path path = withExtension(stem, ".png");
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", 4);  // 8 % larger than by the default, 6, in two fifths of the time
  encode(path, spec, rgb.data());
#else
  const std::filesystem::path path = withExtension(stem, ".npy");
  writeNpy<uint8_t>(path, {size.y, size.x, 3}, rgb);
#endif
  return path;
}

}  // namespace irad
