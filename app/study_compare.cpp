#include "app/study_compare.h"

#include <fmt/format.h>

#include <cmath>

#include "app/table.h"
#include "gi/picture.h"
#include "gi/study/layers.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"

namespace irad::app {
namespace {

LayeredPicture readCompared(const std::filesystem::path& path) {
  LayeredPicture picture = readLayers(path);
  if (picture.integers)
    for (PictureLayer& layer : picture.layers) tell("warning: {}\n", decodeIntegers(path, layer.pixels));
  return picture;
}

}  // namespace

void comparePictures(const std::filesystem::path& path, const std::filesystem::path& referencePath,
                     const std::optional<std::filesystem::path>& secondPath) {
  const LayeredPicture picture = readCompared(path), reference = readCompared(referencePath);
  std::optional<LayeredPicture> second;
  if (secondPath) second = readCompared(*secondPath);
  const std::optional<Camera> camera = cameraOf(path, picture.subject);
  const auto requireCamera = [&](const std::filesystem::path& of, const LayeredPicture& other) {
    const std::string why = camera ? otherCamera(cameraOf(of, other.subject), *camera) : "";
    if (!why.empty()) throw UsageError(fmt::format("{}: made from another camera: {}", of.string(), why));
  };
  requireCamera(referencePath, reference);
  if (second) requireCamera(*secondPath, *second);
  const std::vector<LayerError> layers = compareLayers(picture, reference, second ? &*second : nullptr);
  std::vector<std::vector<std::string>> rows{{"layer", "mean", "relMSE", "±", "RMSE", "mean error", "of the mean"}};
  for (const LayerError& layer : layers) {
    const PictureMetrics& m = layer.metrics;
    const double mean = m.pixels.meanReference;
    rows.push_back({layer.name, shortNumber(mean), shortNumber(m.blockRelMse),
                    std::isfinite(m.blockRelMseHalf) ? shortNumber(m.blockRelMseHalf) : "-", shortNumber(m.pixels.rmse),
                    fmt::format("{:+.3g}", m.pixels.meanError),
                    mean > 0 ? fmt::format("{:+.2f} %", 100 * m.pixels.meanError / mean) : "-"});
  }
  print("{}", formatTable(rows, {false, true, true, true, true, true, true}));
  if (const std::string finding = bounceFinding(layers); !finding.empty()) print("{}\n", finding);
  print("{}\n", second ? "The references' noise cancels in relMSE; ± is half of a 95 % interval by it."
                       : "The reference's noise is in these figures: --second-reference FILE takes it out of relMSE.");
}

}  // namespace irad::app
