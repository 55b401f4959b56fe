// Errors that a person can cause or mend. Each kind carries an exit status (docs/conventions.md, Failures); broken
// invariants use IRAD_CHECK instead and are programming errors.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace irad {

/// Base of all reported errors. `exitStatus`: 1 the work failed, 2 bad usage, 3 bad input file, 4 no device or memory.
struct Error : std::runtime_error {
  Error(int status, const std::string& message) : std::runtime_error(message), exitStatus(status) {}
  int exitStatus;
};

struct WorkError : Error {
  explicit WorkError(const std::string& m) : Error(1, m) {}
};
struct UsageError : Error {
  explicit UsageError(const std::string& m) : Error(2, m) {}
};
/// The message names the file, the object in it and the offending value.
struct InputError : Error {
  explicit InputError(const std::string& m) : Error(3, m) {}
};
struct DeviceError : Error {
  explicit DeviceError(const std::string& m) : Error(4, m) {}
};

[[noreturn]] void invariantFailed(const char* file, int line, const std::string& message);

/// Asserts in release builds too; prints both values.
#define IRAD_CHECK_OP(a, op, b)                                                                                     \
  do {                                                                                                              \
    const auto irad_a = (a);                                                                                        \
    const auto irad_b = (b);                                                                                        \
    if (!(irad_a op irad_b))                                                                                        \
      ::irad::invariantFailed(__FILE__, __LINE__, fmt::format("{} ({} vs {})", #a " " #op " " #b, irad_a, irad_b)); \
  } while (false)
#define IRAD_CHECK(condition, ...)                                                                             \
  do {                                                                                                         \
    if (!(condition)) ::irad::invariantFailed(__FILE__, __LINE__, #condition ": " + fmt::format(__VA_ARGS__)); \
  } while (false)

}  // namespace irad
