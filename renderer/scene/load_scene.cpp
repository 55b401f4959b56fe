// loadScene: the stages of loading, in order.
#include <future>
#include <new>

#include "renderer/base/sha256.h"
#include "renderer/scene/gltf_document.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"
#include "renderer/scene/sidecar.h"

namespace irad {
namespace {

Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options) {
  const auto step = [&](float fraction, const char* name) {
    if (options.progress) options.progress(fraction, name);
  };
  gltf::Document doc;
  doc.path = path;
  doc.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  Scene scene;
  scene.path = path;
  step(0.0f, "file");
  gltf::readContainer(doc);
  auto hash = std::async(std::launch::async, [&doc] { return sha256(doc.file); });
  gltf::precheck(doc);
  gltf::parseModel(doc);
  gltf::verifyAccessors(doc);
  step(0.1f, "buffers");
  gltf::loadBuffers(doc);
  step(0.2f, "images");
  gltf::loadMaterials(doc, options, scene);
  step(0.8f, "geometry");
  gltf::assemble(doc, gltf::flattenNodes(doc, scene), scene);
  scene.sha256 = hash.get();
  scene.warnings = std::move(doc.warnings);
  return scene;
}

}  // namespace

Scene loadScene(const std::filesystem::path& path, const LoadOptions& options) {
  try {
    const bool cache = path.extension() == ".irscene";
    Scene scene = cache ? readSceneCache(path) : loadGltf(path, options);
    if (options.lambertian)
      for (Material& material : scene.materials) {
        material.metallic = 0.0f, material.roughness = 1.0f, material.lambertian = true;
        material.metallicRoughnessTexture = {};
      }
    if (options.doubleSided)
      for (Material& material : scene.materials) material.doubleSided = true;
    if (!cache) addDefaults(scene);
    scene.fileLights = scene.lights;
    if (options.sidecar) takeSidecar(scene);
    if (options.lights) replaceLights(scene, *options.lights);
    if (options.materials) replaceMaterialEdits(scene, *options.materials);
    const std::string from = options.materials ? "" : scene.sidecar.filename().string() + ": ";
    for (const std::string& unknown : unknownMaterials(scene, scene.materialEdits))
      scene.warnings.push_back(from + unknown);
    const HiddenNodes hidden = hiddenPaths(scene.nodes, options.hidden ? *options.hidden : scene.hidden);
    for (const std::string& unknown : unknownNodes(scene.nodes, hidden))
      scene.warnings.push_back((options.hidden ? "" : scene.sidecar.filename().string() + ": ") + unknown);
    hideNodes(scene, hidden);
    if (options.region) scene.region = *options.region;
    scene.sky = options.sky;
    if (options.progress) options.progress(1.0f, "scene");
    return scene;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: needs more memory than there is", path.string()));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace irad
