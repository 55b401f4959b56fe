// Changes to inputs that keep their form: JSON stays JSON, and a GLB's header and chunks agree with its contents. Bytes
// flipped blindly are nearly always refused by the first check.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace irad::fuzz {

struct Mutator {
  /// Changes bytes in place, to at most `capacity` of them; returns how many there are then. (LLVMFuzzerMutate.)
  std::function<size_t(uint8_t* data, size_t size, size_t capacity)> bytes;
  std::vector<std::string> words;  ///< keys and values worth trying
  std::minstd_rand random;

  /// `in` with one to four changes; JSON text and GLB by structure, all else by bytes. At most `capacity` long.
  std::vector<uint8_t> operator()(std::span<const uint8_t> in, size_t capacity);
};

/// The entries of a libFuzzer dictionary: lines "word" without escapes; others are left out.
std::vector<std::string> readWords(const char* path);

}  // namespace irad::fuzz
