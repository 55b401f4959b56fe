// One definition, two compilers: what a header in shaders/shared/ needs to be read by GLSL and by C++.
// Structs use scalar layout (VK 1.2 scalarBlockLayout): members are aligned to their component size, as in C++ with GLM.
#ifndef IRAD_SHARED_TYPES_H
#define IRAD_SHARED_TYPES_H

#ifdef __cplusplus

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>

namespace irad {
using glm::bvec3, glm::ivec2, glm::ivec3, glm::ivec4, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3, glm::vec4;
using glm::mat3, glm::mat4;
// GLSL's functions by GLSL's names: an unqualified abs(float) would be the C library's abs(int).
using glm::abs, glm::acos, glm::atan, glm::bitCount, glm::clamp, glm::cos, glm::findLSB, glm::floor, glm::log, glm::max, glm::min, glm::pow, glm::sign, glm::sin, glm::sqrt,
    glm::uintBitsToFloat;
using uint = uint32_t;
/// What GLSL knows as a pointer: the address of an array in the device's memory, for shaders alone; or in the host's, for
/// functions of these headers that the host calls, which read and write p.at[i] as shaders do.
template <class T>
class SharedArray {
 public:
  T* at = nullptr;
  SharedArray() = default;
  SharedArray(uint64_t deviceAddress) : at(reinterpret_cast<T*>(deviceAddress)) {}
  explicit SharedArray(T* hostArray) : at(hostArray) {}
};
/// GLSL's, for threads of the host.
inline uint atomicAdd(uint& at, uint value) { return std::atomic_ref(at).fetch_add(value, std::memory_order_relaxed); }
}  // namespace irad

#define IRAD_BEGIN namespace irad {
#define IRAD_END }
#define IRAD_FN inline
#define IRAD_CONST inline constexpr
#define IRAD_INOUT(type) type&
/// No product may be fused into a sum. C++ is compiled for machines that cannot.
#define IRAD_PRECISE
/// A struct's members compare with ==.
#define IRAD_EQUALITY(type) bool operator==(const type&) const = default;
#define IRAD_ARRAY(name, type, align) using name = SharedArray<type>;

#else

#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int8 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int16 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require

#define IRAD_BEGIN
#define IRAD_END
#define IRAD_FN
#define IRAD_CONST const
#define IRAD_INOUT(type) inout type
#define IRAD_PRECISE precise
#define IRAD_EQUALITY(type)
/// `name` is a pointer: name p; p.at[i] reads or writes element i. Addresses are multiples of `align`.
#define IRAD_ARRAY(name, type, align) \
  layout(buffer_reference, scalar, buffer_reference_align = align) buffer name { type at[]; };

/// The index of this invocation in a 1D dispatch folded to 2D (renderer/frame/frame.h, Pass::dispatch). A macro, because
/// gl_GlobalInvocationID exists in compute shaders only.
#define irad_index() \
  (gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x))
/// Likewise of this workgroup (Pass::dispatchWorkgroups).
#define irad_workgroup() (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x)

#endif

IRAD_BEGIN
IRAD_ARRAY(UintArray, uint, 4)
IRAD_ARRAY(Uvec2Array, uvec2, 8)
IRAD_ARRAY(Uvec4Array, uvec4, 16)
IRAD_ARRAY(FloatArray, float, 4)
IRAD_ARRAY(Vec2Array, vec2, 8)
IRAD_ARRAY(Vec3Array, vec3, 4)
IRAD_ARRAY(Vec4Array, vec4, 16)
IRAD_CONST float IRAD_PI = 3.14159265358979f;
IRAD_END

#endif
