// Buffers and bufferViews: where the bytes come from, and that every range lies inside them.
#include <array>
#include <nlohmann/json.hpp>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// RFC 3986 percent-decoding; a stray '%' stays as it is, because exporters write plain file names.
std::string percentDecode(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0) {
      out += static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

bool decodeBase64(std::string_view text, Bytes& out) {
  static const std::array<int8_t, 256> table = [] {
    std::array<int8_t, 256> t;
    t.fill(-1);
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < digits.size(); ++i) t[static_cast<uint8_t>(digits[i])] = static_cast<int8_t>(i);
    return t;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  out.clear();
  out.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int8_t digit = table[static_cast<uint8_t>(c)];
    if (digit < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    held += 6;
    if (held >= 8) {
      held -= 8;
      out.push_back(static_cast<uint8_t>(bits >> held));
    }
  }
  return true;
}

void loadBuffer(Document& doc, const Json& buffer, size_t index) {
  const std::string where = fmt::format("buffers[{}]", index);
  const uint64_t length = buffer.at("byteLength").get<uint64_t>();
  ByteSpan bytes;
  bool present = true;
  if (!buffer.contains("uri")) {
    present = index == 0 && doc.hasBin;
    if (present) bytes = doc.bin;
  } else {
    const std::string uri = buffer.at("uri").get<std::string>();
    Bytes data;
    if (isDataUri(uri)) {
      std::string mime;
      doc.take(uri.size(), where);
      if (!decodeDataUri(uri, data, mime)) doc.fail(where + ".uri", "is a malformed data URI");
    } else {
      std::string why;
      const std::filesystem::path path = resolveUri(doc, uri, why);
      if (why.empty()) data = readFile(path, kMemoryBudget, why);
      if (!why.empty()) doc.fail(where + ".uri", fmt::format("\"{}\": {}", uri.substr(0, 200), why));
      doc.take(data.size(), where);
    }
    doc.owned.push_back(std::move(data));
    bytes = doc.owned.back();
  }
  if (present && bytes.size() < length)
    doc.fail(where, fmt::format("byteLength {} exceeds the {} bytes of its data", length, bytes.size()));
  doc.buffers.push_back(present ? bytes.first(length) : bytes);
  doc.bufferPresent.push_back(present);
}

/// The range [offset, offset + length) of a buffer; both are below 2^41, so the sum cannot wrap.
ByteSpan range(const Document& doc, size_t buffer, uint64_t offset, uint64_t length, const std::string& where) {
  const uint64_t declared = doc.root->at("buffers")[buffer].at("byteLength").get<uint64_t>();
  if (offset + length > declared)
    doc.fail(where, fmt::format("bytes {} to {} lie outside buffers[{}] ({} bytes)", offset, offset + length, buffer,
                                declared));
  return doc.bufferPresent[buffer] ? doc.buffers[buffer].subspan(offset, length) : ByteSpan();
}

}  // namespace

bool isDataUri(const std::string& uri) {
  return uri.rfind("data:", 0) == 0;
}

bool decodeDataUri(const std::string& uri, Bytes& out, std::string& mime) {
  // RFC 2397: data:[type][;base64],data; without base64 the data is percent-encoded text.
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return false;
  const std::string header = uri.substr(5, comma - 5);
  mime = header.substr(0, header.find(';'));
  const size_t semicolon = header.rfind(';');
  if (semicolon != std::string::npos && header.substr(semicolon) == ";base64")
    return decodeBase64(std::string_view(uri).substr(comma + 1), out);
  const std::string text = percentDecode(uri.substr(comma + 1));
  out.assign(text.begin(), text.end());
  return true;
}

std::filesystem::path resolveUri(const Document& doc, const std::string& uri, std::string& why) {
  const std::string name = percentDecode(uri);
  if (name.empty() || name.find('\0') != std::string::npos) return why = "is not a file name", std::filesystem::path();
  if (name.find('\\') != std::string::npos) return why = "holds a backslash", std::filesystem::path();
  if (const size_t colon = name.find(':'); colon != std::string::npos && name.find('/') > colon)
    return why = "names a scheme; only files beside the scene are read", std::filesystem::path();
  const std::filesystem::path relative(name);
  if (relative.is_absolute()) return why = "is an absolute path", std::filesystem::path();
  for (const auto& part : relative)
    if (part == "..") return why = "leaves the scene's folder", std::filesystem::path();
  // Symbolic links may not lead out either.
  std::error_code error;
  const auto folder = std::filesystem::weakly_canonical(doc.folder, error);
  const auto file = std::filesystem::weakly_canonical(doc.folder / relative, error);
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  if (error || end != folder.end()) return why = "leaves the scene's folder", std::filesystem::path();
  return file;
}

void loadBuffers(Document& doc) {
  if (doc.root->contains("buffers")) {
    const Json& buffers = doc.root->at("buffers");
    doc.owned.reserve(buffers.size() + doc.model.bufferViews.size());
    for (size_t i = 0; i < buffers.size(); ++i) loadBuffer(doc, buffers[i], i);
  }
  if (!doc.root->contains("bufferViews")) return;
  const Json& views = doc.root->at("bufferViews");
  for (size_t i = 0; i < views.size(); ++i) {
    const std::string where = fmt::format("bufferViews[{}]", i);
    const Json& json = views[i];
    View view;
    const size_t buffer = json.at("buffer").get<size_t>();
    const uint64_t length = json.at("byteLength").get<uint64_t>();
    view.bytes = range(doc, buffer, json.value("byteOffset", uint64_t{0}), length, where);
    view.stride = json.value("byteStride", 0u);
    view.present = doc.bufferPresent[buffer];
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      if (!json.contains("extensions") || !json.at("extensions").contains(name)) continue;
      const Json& packed = json.at("extensions").at(name);
      const std::string at = where + "." + name;
      const size_t source = packed.at("buffer").get<size_t>();
      const ByteSpan bytes =
          range(doc, source, packed.value("byteOffset", uint64_t{0}), packed.at("byteLength").get<uint64_t>(), at);
      if (!doc.bufferPresent[source]) doc.fail(at, fmt::format("buffers[{}] has no data", source));
      const uint64_t count = packed.at("count").get<uint64_t>(), stride = packed.at("byteStride").get<uint64_t>();
      if (count * stride != length)
        doc.fail(at, fmt::format("{} elements of {} bytes are not the view's {} bytes", count, stride, length));
      doc.take(length, at);
      doc.owned.push_back(decodeMeshopt(doc, bytes, static_cast<uint32_t>(count), static_cast<uint32_t>(stride),
                                        packed.at("mode").get<std::string>(),
                                        packed.value("filter", std::string("NONE")), at));
      view.bytes = doc.owned.back();
      view.present = true;
    }
    doc.views.push_back(view);
  }
}

}  // namespace irad::gltf
