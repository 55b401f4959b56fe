// Pictures to files: EXR (linear, fp32) and PNG (display) with OpenImageIO; .pfm and .npy in builds without it. All
// appear whole or not at all (renderer/base/output_file.h), and hold no date, so two runs give the same bytes.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace irad {

/// Light before exposure and tone curve, top row first; alpha is left out. Writes stem.exr (three float channels R G B,
/// ZIP), or stem.pfm; returns the file's path.
std::filesystem::path writeLinear(const std::filesystem::path& stem, glm::uvec2 size,
                                  std::span<const glm::vec4> pixels);
/// A picture of several layers, which share their size.
struct PictureLayer {
  std::string name;  ///< "" for the first, which readLinear reads
  std::vector<glm::vec4> pixels;
};
/// What a file says that its picture shows; empty: it does not say.
struct PictureSubject {
  std::string camera;  ///< JSON: renderer/scene/camera_json.h
  std::string view;    ///< name of the first layer's view
};
/// How files of layers end: ".exr", or ".pfm" in builds without OpenImageIO.
const char* linearExtension();
/// stem.exr with the channels R G B of the first layer and NAME.R NAME.G NAME.B of each other, as OpenEXR names layers;
/// or stem.pfm and stem.NAME.pfm. An .exr keeps the subject in its header (iradCamera, iradView), a .pfm has no room
/// for it. Returns the files' paths.
std::vector<std::filesystem::path> writeLayers(const std::filesystem::path& stem, glm::uvec2 size,
                                               std::span<const PictureLayer> layers,
                                               const PictureSubject& subject = {});
/// What the screen shows: sRGB-encoded bytes, alpha left out. Writes stem.png, or stem.npy of shape (height, width, 3).
std::filesystem::path writeDisplay(const std::filesystem::path& stem, glm::uvec2 size,
                                   std::span<const glm::u8vec4> pixels);

/// The typeface of panels and legends, where Debian's packages put it, and the one to fall back on.
inline constexpr std::array kTextFonts{"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                                       "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
/// Whether this build draws text.
bool canDrawText();
enum class TextAlign { Left, Middle, Right };
/// Text, UTF-8, over a display picture, top row first: `at` its upper left, middle or right point, `height` in pixels.
/// WorkError without OpenImageIO, or where there is none of kTextFonts.
void drawText(glm::uvec2 size, std::span<glm::u8vec4> pixels, glm::ivec2 at, TextAlign align, int height,
              const std::string& text, glm::u8vec4 color);

/// Portable float map: "PF", little-endian, bottom row first. In every build.
void writePfm(const std::filesystem::path& path, glm::uvec2 size, std::span<const glm::vec4> pixels);

struct LinearPicture {
  glm::uvec2 size{0};
  std::vector<glm::vec4> pixels;  ///< top row first; alpha 1
  bool integers = false;          ///< the file holds integers, which end at white
  PictureSubject subject{};       ///< of an .exr by writeLayers()
};
/// A little-endian "PF" with its pixels, in every build; a scale is left aside. InputError where that fails.
LinearPicture readPfm(const std::filesystem::path& path);
/// A picture to compare with: the channels R, G, B of an EXR or of its first layer that has them, the first three of
/// any other format that OpenImageIO reads; in builds without it .pfm alone. InputError where that fails.
LinearPicture readLinear(const std::filesystem::path& path);
/// What writeLayers() wrote, from the path of its first file: all layers of an .exr that have the channels R, G and B,
/// the plain one first; beside stem.pfm all stem.NAME.pfm of its size. InputError where that fails.
struct LayeredPicture {
  glm::uvec2 size{0};
  std::vector<PictureLayer> layers;
  bool integers = false;  ///< as of a LinearPicture
  PictureSubject subject{};
};
LayeredPicture readLayers(const std::filesystem::path& path);

}  // namespace irad
