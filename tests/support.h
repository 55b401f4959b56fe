// What the suites share: one headless device with validation per process, the folder of real scenes, temporary folders.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "renderer/frame.h"

namespace irad::test {

/// A device with core and synchronization validation, made on first use, shared by the suite's tests.
struct Gpu {
  std::unique_ptr<Device> device;
  std::unique_ptr<ShaderLibrary> shaders;
  Timings timings;
  std::unique_ptr<Context> context;
};
Gpu& gpu();

/// Fixture of all GPU tests: fails the test on any validation message it caused.
class GpuTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  Context& context() { return *gpu().context; }

 private:
  size_t messagesBefore_ = 0;
};

/// ../shared/scenes (or $IRAD_SHARED/scenes), nullopt where absent: GTEST_SKIP() << "..." then.
std::optional<std::filesystem::path> sharedScenes();
std::filesystem::path assets();

/// A fresh folder, removed with the object.
struct TemporaryFolder {
  TemporaryFolder();
  ~TemporaryFolder();
  std::filesystem::path path;
};

/// Runs the irad binary with these arguments; output and exit status.
struct RunResult {
  int status = -1;
  std::string out, err;
};
RunResult runIrad(const std::vector<std::string>& arguments, double timeoutSeconds = 600);
/// The same with another program, by its path.
RunResult runProgram(const std::string& program, const std::vector<std::string>& arguments,
                     double timeoutSeconds = 600);

}  // namespace irad::test
