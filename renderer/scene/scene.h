// A glTF 2.0 scene as the engine uses it: static, flattened to world space, one vertex and index array, triangles
// grouped by material. World coordinates are glTF's (right-handed, Y up, metres as the file says); positions are stored
// in fp32 relative to `origin`, which is taken in double precision, so that a scene 10^6 units from the origin keeps
// its detail. Light units: 1 lux = 1 W/m^2, 1 cd = 1 W/sr; emitted radiance = emissiveFactor x emissiveStrength x
// texture.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/limits.h"
#include "renderer/resources.h"
#include "renderer/scene/light_kind.h"

namespace irad {

struct SkyImage;

constexpr double kMaxLightOrEmission = 1e12;  ///< of intensities, colours and emitted radiance
constexpr double kMaxLightAngle = 90.0;       ///< of a distant light, degrees

/// A decoded image, RGBA, 8 bits per channel, top row first. `srgb` is decided by use (base colour, emissive: yes).
struct SceneImage {
  std::string name;
  uint32_t width = 0, height = 0;
  bool srgb = false;
  std::vector<uint8_t> rgba;
};

/// A use of an image by a material. uv' = transform * (uv, 1) per KHR_texture_transform (column-major 2x3).
struct TextureUse {
  int image = -1;  ///< index into Scene::images, -1: none (the factor alone)
  SamplerDesc sampler;
  uint32_t uvSet = 0;  ///< 0 or 1
  glm::mat3x2 transform{1.0f};
};

enum class AlphaMode : uint32_t { Opaque, Mask, Blend };

struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};  ///< linear
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emission{0.0f};  ///< emissiveFactor x emissiveStrength: radiance, W/(m^2 sr), >= 0
  float normalScale = 1.0f, occlusionStrength = 1.0f, alphaCutoff = 0.5f;
  AlphaMode alpha = AlphaMode::Opaque;
  float transmission = 0.0f;  ///< share of the diffuse part that passes straight through, tinted by the base colour
  bool doubleSided = false;
  bool lambertian = false;  ///< no specular lobe (LoadOptions::lambertian)
  TextureUse baseColorTexture, metallicRoughnessTexture, normalTexture, occlusionTexture, emissiveTexture;
  TextureUse transmissionTexture;  ///< in red
};

/// What a user has made of a material beside the scene's file; what is absent is the file's.
struct MaterialEdit {
  std::string material;                      ///< its name, of materialNames()
  std::optional<glm::vec3> baseColor;        ///< linear, 0 to 1; alpha stays the file's
  std::optional<float> metallic, roughness;  ///< 0 to 1; nothing to a Lambertian one
  std::optional<glm::vec3> emissionColor;    ///< linear, 0 to 1
  std::optional<float> emissionStrength;     ///< W/(m^2 sr) where the colour is 1: radiance = colour x strength
  std::optional<float> alphaCutoff;          ///< 0 to 1; nothing to one without an alpha mask
  std::optional<float> transmission;         ///< 0 to 1
  uint32_t texturesOff = 0;                  ///< bit i: texture i of kMaterialTextures is left out
  bool operator==(const MaterialEdit&) const = default;
};

struct Light {
  std::string name;
  LightType type = LightType::Sun;
  glm::dvec3 position{0.0};                       ///< world
  glm::vec3 direction{0.0f, -1.0f, 0.0f};         ///< unit, the way the light shines
  glm::vec3 color{1.0f};                          ///< linear
  float intensity = 1.0f;                         ///< distant ones: lux; the others: candela
  float range = 0.0f;                             ///< 0: unlimited
  float innerCos = 1.0f, outerCos = 0.70710678f;  ///< of a cone: cosines of the half-angles
  float angle = 0.0f;                             ///< distant ones: as they are seen, across, degrees; 0: a point
  float radius = 0.0f;                            ///< the others: of the lamp's sphere, m; 0: a point
  bool on = true;                                 ///< false: it gives no light, and costs nothing
  bool operator==(const Light&) const = default;
};

struct Camera {
  std::string name;
  glm::dvec3 position{0.0};
  glm::quat orientation{1, 0, 0, 0};  ///< rotates camera space (looks along -Z, Y up) to world
  bool orthographic = false;
  float yfov = 1.0f;                ///< perspective: vertical angle, radians
  float ymag = 1.0f;                ///< orthographic: half height
  float aspect = 0.0f;              ///< 0: that of the viewport
  float znear = 0.1f, zfar = 0.0f;  ///< zfar 0: chosen from the bounds
  bool operator==(const Camera&) const = default;
};

struct Draw {
  uint32_t material = 0, firstIndex = 0, indexCount = 0;
};

/// What lies in a row in the arrays of a geometry, of one node and one material.
struct Piece {
  uint32_t node = 0;  ///< of Scene::nodes
  uint32_t firstVertex = 0, vertexCount = 0, firstIndex = 0, indexCount = 0;
};

/// A node of the scene's file that has a mesh, or under which some node has one.
struct SceneNode {
  static constexpr uint32_t kNoParent = ~0u;
  std::string name;             ///< among those of one parent no other has it; never empty
  uint32_t parent = kNoParent;  ///< before it in the list
  uint32_t end = 0;             ///< it and all under it are the nodes from its own number to before this one
  uint32_t instances = 0;       ///< of its own mesh; 0: it has none
  // Of it and all under it, also of what is hidden (measureNodes()):
  uint64_t triangles = 0;
  glm::dvec3 boundsMin{0.0}, boundsMax{0.0};  ///< world; 0 where there is no triangle
};

/// What a user has hidden of a scene's nodes, by paths (scene/nodes.h). A node that is hidden hides all under it.
struct HiddenNodes {
  std::vector<std::string> paths;  ///< sorted, each once
  std::string isolated;            ///< of all others nothing is shown; empty: no such node
  bool empty() const { return paths.empty() && isolated.empty(); }
  bool operator==(const HiddenNodes&) const = default;
};

/// Corners, world; as settings have them.
struct RegionBox {
  glm::vec3 least{0.0f}, largest{0.0f};
  bool operator==(const RegionBox&) const = default;
};

/// The surfaces of a scene.
struct Geometry {
  glm::dvec3 origin{0.0};                      ///< world position of local (0,0,0): the centre of the bounds
  glm::vec3 boundsMin{0.0f}, boundsMax{0.0f};  ///< local

  // Structure of arrays, one element per vertex; all the same length.
  std::vector<glm::vec3> positions;  ///< local
  std::vector<glm::vec3> normals;    ///< unit
  std::vector<glm::vec4> tangents;   ///< xyz unit, w = handedness +-1
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;  ///< linear, multiplies the base colour; 1 where the file has none
  std::vector<uint32_t>
      indices;              ///< three per triangle, counter-clockwise seen from the front (mirrored nodes rewound)
  std::vector<Draw> draws;  ///< at most one per material, in material order; empty ones left out

  // Where the scene's file has nodes; else empty.
  std::vector<Piece> pieces;      ///< one after the other all of the arrays, within a draw in the order of nodes
  std::vector<glm::dvec3> world;  ///< positions before the origin was taken off, which is another where bounds are; not
                                  ///< finite where a vertex belongs to no triangle

  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

struct Scene : Geometry {
  std::filesystem::path path;
  std::string sha256;                     ///< of the scene file itself
  std::vector<SceneNode> nodes;           ///< from the roots on, what lies under a node right behind it
  HiddenNodes hidden;                     ///< left out of the geometry, and names that no node has
  std::shared_ptr<const Geometry> whole;  ///< with what is hidden, where something is

  std::vector<Material> materials;          ///< at least one
  std::vector<Material> fileMaterials;      ///< those of the scene file, where edits changed them; empty: `materials`
  std::vector<MaterialEdit> materialEdits;  ///< that `materials` are made with, and those of names that none has
  std::vector<SceneImage> images;
  std::vector<Light> lights;
  std::vector<Light> fileLights;  ///< those of the scene file (or the default sun), where others took their place
  std::vector<Camera> cameras;    ///< at least one after addDefaults
  std::vector<Camera> bookmarks;  ///< further cameras, the sidecar's
  std::shared_ptr<const SkyImage>
      sky;                        ///< a picture of what is around (renderer/scene/sky_image.h), where one was given
  std::filesystem::path sidecar;  ///< that lights, materials, objects, bookmarks and region come from; empty: none

  std::vector<std::string> warnings;  ///< in words, each once
  /// That voxels are made of with scene.region=auto (gi/region.h), the sidecar's.
  std::optional<RegionBox> region;
  bool defaultCamera = false, defaultLight = false;
};

struct LoadOptions {
  bool lambertian =
      false;  ///< every material Lambertian with its base colour: metallic 0, no specular (for references)
  /// Every material double-sided, so that faces emit and are seen from both sides: for comparisons with path tracers
  /// that know no culled faces.
  bool doubleSided = false;
  bool sidecar = false;                      ///< take the sidecar beside the file (scene/sidecar.h), if there is one
  std::optional<std::vector<Light>> lights;  ///< in place of the file's and the sidecar's
  std::optional<std::vector<MaterialEdit>> materials;              ///< in place of the sidecar's
  std::optional<HiddenNodes> hidden;                               ///< in place of the sidecar's
  std::optional<std::optional<RegionBox>> region;                  ///< likewise
  std::shared_ptr<const SkyImage> sky;                             ///< Scene::sky
  std::function<void(float fraction, const char* step)> progress;  ///< may be empty
};

/// Loads .gltf or .glb (or .irscene, the decoded cache that writeSceneCache makes; the portable build reads only that
/// and untextured glTF). Throws InputError naming file, object and value; what is merely odd becomes a warning. Adds a
/// fitted camera where the file has none, and a default sun where it has no light and nothing that emits; both noted.
Scene loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

/// The cameras of the scene file, then the bookmarks.
std::vector<Camera> allCameras(const Scene& scene);

/// Puts other lights in place of the scene's, its default sun included.
void replaceLights(Scene& scene, std::vector<Light> lights);

/// A scene with all images decoded, for machines without image decoders. Little-endian, versioned, written atomically.
void writeSceneCache(const Scene& scene, const std::filesystem::path& path);

/// What is wrong with a scene, in words; empty where it is sound, that is: arrays of one length, indices inside them,
/// numbers finite and in range, directions unit. loadScene returns sound scenes only.
std::string unsound(const Scene& scene);
/// The same for a material: "material "wall": emits -1".
std::string unsound(const Material& material, size_t images);
/// The same for a light: "light "lamp": its intensity -1 is not from 0 to 1e+12".
std::string unsound(const Light& light);

}  // namespace irad
