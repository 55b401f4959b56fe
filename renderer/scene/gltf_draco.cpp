// KHR_draco_mesh_compression, by libdraco.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

int componentTypeOf(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16:
      return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32:
      return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default:
      return 0;
  }
}

Elements readAttribute(Document& doc, const draco::Mesh& mesh, const draco::PointAttribute& attribute, bool normalized,
                       const std::string& where) {
  const int type = componentTypeOf(attribute.data_type());
  if (type == 0)
    doc.fail(where, fmt::format("Draco data type {} is not used by glTF", static_cast<int>(attribute.data_type())));
  Elements out;
  out.count = mesh.num_points();
  out.components = static_cast<uint32_t>(attribute.num_components());
  if (out.components < 1 || out.components > 4) doc.fail(where, fmt::format("{} components", out.components));
  out.values.resize(uint64_t{out.count} * out.components);
  const uint32_t size = componentSize(type);
  for (uint32_t point = 0; point < out.count; ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute.size()) doc.fail(where, "an attribute points past its values");
    const uint8_t* bytes = attribute.GetAddress(value);
    for (uint32_t c = 0; c < out.components; ++c)
      out.values[uint64_t{point} * out.components + c] = componentToFloat(bytes + c * size, type, normalized);
  }
  return out;
}

}  // namespace

DracoMesh decodeDraco(Document& doc, const tinygltf::Primitive& primitive, const std::string& where) {
  const tinygltf::Value& extension = primitive.extensions.at("KHR_draco_mesh_compression");
  const std::string at = where + ".KHR_draco_mesh_compression";
  const int viewIndex = extension.Get("bufferView").GetNumberAsInt();
  const View& view = doc.views[static_cast<size_t>(viewIndex)];
  if (!view.present) doc.fail(at, fmt::format("bufferViews[{}] has no data", viewIndex));
  DracoMesh out;
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(view.bytes.data()), view.bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) doc.fail(at, fmt::format("damaged data ({})", decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (mesh->num_faces() > kMaxTriangles)
      doc.fail(at, fmt::format("{} triangles, at most {} are accepted", mesh->num_faces(), kMaxTriangles));
    out.indices.reserve(uint64_t{mesh->num_faces()} * 3);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
      for (const draco::PointIndex& point : mesh->face(f)) out.indices.push_back(point.value());
    const tinygltf::Value& attributes = extension.Get("attributes");
    for (const std::string& semantic : attributes.Keys()) {
      const tinygltf::Value& id = attributes.Get(semantic);
      const auto accessor = primitive.attributes.find(semantic);
      if (!id.IsInt() || id.GetNumberAsInt() < 0) doc.fail(at + ".attributes." + semantic, "is not an attribute id");
      if (accessor == primitive.attributes.end()) continue;
      const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<uint32_t>(id.GetNumberAsInt()));
      if (attribute == nullptr)
        doc.fail(at + ".attributes." + semantic, fmt::format("id {} is not in the mesh", id.GetNumberAsInt()));
      const tinygltf::Accessor& a = doc.model.accessors[static_cast<size_t>(accessor->second)];
      out.attributes[semantic] = readAttribute(doc, *mesh, *attribute, a.normalized, at + ".attributes." + semantic);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    doc.fail(at, fmt::format("damaged data ({})", error.what()));
  }
  return out;
}

}  // namespace irad::gltf
