#include "gi/study/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "gi/study/plot.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// The bytes of an .npy file's picture, height x width x 3, as a .bmp, which browsers show.
std::string bitmapOf(const std::string& npy, glm::uvec2 size) {
  const size_t row = size_t{3} * size.x, padded = (row + 3) / 4 * 4;
  if (npy.size() < row * size.y) return "";
  std::string out = "BM";
  const auto put = [&](uint32_t value, size_t bytes) {
    for (size_t i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
  };
  put(static_cast<uint32_t>(54 + padded * size.y), 4), put(0, 4), put(54, 4);  // the file's size, where pixels begin
  put(40, 4), put(size.x, 4), put(size.y, 4), put(1, 2), put(24, 2);           // one plane, bits per pixel
  for (size_t i = 0; i < 6; ++i) put(0, 4);                                    // not compressed, no palette
  const size_t head = npy.size() - row * size.y;
  for (size_t y = size.y; y-- > 0;) {
    for (size_t x = 0; x < size.x; ++x)
      for (size_t c = 3; c-- > 0;) out += npy[head + y * row + 3 * x + c];
    out.append(padded - row, '\0');
  }
  return out;
}

/// As a data URI; empty where there is none.
std::string pictureUri(const std::filesystem::path& stem, glm::uvec2 size) {
  if (const std::string png = readFile(stem.string() + ".png"); !png.empty())
    return "data:image/png;base64," + base64(png);
  const std::string bitmap = bitmapOf(readFile(stem.string() + ".npy"), size);
  return bitmap.empty() ? "" : "data:image/bmp;base64," + base64(bitmap);
}

const char* const kStyle =
    "body{font:15px/1.5 Inter,'DejaVu Sans',Helvetica,Arial,sans-serif;color:#222;background:#fff;max-width:1180px;"
    "margin:32px auto;padding:0 24px}h1{font-size:26px}h2{font-size:20px;margin-top:36px}h3{font-size:16px}"
    "table{border-collapse:collapse;font-size:13px;display:block;overflow-x:auto}th,td{padding:4px 9px;"
    "border-bottom:1px solid #ddd;text-align:right;white-space:nowrap}th{border-bottom:2px solid #888}.name{text-align:"
    "left}tr.front{background:#eaf3fa}.crops{display:flex;flex-wrap:wrap;gap:16px}figure{margin:0;max-width:256px}"
    "figcaption{font-size:13px;color:#444}.finding{max-width:820px}svg{max-width:100%}"
    ".said td{white-space:normal;text-align:left;vertical-align:top;min-width:90px}.said .here{min-width:380px}"
    ".agrees{color:#00695c}.disagrees{color:#b3261e}.open{color:#666}.answered{color:#0057a8}";

}  // namespace

std::string htmlPage(const std::string& title, const std::vector<std::string>& facts, const std::string& body) {
  const std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>"
      "<meta name=\"viewport\" content=\"width=device-width\"><style>{1}</style></head>\n<body>\n"
      "<h1>{0}</h1>\n",
      escapeXml(title), kStyle);
  return out + htmlList(facts) + body + "</body>\n</html>\n";
}

std::string htmlFinding(const std::string& words) {
  return fmt::format("<p class=\"finding\">{}</p>\n", escapeXml(words));
}

std::string htmlList(const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string out = "<ul>\n";
  for (const std::string& item : items) out += fmt::format("<li>{}</li>\n", escapeXml(item));
  return out + "</ul>\n";
}

std::string htmlFigure(const std::filesystem::path& stem, const PicturePart& part, const std::string& caption) {
  const std::string uri = part.size.x > 0 ? pictureUri(stem, part.picture) : "";
  if (uri.empty()) return "";
  const uint32_t zoom = std::max(2u, 224 / part.size.x);
  return fmt::format(
      "<figure><svg viewBox=\"{} {} {} {}\" width=\"{}\" height=\"{}\" role=\"img\"><image width=\"{}\" height=\"{}\" "
      "href=\"{}\" style=\"image-rendering:pixelated\"/></svg><figcaption>{}</figcaption></figure>\n",
      part.at.x, part.at.y, part.size.x, part.size.y, zoom * part.size.x, zoom * part.size.y, part.picture.x,
      part.picture.y, uri, escapeXml(caption));
}

}  // namespace irad
