#include "gi/region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "gi/settings.h"
#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"
#include "shaders/shared/sampling.h"

namespace irad {
namespace {

/// As scene.region takes it, to four digits of the largest extent: what is less is rounding.
std::string corners(const glm::dvec3& lo, const glm::dvec3& hi) {
  const glm::dvec3 size = hi - lo;
  const double extent = std::max({size.x, size.y, size.z});
  const double step = extent > 0 ? std::pow(10.0, std::floor(std::log10(extent)) - 4) : 0;
  const auto of = [&](double x) { return step > 0 ? std::round(x / step) * step + 0.0 : x; };  // -0 + 0 is 0
  return fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}", of(lo.x), of(lo.y), of(lo.z), of(hi.x),
                     of(hi.y), of(hi.z));
}

bool holds(const SceneRegion& region, const glm::vec3& p) {
  return glm::all(glm::greaterThanEqual(p, region.lo)) && glm::all(glm::lessThanEqual(p, region.hi));
}

/// Detail that is larger than this share of the scene gets enough voxels of the whole.
constexpr double kSmall = 0.1;
/// The whole is taken where that has voxels which are larger by less than a quarter.
constexpr double kWorth = 0.75;
/// Triangles are detail below this share of the median size.
constexpr double kFine = 0.25;
/// Of the detail's area so much may lie outside on either side of an axis.
constexpr double kStray = 0.002;

/// Of the light outside this share may be reflected from there to there.
constexpr double kShared = 0.02;

struct Weighted {
  double value, weight;
};
double weightOf(std::span<const Weighted> of) {
  return std::accumulate(of.begin(), of.end(), 0.0, [](double sum, const Weighted& w) { return sum + w.weight; });
}
/// The least value up to which there is this share of the weight. Every scene is asked: it is looked for by halves, not
/// by sorting.
double quantile(std::vector<Weighted>& of, double share) {
  std::span<Weighted> in(of);
  double wanted = share * weightOf(in);
  while (in.size() > 1) {
    const size_t half = in.size() / 2;
    std::ranges::nth_element(in, in.begin() + static_cast<std::ptrdiff_t>(half), {}, &Weighted::value);
    const double low = weightOf(in.first(half));
    if (low >= wanted) {
      in = in.first(half);
    } else {
      wanted -= low;
      in = in.subspan(half);
    }
  }
  return in.front().value;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Of the light that falls on what lies outside, the share that is reflected onto other parts of it, at most: by rays
/// from points of its area. What is outside passes no light on, so that this is what would be missing there.
double sharedOutside(const Scene& scene, const SceneRegion& region) {
  constexpr uint32_t kRays = 256;
  std::vector<double> albedo(scene.triangleCount());
  std::vector<bool> bothSides(scene.triangleCount());
  for (const Draw& draw : scene.draws) {
    const Material& m = fileMaterials(scene).at(draw.material);
    for (uint32_t i = draw.firstIndex; i < draw.firstIndex + draw.indexCount; i += 3) {
      albedo[i / 3] = double{std::max({m.baseColor.r, m.baseColor.g, m.baseColor.b})} * (1 - double{m.metallic});
      bothSides[i / 3] = m.doubleSided;
    }
  }
  struct Face {
    glm::dvec3 a, b, c;  ///< a corner, and the edges to the others
    double albedo, end;  ///< end: of its share of the area before and with it
    bool bothSides;
  };
  std::vector<Face> faces;
  double area = 0;
  for (const uint32_t t : trianglesOutside(scene, region)) {
    const auto corner = [&](uint32_t i) { return glm::dvec3(scene.positions[scene.indices[3 * size_t{t} + i]]); };
    const glm::dvec3 a = corner(0), b = corner(1) - a, c = corner(2) - a;
    const double own = 0.5 * glm::length(glm::cross(b, c));
    if (own > 0) faces.push_back({a, b, c, albedo[t], area += own, bothSides[t]});
  }
  if (faces.empty()) return 0;
  double sum = 0;
  for (uint32_t k = 0; k < kRays; ++k) {
    const double at = (k + 0.5) / kRays * area;
    const auto found =
        std::lower_bound(faces.begin(), faces.end(), at, [](const Face& f, double x) { return f.end < x; });
    const Face& from = found == faces.end() ? faces.back() : *found;
    if (from.albedo == 0) continue;
    glm::dvec2 on(hammersley(k, kRays, uvec2(0x9E3779B9u, 0x85EBCA6Bu)));
    if (on.x + on.y > 1) on = 1.0 - on;
    const glm::dvec3 normal = glm::normalize(glm::cross(from.b, from.c)) * (from.bothSides && k % 2 != 0 ? -1.0 : 1.0);
    const glm::dvec3 origin = from.a + on.x * from.b + on.y * from.c;
    const glm::dvec3 d(toWorld(cosineDirection(hammersley(k, kRays, uvec2(0))), glm::vec3(normal)));
    const double reach = 1e-6 * std::sqrt(area);
    // Moeller and Trumbore 1997; any meeting counts.
    sum += from.albedo * std::ranges::any_of(faces, [&](const Face& f) {
             const glm::dvec3 p = glm::cross(d, f.c), s = origin - f.a, q = glm::cross(s, f.b);
             const double det = glm::dot(f.b, p), u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
             return &f != &from && (det > 0 || (f.bothSides && det < 0)) && u >= 0 && v >= 0 && u + v <= 1 &&
                    glm::dot(f.c, q) / det > reach;
           });
  }
  return sum / kRays;
}

/// Emitters outside that fill less than this share of what is seen from the region are kept inside: rays would rarely
/// meet them, and places are drawn on those alone that have facets.
constexpr double kFew = 0.1;

/// The box around the emitters that lie outside of another, where these are few; else that box.
void keepFewEmitters(const Scene& scene, const std::vector<bool>& emits, glm::dvec3& lo, glm::dvec3& hi) {
  const glm::dvec3 middle = 0.5 * (lo + hi);
  glm::dvec3 outLo = lo, outHi = hi;
  // Over the directions from the middle, the integrals of radiance and of its square: what they would be of even light
  // from a part of the directions tells how large that part is.
  double light = 0, squares = 0;
  for (const Draw& draw : scene.draws) {
    const glm::vec3 emission = fileMaterials(scene).at(draw.material).emission;
    const double radiance{std::max({emission.r, emission.g, emission.b})};
    for (uint32_t i = draw.firstIndex; i < draw.firstIndex + draw.indexCount; i += 3) {
      if (!emits[i / 3]) continue;
      const auto corner = [&](uint32_t k) { return glm::dvec3(scene.positions[scene.indices[i + k]]); };
      const glm::dvec3 a = corner(0), b = corner(1), c = corner(2), away = (a + b + c) / 3.0 - middle;
      const glm::dvec3 least = glm::min(a, glm::min(b, c)), most = glm::max(a, glm::max(b, c));
      if (glm::all(glm::greaterThanEqual(least, lo)) && glm::all(glm::lessThanEqual(most, hi))) continue;
      const double distance = glm::length(away),
                   angle = 0.5 * std::abs(glm::dot(glm::cross(b - a, c - a), away)) / std::pow(distance, 3);
      if (!(angle > 0)) continue;
      light += radiance * angle, squares += radiance * radiance * angle;
      outLo = glm::min(outLo, least), outHi = glm::max(outHi, most);
    }
  }
  if (squares > 0 && light * light < kFew * 4 * std::numbers::pi * squares) lo = outLo, hi = outHi;
}

/// The part that holds the detail, and why the whole has the voxels all the same.
struct Detail {
  enum class Kept { No, Large, Reflects };
  SceneRegion part;
  Kept kept = Kept::No;
  double share = 0;  ///< of the scene's extent, or of the light
};

/// Nothing where there is no detail, or the part is not worth it. By the file's materials: an edit of one moves no
/// voxels.
std::optional<Detail> detailOf(const Scene& scene) {
  struct Face {
    glm::dvec3 lo, hi;
    double size, area;
  };
  std::vector<Face> faces;
  std::vector<Weighted> sizes;
  std::vector<bool> emits(scene.triangleCount());
  for (const Draw& draw : scene.draws)
    for (uint32_t i = draw.firstIndex; i < draw.firstIndex + draw.indexCount; i += 3)
      emits[i / 3] = fileMaterials(scene).at(draw.material).emission != glm::vec3(0);
  for (uint32_t t = 0; t < scene.triangleCount(); ++t) {
    const auto corner = [&](uint32_t i) { return glm::dvec3(scene.positions[scene.indices[3 * size_t{t} + i]]); };
    const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
    // A lamp is nothing that needs voxels.
    const double area = emits[t] ? 0 : 0.5 * glm::length(glm::cross(b - a, c - a));
    const double size = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    faces.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), size, area});
    sizes.push_back({size, 0.5 * glm::length(glm::cross(b - a, c - a))});
  }
  const double fine = kFine * quantile(sizes, 0.5);
  std::erase_if(faces, [&](const Face& f) { return !(f.size < fine) || !(f.area > 0); });
  if (faces.empty()) return std::nullopt;
  glm::dvec3 lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Weighted> low, high;
    for (const Face& f : faces) low.push_back({f.lo[axis], f.area}), high.push_back({f.hi[axis], f.area});
    lo[axis] = quantile(low, kStray);
    hi[axis] = quantile(high, 1 - kStray);
  }
  const glm::dvec3 boundsLo(scene.boundsMin), boundsHi(scene.boundsMax);
  const double whole = largest(boundsHi - boundsLo), extent = largest(hi - lo);
  // As much again on all sides: what is beside it lights it, and is in its shadow.
  lo -= extent, hi += extent;
  if (!scene.defaultCamera)
    for (const Camera& camera : scene.cameras) {
      const glm::dvec3 at = glm::clamp(camera.position - scene.origin, boundsLo, boundsHi);
      lo = glm::min(lo, at), hi = glm::max(hi, at);
    }
  keepFewEmitters(scene, emits, lo, hi);
  lo = glm::max(lo, boundsLo), hi = glm::min(hi, boundsHi);
  if (!(largest(hi - lo) <= kWorth * whole)) return std::nullopt;
  Detail detail{{glm::vec3(lo), glm::vec3(hi), false}, Detail::Kept::Large, extent / whole};
  if (detail.share > kSmall) return detail;
  detail.share = sharedOutside(scene, detail.part);
  detail.kept = detail.share > kShared ? Detail::Kept::Reflects : Detail::Kept::No;
  return detail;
}

/// World coordinates.
std::string cornersOf(const Scene& scene, const SceneRegion& region) {
  return corners(scene.origin + glm::dvec3(region.lo), scene.origin + glm::dvec3(region.hi));
}

std::string whyWhole(const Scene& scene, const Detail& detail) {
  const std::string part = cornersOf(scene, detail.part);
  if (detail.kept == Detail::Kept::Large)
    return fmt::format(
        "scene.region: whole, since its detail is {:.2g} of it, more than {}, and so has voxels enough; "
        "scene.region={} takes the part around it",
        detail.share, kSmall, part);
  return fmt::format(
      "scene.region: whole, since {:.2g} % of the light outside of {}, the part with its detail, is reflected to and "
      "fro there, more than {:.2g} %, and would be lost; scene.region={} takes the part",
      100 * detail.share, part, 100 * kShared, part);
}

}  // namespace

SceneRegion regionOf(const Scene& scene, const Settings& settings) {
  SceneRegion whole{scene.boundsMin, scene.boundsMax};
  const RegionSettings& wanted = settings.scene.region;
  if (wanted.mode == RegionMode::whole || scene.triangleCount() == 0) return whole;
  const auto boxed = [&](const glm::dvec3& lo, const glm::dvec3& hi, const std::string& what) {
    SceneRegion region{glm::max(glm::vec3(lo - scene.origin), scene.boundsMin),
                       glm::min(glm::vec3(hi - scene.origin), scene.boundsMax), false};
    if (glm::any(glm::greaterThan(region.lo, region.hi)))
      throw UsageError(fmt::format(
          "{}={},{},{},{},{},{}: holds nothing of the scene, which lies in {}", what, lo.x, lo.y, lo.z, hi.x, hi.y,
          hi.z, corners(scene.origin + glm::dvec3(scene.boundsMin), scene.origin + glm::dvec3(scene.boundsMax))));
    region.whole = region.lo == scene.boundsMin && region.hi == scene.boundsMax;
    region.line = describe(scene, region);
    return region;
  };
  if (wanted.mode == RegionMode::box)
    return boxed({wanted.x0, wanted.y0, wanted.z0}, {wanted.x1, wanted.y1, wanted.z1}, "scene.region");
  if (settings.matrix.gpu.hitRule == HitRule::thesis) return whole;
  if (scene.region) return boxed(scene.region->least, scene.region->largest, scene.sidecar.string() + ": region");
  std::optional<Detail> detail = detailOf(scene);
  if (detail && detail->kept == Detail::Kept::No) {
    detail->part.line = describe(scene, detail->part);
    return detail->part;
  }
  if (detail) whole.line = whyWhole(scene, *detail);
  return whole;
}

SceneRegion regionOrWhole(const Scene& scene, const Settings& settings) {
  const bool thesis = settings.matrix.gpu.hitRule == HitRule::thesis;
  try {
    if (!thesis) return regionOf(scene, settings);
  } catch (const UsageError&) {
    // As the build says.
  }
  return {scene.boundsMin, scene.boundsMax, true};
}

Settings withRegionOf(const Scene& scene, const Settings& settings) {
  Settings out = settings;
  if (!scene.region || settings.scene.region.mode != RegionMode::automatic ||
      settings.matrix.gpu.hitRule == HitRule::thesis)
    return out;
  const glm::vec3 &lo = scene.region->least, &hi = scene.region->largest;
  out.scene.region = {RegionMode::box, lo.x, lo.y, lo.z, hi.x, hi.y, hi.z};
  return out;
}

std::vector<uint32_t> trianglesOutside(const Geometry& geometry, const SceneRegion& region) {
  std::vector<uint32_t> out;
  if (region.whole) return out;
  for (uint32_t t = 0; t < geometry.triangleCount(); ++t)
    for (uint32_t i = 0; i < 3; ++i)
      if (!holds(region, geometry.positions[geometry.indices[3 * size_t{t} + i]])) {
        out.push_back(t);
        break;
      }
  return out;
}

std::string describe(const Scene& scene, const SceneRegion& region) {
  if (region.whole) return {};
  const size_t outside = trianglesOutside(scene, region).size();
  return fmt::format(
      "scene.region: voxels are made of {} alone; {} of {} triangles lie outside of it, at least in part: there they "
      "are lit directly, and give light, but pass none on",
      cornersOf(scene, region), outside, scene.triangleCount());
}

}  // namespace irad
