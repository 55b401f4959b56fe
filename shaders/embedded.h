// The SPIR-V modules compiled into the program.
#pragma once

#include <cstdint>
#include <span>

namespace irad {
struct EmbeddedShader {
  const char* name;  ///< path below shaders/, e.g. "gi/solve.comp"
  std::span<const uint32_t> spirv;
};
std::span<const EmbeddedShader> embeddedShaders();
}  // namespace irad
