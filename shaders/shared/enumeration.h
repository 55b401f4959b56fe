// Enumerations: one list with a row per value, from which C++ has an enum class with its names as text (EnumNames) and
// GLSL its constants. A new value is one more row.
#ifndef IRAD_SHARED_ENUMERATION_H
#define IRAD_SHARED_ENUMERATION_H
#include "shared/types.h"

// One that C++ alone knows:
//   #define IRAD_AXES(X) X(x, "x") X(y, "y") X(automatic, "auto")
//   IRAD_ENUM(Axis, IRAD_AXES)
// One that shaders know too also names their constants and numbers them, in order:
//   #define IRAD_AXES(X, E) X(E, x, "x", AXIS_X, 0) X(E, y, "y", AXIS_Y, 1)
//   IRAD_SHARED_ENUM(Axis, IRAD_AXES)
// The constants are of the enumeration's type, for what both languages compile; C++ alone writes Axis::x.
// IRAD_AS(Axis) is the type of a member or parameter that holds such a value: a uint to shaders, as is IRAD_AS(Flag).
#ifdef __cplusplus
#include "shaders/host_types.h"
#define IRAD_AS(type) type
#else
#define IRAD_SHARED_ENUM_CONSTANT(E, id, text, constant, number) const uint constant = uint(number);
#define IRAD_SHARED_ENUM(E, ROWS) ROWS(IRAD_SHARED_ENUM_CONSTANT, E)
#define IRAD_AS(type) uint
#endif

#endif
