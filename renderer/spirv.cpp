// A small reader of SPIR-V: what pipelines and the layout test need to know of a module (SPIR-V specification 1.6,
// section 3, "Binary Form").
#include <algorithm>
#include <unordered_map>

#include "renderer/base/error.h"
#include "renderer/shaders.h"

namespace irad {
namespace {

enum Op : uint32_t {
  OpSourceContinued = 2,
  OpSource = 3,
  OpSourceExtension = 4,
  OpName = 5,
  OpMemberName = 6,
  OpString = 7,
  OpLine = 8,
  OpExecutionMode = 16,
  OpTypeInt = 21,
  OpTypeFloat = 22,
  OpTypeVector = 23,
  OpTypeMatrix = 24,
  OpTypeImage = 25,
  OpTypeSampledImage = 27,
  OpTypeArray = 28,
  OpTypeRuntimeArray = 29,
  OpTypeStruct = 30,
  OpTypePointer = 32,
  OpConstant = 43,
  OpSpecConstantTrue = 48,
  OpSpecConstantFalse = 49,
  OpSpecConstant = 50,
  OpConstantComposite = 44,
  OpSpecConstantComposite = 51,
  OpFunction = 54,
  OpFunctionEnd = 56,
  OpVariable = 59,
  OpDecorate = 71,
  OpMemberDecorate = 72,
  OpNoLine = 317,
  OpModuleProcessed = 330,
  OpExecutionModeId = 331,
};
enum Decoration : uint32_t {
  SpecId = 1,
  ArrayStride = 6,
  MatrixStride = 7,
  BuiltIn = 11,
  Binding = 33,
  DescriptorSet = 34,
  Offset = 35
};
constexpr size_t kHeaderWords = 5;
constexpr uint32_t kLocalSize = 17, kLocalSizeId = 38, kWorkgroupSize = 25, kPushConstant = 9, kUniform = 2,
                   kNone = UINT32_MAX;

struct Type {
  uint32_t op = 0;
  std::vector<uint32_t> operands;  ///< words after the result id
};
struct Member {
  std::string name;
  uint32_t offset = kNone, matrixStride = 0;
};
struct Id {
  std::string name;
  uint32_t binding = kNone, set = 0, specId = kNone, arrayStride = 0, builtIn = kNone;
  std::vector<Member> members;
  Member& member(uint32_t i) {
    if (members.size() <= i) members.resize(i + 1);
    return members[i];
  }
};
struct Variable {
  uint32_t id, pointerType, storage;
};

struct Parsed {
  std::unordered_map<uint32_t, Id> ids;
  std::unordered_map<uint32_t, Type> types;
  std::unordered_map<uint32_t, uint32_t> constants;
  std::unordered_map<uint32_t, std::vector<uint32_t>> composites;
  std::vector<uint32_t> structs;  ///< in order of declaration
  std::vector<Variable> variables;
  std::vector<uint32_t> localSize;    ///< literals
  std::vector<uint32_t> localSizeId;  ///< ids of constants

  uint32_t size(uint32_t type, uint32_t matrixStride = 0) const;
  uint32_t structSize(uint32_t type) const;
  /// Adds where the addresses lie in a `type` that begins at `at`.
  void addresses(uint32_t type, uint32_t at, std::vector<uint32_t>& out) const;
};

std::string text(std::span<const uint32_t> words) {
  std::string s;
  for (const uint32_t word : words)
    for (int shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(word >> shift & 0xFF);
      if (c == 0) return s;
      s += c;
    }
  return s;
}

/// Calls visit(opcode, all words of the instruction) for each instruction after the header.
template <class Visit>
void forEachInstruction(std::span<const uint32_t> spirv, Visit visit) {
  IRAD_CHECK(spirv.size() > kHeaderWords && spirv[0] == 0x07230203, "not SPIR-V: {} words", spirv.size());
  for (size_t at = kHeaderWords; at < spirv.size();) {
    const uint32_t op = spirv[at] & 0xFFFF, length = spirv[at] >> 16;
    IRAD_CHECK(length > 0 && at + length <= spirv.size(), "instruction of {} words at {}", length, at);
    visit(op, spirv.subspan(at, length));
    at += length;
  }
}

Parsed parse(std::span<const uint32_t> spirv) {
  Parsed p;
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t> words) {
    const std::span<const uint32_t> w = words.subspan(1);
    switch (op) {
      case OpName:
        p.ids[w[0]].name = text(w.subspan(1));
        break;
      case OpMemberName:
        p.ids[w[0]].member(w[1]).name = text(w.subspan(2));
        break;
      case OpExecutionMode:
        if (w[1] == kLocalSize) p.localSize.assign(w.begin() + 2, w.end());
        break;
      case OpExecutionModeId:
        if (w[1] == kLocalSizeId) p.localSizeId.assign(w.begin() + 2, w.end());
        break;
      case OpDecorate:
        if (w.size() < 3) break;
        if (w[1] == SpecId) p.ids[w[0]].specId = w[2];
        if (w[1] == ArrayStride) p.ids[w[0]].arrayStride = w[2];
        if (w[1] == BuiltIn) p.ids[w[0]].builtIn = w[2];
        if (w[1] == Binding) p.ids[w[0]].binding = w[2];
        if (w[1] == DescriptorSet) p.ids[w[0]].set = w[2];
        break;
      case OpMemberDecorate:
        if (w[2] == Offset) p.ids[w[0]].member(w[1]).offset = w[3];
        if (w[2] == MatrixStride) p.ids[w[0]].member(w[1]).matrixStride = w[3];
        break;
      case OpTypeStruct:
        p.structs.push_back(w[0]);
        [[fallthrough]];
      case OpTypeInt:
      case OpTypeFloat:
      case OpTypeVector:
      case OpTypeMatrix:
      case OpTypeImage:
      case OpTypeSampledImage:
      case OpTypeArray:
      case OpTypeRuntimeArray:
      case OpTypePointer:
        p.types[w[0]] = {op, {w.begin() + 1, w.end()}};
        break;
      case OpConstant:
      case OpSpecConstant:
        p.constants[w[1]] = w[2];
        break;
      case OpConstantComposite:
      case OpSpecConstantComposite:
        p.composites[w[1]].assign(w.begin() + 2, w.end());
        break;
      case OpVariable:
        p.variables.push_back({w[1], w[0], w[2]});
        break;
      default:
        break;
    }
  });
  return p;
}

uint32_t Parsed::size(uint32_t id, uint32_t matrixStride) const {
  const auto it = types.find(id);
  if (it == types.end()) return 0;
  const Type& t = it->second;
  switch (t.op) {
    case OpTypeInt:
    case OpTypeFloat:
      return t.operands[0] / 8;
    case OpTypeVector:
      return t.operands[1] * size(t.operands[0]);
    case OpTypeMatrix:
      return t.operands[1] * (matrixStride ? matrixStride : size(t.operands[0]));
    case OpTypeArray: {
      const auto decorated = ids.find(id);
      const uint32_t stride = decorated != ids.end() ? decorated->second.arrayStride : 0;
      const auto count = constants.find(t.operands[1]);
      return (count == constants.end() ? 0 : count->second) * (stride ? stride : size(t.operands[0], matrixStride));
    }
    case OpTypeStruct:
      return structSize(id);
    case OpTypePointer:
      return 8;  // a device address
    default:
      return 0;
  }
}

uint32_t Parsed::structSize(uint32_t id) const {
  const auto decorated = ids.find(id);
  const Type& t = types.at(id);
  uint32_t end = 0;
  if (decorated == ids.end()) return 0;
  for (size_t i = 0; i < t.operands.size() && i < decorated->second.members.size(); ++i) {
    const Member& m = decorated->second.members[i];
    if (m.offset != kNone) end = std::max(end, m.offset + size(t.operands[i], m.matrixStride));
  }
  return end;
}

void Parsed::addresses(uint32_t id, uint32_t at, std::vector<uint32_t>& out) const {
  const auto it = types.find(id);
  if (it == types.end()) return;
  const Type& t = it->second;
  const auto decorated = ids.find(id);
  if (t.op == OpTypePointer) out.push_back(at);
  if (decorated == ids.end()) return;
  if (t.op == OpTypeStruct)
    for (size_t i = 0; i < t.operands.size() && i < decorated->second.members.size(); ++i)
      addresses(t.operands[i], at + decorated->second.members[i].offset, out);
  if (t.op == OpTypeArray)
    for (uint32_t i = 0, stride = decorated->second.arrayStride; i < constants.at(t.operands[1]); ++i)
      addresses(t.operands[0], at + i * stride, out);
}

ShaderBinding binding(const Parsed& p, const Variable& variable, const Id& id, const std::string& module) {
  ShaderBinding b;
  b.set = id.set;
  b.binding = id.binding;
  b.name = id.name;
  uint32_t type = p.types.at(variable.pointerType).operands[1];
  if (p.types.at(type).op == OpTypeArray) {
    b.count = p.constants.at(p.types.at(type).operands[1]);
    type = p.types.at(type).operands[0];
  }
  const uint32_t op = p.types.at(type).op;
  b.storageImage = op == OpTypeImage;
  b.uniformBlock = op == OpTypeStruct && variable.storage == kUniform;
  if (!b.storageImage && !b.uniformBlock && op != OpTypeSampledImage)
    throw WorkError(
        fmt::format("{}: set {} binding {} ({}) is neither image nor combined sampler nor uniform block; storage "
                    "buffers travel by address",
                    module, b.set, b.binding, b.name));
  return b;
}

}  // namespace

ShaderModule reflect(std::string name, std::vector<uint32_t> spirv) {
  const Parsed p = parse(spirv);
  ShaderModule module;
  for (const Variable& variable : p.variables) {
    const auto id = p.ids.find(variable.id);
    if (variable.storage == kPushConstant) {
      const uint32_t block = p.types.at(variable.pointerType).operands[1];
      module.pushBytes = p.size(block);
      p.addresses(block, 0, module.addressOffsets);
    } else if (id != p.ids.end() && id->second.binding != kNone)
      module.bindings.push_back(binding(p, variable, id->second, name));
  }
  std::sort(module.bindings.begin(), module.bindings.end(),
            [](const auto& a, const auto& b) { return std::pair(a.set, a.binding) < std::pair(b.set, b.binding); });

  // The workgroup: literals, ids of constants, or the WorkgroupSize built-in, which overrides both.
  for (size_t i = 0; i < p.localSize.size() && i < 3; ++i) module.localSize[i] = p.localSize[i];
  std::vector<uint32_t> sizeIds = p.localSizeId;
  for (const auto& [id, parts] : p.composites)
    if (const auto it = p.ids.find(id); it != p.ids.end() && it->second.builtIn == kWorkgroupSize) sizeIds = parts;
  for (size_t i = 0; i < sizeIds.size() && i < 3; ++i) {
    module.localSize[i] = p.constants.at(sizeIds[i]);
    if (const auto it = p.ids.find(sizeIds[i]); it != p.ids.end()) module.localSizeId[i] = it->second.specId;
  }
  module.name = std::move(name);
  module.spirv = std::move(spirv);
  return module;
}

std::vector<uint32_t> withoutDebugInfo(std::span<const uint32_t> spirv) {
  std::vector<uint32_t> code;
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t> words) {
    constexpr Op kDebug[] = {OpSourceContinued, OpSource, OpSourceExtension, OpName,           OpMemberName,
                             OpString,          OpLine,   OpNoLine,          OpModuleProcessed};
    if (std::find(std::begin(kDebug), std::end(kDebug), op) == std::end(kDebug))
      code.insert(code.end(), words.begin(), words.end());
  });
  return code;
}

std::vector<uint32_t> withConstants(std::span<const uint32_t> spirv, const std::map<uint32_t, uint32_t>& constants) {
  std::vector<uint32_t> code(spirv.begin(), spirv.end());
  std::unordered_map<uint32_t, uint32_t> values;  // by SPIR-V's id
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t> words) {
    uint32_t* const out = code.data() + (words.data() - spirv.data());
    if (op == OpDecorate && words[2] == SpecId) {
      if (const auto it = constants.find(words[3]); it != constants.end()) values[words[1]] = it->second;
    } else if (op == OpSpecConstantTrue || op == OpSpecConstantFalse) {
      if (const auto it = values.find(words[2]); it != values.end())
        out[0] = (words[0] & ~0xFFFFu) | (it->second != 0 ? OpSpecConstantTrue : OpSpecConstantFalse);
    } else if (op == OpSpecConstant) {
      if (const auto it = values.find(words[2]); it != values.end()) out[3] = it->second;
    }
  });
  return code;
}

uint64_t functionInstructions(std::span<const uint32_t> spirv) {
  uint64_t count = 0;
  bool inside = false;
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t>) {
    inside |= op == OpFunction;
    count += inside ? 1 : 0;
    inside &= op != OpFunctionEnd;
  });
  return count;
}

std::vector<ReflectedStruct> reflectStructs(std::span<const uint32_t> spirv) {
  const Parsed p = parse(spirv);
  std::vector<ReflectedStruct> structs;
  for (const uint32_t id : p.structs) {
    const auto it = p.ids.find(id);
    if (it == p.ids.end()) continue;
    // Structs without offsets are copies in registers; their layout means nothing.
    ReflectedStruct s;
    s.name = it->second.name;
    bool laidOut = !it->second.members.empty();
    for (const Member& m : it->second.members) {
      laidOut &= m.offset != kNone;
      s.members.emplace_back(m.name, m.offset);
    }
    if (!laidOut || s.name.empty()) continue;
    s.bytes = p.structSize(id);
    structs.push_back(std::move(s));
  }
  return structs;
}

}  // namespace irad
