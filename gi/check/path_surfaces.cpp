#include "gi/check/path_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace irad::truth {
namespace {

constexpr double kMostAlbedo = 0.98;

/// IEC 61966-2-1.
double decoded(uint8_t code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// The texel that a coordinate leads to in a row of `size`.
int64_t wrapped(int64_t i, int64_t size, Wrap wrap) {
  switch (wrap) {
    case Wrap::Clamp:
      return std::clamp<int64_t>(i, 0, size - 1);
    case Wrap::Repeat:
      return ((i % size) + size) % size;
    case Wrap::Mirror: {
      const int64_t k = ((i % (2 * size)) + 2 * size) % (2 * size);
      return k < size ? k : 2 * size - 1 - k;
    }
  }
  return 0;
}

glm::dvec4 fetched(const SceneImage& image, int64_t x, int64_t y) {
  static const std::array<double, 256> fromSrgb = [] {
    std::array<double, 256> table;
    for (int i = 0; i < 256; ++i) table[i] = decoded(static_cast<uint8_t>(i));
    return table;
  }();
  const uint8_t* t = &image.rgba[4 * (static_cast<size_t>(y) * image.width + static_cast<size_t>(x))];
  glm::dvec4 out;
  for (int c = 0; c < 3; ++c) out[c] = image.srgb ? fromSrgb[t[c]] : t[c] / 255.0;
  out.w = t[3] / 255.0;
  return out;
}

double luminance(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

template <class Value>
auto interpolated(const std::vector<Value>& values, const glm::uvec3& corner, glm::dvec2 uv) {
  using Wide = glm::vec<Value::length(), double>;
  return (1 - uv.x - uv.y) * Wide(values[corner.x]) + uv.x * Wide(values[corner.y]) + uv.y * Wide(values[corner.z]);
}

glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

/// Mean of an emissive texture, at least a thousandth: wherever light may come from has a density.
double meanTexel(const Scene& scene, const TextureUse& use) {
  if (use.image < 0) return 1;
  const SceneImage& image = scene.images[static_cast<size_t>(use.image)];
  double sum = 0;
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) sum += luminance(glm::dvec3(fetched(image, x, y)));
  return std::max(sum / std::max(1.0, double{1} * image.width * image.height), 1e-3);
}

}  // namespace

Surfaces::Surfaces(Scene scene) : scene_(std::move(scene)) {
  std::vector<double> power(scene_.materials.size());  // per m^2 of one side, in proportion
  for (size_t m = 0; m < power.size(); ++m) {
    const Material& material = scene_.materials[m];
    const double factor = luminance(glm::dvec3(material.emission));
    if (factor > 0) power[m] = factor * meanTexel(scene_, material.emissiveTexture) * (material.doubleSided ? 2 : 1);
  }
  double total = 0;
  for (const Draw& draw : scene_.draws)
    for (uint32_t i = draw.firstIndex; i + 2 < draw.firstIndex + draw.indexCount; i += 3) {
      Triangle t{.corner = {scene_.indices[i], scene_.indices[i + 1], scene_.indices[i + 2]},
                 .material = draw.material};
      const glm::dvec3 a(scene_.positions[t.corner.x]), b(scene_.positions[t.corner.y]),
          c(scene_.positions[t.corner.z]);
      const glm::dvec3 cross = glm::cross(b - a, c - a);
      const double length = glm::length(cross);
      if (!(length > 0) || !std::isfinite(length)) continue;
      t.normal = cross / length;
      t.area = 0.5 * length;
      t.share = power[draw.material] * t.area;
      total += t.share;
      if (t.share > 0) emitters_.push_back(static_cast<uint32_t>(triangles_.size()));
      triangles_.push_back(t);
    }
  double sum = 0;
  for (const uint32_t e : emitters_) {
    triangles_[e].share /= total;
    cumulative_.push_back(sum += triangles_[e].share);
  }
}

glm::dvec3 Surfaces::position(uint32_t triangle, glm::dvec2 uv) const {
  return interpolated(scene_.positions, triangles_[triangle].corner, uv);
}

glm::dvec4 Surfaces::texel(uint32_t triangle, const TextureUse& use, glm::dvec2 uv) const {
  if (use.image < 0) return glm::dvec4(1);
  const SceneImage& image = scene_.images[static_cast<size_t>(use.image)];
  if (image.width == 0 || image.height == 0) return glm::dvec4(1);
  const glm::dvec2 raw = interpolated(use.uvSet == 0 ? scene_.uv0 : scene_.uv1, triangles_[triangle].corner, uv);
  const glm::dvec2 at = glm::dmat3x2(use.transform) * glm::dvec3(raw, 1);
  const int64_t width = image.width, height = image.height;
  const auto fetch = [&](int64_t x, int64_t y) {
    return fetched(image, wrapped(x, width, use.sampler.u), wrapped(y, height, use.sampler.v));
  };
  // Level 0: as a picture sees it that is close enough. Texel i covers [i, i + 1).
  const double x = at.x * static_cast<double>(width), y = at.y * static_cast<double>(height);
  if (!std::isfinite(x) || !std::isfinite(y) || std::abs(x) > 1e15 || std::abs(y) > 1e15) return fetch(0, 0);
  if (!use.sampler.linearMag) return fetch(std::llround(std::floor(x)), std::llround(std::floor(y)));
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
  const int64_t i = std::llround(left), j = std::llround(top);
  return (1 - fy) * ((1 - fx) * fetch(i, j) + fx * fetch(i + 1, j)) +
         fy * ((1 - fx) * fetch(i, j + 1) + fx * fetch(i + 1, j + 1));
}

glm::dvec4 Surfaces::baseColor(uint32_t triangle, glm::dvec2 uv) const {
  const Material& m = material(triangle);
  return glm::dvec4(m.baseColor) * texel(triangle, m.baseColorTexture, uv) *
         interpolated(scene_.colors, triangles_[triangle].corner, uv);
}

double Surfaces::metallic(uint32_t triangle, glm::dvec2 uv) const {
  const Material& m = material(triangle);
  if (m.lambertian) return 0;
  return std::clamp(double{m.metallic} * texel(triangle, m.metallicRoughnessTexture, uv).z, 0.0, 1.0);
}

double Surfaces::transmitted(uint32_t triangle, glm::dvec2 uv) const {
  const Material& m = material(triangle);
  if (!(m.transmission > 0)) return 0;
  return double{m.transmission} * texel(triangle, m.transmissionTexture, uv).x * (1 - metallic(triangle, uv));
}

double Surfaces::alpha(uint32_t triangle, glm::dvec2 uv) const {
  return material(triangle).alpha == AlphaMode::Blend ? std::clamp(baseColor(triangle, uv).w, 0.0, 1.0) : 1;
}

double Surfaces::weight(uint32_t triangle, glm::dvec2 uv) const {
  const double met = cover(triangle, uv);
  return met > 0 ? alpha(triangle, uv) / met : 0;
}

glm::dvec3 Surfaces::passing(uint32_t triangle, glm::dvec2 uv) const {
  const double a = alpha(triangle, uv);
  const glm::dvec3 base = glm::clamp(glm::dvec3(baseColor(triangle, uv)), 0.0, 1.0);
  return 1 - a + a * transmitted(triangle, uv) * base;
}

bool Surfaces::cutOut(uint32_t triangle, glm::dvec2 uv) const {
  return masked(triangle) && baseColor(triangle, uv).w < double{material(triangle).alphaCutoff};
}

glm::dvec3 Surfaces::bumped(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& normal) const {
  const Material& m = material(triangle);
  if (m.normalTexture.image < 0) return normal;
  const glm::uvec3& corner = triangles_[triangle].corner;
  const glm::dvec3 along(interpolated(scene_.tangents, corner, uv));
  const glm::dvec3 tangent = unit(along - normal * glm::dot(normal, along), glm::dvec3(0));
  const glm::dvec3 bitangent = glm::cross(normal, tangent) * double{scene_.tangents[corner.x].w};
  const glm::dvec3 s = 2.0 * glm::dvec3(texel(triangle, m.normalTexture, uv)) - 1.0;
  return unit(double{m.normalScale} * (s.x * tangent + s.y * bitangent) + s.z * normal, normal);
}

PathVertex Surfaces::at(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& direction) const {
  const Triangle& t = triangles_[triangle];
  const Material& m = material(triangle);
  const bool front = glm::dot(direction, t.normal) < 0;
  PathVertex p{.position = position(triangle, uv), .face = front ? t.normal : -t.normal};
  const glm::dvec3 smooth = unit(interpolated(scene_.normals, t.corner, uv), p.face);
  const double side = glm::dot(smooth, p.face) < 0 ? -1 : 1;
  p.smooth = side * smooth;
  p.normal = side * bumped(triangle, uv, smooth);  // from behind, bumps are dents
  if (!front && !m.doubleSided) return p;
  p.albedo = glm::clamp(glm::dvec3(baseColor(triangle, uv)), 0.0, 1.0) *
             (1 - metallic(triangle, uv) - transmitted(triangle, uv));
  if (t.share > 0) p.emission = glm::dvec3(m.emission) * glm::dvec3(texel(triangle, m.emissiveTexture, uv));
  if (m.transmission > 0) {
    p.albedo *= weight(triangle, uv);
    p.emission *= weight(triangle, uv);
  }
  p.albedo = glm::min(p.albedo, kMostAlbedo);
  return p;
}

std::optional<Gloss> Surfaces::glossAt(uint32_t triangle, glm::dvec2 uv, const glm::dvec3& direction) const {
  const Material& m = material(triangle);
  if (m.lambertian || (!m.doubleSided && glm::dot(direction, triangles_[triangle].normal) >= 0)) return std::nullopt;
  const glm::dvec4 mr = texel(triangle, m.metallicRoughnessTexture, uv);
  const double metallic = std::clamp(double{m.metallic} * mr.z, 0.0, 1.0);
  const glm::dvec3 base = glm::clamp(glm::dvec3(baseColor(triangle, uv)), 0.0, 1.0);
  return Gloss{.f0 = glm::mix(glm::dvec3(0.04), base, metallic),
               .roughness = std::clamp(double{m.roughness} * mr.y, 0.0, 1.0),
               .weight = m.transmission > 0 ? weight(triangle, uv) : 1};
}

double Surfaces::offset(uint32_t triangle) const {
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(double{scene_.positions[triangles_[triangle].corner[k]][axis]}));
  return 8 * largest * std::numeric_limits<float>::epsilon();
}

EmitterPoint Surfaces::drawEmitter(Random& random) const {
  const double at = random.next();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), at);
  const size_t k = std::min(static_cast<size_t>(found - cumulative_.begin()), emitters_.size() - 1);
  EmitterPoint e{.triangle = emitters_[k]};
  const double root = std::sqrt(random.next()), v = random.next();
  e.uv = {root * (1 - v), root * v};
  e.position = position(e.triangle, e.uv);
  e.density = emitterDensity(e.triangle);
  return e;
}

std::optional<Arriving> Surfaces::arriving(size_t light, const glm::dvec3& position, Random& random) const {
  const Light& l = scene_.lights[light];
  if (!l.on) return std::nullopt;
  Arriving a;
  a.irradiance = double{l.intensity} * glm::dvec3(l.color);
  // A point of the disc of this radius about the light's middle, across the way to it.
  const auto aside = [&](double radius, const glm::dvec3& way) {
    const double r = radius * std::sqrt(random.next()), phi = 2 * std::numbers::pi * random.next();
    const glm::dvec3 axis = std::abs(way.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(way, axis));
    return r * (std::cos(phi) * u + std::sin(phi) * glm::cross(way, u));
  };
  if (l.type == LightType::Sun) {
    a.towards = -glm::normalize(glm::dvec3(l.direction));
    a.distance = std::numeric_limits<double>::infinity();
    if (l.angle > 0)
      a.towards = glm::normalize(a.towards + aside(std::tan(l.angle * std::numbers::pi / 360), a.towards));
    return a;
  }
  const glm::dvec3 way = l.position - scene_.origin - position;
  a.distance = glm::length(way);
  if (!(a.distance > 0)) return std::nullopt;
  a.towards = way / a.distance;
  a.irradiance /= a.distance * a.distance;
  if (l.range > 0) {
    const double share = a.distance / double{l.range};
    a.irradiance *= std::clamp(1 - share * share * share * share, 0.0, 1.0);
  }
  if (l.type == LightType::Spot) {
    const double cosine = -glm::dot(a.towards, glm::normalize(glm::dvec3(l.direction)));
    const double inner = l.innerCos, outer = l.outerCos;
    const double ramp = inner > outer ? std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0) : cosine >= outer;
    a.irradiance *= ramp * ramp;
  }
  if (!(std::max({a.irradiance.x, a.irradiance.y, a.irradiance.z}) > 0)) return std::nullopt;
  if (l.radius > 0) {
    const glm::dvec3 to = way + aside(l.radius, a.towards);
    a.distance = glm::length(to);
    a.towards = to / a.distance;
  }
  return a;
}

}  // namespace irad::truth
