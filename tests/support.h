// What the suites share: one headless device with validation per process, the folder of real scenes, temporary folders,
// runs of the program.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "gi/settings.h"
#include "renderer/base/temporary_folder.h"
#include "renderer/frame/frame.h"

namespace irad::test {

/// Padded rows are the thesis's, and go with its hit rule.
inline void useFormat(Settings& settings, MatrixFormat format) {
  settings.matrix.format = format;
  settings.matrix.gpu.hitRule = format == MatrixFormat::padded ? HitRule::thesis : HitRule::triangles;
}

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
std::filesystem::path sourceFolder();  ///< the checkout
std::filesystem::path buildFolder();
std::string iradProgram();  ///< the program's path

using irad::TemporaryFolder;

/// Processor time used so far by all threads of a process that is a child of this one, and by its own children that
/// have ended, seconds.
double processorSeconds(pid_t process);
/// Children that go on from one test to the next: what they do in a test counts as the test's.
std::set<pid_t>& lastingProcesses();

/// A file's bytes; none where it cannot be read.
std::string slurp(const std::filesystem::path& path);
/// Name -> bytes of every file in a folder; none where there is no folder.
std::map<std::string, std::string> contents(const std::filesystem::path& folder);
bool contains(const std::string& text, const std::string& part);

/// Output and exit status of a run.
struct RunResult {
  int status = -1;
  std::string out, err;
};
/// Runs `irad ARGUMENTS` within this process, on the device that the run before has left, with the pipelines made on
/// it: a start of the program, which compiles them anew, takes longer than what most tests ask of it. No window, and
/// nothing that may not come back.
RunResult runIrad(const std::vector<std::string>& arguments);
/// Runs the program itself: for tests of what belongs to a process (its streams, signals, limits, the device from its
/// start), and for one of each subcommand.
RunResult startIrad(const std::vector<std::string>& arguments, double timeoutSeconds = 600);
/// The same with another program, by its path.
RunResult runProgram(const std::string& program, const std::vector<std::string>& arguments,
                     double timeoutSeconds = 600);
/// `irad render box` into `out`, two views, so small that a CPU device takes a second or two; and `more` options.
std::vector<std::string> smallRender(const std::filesystem::path& out, const std::vector<std::string>& more = {});
/// The same files in half of its time, which goes into the driver's pipelines: for tests to which it is all the same
/// what the pictures show.
std::vector<std::string> quickRender(const std::filesystem::path& out);

}  // namespace irad::test
