// A glTF file that has been read and verified: the JSON by tinygltf, the bytes by ourselves. Internal to
// renderer/scene. Everything below this line of defence may index without asking: gltf_precheck has checked types,
// ranges, indices, counts, node tree and required extensions, and gltf_buffers every range of bytes.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/image_header.h"
#include "renderer/scene/scene.h"

namespace irad::gltf {

using Json = nlohmann::json;
using Bytes = std::vector<uint8_t>;
using ByteSpan = std::span<const uint8_t>;

constexpr uint64_t kMaxTriangles = 1u << 24;
constexpr uint64_t kMemoryBudget = 1400ull << 20;    ///< bytes of all that one load holds at a time
constexpr uint64_t kMaxImageBytes = 1ull << 30;      ///< decoded, all images together
constexpr uint64_t kMaxImageScratch = 600ull << 20;  ///< beside them while decoding, all images in progress together
constexpr uint32_t kMaxImageExtent = 16384;          ///< pixels per side

/// What is said of files of the format's first version.
constexpr const char* kOldFormat = "this is glTF 1.0, and glTF 2.0 is read; converters from one to the other exist";

/// The bytes of a bufferView; `present` is false where its buffer is a placeholder without data.
struct View {
  ByteSpan bytes;
  uint32_t stride = 0;  ///< 0: tightly packed
  bool present = false;
};

/// A node; there may be very many.
struct Node {
  std::string name;
  int mesh = -1, skin = -1, camera = -1, light = -1;
  bool visible = true;  ///< KHR_node_visibility; what lies under one that is not is not either
  std::vector<int> children;
  std::vector<double> weights;
  glm::dmat4 transform{1.0};  ///< its own, until flattenNodes() makes it the world's
};

struct Document {
  Document();
  ~Document();

  std::filesystem::path path, folder;
  Bytes file;     ///< the whole .gltf or .glb
  ByteSpan json;  ///< its JSON text
  ByteSpan bin;   ///< the BIN chunk of a .glb
  bool hasBin = false;

  std::unique_ptr<Json> root;  ///< with an array "nodes" that is empty
  std::vector<Node> nodes;
  std::map<size_t, std::map<std::string, int>> instancing;  ///< of few nodes: EXT_mesh_gpu_instancing's accessors
  tinygltf::Model model;                                    ///< without nodes, buffers, images and animations
  std::vector<Bytes> owned;
  std::vector<ByteSpan> buffers;
  std::vector<bool> bufferPresent;
  std::vector<View> views;
  std::vector<std::string> warnings;

  /// Throws InputError "FILE: OBJECT: TEXT".
  [[noreturn]] void fail(const std::string& object, const std::string& text) const;
  /// Notes a warning once.
  void warn(const std::string& text);
  /// Counts memory against kMemoryBudget before it is allocated.
  void take(uint64_t bytes, const std::string& object);
  void release(uint64_t bytes) { used_ -= std::min(used_, bytes); }

 private:
  uint64_t used_ = 0;
};

// gltf_container.cpp: the file, its GLB chunks, and JSON with bounded depth and size, valid UTF-8 and no duplicate
// keys.
void readContainer(Document&);
// gltf_json.cpp: Document::root and Document::nodes, whose types are then right, but indices may point past their
// arrays.
void readJson(Document&);
// gltf_precheck.cpp
void precheck(Document&);
// gltf_model.cpp: runs tinygltf over what the precheck has approved.
void parseModel(Document&);
// gltf_buffers.cpp
void loadBuffers(Document&);
/// A file named by a relative URI, never outside the scene's folder; nullopt-like empty path and `why` when refused.
std::filesystem::path resolveUri(const Document&, const std::string& uri, std::string& why);
bool isDataUri(const std::string& uri);
/// Decodes a data URI; false when malformed.
bool decodeDataUri(const std::string& uri, Bytes& out, std::string& mime);
Bytes readFile(const std::filesystem::path& path, uint64_t maxBytes, std::string& why);
/// Why a path cannot be read as a file ("no such file", "is a folder, not a file"); empty: it is one.
std::string whyNoFile(const std::filesystem::path& path);

// gltf_accessors.cpp
struct Elements {
  uint32_t count = 0, components = 0;
  std::vector<float> values;
};
void verifyAccessors(const Document&);
/// Any accessor as floats (normalized integers scaled, sparse applied). `components` 0: whatever it has.
Elements readFloats(Document&, int accessor, uint32_t components, const std::string& what);
std::vector<uint32_t> readIntegers(Document&, int accessor, uint32_t components, const std::string& what);
/// One component as a float, by glTF's normalization rule.
float componentToFloat(const uint8_t* bytes, int componentType, bool normalized);
uint32_t componentSize(int componentType);
uint32_t componentCount(int type);

// gltf_draco.cpp: decoded attributes by semantic, and the triangle list.
struct DracoMesh {
  std::vector<uint32_t> indices;
  std::map<std::string, Elements> attributes;
};
DracoMesh decodeDraco(Document&, const tinygltf::Primitive&, const std::string& where);

// gltf_meshopt.cpp
Bytes decodeMeshopt(Document&, ByteSpan source, uint32_t count, uint32_t stride, const std::string& mode,
                    const std::string& filter, const std::string& where);

// gltf_materials.cpp, gltf_images.cpp, gltf_lights.cpp
void loadMaterials(Document&, const LoadOptions&, Scene&);
/// Fills Scene::images[i] for the requested (image, sRGB) pairs.
struct ImageRequest {
  int source = -1;  ///< index into the file's images, -1: none named
  bool srgb = false;
  std::string user;  ///< which texture asked first
};
void loadImages(Document&, const std::vector<ImageRequest>&, const LoadOptions&, Scene&);

// gltf_primitives.cpp: one primitive in mesh space: triangle list, finite, with normals and tangents.
struct Primitive {
  uint32_t material = 0;
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;
  std::vector<uint32_t> indices;
  uint32_t influences = 0;  ///< joints per vertex; 0: not skinned
  std::vector<uint32_t> joints;
  std::vector<float> weights;
  uint64_t nonFinite = 0, degenerate = 0, zeroNormals = 0;
};
bool loadPrimitive(Document&, const tinygltf::Mesh&, uint32_t meshIndex, uint32_t primitiveIndex,
                   const std::vector<double>& morphWeights, const Scene& scene, Primitive& out);

// gltf_nodes.cpp: world transforms, instances, lights, cameras, the list of nodes that have meshes.
struct Instance {
  int mesh = -1, node = -1, skin = -1;
  uint32_t sceneNode = 0;  ///< of Scene::nodes
  glm::dmat4 world{1.0};
};
std::vector<Instance> flattenNodes(Document&, Scene&);
std::vector<glm::dmat4> jointMatrices(Document&, int skin);
/// Warns of a rotation (x, y, z, w) that is none.
glm::dmat4 transformOf(Document&, size_t node, const glm::dvec3& translation, const glm::dvec4& rotation,
                       const glm::dvec3& scale);

// gltf_assemble.cpp: primitives and instances into the scene's arrays.
void assemble(Document&, const std::vector<Instance>&, Scene&);

}  // namespace irad::gltf

namespace irad {

// tangents.cpp
/// MikkTSpace-like tangents (angle-weighted, orthogonal to the normal, vertices split where handedness changes).
void generateTangents(gltf::Primitive& primitive, const std::vector<glm::vec2>& uv);
/// A unit tangent orthogonal to `normal` where no map asks for a particular one.
glm::vec4 anyTangent(const glm::vec3& normal);

// image_decode_oiio.cpp or image_decode_none.cpp
struct DecodeResult {
  bool ok = false;
  std::string why;
};
/// `header` is that of the bytes, and not too large.
DecodeResult decodeImage(std::span<const uint8_t> bytes, const ImageHeader& header, SceneImage& out);

// defaults.cpp
void addDefaults(Scene& scene);

// scene_cache.cpp
Scene readSceneCache(const std::filesystem::path& path);
}  // namespace irad
