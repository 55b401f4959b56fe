#include "gi/study/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"

namespace irad {
namespace {

const std::vector<glm::vec4>* pixelsNamed(const LayeredPicture& picture, const std::string& name) {
  const auto found = std::ranges::find(picture.layers, name, &PictureLayer::name);
  return found == picture.layers.end() ? nullptr : &found->pixels;
}

/// Of the mean of two pictures, from that of each; empty where one has none.
std::vector<glm::vec4> errorOfMean(const LayeredPicture& a, const LayeredPicture& b, const std::string& layer) {
  const std::string name = layer.empty() ? "error" : layer + ".error";
  const std::vector<glm::vec4>*first = pixelsNamed(a, name), *second = pixelsNamed(b, name);
  std::vector<glm::vec4> out;
  if (!first || !second) return out;
  for (size_t i = 0; i < first->size(); ++i) {
    const glm::vec4 &e = (*first)[i], &f = (*second)[i];
    out.push_back(0.5f * glm::sqrt(e * e + f * f));
  }
  return out;
}

}  // namespace

std::vector<LayerError> compareLayers(const LayeredPicture& picture, const LayeredPicture& reference,
                                      const LayeredPicture* second) {
  for (const LayeredPicture* other : {&reference, second})
    if (other && other->size != picture.size)
      throw UsageError(fmt::format("pictures of {} x {} and of {} x {} pixels", picture.size.x, picture.size.y,
                                   other->size.x, other->size.y));
  std::string view = picture.subject.view;
  bool firstIsShared = true;
  for (const LayeredPicture* other : {&reference, second}) {
    if (!other || other->subject.view.empty()) continue;
    if (view.empty()) view = other->subject.view;
    firstIsShared = firstIsShared && view == other->subject.view;
  }
  std::vector<LayerError> out;
  for (const PictureLayer& layer : picture.layers) {
    if (layer.name == "error" || layer.name.ends_with(".error") || (layer.name.empty() && !firstIsShared)) continue;
    const std::vector<glm::vec4>* r = pixelsNamed(reference, layer.name);
    const std::vector<glm::vec4>* s = second ? pixelsNamed(*second, layer.name) : nullptr;
    if (!r || (second && !s)) continue;
    const std::vector<glm::vec4> none;
    const std::vector<glm::vec4> error = second ? errorOfMean(reference, *second, layer.name) : none;
    const std::string name = !layer.name.empty() ? layer.name : view.empty() ? "first" : view;
    out.push_back({name, measurePicture(picture.size, layer.pixels, *r, s ? *s : none, std::nullopt, error)});
  }
  if (out.empty()) throw UsageError("the pictures have no layer in common");
  return out;
}

std::string bounceFinding(const std::vector<LayerError>& layers) {
  const LayerError *lit = nullptr, *most = nullptr;
  double rest = 0;
  size_t bounces = 0;
  for (const LayerError& layer : layers) {
    if (layer.name == "lit") lit = &layer, rest += layer.metrics.pixels.meanError;
    if (!layer.name.starts_with("bounce.")) continue;
    ++bounces;
    rest -= layer.metrics.pixels.meanError;
    if (!most || std::abs(layer.metrics.pixels.meanError) > std::abs(most->metrics.pixels.meanError)) most = &layer;
  }
  if (!lit || !most) return "";
  return fmt::format(
      "Of the mean error of lit, {:+.2g} W/(m^2 sr), {} has most among the {} bounces, {:+.2g}; {:+.2g} is of more "
      "reflections than they have.",
      lit->metrics.pixels.meanError, most->name, bounces, most->metrics.pixels.meanError, rest);
}

}  // namespace irad
