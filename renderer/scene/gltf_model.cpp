// tinygltf, header-only, in this one translation unit. It gets the approved JSON without nodes, buffers, images,
// animations, extras and extensions that nobody reads, so that it touches no file and copies no data. Before tinygltf,
// which would include it with hidden visibility.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>  // first: tinygltf includes it with hidden visibility
#pragma GCC diagnostic pop
#undef TINYGLTF_IMPLEMENTATION  // that part of the header has no include guard

#include <set>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

const std::set<std::string>& readExtensions() {
  static const std::set<std::string> names = {"KHR_lights_punctual",        "KHR_materials_emissive_strength",
                                              "KHR_texture_transform",      "EXT_texture_webp",
                                              "KHR_draco_mesh_compression", "KHR_materials_pbrSpecularGlossiness",
                                              "KHR_materials_transmission"};
  return names;
}

void strip(Json& value) {
  if (value.is_array()) {
    for (Json& element : value) strip(element);
  } else if (value.is_object()) {
    value.erase("extras");
    if (const auto extensions = value.find("extensions"); extensions != value.end() && extensions->is_object())
      for (auto it = extensions->begin(); it != extensions->end();)
        it = readExtensions().contains(it.key()) ? std::next(it) : extensions->erase(it);
    for (Json& element : value) strip(element);
  }
}

/// A few bytes of JSON are a few hundred of a model.
void takeModel(Document& doc) {
  const auto take = [&](const char* name, uint64_t each) {
    if (doc.root->contains(name)) doc.take(doc.root->at(name).size() * each, name);
  };
  take("materials", sizeof(tinygltf::Material));
  take("meshes", sizeof(tinygltf::Mesh)), take("accessors", sizeof(tinygltf::Accessor));
  take("bufferViews", sizeof(tinygltf::BufferView)), take("textures", sizeof(tinygltf::Texture));
  take("samplers", sizeof(tinygltf::Sampler)), take("skins", sizeof(tinygltf::Skin));
  take("cameras", sizeof(tinygltf::Camera)), take("scenes", sizeof(tinygltf::Scene));
  if (doc.root->contains("meshes"))
    for (const Json& mesh : doc.root->at("meshes"))
      doc.take(mesh.at("primitives").size() * sizeof(tinygltf::Primitive), "meshes");
}

}  // namespace

void parseModel(Document& doc) {
  takeModel(doc);
  // Nodes have been read; the rest is tinygltf's, which wants a text of its own.
  Json json = *doc.root;
  for (const char* name : {"nodes", "buffers", "images", "animations"}) json.erase(name);
  strip(json);
  // The file's bounds may be wrong or infinite; the data itself is measured.
  if (json.contains("accessors"))
    for (Json& accessor : json.at("accessors"))
      if (accessor.is_object()) accessor.erase("min"), accessor.erase("max");
  // tinygltf refuses index accessors without a bufferView, which Draco meshes have by design: put them back afterwards.
  std::vector<std::vector<int>> indices;
  if (json.contains("meshes"))
    for (Json& mesh : json.at("meshes")) {
      auto& list = indices.emplace_back();
      for (Json& primitive : mesh.at("primitives")) {
        list.push_back(primitive.value("indices", -1));
        primitive.erase("indices");
      }
    }
  tinygltf::TinyGLTF reader;
  // tinygltf has no reason to open files; if it tries, it gets none.
  tinygltf::FsCallbacks none{};
  none.FileExists = [](const std::string&, void*) { return false; };
  none.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
  none.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
  none.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  reader.SetFsCallbacks(none);
  reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  std::string error, warning;
  bool loaded = false;
  try {
    const std::string text = json.dump();
    loaded = reader.LoadASCIIFromString(&doc.model, &error, &warning, text.c_str(),
                                        static_cast<unsigned int>(text.size()), "", tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!loaded) {
    while (!error.empty() && (error.back() == '\n' || error.back() == ' ')) error.pop_back();
    doc.fail("glTF", error.empty() ? "tinygltf refuses it" : error);
  }
  // tinygltf must have kept every object, or our indices would point elsewhere.
  const auto same = [&](const char* name, size_t size) {
    const size_t want = doc.root->contains(name) ? doc.root->at(name).size() : 0;
    if (want != size) doc.fail(name, fmt::format("{} objects in the file, {} understood", want, size));
  };
  same("scenes", doc.model.scenes.size()), same("meshes", doc.model.meshes.size());
  same("accessors", doc.model.accessors.size()), same("bufferViews", doc.model.bufferViews.size());
  same("materials", doc.model.materials.size()), same("textures", doc.model.textures.size());
  same("samplers", doc.model.samplers.size()), same("skins", doc.model.skins.size()),
      same("cameras", doc.model.cameras.size());
  for (size_t m = 0; m < indices.size(); ++m) {
    if (doc.model.meshes[m].primitives.size() != indices[m].size())
      doc.fail(fmt::format("meshes[{}]", m), "primitives lost");
    for (size_t p = 0; p < indices[m].size(); ++p) doc.model.meshes[m].primitives[p].indices = indices[m][p];
  }
}

}  // namespace irad::gltf
