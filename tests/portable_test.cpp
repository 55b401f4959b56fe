// The headless binary for another Linux, which is built beside the full one (portable/irad there).
#include <fstream>
#include <sstream>
#include <tuple>

#include "tests/exr.h"
#include "tests/support.h"

namespace irad::test::portable_suite {
namespace {

namespace fs = std::filesystem;

class Portable : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(program_)) GTEST_SKIP() << program_ << " is not built: this build is the portable one";
  }
  const fs::path program_ = fs::path(iradProgram()).parent_path() / "portable" / "irad";
};

ExrPicture readPfm(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string magic;
  ExrPicture out;
  double scale = 0;
  in >> magic >> out.width >> out.height >> scale;
  in.get();
  if (magic != "PF" || scale != -1) throw std::runtime_error(path.string() + " is no little-endian colour PFM");
  out.pixels.resize(static_cast<size_t>(out.width) * out.height);
  for (uint32_t y = out.height; y-- > 0;)  // bottom row first
    in.read(reinterpret_cast<char*>(&out.pixels[static_cast<size_t>(y) * out.width]), 12ll * out.width);
  if (!in) throw std::runtime_error(path.string() + " is cut short");
  return out;
}

TEST_F(Portable, NeedsTheCLibraryAlone) {
  const RunResult read = runProgram("/usr/bin/readelf", {"-d", program_.string()});
  ASSERT_EQ(read.status, 0) << read.err;
  std::istringstream lines(read.out);
  int needed = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("(NEEDED)") == std::string::npos) continue;
    ++needed;
    EXPECT_TRUE(line.find("[libc.so.6]") != std::string::npos || line.find("[libm.so.6]") != std::string::npos ||
                line.find("[ld-linux-x86-64.so.2]") != std::string::npos)
        << line;
  }
  EXPECT_GT(needed, 0);
}

TEST_F(Portable, RendersTheFullBuildsPictureFromItsCache) {
  const TemporaryFolder folder;
  // Beside a program, where its built-in scenes are: there it goes by its name.
  const fs::path program = folder.path / "irad", cache = folder.path / "assets/kept.irscene";
  fs::create_directory(cache.parent_path());
  fs::copy_file(program_, program);
  const std::string full = folder.path / "full", small = folder.path / "small";
  const RunResult exported = runIrad({"export", "box", "--cache", cache.string(), "--out", full});
  ASSERT_EQ(exported.status, 0) << exported.err;
  for (const auto& [which, scene, out] :
       {std::tuple{iradProgram(), cache.string(), full}, std::tuple{program.string(), std::string("kept"), small}}) {
    // Samples of the emitters would differ more: on CPU devices the full build's host draws them.
    const RunResult run =
        runProgram(which, {"render", scene, "--view", "lit", "--size", "48x48", "--set", "voxel.resolution=24", "--set",
                           "matrix.rays=32", "--set", "matrix.emitter_sampling=off", "--out", out});
    ASSERT_EQ(run.status, 0) << which << ": " << run.err;
  }
  const ExrPicture a = readExr(fs::path(full) / "lit.exr"), b = readPfm(fs::path(small) / "lit.pfm");
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  // But for the last bits: on CPU devices the full build's host sums up direct light, which this one leaves to a
  // kernel.
  float apart = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    apart = std::max(apart, glm::length(a.pixels[i] - b.pixels[i]) / std::max(glm::length(a.pixels[i]), 1e-3f));
  std::printf("pictures are apart by %.2g of a pixel at most\n", double{apart});
  EXPECT_LT(apart, 1e-5f) << "same device, same shaders";
  EXPECT_GT(a.mean().x, 0.01);
}

}  // namespace
}  // namespace irad::test::portable_suite
