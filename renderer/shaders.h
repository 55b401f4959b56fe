// SPIR-V by source name ("gi/solve.comp"): embedded at build time; recompiled with glslang on reload when the sources
// are present. The reflection is our own small reader of the words we need.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace irad {

struct ShaderBinding {
  uint32_t set = 0, binding = 0, count = 1;
  bool storageImage = false;
  bool uniformBlock = false;  ///< neither: combined image sampler
  std::string name;
  /// Equality as pipelines see it: the name does not matter.
  bool sameAs(const ShaderBinding& o) const {
    return set == o.set && binding == o.binding && count == o.count && storageImage == o.storageImage;
  }
};

struct ShaderModule {
  std::string name;
  std::vector<uint32_t> spirv;
  std::vector<ShaderBinding> bindings;  ///< sorted by set, binding
  std::array<uint32_t, 3> localSize{1, 1, 1};
  /// The specialization constants that set localSize (local_size_x_id); UINT32_MAX: fixed.
  std::array<uint32_t, 3> localSizeId{UINT32_MAX, UINT32_MAX, UINT32_MAX};
  uint32_t pushBytes = 0;                ///< size of the push-constant block
  std::vector<uint32_t> addressOffsets;  ///< where in it addresses lie, bytes, ascending
};

/// Struct layouts found in a module, for the layout test: struct name -> (member name, byte offset), total size.
struct ReflectedStruct {
  std::string name;
  std::vector<std::pair<std::string, uint32_t>> members;
  uint32_t bytes = 0;  ///< end of the last member; 0 if it is an unsized array
};
std::vector<ReflectedStruct> reflectStructs(std::span<const uint32_t> spirv);
ShaderModule reflect(std::string name, std::vector<uint32_t> spirv);
/// What a device executes: the module without its names, sources and lines.
std::vector<uint32_t> withoutDebugInfo(std::span<const uint32_t> spirv);
/// The module with other values for its specialization constants, of 32 bits each: number -> value, as Vulkan takes
/// them.
std::vector<uint32_t> withConstants(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants);

/// Instructions of the module's functions, their labels, variables and parameters included.
uint64_t functionInstructions(std::span<const uint32_t> spirv);

/// What a reload did.
struct ShaderReload {
  std::string errors;                ///< the compiler's messages; not empty: nothing was replaced
  std::vector<std::string> changed;  ///< modules that now do something else
};

class ShaderLibrary {
 public:
  ShaderLibrary();                                       ///< the embedded modules
  const ShaderModule& get(std::string_view name) const;  ///< unknown name: broken invariant, near names printed
  std::vector<std::string> names() const;
  std::vector<std::string> modified() const;  ///< embedded ones that do something else by now, after a reload
  /// Adds or replaces a module from outside the program (tests).
  void add(std::string name, std::vector<uint32_t> spirv);
  uint64_t generation() const { return generation_; }  ///< grows with every replacement; pipelines key on it

  /// Recompiles every shader of the library whose source is below `sources` (the shaders/ folder), and replaces all
  /// that have changed or, after an error, none. A module whose images or push constants have changed is an error: the
  /// program feeds it the old ones.
  ShaderReload reload(const std::filesystem::path& sources);

 private:
  std::map<std::string, ShaderModule, std::less<>> modules_;
  uint64_t generation_ = 0;
};

/// Compiles one GLSL file (includes relative to `sources`), with a definition "NAME=VALUE" where it is given; throws
/// WorkError with glslang's message.
std::vector<uint32_t> compileGlsl(const std::filesystem::path& sources, const std::string& name,
                                  std::string_view definition = {});

}  // namespace irad
