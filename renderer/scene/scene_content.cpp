#include "renderer/scene/scene_content.h"

#include <fmt/format.h>

#include <span>
#include <type_traits>

#include "renderer/base/sha256.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/sky_image.h"

namespace irad {
namespace {

/// A line per member: its name and the hash of its bytes. Structures are taken apart by all of their members, so that
/// one that gets a member more does not compile until it is said here whether pictures depend on it.
class Members {
 public:
  template <class T>
  void add(const char* name, const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T> || kPlain<T>, "may hold padding");
    bytes(name, std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void add(const char* name, const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T> || kPlain<T>, "may hold padding");
    bytes(name, std::as_bytes(std::span(values)));
  }
  void nothing(const char* name) { text_ += fmt::format("{} none\n", name); }
  /// Of a list: how many there are, before them.
  void count(const char* name, size_t n) { text_ += fmt::format("{} {}\n", name, n); }
  std::string hash() const { return sha256({reinterpret_cast<const uint8_t*>(text_.data()), text_.size()}); }

 private:
  template <class T>
  static constexpr bool kPlain =
      std::is_same_v<T, glm::vec2> || std::is_same_v<T, glm::vec3> || std::is_same_v<T, glm::vec4> ||
      std::is_same_v<T, glm::dvec3> || std::is_same_v<T, glm::uvec2> || std::is_same_v<T, glm::mat3x2>;
  void bytes(const char* name, std::span<const std::byte> values) {
    text_ += fmt::format("{} {}\n", name, sha256({reinterpret_cast<const uint8_t*>(values.data()), values.size()}));
  }
  std::string text_;
};

void addUse(Members& m, const TextureUse& use) {
  const auto& [image, sampler, uvSet, transform] = use;
  m.add("image", image), m.add("uv set", uvSet), m.add("transform", transform);
  const auto& [u, v, linearMag, linearMin, mips, linearMips, anisotropic] = sampler;
  m.add("u", u), m.add("v", v), m.add("magnified", linearMag), m.add("minified", linearMin);
  m.add("mips", mips), m.add("linear mips", linearMips), m.add("anisotropic", anisotropic);
}

void addMaterial(Members& m, const Material& material) {
  const auto& [name, baseColor, metallic, roughness, emission, normalScale, occlusionStrength, alphaCutoff, alpha,
               transmission, doubleSided, lambertian, baseColorTexture, metallicRoughnessTexture, normalTexture,
               occlusionTexture, emissiveTexture, transmissionTexture] = material;
  (void)name;
  m.add("base colour", baseColor), m.add("metallic", metallic), m.add("roughness", roughness);
  m.add("emission", emission), m.add("normal scale", normalScale), m.add("occlusion strength", occlusionStrength);
  m.add("alpha cutoff", alphaCutoff), m.add("alpha", alpha);
  m.add("double sided", doubleSided), m.add("lambertian", lambertian);
  for (const TextureUse* use :
       {&baseColorTexture, &metallicRoughnessTexture, &normalTexture, &occlusionTexture, &emissiveTexture})
    addUse(m, *use);
  if (transmission == 0) return;  // what materials had been before they could transmit light keeps its content
  m.add("transmission", transmission);
  addUse(m, transmissionTexture);
}

void addLight(Members& m, const Light& light) {
  const auto& [name, type, position, direction, color, intensity, range, innerCos, outerCos, angle, radius, on] = light;
  (void)name;
  m.add("type", type), m.add("position", position), m.add("direction", direction), m.add("colour", color);
  m.add("intensity", intensity), m.add("range", range), m.add("inner cone", innerCos), m.add("outer cone", outerCos);
  m.add("angle", angle), m.add("radius", radius);
  if (!on) m.add("on", on);  // what lights had been before they could be off keeps its content
}

void addTexels(Members& m, const SkyTexels* sky) {
  if (!sky) return m.nothing("texels");
  const auto& [size, texels] = *sky;
  m.add("size", size), m.add("texels", texels);
}

void addSky(Members& m, const SkyImage* image) {
  if (!image) return m.nothing("sky");
  const auto& [path, ofFile, whole, texels, sun] = *image;
  (void)path, (void)ofFile;
  addTexels(m, whole.get()), addTexels(m, texels.get());
  if (!sun) return m.nothing("sun");
  const auto& [towards, irradiance] = *sun;
  m.add("towards the sun", towards), m.add("sun", irradiance);
}

// A member that is added to a scene does not compile until it is known here. (Structured bindings do not take a class
// and its base at once.)
constexpr size_t kKnown =
    sizeof(Geometry) + sizeof(Scene::path) + sizeof(Scene::sha256) + sizeof(Scene::nodes) + sizeof(Scene::hidden) +
    sizeof(Scene::whole) + sizeof(Scene::materials) + sizeof(Scene::fileMaterials) + sizeof(Scene::materialEdits) +
    sizeof(Scene::images) + sizeof(Scene::lights) + sizeof(Scene::fileLights) + sizeof(Scene::cameras) +
    sizeof(Scene::bookmarks) + sizeof(Scene::region) + sizeof(Scene::sky) + sizeof(Scene::sidecar) +
    sizeof(Scene::warnings) + sizeof(Scene::defaultCamera) + sizeof(Scene::defaultLight);
static_assert(sizeof(Scene) == (kKnown + alignof(Scene) - 1) / alignof(Scene) * alignof(Scene));

}  // namespace

/// What was made of a file counts, not by which file, nodes and edits.
std::string sceneContent(const Scene& scene) {
  const auto& [origin, boundsMin, boundsMax, positions, normals, tangents, uv0, uv1, colors, indices, draws, pieces,
               world] = static_cast<const Geometry&>(scene);
  (void)pieces, (void)world;
  Members m;
  m.add("origin", origin), m.add("least", boundsMin), m.add("most", boundsMax);
  m.add("positions", positions), m.add("normals", normals), m.add("tangents", tangents);
  m.add("uv0", uv0), m.add("uv1", uv1), m.add("colours", colors), m.add("indices", indices);
  m.count("draws", draws.size());
  for (const Draw& draw : draws) {
    const auto& [material, firstIndex, indexCount] = draw;
    m.add("material", material), m.add("first", firstIndex), m.add("indices", indexCount);
  }
  m.count("materials", scene.materials.size());
  for (const Material& material : scene.materials) addMaterial(m, material);
  m.count("images", scene.images.size());
  for (const SceneImage& image : scene.images) {
    const auto& [name, width, height, srgb, rgba] = image;
    (void)name;
    m.add("width", width), m.add("height", height), m.add("srgb", srgb), m.add("texels", rgba);
  }
  m.count("lights", scene.lights.size());
  for (const Light& light : scene.lights) addLight(m, light);
  addSky(m, scene.sky.get());
  return m.hash();
}

}  // namespace irad
