// Every seed of the fuzzer, on every run: what the fuzzer starts from is read, and what once broke a reader
// (regression-*) is read or refused in words.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <vector>

#include "renderer/base/error.h"
#include "tests/fuzz/readers.h"
#include "tests/support.h"

namespace irad::fuzz::fuzz_seeds_suite {
namespace {

namespace fs = std::filesystem;

struct Reader {
  const char* name;
  void (*read)(Bytes);
};

class FuzzSeeds : public ::testing::TestWithParam<Reader> {};

TEST_P(FuzzSeeds, AreReadOrRefused) {
  size_t seeds = 0;
  for (const auto& entry : fs::directory_iterator(test::sourceFolder() / "tests/fuzz/seeds" / GetParam().name)) {
    const std::string name = entry.path().filename().string();
    std::ifstream in(entry.path(), std::ios::binary);
    const std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
    const auto start = std::chrono::steady_clock::now();
    try {
      GetParam().read(bytes);
    } catch (const Error& error) {
#ifdef IRAD_OIIO  // the portable build decodes neither images nor meshopt streams
      EXPECT_TRUE(name.starts_with("regression-")) << name << ": " << error.what();
#endif
    } catch (const std::exception& error) {
      ADD_FAILURE() << name << ": " << error.what();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10)) << name;
    seeds += !name.starts_with("regression-");
  }
  EXPECT_GT(seeds, 0u);
}

#define IRAD_FUZZ_ROW(name) Reader{#name, name},
const Reader kReaders[] = {IRAD_FUZZ_READERS(IRAD_FUZZ_ROW)};
#undef IRAD_FUZZ_ROW
INSTANTIATE_TEST_SUITE_P(Readers, FuzzSeeds, ::testing::ValuesIn(kReaders),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace irad::fuzz::fuzz_seeds_suite
