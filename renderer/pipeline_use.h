// Which pipelines were used, what their constants leave of them, and how large that is.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace irad {

class ShaderLibrary;

struct PipelineUse {
  std::vector<std::string> shaders;
  std::map<uint32_t, uint32_t> constants;  ///< specialization: id -> value; the others are as in the shader's text
};

/// A module without what these values of its specialization constants leave out (SPIRV-Tools), and without constants
/// left to specialize.
std::vector<uint32_t> specialized(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants);

/// SPIR-V instructions of a module's functions once its specialization constants are known and what follows from them
/// is folded and left out (SPIRV-Tools): what a driver starts from.
uint64_t specializedInstructions(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants);
/// Sum over the stages of these pipelines.
uint64_t specializedInstructions(const ShaderLibrary& shaders, std::span<const PipelineUse> pipelines);

}  // namespace irad
