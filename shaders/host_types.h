// What the headers of shaders/shared have for C++ alone: types whose words shaders read as uint, and names as text.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace irad {

/// A switch in a word of a struct that shaders read: there 1 or 0.
struct Flag {
  uint32_t word;
  constexpr Flag(bool on = false) : word(on ? 1 : 0) {}
  constexpr operator bool() const { return word != 0; }
};

/// EnumNames<E>::names: the names of an enumeration's values as users write them, in order.
template <class E>
struct EnumNames;

template <class E>
constexpr const char* nameOf(E value) {
  return EnumNames<E>::names.at(static_cast<size_t>(value));
}

}  // namespace irad

// shaders/shared/enumeration.h says how these are used.
#define IRAD_ENUM_VALUE(id, text) id,
#define IRAD_ENUM_TEXT(id, text) text,
#define IRAD_ENUM(E, ROWS)                                   \
  enum class E : uint32_t { ROWS(IRAD_ENUM_VALUE) };         \
  template <>                                                \
  struct EnumNames<E> {                                      \
    static constexpr std::array names{ROWS(IRAD_ENUM_TEXT)}; \
  };

#define IRAD_SHARED_ENUM_VALUE(E, id, text, constant, number) id,
#define IRAD_SHARED_ENUM_TEXT(E, id, text, constant, number) text,
#define IRAD_SHARED_ENUM_CONSTANT(E, id, text, constant, number) \
  inline constexpr E constant = E::id;                           \
  static_assert(uint32_t(E::id) == number, "rows are numbered in order");
#define IRAD_SHARED_ENUM(E, ROWS)                                      \
  enum class E : uint32_t { ROWS(IRAD_SHARED_ENUM_VALUE, E) };         \
  template <>                                                          \
  struct EnumNames<E> {                                                \
    static constexpr std::array names{ROWS(IRAD_SHARED_ENUM_TEXT, E)}; \
  };                                                                   \
  ROWS(IRAD_SHARED_ENUM_CONSTANT, E)
