#include "ui/captures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/srgb.h"
#include "ui/imgui_layer.h"
#include "ui/session.h"

namespace irad {
namespace {

/// What a thread has made of a file; no pixels: `error` says why.
struct Decoded {
  glm::uvec2 size{0};
  std::vector<glm::u8vec4> pixels;
  std::string error;
};

/// A picture as screens show it, its longer side `most` pixels at most: each of them the mean light of those it covers.
Decoded decodeCapture(const std::filesystem::path& file, uint32_t most) {
  Decoded out;
  try {
    const LinearPicture picture = readLinear(file);
    const glm::uvec2 from = picture.size;
    const double shrink = std::min(1.0, static_cast<double>(most) / std::max(from.x, from.y));
    out.size = glm::max(glm::uvec2(glm::round(glm::dvec2(from) * shrink)), glm::uvec2(1));
    // The light of a code; a code beyond those of 8 bits is none that a capture has.
    const auto light = [](float code) {
      return linearFromSrgb(static_cast<uint8_t>(std::lround(255 * std::clamp(code, 0.0f, 1.0f))));
    };
    for (uint32_t y = 0; y < out.size.y; ++y)
      for (uint32_t x = 0; x < out.size.x; ++x) {
        const glm::uvec2 at(x, y), first = at * from / out.size;
        const glm::uvec2 end = glm::max((at + 1u) * from / out.size, first + 1u);
        glm::vec3 sum(0);
        for (uint32_t v = first.y; v < end.y; ++v)
          for (uint32_t u = first.x; u < end.x; ++u) {
            const glm::vec4& pixel = picture.pixels[size_t{v} * from.x + u];
            sum += glm::vec3(light(pixel.x), light(pixel.y), light(pixel.z));
          }
        sum /= static_cast<float>((end.x - first.x) * (end.y - first.y));
        out.pixels.emplace_back(srgbFromLinear(sum.x), srgbFromLinear(sum.y), srgbFromLinear(sum.z), 255);
      }
  } catch (const Error& error) {
    out.error = error.what();
  }
  return out;
}

Captures::Picture uploadedCapture(Context& context, const Decoded& decoded) {
  Captures::Picture picture{.image = {}, .error = decoded.error};
  if (!decoded.pixels.empty()) picture.image = imageOf(context, "capture", decoded.size, decoded.pixels);
  return picture;
}

/// The second's numbers against the first's; else the reason why there are none.
std::pair<std::optional<PictureMetrics>, std::string> measureCaptures(const std::filesystem::path& first,
                                                                      const std::filesystem::path& second) {
  try {
    const LinearPicture a = readLinear(first), b = readLinear(second);
    if (a.size != b.size)
      return {std::nullopt,
              fmt::format("no numbers: {} x {} pixels, and {} x {}", a.size.x, a.size.y, b.size.x, b.size.y)};
    return {measurePicture(a.size, b.pixels, a.pixels, {}, std::nullopt), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

}  // namespace

void Captures::readList(Session& session, const std::filesystem::path& folder) {
  worker_.clear();
  worker_.add([this, &session, folder, defaults = session.defaults]() -> BackgroundWorker::Result {
    return [this, &session, found = listCaptures(folder, defaults)] {
      list = found;
      listed = true;
      std::map<std::filesystem::path, Picture> known = std::exchange(pictures, {});
      for (const CaptureEntry& entry : list.entries) {
        if (entry.picture.empty()) continue;
        Picture& picture = pictures[entry.picture];
        if (const auto at = known.find(entry.picture); at != known.end() && at->second.image) {
          picture = std::move(at->second);
          continue;
        }
        worker_.add([this, &session, file = entry.picture]() -> BackgroundWorker::Result {
          return [this, &session, file, decoded = decodeCapture(file, kThumbnail)] {
            pictures[file] = uploadedCapture(session.context, decoded);
          };
        });
      }
    };
  });
}

void Captures::readPair(Session& session) {
  pair.emplace();
  pair->of = std::move(*std::exchange(compare, std::nullopt));
  for (const size_t i : {0u, 1u})
    worker_.add([this, &session, i, file = pair->of[i].picture]() -> BackgroundWorker::Result {
      return [this, &session, i, file, decoded = decodeCapture(file, kLarge)] {
        if (pair && pair->of[i].picture == file) pair->pictures[i] = uploadedCapture(session.context, decoded);
      };
    });
  const std::filesystem::path a = pair->of[0].linear, b = pair->of[1].linear;
  if (pair->of[0].view != pair->of[1].view)
    pair->noMetrics = "no numbers: they are of different views";
  else if (a.empty() || b.empty())
    pair->noMetrics = fmt::format("no numbers: {} lacks its {}", pair->of[a.empty() ? 0 : 1].name, linearExtension());
  else
    worker_.add([this, a, b]() -> BackgroundWorker::Result {
      return [this, a, b, measured = measureCaptures(a, b)] {
        if (pair && pair->of[0].linear == a && pair->of[1].linear == b)
          std::tie(pair->metrics, pair->noMetrics) = measured;
      };
    });
}

bool Captures::serve(Session& session, const std::filesystem::path& folder) {
  if (!shown) {
    worker_.clear();
    pictures.clear();
    pair.reset();
    listed = false;
    said.clear();
    return false;
  }
  if (std::exchange(endPair, false)) pair.reset();
  if (std::exchange(read, false)) readList(session, folder);
  if (compare) readPair(session);
  return worker_.take();
}

}  // namespace irad
