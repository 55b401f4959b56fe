// Materials: core metallic-roughness; extensions that change how light leaves a surface are approximated with a
// warning.
#include <cmath>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

using tinygltf::Value;

double number(const Value& object, const char* key, double otherwise) {
  return object.IsObject() && object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble()
                                                                            : otherwise;
}

glm::vec2 pair(const Value& object, const char* key, glm::vec2 otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const Value& array = object.Get(key);
  return {array.Get(0).GetNumberAsDouble(), array.Get(1).GetNumberAsDouble()};
}

const Value* extension(const tinygltf::ExtensionMap& map, const char* name) {
  const auto found = map.find(name);
  return found != map.end() && found->second.IsObject() ? &found->second : nullptr;
}

class MaterialReader {
 public:
  MaterialReader(Document& doc, const LoadOptions& options, Scene& scene)
      : doc_(doc), options_(options), scene_(scene) {}

  void read() {
    for (size_t i = 0; i < doc_.model.materials.size(); ++i) scene_.materials.push_back(material(i));
    // glTF 3.9: a primitive without a material has the default one, which is white metal.
    Material standard;
    standard.name = "(default)";
    if (options_.lambertian) standard.metallic = 0.0f;
    scene_.materials.push_back(standard);
    loadImages(doc_, requests_, options_, scene_);
  }

 private:
  Document& doc_;
  const LoadOptions& options_;
  Scene& scene_;
  std::vector<ImageRequest> requests_;

  float clamped(double value, double lo, double hi, const std::string& what) {
    if (value >= lo && value <= hi) return static_cast<float>(value);
    const double to = std::isnan(value) ? lo : std::clamp(value, lo, hi);
    doc_.warn(fmt::format("{}: {} is clamped to {}", what, value, to));
    return static_cast<float>(to);
  }

  SamplerDesc samplerOf(int index) {
    SamplerDesc desc;
    if (index < 0) return desc;
    const tinygltf::Sampler& s = doc_.model.samplers[static_cast<size_t>(index)];
    const auto wrap = [&](int mode) {
      if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
      if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::Mirror;
      if (mode != TINYGLTF_TEXTURE_WRAP_REPEAT)
        doc_.fail(fmt::format("samplers[{}]", index), fmt::format("wrap mode {} is not known", mode));
      return Wrap::Repeat;
    };
    desc.u = wrap(s.wrapS), desc.v = wrap(s.wrapT);
    desc.linearMag = s.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
    switch (s.minFilter) {
      case -1:
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
        break;
      case TINYGLTF_TEXTURE_FILTER_NEAREST:
        desc.linearMin = false, desc.mips = false;
        break;
      case TINYGLTF_TEXTURE_FILTER_LINEAR:
        desc.mips = false;
        break;
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        desc.linearMin = false, desc.linearMips = false;
        break;
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        desc.linearMips = false;
        break;
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        desc.linearMin = false;
        break;
      default:
        doc_.fail(fmt::format("samplers[{}].minFilter", index), fmt::format("{} is not known", s.minFilter));
    }
    return desc;
  }

  /// One entry per (image, colour space): an image used both as colour and as data is decoded twice.
  int request(int source, bool srgb, const std::string& user) {
    for (size_t i = 0; i < requests_.size(); ++i)
      if (source >= 0 && requests_[i].source == source && requests_[i].srgb == srgb) return static_cast<int>(i);
    requests_.push_back({source, srgb, user});
    return static_cast<int>(requests_.size() - 1);
  }

  TextureUse use(int textureIndex, int texCoord, const tinygltf::ExtensionMap& extensions, bool srgb,
                 const std::string& where) {
    TextureUse out;
    if (textureIndex < 0) return out;
    const tinygltf::Texture& texture = doc_.model.textures[static_cast<size_t>(textureIndex)];
    int source = texture.source;
    if (const Value* webp = extension(texture.extensions, "EXT_texture_webp"); webp && webp->Has("source"))
      source = webp->Get("source").GetNumberAsInt();
    if (const Value* transform = extension(extensions, "KHR_texture_transform")) {
      // uv' = T(offset) R(rotation) S(scale) uv, with the extension's sense of rotation (v points down).
      const glm::vec2 offset = pair(*transform, "offset", {0, 0}), scale = pair(*transform, "scale", {1, 1});
      const float angle = static_cast<float>(number(*transform, "rotation", 0.0)), c = std::cos(angle),
                  s = std::sin(angle);
      out.transform[0] = glm::vec2(c, -s) * scale.x;
      out.transform[1] = glm::vec2(s, c) * scale.y;
      out.transform[2] = offset;
      texCoord = static_cast<int>(number(*transform, "texCoord", texCoord));
    }
    if (texCoord > 1) {
      doc_.warn(fmt::format("{}: uses TEXCOORD_{}, two sets are supported; the texture is left out", where, texCoord));
      return out;
    }
    out.uvSet = static_cast<uint32_t>(texCoord);
    out.sampler = samplerOf(texture.sampler);
    out.image = request(source, srgb, where);
    return out;
  }

  template <class Info>
  TextureUse use(const Info& info, bool srgb, const std::string& where) {
    return use(info.index, info.texCoord, info.extensions, srgb, where);
  }

  /// Of an extension.
  TextureUse use(const Value& info, bool srgb, const std::string& where) {
    tinygltf::ExtensionMap extensions;
    if (info.Has("extensions"))
      for (const std::string& key : info.Get("extensions").Keys()) extensions[key] = info.Get("extensions").Get(key);
    return use(info.Get("index").GetNumberAsInt(), static_cast<int>(number(info, "texCoord", 0)), extensions, srgb,
               where);
  }

  glm::vec4 baseColor(const std::vector<double>& factor, const std::string& where) {
    glm::vec4 color(1.0f);
    for (size_t c = 0; c < factor.size() && c < 4; ++c)
      color[static_cast<int>(c)] = clamped(factor[c], 0.0, 1.0, fmt::format("{}[{}]", where, c));
    return color;
  }

  Material material(size_t index) {
    const tinygltf::Material& in = doc_.model.materials[index];
    const auto& pbr = in.pbrMetallicRoughness;
    const std::string where = fmt::format("materials[{}]{}", index, in.name.empty() ? "" : " \"" + in.name + "\"");
    Material out;
    out.name = in.name.empty() ? fmt::format("material {}", index) : in.name;
    out.baseColor = baseColor(pbr.baseColorFactor, where + ".baseColorFactor");
    out.metallic = clamped(pbr.metallicFactor, 0.0, 1.0, where + ".metallicFactor");
    out.roughness = clamped(pbr.roughnessFactor, 0.0, 1.0, where + ".roughnessFactor");
    out.baseColorTexture = use(pbr.baseColorTexture, true, where + ".baseColorTexture");
    out.metallicRoughnessTexture = use(pbr.metallicRoughnessTexture, false, where + ".metallicRoughnessTexture");
    if (const Value* old = extension(in.extensions, "KHR_materials_pbrSpecularGlossiness"))
      specularGlossiness(*old, where, out);
    out.normalTexture = use(in.normalTexture, false, where + ".normalTexture");
    out.normalScale = clamped(in.normalTexture.scale, -1e3, 1e3, where + ".normalTexture.scale");
    out.occlusionTexture = use(in.occlusionTexture, false, where + ".occlusionTexture");
    out.occlusionStrength = clamped(in.occlusionTexture.strength, 0.0, 1.0, where + ".occlusionTexture.strength");
    double strength = 1.0;
    if (const Value* emissive = extension(in.extensions, "KHR_materials_emissive_strength"))
      strength = number(*emissive, "emissiveStrength", 1.0);
    for (size_t c = 0; c < in.emissiveFactor.size() && c < 3; ++c)
      out.emission[static_cast<int>(c)] = clamped(in.emissiveFactor[c] * strength, 0.0, kMaxLightOrEmission,
                                                  fmt::format("{}.emissiveFactor[{}]", where, c));
    out.emissiveTexture = use(in.emissiveTexture, true, where + ".emissiveTexture");
    if (const Value* transmitted = extension(in.extensions, "KHR_materials_transmission"))
      transmission(*transmitted, where + ".extensions.KHR_materials_transmission", out);
    out.doubleSided = in.doubleSided;
    if (in.alphaMode == "MASK") {
      out.alpha = AlphaMode::Mask;
    } else if (in.alphaMode == "BLEND") {
      out.alpha = AlphaMode::Blend;
    } else if (in.alphaMode != "OPAQUE") {
      doc_.fail(where + ".alphaMode", fmt::format("\"{}\" is not OPAQUE, MASK or BLEND", in.alphaMode.substr(0, 40)));
    }
    out.alphaCutoff = clamped(in.alphaCutoff, 0.0, 1e9, where + ".alphaCutoff");
    if (options_.lambertian) {
      out.metallic = 0.0f, out.roughness = 1.0f;
      out.metallicRoughnessTexture = {};
    }
    return out;
  }

  void transmission(const Value& in, const std::string& where, Material& out) {
    out.transmission = clamped(number(in, "transmissionFactor", 0.0), 0.0, 1.0, where + ".transmissionFactor");
    if (in.Has("transmissionTexture"))
      out.transmissionTexture = use(in.Get("transmissionTexture"), false, where + ".transmissionTexture");
  }

  /// The retired model as a dielectric of its diffuse colour; only where it is the material's sole description.
  void specularGlossiness(const Value& old, const std::string& where, Material& out) {
    const bool hasCore = doc_.model.materials.size() > 0 && out.baseColorTexture.image >= 0;
    if (hasCore) return;
    doc_.warn(where + ": KHR_materials_pbrSpecularGlossiness is approximated by its diffuse colour and glossiness");
    if (old.Has("diffuseFactor")) {
      std::vector<double> factor;
      for (int c = 0; c < 4; ++c) factor.push_back(old.Get("diffuseFactor").Get(c).GetNumberAsDouble());
      out.baseColor = baseColor(factor, where + ".diffuseFactor");
    }
    out.metallic = 0.0f;
    out.roughness = 1.0f - clamped(number(old, "glossinessFactor", 1.0), 0.0, 1.0, where + ".glossinessFactor");
    out.metallicRoughnessTexture = {};
    if (!old.Has("diffuseTexture")) return;
    out.baseColorTexture = use(old.Get("diffuseTexture"), true, where + ".diffuseTexture");
  }
};

}  // namespace

void loadMaterials(Document& doc, const LoadOptions& options, Scene& scene) {
  MaterialReader(doc, options, scene).read();
}

}  // namespace irad::gltf
