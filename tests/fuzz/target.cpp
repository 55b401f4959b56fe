// libFuzzer's entry points for one reader, IRAD_FUZZ_READER.
#include <cstring>

#include "renderer/base/error.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/readers.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned int seed) {
  static const std::vector<std::string> words = irad::fuzz::readWords(IRAD_FUZZ_WORDS);
  irad::fuzz::Mutator mutate{LLVMFuzzerMutate, words, std::minstd_rand(seed)};
  const std::vector<uint8_t> out = mutate({data, size}, maxSize);
  std::memcpy(data, out.data(), out.size());
  return out.size();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    irad::fuzz::IRAD_FUZZ_READER({data, size});
  } catch (const irad::Error&) {
  }
  return 0;
}
