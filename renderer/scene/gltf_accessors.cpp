// Accessors: glTF 2.0 section 3.6.2. Verified once, all of them; then read as floats or integers.
#include <cstring>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

std::string nameOf(int accessor) {
  return fmt::format("accessors[{}]", accessor);
}

template <class T>
T load(const uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

uint32_t componentToInteger(const uint8_t* bytes, int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return bytes[0];
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<uint32_t>(bytes);
    default:
      invariantFailed(__FILE__, __LINE__, fmt::format("component type {} as an integer", componentType));
  }
}

/// Bytes of an element; matrix columns start at multiples of 4 bytes (glTF 3.6.2.4).
uint32_t elementSize(const tinygltf::Accessor& a) {
  const uint32_t size = componentSize(a.componentType);
  switch (a.type) {
    case TINYGLTF_TYPE_MAT2:
      return 2 * ((2 * size + 3) / 4 * 4);
    case TINYGLTF_TYPE_MAT3:
      return 3 * ((3 * size + 3) / 4 * 4);
    default:
      return size * componentCount(a.type);
  }
}

/// Bytes of the last element that must exist: the padding after its last column need not.
uint32_t lastElementSize(const tinygltf::Accessor& a) {
  const uint32_t size = componentSize(a.componentType);
  if (a.type == TINYGLTF_TYPE_MAT2) return elementSize(a) / 2 + 2 * size;
  if (a.type == TINYGLTF_TYPE_MAT3) return elementSize(a) / 3 * 2 + 3 * size;
  return elementSize(a);
}

void checkRange(const Document& doc, int view, uint64_t offset, uint64_t stride, uint64_t size, uint64_t count,
                const std::string& where) {
  const tinygltf::BufferView& v = doc.model.bufferViews[static_cast<size_t>(view)];
  // offset < 2^40, stride < 2^8, count < 2^32: no overflow.
  const uint64_t end = offset + stride * (count - 1) + size;
  if (end > v.byteLength)
    doc.fail(where, fmt::format("{} elements end at byte {} of bufferViews[{}], which has {}", count, end, view,
                                v.byteLength));
}

/// Calls visit(element, pointer to its bytes) for every element in the view and then for every sparse replacement.
template <class Visit>
void visitElements(Document& doc, int index, Visit visit) {
  const tinygltf::Accessor& a = doc.model.accessors[static_cast<size_t>(index)];
  const auto bytesOf = [&](int view) -> const View& {
    const View& v = doc.views[static_cast<size_t>(view)];
    if (!v.present) doc.fail(nameOf(index), fmt::format("bufferViews[{}] has no data", view));
    return v;
  };
  if (a.bufferView >= 0) {
    const View& view = bytesOf(a.bufferView);
    const uint64_t stride = view.stride != 0 ? view.stride : elementSize(a);
    const uint8_t* at = view.bytes.data() + a.byteOffset;
    for (uint64_t i = 0; i < a.count; ++i) visit(i, at + i * stride);
  }
  if (!a.sparse.isSparse) return;
  const View& indices = bytesOf(a.sparse.indices.bufferView);
  const View& values = bytesOf(a.sparse.values.bufferView);
  const uint32_t indexSize = componentSize(a.sparse.indices.componentType);
  int64_t last = -1;
  for (int i = 0; i < a.sparse.count; ++i) {
    const uint32_t element =
        componentToInteger(indices.bytes.data() + a.sparse.indices.byteOffset + static_cast<uint64_t>(i) * indexSize,
                           a.sparse.indices.componentType);
    if (element >= a.count || element <= last)
      doc.fail(nameOf(index) + ".sparse", fmt::format("index {} after {} of {} elements", element, last, a.count));
    last = element;
    visit(element, values.bytes.data() + a.sparse.values.byteOffset + static_cast<uint64_t>(i) * elementSize(a));
  }
}

}  // namespace

uint32_t componentSize(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

uint32_t componentCount(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
    case TINYGLTF_TYPE_MAT2:
      return 4;
    case TINYGLTF_TYPE_MAT3:
      return 9;
    case TINYGLTF_TYPE_MAT4:
      return 16;
    default:
      return 0;
  }
}

float componentToFloat(const uint8_t* bytes, int componentType, bool normalized) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load<float>(bytes);
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<int8_t>(bytes);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized ? bytes[0] / 255.0f : bytes[0];
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<int16_t>(bytes);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<uint16_t>(bytes);
      return normalized ? value / 65535.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<uint32_t>(bytes));
    default:
      return 0.0f;
  }
}

void verifyAccessors(const Document& doc) {
  for (size_t i = 0; i < doc.model.accessors.size(); ++i) {
    const tinygltf::Accessor& a = doc.model.accessors[i];
    const std::string where = nameOf(static_cast<int>(i));
    if (componentSize(a.componentType) == 0)
      doc.fail(where + ".componentType", fmt::format("{} is not known", a.componentType));
    if (componentCount(a.type) == 0) doc.fail(where + ".type", "is not known");
    if (a.bufferView >= 0) {
      const uint64_t stride = doc.model.bufferViews[static_cast<size_t>(a.bufferView)].byteStride;
      if (stride != 0 && stride < elementSize(a))
        doc.fail(where, fmt::format("elements of {} bytes at a stride of {}", elementSize(a), stride));
      checkRange(doc, a.bufferView, a.byteOffset, stride != 0 ? stride : elementSize(a), lastElementSize(a), a.count,
                 where);
    }
    if (!a.sparse.isSparse) continue;
    const auto& s = a.sparse;
    const int type = s.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
      doc.fail(where + ".sparse.indices.componentType", fmt::format("{} is not an unsigned integer type", type));
    if (static_cast<uint64_t>(s.count) > a.count)
      doc.fail(where + ".sparse.count", fmt::format("{} of {} elements", s.count, a.count));
    const uint64_t count = static_cast<uint64_t>(s.count);
    checkRange(doc, s.indices.bufferView, static_cast<uint64_t>(s.indices.byteOffset), componentSize(type),
               componentSize(type), count, where + ".sparse.indices");
    checkRange(doc, s.values.bufferView, static_cast<uint64_t>(s.values.byteOffset), elementSize(a), lastElementSize(a),
               count, where + ".sparse.values");
  }
}

Elements readFloats(Document& doc, int index, uint32_t components, const std::string& what) {
  const tinygltf::Accessor& a = doc.model.accessors[static_cast<size_t>(index)];
  Elements out;
  out.count = static_cast<uint32_t>(a.count);
  out.components = componentCount(a.type);
  if (components != 0 && out.components != components)
    doc.fail(what, fmt::format("{} has {} components, not {}", nameOf(index), out.components, components));
  if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) doc.fail(what, nameOf(index) + " holds 32-bit integers");
  if (a.type == TINYGLTF_TYPE_MAT2 || a.type == TINYGLTF_TYPE_MAT3)
    doc.fail(what, nameOf(index) + " holds 2x2 or 3x3 matrices");
  const uint64_t bytes = a.count * out.components * sizeof(float);
  doc.take(bytes, what);
  doc.release(bytes);  // short-lived: the caller counts what it keeps
  out.values.assign(a.count * out.components, 0.0f);
  const uint32_t size = componentSize(a.componentType);
  visitElements(doc, index, [&](uint64_t element, const uint8_t* at) {
    for (uint32_t c = 0; c < out.components; ++c)
      out.values[element * out.components + c] = componentToFloat(at + c * size, a.componentType, a.normalized);
  });
  return out;
}

std::vector<uint32_t> readIntegers(Document& doc, int index, uint32_t components, const std::string& what) {
  const tinygltf::Accessor& a = doc.model.accessors[static_cast<size_t>(index)];
  if (componentCount(a.type) != components)
    doc.fail(what, fmt::format("{} has {} components, not {}", nameOf(index), componentCount(a.type), components));
  if (a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    doc.fail(what, fmt::format("{} has component type {}, not an unsigned integer", nameOf(index), a.componentType));
  doc.take(a.count * components * sizeof(uint32_t), what);
  doc.release(a.count * components * sizeof(uint32_t));
  std::vector<uint32_t> out(a.count * components, 0u);
  const uint32_t size = componentSize(a.componentType);
  visitElements(doc, index, [&](uint64_t element, const uint8_t* at) {
    for (uint32_t c = 0; c < components; ++c)
      out[element * components + c] = componentToInteger(at + c * size, a.componentType);
  });
  return out;
}

}  // namespace irad::gltf
