// .irscene: a loaded scene with its images decoded, for machines without image decoders. Little-endian, fields in the
// order of Scene, with nothing of what is hidden. Version 2 had no nodes, and is read as a scene without; up to
// version 3 lights had no switch, and are on; up to version 4 nothing was transmitted. Reading trusts nothing: every
// length is checked against the bytes left, and the whole against what a scene must be.
#include <bit>
#include <cstring>
#include <type_traits>

#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/gltf_document.h"
#include "renderer/scene/nodes.h"

namespace irad {
namespace {

static_assert(std::endian::native == std::endian::little, "the cache is written as it lies in memory");
constexpr char kMagic[8] = {'I', 'R', 'S', 'C', 'E', 'N', 'E', '\n'};
constexpr uint32_t kVersion = 5, kOldestVersion = 2;

class Writer {
 public:
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* bytes = reinterpret_cast<const char*>(&value);
    data.append(bytes, sizeof value);
  }
  void operator()(const std::string& text) { array(text); }
  template <class Container>
  void array(const Container& values) {
    (*this)(static_cast<uint64_t>(values.size()));
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    data.append(bytes, values.size() * sizeof(values[0]));
  }
  template <class T, class Each>
  void list(const std::vector<T>& values, Each each) {
    (*this)(static_cast<uint64_t>(values.size()));
    for (const T& value : values) each(value);
  }
  std::string data;
};

class Reader {
 public:
  Reader(std::span<const uint8_t> bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(fmt::format("{}: byte {}: {}", file_, at_, text));
  }

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    copy(&value, sizeof value);
  }
  void operator()(std::string& text) { array(text); }
  /// A bool or an enum below `end`: other bit patterns would be undefined values.
  template <class T>
  void choice(T& value, uint32_t end) {
    uint32_t raw = 0;
    (*this)(raw);
    if (raw >= end) fail(fmt::format("{} is not below {}", raw, end));
    value = static_cast<T>(raw);
  }
  template <class Container>
  void array(Container& values) {
    const uint64_t count = size(sizeof(values[0]));
    values.resize(count);
    copy(values.data(), count * sizeof(values[0]));
  }
  template <class T, class Each>
  void list(std::vector<T>& values, Each each) {
    // One by one: an element may be far larger in memory than in the file.
    for (uint64_t left = size(1); left > 0; --left) each(values.emplace_back());
  }
  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  uint64_t size(uint64_t elementBytes) {
    uint64_t count = 0;
    (*this)(count);
    if (count > (bytes_.size() - at_) / elementBytes)
      fail(fmt::format("{} elements do not fit into the rest of the file", count));
    return count;
  }
  void copy(void* to, uint64_t count) {
    if (count > bytes_.size() - at_) fail("the file is truncated");
    if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
  }
  std::span<const uint8_t> bytes_;
  std::string file_;
  uint64_t at_ = 0;
};

struct WriteOps {
  Writer& io;
  template <class T>
  void choice(const T& value, uint32_t) {
    io(static_cast<uint32_t>(value));
  }
};
struct ReadOps {
  Reader& io;
  template <class T>
  void choice(T& value, uint32_t end) {
    io.choice(value, end);
  }
};

// One description of the fields serves both directions.
template <class Io, class Ops, class S>
void transfer(Io& io, Ops ops, S& sampler) {
  ops.choice(sampler.u, 3), ops.choice(sampler.v, 3);
  for (auto* flag : {&sampler.linearMag, &sampler.linearMin, &sampler.mips, &sampler.linearMips}) ops.choice(*flag, 2);
  (void)io;
}
template <class Io, class Ops, class U>
void transferUse(Io& io, Ops ops, U& use) {
  io(use.image), io(use.transform), ops.choice(use.uvSet, 2);
  transfer(io, ops, use.sampler);
}
template <class Io, class Ops, class M>
void transferMaterial(Io& io, Ops ops, M& m) {
  io(m.name), io(m.baseColor), io(m.metallic), io(m.roughness), io(m.emission), io(m.normalScale),
      io(m.occlusionStrength);
  io(m.alphaCutoff), ops.choice(m.alpha, 3), ops.choice(m.doubleSided, 2);
  for (auto* use :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture, &m.emissiveTexture})
    transferUse(io, ops, *use);
}
template <class Io, class Ops, class S>
void transferScene(Io& io, Ops ops, S& s, uint32_t version) {
  io(s.sha256), io(s.origin), io(s.boundsMin), io(s.boundsMax);
  io.array(s.positions), io.array(s.normals), io.array(s.tangents), io.array(s.uv0), io.array(s.uv1),
      io.array(s.colors);
  io.array(s.indices), io.array(s.draws);
  io.list(s.materials, [&](auto& m) { transferMaterial(io, ops, m); });
  io.list(s.images, [&](auto& i) { io(i.name), io(i.width), io(i.height), ops.choice(i.srgb, 2), io.array(i.rgba); });
  io.list(s.lights, [&](auto& l) {
    io(l.name), ops.choice(l.type, LIGHT_KINDS), io(l.position), io(l.direction), io(l.color), io(l.intensity),
        io(l.range);
    io(l.innerCos), io(l.outerCos), io(l.angle), io(l.radius);
    if (version >= 4) ops.choice(l.on, 2);
  });
  io.list(s.cameras, [&](auto& c) {
    io(c.name), io(c.position), io(c.orientation), ops.choice(c.orthographic, 2), io(c.yfov), io(c.ymag), io(c.aspect);
    io(c.znear), io(c.zfar);
  });
  io.list(s.warnings, [&](auto& w) { io(w); });
  ops.choice(s.defaultCamera, 2), ops.choice(s.defaultLight, 2);
  if (version < 3) return;
  io.list(s.nodes, [&](auto& n) { io(n.name), io(n.parent), io(n.end), io(n.instances); });
  io.array(s.pieces), io.array(s.world);
  if (version < 5) return;
  for (auto& m : s.materials) {
    io(m.transmission);
    transferUse(io, ops, m.transmissionTexture);
  }
}

}  // namespace

void writeSceneCache(const Scene& scene, const std::filesystem::path& path) {
  Writer io;
  io(kMagic), io(kVersion);
  transferScene(io, WriteOps{io}, scene, kVersion);
  writeFile(path, io.data);
}

Scene readSceneCache(const std::filesystem::path& path) {
  std::string why;
  const gltf::Bytes bytes = gltf::readFile(path, 4ull << 30, why);
  if (!why.empty()) throw InputError(fmt::format("{}: {}", path.string(), why));
  Reader io(bytes, path.string());
  char magic[8];
  uint32_t version = 0;
  io(magic), io(version);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0) io.fail("is not an .irscene file");
  if (version < kOldestVersion || version > kVersion)
    io.fail(fmt::format("version {}; this program reads {} to {}", version, kOldestVersion, kVersion));
  Scene scene;
  transferScene(io, ReadOps{io}, scene, version);
  if (!io.atEnd()) io.fail("bytes follow the end of the scene");
  if (const std::string problem = unsound(scene); !problem.empty())
    throw InputError(fmt::format("{}: {}", path.string(), problem));
  measureNodes(scene);
  scene.path = path;
  return scene;
}

}  // namespace irad
