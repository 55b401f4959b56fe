// The file and its container. GLB: glTF 2.0 specification, section 4 (binary glTF layout).
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/base/json_extent.h"
#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

constexpr uint64_t kMaxJsonBytes = 64ull << 20;
constexpr uint64_t kMaxJsonElements = 8'000'000;  // 300,000 nodes have up to 7 million
constexpr uint64_t kJsonElementBytes = 48;        // about what one takes as a value
constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

uint32_t readU32(ByteSpan bytes, size_t at) {
  uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

void readGlb(Document& doc) {
  const ByteSpan all = doc.file;
  if (all.size() < 20) doc.fail("GLB header", fmt::format("the file ends after {} bytes", all.size()));
  const uint32_t version = readU32(all, 4), length = readU32(all, 8);
  if (version == 1) doc.fail("GLB header", fmt::format("version 1: {}", kOldFormat));
  if (version != 2) doc.fail("GLB header", fmt::format("version {} is not 2", version));
  if (length > all.size() || length < 20)
    doc.fail("GLB header", fmt::format("states {} bytes, the file has {}", length, all.size()));
  uint64_t at = 12;
  bool first = true;
  while (at < length) {
    if (at + 8 > length) doc.fail("GLB chunk", fmt::format("its header at byte {} is truncated", at));
    const uint32_t size = readU32(all, at), type = readU32(all, at + 4);
    if (at + 8 + size > length)
      doc.fail("GLB chunk", fmt::format("at byte {} states {} bytes, {} are left", at, size, length - at - 8));
    if (size % 4 != 0) doc.fail("GLB chunk", fmt::format("at byte {}: length {} is not a multiple of 4", at, size));
    const ByteSpan body = all.subspan(at + 8, size);
    if (first && type != kJsonChunk) doc.fail("GLB chunk", "the first chunk is not JSON");
    if (!first && type == kJsonChunk) doc.fail("GLB chunk", "a second JSON chunk");
    if (type == kBinChunk) {
      if (doc.hasBin) doc.fail("GLB chunk", "a second BIN chunk");
      doc.bin = body;
      doc.hasBin = true;
    } else if (type == kJsonChunk) {
      doc.json = body;
    }
    first = false;
    at += 8 + uint64_t{size};
  }
}

/// Depth and size of the JSON before any parser sees it.
void checkJson(Document& doc) {
  if (doc.json.size() > kMaxJsonBytes)
    doc.fail("JSON", fmt::format("{} bytes, at most {} are accepted", doc.json.size(), kMaxJsonBytes));
  const JsonExtent extent = jsonExtent({reinterpret_cast<const char*>(doc.json.data()), doc.json.size()});
  if (extent.depth > kMaxJsonDepth)
    doc.fail("JSON", fmt::format("nested deeper than {} levels ({})", kMaxJsonDepth, extent.depth));
  if (extent.elements > kMaxJsonElements) doc.fail("JSON", fmt::format("more than {} elements", kMaxJsonElements));
  doc.take(extent.elements * kJsonElementBytes, "JSON");
}

}  // namespace

Document::Document() = default;
Document::~Document() = default;

void Document::fail(const std::string& object, const std::string& text) const {
  throw InputError(fmt::format("{}: {}: {}", path.string(), object, text));
}

void Document::warn(const std::string& text) {
  constexpr size_t kMaxWarnings = 200;
  if (std::find(warnings.begin(), warnings.end(), text) != warnings.end()) return;
  if (warnings.size() < kMaxWarnings) warnings.push_back(text);
  if (warnings.size() == kMaxWarnings) warnings.push_back("further warnings are left out");
}

void Document::take(uint64_t bytes, const std::string& object) {
  if (bytes > kMemoryBudget || used_ + bytes > kMemoryBudget)
    fail(object, fmt::format("needs {} MiB beside {} MiB in use; a scene may hold {} MiB", bytes >> 20, used_ >> 20,
                             kMemoryBudget >> 20));
  used_ += bytes;
}

std::string whyNoFile(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_regular_file(status)) return "";
  if (std::filesystem::is_directory(status)) return "is a folder, not a file";
  if (std::filesystem::exists(status)) return "is a device or a pipe, not a file";
  if (status.type() == std::filesystem::file_type::none && error) return error.message();
  return "no such file";
}

Bytes readFile(const std::filesystem::path& path, uint64_t maxBytes, std::string& why) {
  std::error_code error;
  why = whyNoFile(path);
  if (!why.empty()) return {};
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error || size > maxBytes) {
    why = error ? error.message() : fmt::format("{} bytes, at most {} are accepted", size, maxBytes);
    return {};
  }
  Bytes bytes(size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in || static_cast<uint64_t>(in.gcount()) != size) {
    why = "cannot be read";
    return {};
  }
  return bytes;
}

void readContainer(Document& doc) {
  std::string why;
  doc.file = readFile(doc.path, kMemoryBudget, why);
  if (!why.empty()) throw InputError(fmt::format("{}: {}", doc.path.string(), why));
  doc.take(doc.file.size(), "file");
  if (doc.file.empty()) doc.fail("file", "is empty");
  if (doc.file.size() >= 4 && readU32(doc.file, 0) == kMagic) {
    readGlb(doc);
  } else if (doc.path.extension() == ".glb" || doc.path.extension() == ".GLB") {
    doc.fail("GLB header", "does not begin with 'glTF'");
  } else {
    doc.json = doc.file;
  }
  checkJson(doc);
  readJson(doc);
  if (!doc.root->is_object()) doc.fail("JSON", "the root is not an object");
}

}  // namespace irad::gltf
