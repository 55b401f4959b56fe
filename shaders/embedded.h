// The SPIR-V modules compiled into the program.
#pragma once

#include <cstdint>
#include <span>

namespace irad {
struct EmbeddedShader {
  const char* name;        ///< "gi/trace_rays.comp"
  const char* source;      ///< path below shaders/; the name, but for variants
  const char* definition;  ///< of a variant, "NAME=VALUE"; else ""
  std::span<const uint32_t> spirv;
};
std::span<const EmbeddedShader> embeddedShaders();
}  // namespace irad
