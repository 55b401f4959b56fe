#include "gi/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/preetham.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/record.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/emitters.h"

namespace irad {
namespace {

/// Samples of a bin in each direction.
constexpr uint32_t kBinSamples = 16;

glm::vec3 towardsSun(const SkySettings& s, const SkyInputs& inputs) {
  if (s.coupled && inputs.sun) return inputs.sun->towards;
  const float elevation = glm::radians(s.elevation), azimuth = glm::radians(s.azimuth);
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), -std::cos(elevation) * std::cos(azimuth)};
}

/// Puts the ground below the horizon.
void lay(const SkyGround& ground, const glm::vec3& towardsSun, SkyTexels& sky) {
  const glm::dvec3 irradiance = irradianceFromAbove(sky) + glm::dvec3(ground.sun) * std::max(0.0, double{towardsSun.y});
  std::fill(sky.texels.begin() + static_cast<std::ptrdiff_t>(sky.texels.size() / 2), sky.texels.end(),
            glm::vec3(irradiance * double{ground.albedo} / std::numbers::pi));
}

/// What takes kcd/m^2 of Preetham's sky to the unit of a sun, so that the two are to each other as in the open.
float asBrightAs(const SkySun& sun, float turbidity) {
  const double fromZenith = std::acos(std::clamp(double{sun.towards.y}, -1.0, 1.0));
  return luminance(sun.irradiance) / static_cast<float>(preethamSun(turbidity, fromZenith));
}

glm::vec3 mostOf(const SkyTexels& sky) {
  glm::vec3 most(0);
  for (const glm::vec3& t : sky.texels) most = glm::max(most, t);
  return most;
}

}  // namespace

glm::vec3 Sky::radiance(const glm::vec3& direction) const {
  if (!texels) return glm::vec3(0);
  const SkyTaps taps = skyTaps(direction, texels->size, turn);
  glm::vec3 sum(0);
  for (int i = 0; i < 4; ++i) sum += taps.weight[i] * texels->texels[taps.texel[i]];
  return sum * scale;
}

float Sky::largest() const {
  const glm::vec3 l = most * scale;
  return std::max({l.x, l.y, l.z});
}

SkyInputs skyInputs(const Scene& scene, std::span<const Light> lights) {
  SkyInputs in{.image = scene.sky.get(), .sun = {}};
  for (const Light& light : lights)
    if (lightHas(static_cast<uint32_t>(light.type), LIGHT_DISTANT) && light.on && light.intensity > 0 && !in.sun)
      in.sun = SkySun{-light.direction, light.intensity * light.color};
  return in;
}

Sky makeSky(const SkySettings& s, const SkyInputs& inputs, const Sky* before) {
  Sky sky;
  sky.turn = s.rotation / 360;
  sky.scale = glm::vec3(s.intensity);
  switch (s.source) {
    case SkySource::none:
      return {};
    case SkySource::constant: {
      static const auto white = std::make_shared<const SkyTexels>();
      sky.texels = white;
      sky.scale *= glm::vec3(s.red, s.green, s.blue);
      break;
    }
    case SkySource::image:
      if (inputs.image == nullptr) return {};
      sky.texels = inputs.image->texels;
      sky.whole = inputs.image->whole;
      if (const std::optional<SkySun>& sun = inputs.image->sun; sun && s.intensity > 0) {
        const float angle = glm::radians(s.rotation), c = std::cos(angle), n = std::sin(angle);
        const glm::vec3& d = sun->towards;
        sky.sun = SkySun{{c * d.x + n * d.z, d.y, c * d.z - n * d.x}, s.intensity * sun->irradiance};
      }
      break;
    case SkySource::preetham: {
      const bool coupled = s.coupled && inputs.sun;
      const float unit = coupled ? asBrightAs(*inputs.sun, s.turbidity) : 1;
      sky.scale *= unit;
      sky.model = glm::vec4(towardsSun(s, inputs), s.turbidity);
      sky.ground = {s.ground, coupled && unit > 0 ? inputs.sun->irradiance / unit : glm::vec3(0)};
      const bool same = before != nullptr && before->model == sky.model;
      if (same && before->ground == sky.ground) {
        sky.texels = before->texels;
        break;
      }
      SkyTexels texels = same ? *before->texels : preethamSky(s.turbidity, glm::vec3(sky.model));
      lay(sky.ground, glm::vec3(sky.model), texels);
      sky.texels = std::make_shared<const SkyTexels>(std::move(texels));
      break;
    }
  }
  if (!sky.whole) sky.whole = sky.texels;
  sky.most = before != nullptr && before->texels == sky.texels ? before->most : mostOf(*sky.texels);
  return sky;
}

std::vector<glm::vec4> skyBins(const Sky& sky, uint32_t edge) {
  std::vector<glm::vec4> bins(6 * size_t{edge} * edge, glm::vec4(0));
  for (uint32_t bin = 0; bin < bins.size(); ++bin) {
    glm::dvec3 sum(0);
    double solidAngle = 0;
    for (uint32_t i = 0; i < kBinSamples * kBinSamples; ++i) {
      const glm::vec2 within = (glm::vec2(i % kBinSamples, i / kBinSamples) + 0.5f) / float{kBinSamples};
      const glm::vec3 p = skyBinPoint(bin, within, edge);
      const double r = glm::length(p), share = 1 / (r * r * r);
      sum += share * glm::dvec3(sky.radiance(p / static_cast<float>(r)));
      solidAngle += share;
    }
    bins[bin] = glm::vec4(sum / solidAngle, 0);
  }
  return bins;
}

void place(Context& context, const Sky& sky, SkyOnDevice& onDevice) {
  if (sky == onDevice.sky) return;
  if (!(sky.largest() > 0)) {
    onDevice = {};
    onDevice.sky = sky;
    return;
  }
  if (sky.texels != onDevice.sky.texels || !onDevice.texels)
    onDevice.texels = makeBuffer<glm::vec3>(context, "sky", Subsystem::Scene, sky.texels->texels);
  if (sky.whole == sky.texels)
    onDevice.whole = Buffer();
  else if (sky.whole != onDevice.sky.whole || !onDevice.whole)
    onDevice.whole = makeBuffer<glm::vec3>(context, "sky with its sun", Subsystem::Scene, sky.whole->texels);
  onDevice.bins = makeBuffer<glm::vec4>(context, "sky by bins", Subsystem::Scene, skyBins(sky));
  RecordMaker maker(context, "sky record", Subsystem::Scene, sizeof(SkyPicture));
  const uint64_t texels = maker.of(onDevice.texels);
  onDevice.record = maker.make(
      SkyPicture{texels, onDevice.whole ? maker.of(onDevice.whole) : texels, sky.texels->size, sky.turn, sky.scale});
  onDevice.sky = sky;
}

void gatherSky(Frame& frame, const FormFactors& matrix, const Buffer& bins, Lighting& light) {
  if (!bins || !matrix.rowSky) {
    light.sky = Buffer();
    return;
  }
  if (!light.sky)
    light.sky = Buffer(frame.context().device, "irradiance from the sky", Subsystem::Solver, light.direct.bytes);
  Pass pass = frame.pass("GI Gather");
  pass.shader("gi/gather_sky.comp")
      .constant(CONSTANT_TINTED, matrix.tinted)
      .push(GatherSkyPush{pass.in(matrix.record), pass.in(bins), pass.out(light.sky)})
      .dispatch(matrix.rows);
}

}  // namespace irad
