#include "tests/support.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "gi/check/process.h"
#include "renderer/base/error.h"

namespace irad::test {
Gpu& gpu() {
  // Shared by the tests of a suite's process. Members are destroyed in reverse order.
  static Gpu shared = [] {
    Gpu g;
    g.device = Device::create({.validate = true});
    g.shaders = std::make_unique<ShaderLibrary>();
    return g;
  }();
  if (!shared.context) shared.context = std::make_unique<Context>(*shared.device, *shared.shaders, shared.timings);
  return shared;
}

void GpuTest::SetUp() {
  messagesBefore_ = gpu().device->validationMessages().size();
}

void GpuTest::TearDown() {
  gpu().device->waitIdle();
  const std::vector<std::string> messages = gpu().device->validationMessages();
  for (size_t i = messagesBefore_; i < messages.size(); ++i) ADD_FAILURE() << "validation: " << messages[i];
}

std::optional<std::filesystem::path> sharedScenes() {
  const char* variable = std::getenv("IRAD_SHARED");
  const std::filesystem::path shared =
      variable ? std::filesystem::path(variable) : sourceFolder().parent_path() / "shared";
  std::error_code ignored;
  if (!std::filesystem::is_directory(shared / "scenes", ignored)) return std::nullopt;
  return shared / "scenes";
}

std::filesystem::path assets() {
  return sourceFolder() / "assets";
}

// Paths of this machine stand on the command line of this file alone, so that a compiler cache serves the others from
// any folder.
std::filesystem::path sourceFolder() {
  return IRAD_SOURCE_DIR;
}

std::string iradProgram() {
  return IRAD_BINARY;
}

std::filesystem::path buildFolder() {
  return std::filesystem::path(IRAD_BINARY).parent_path();
}

double processorSeconds(pid_t process) {
  const std::string stat = slurp(fmt::format("/proc/{}/stat", process));
  if (stat.empty()) return 0;
  std::istringstream fields(stat.substr(stat.rfind(')') + 2));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double sum = 0, ticks = 0;
  for (int i = 14; i < 18; ++i) {  // utime, stime, cutime, cstime
    fields >> ticks;
    sum += ticks;
  }
  return sum / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::set<pid_t>& lastingProcesses() {
  static std::set<pid_t>& processes = *new std::set<pid_t>;  // outlives what ends with the program
  return processes;
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string out;
  for (char block[1 << 14]; in.read(block, sizeof block), in.gcount() > 0;)
    out.append(block, static_cast<size_t>(in.gcount()));
  return out;
}

std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> out;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    out[entry.path().filename().string()] = slurp(entry.path());
  return out;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

RunResult startIrad(const std::vector<std::string>& arguments, double timeoutSeconds) {
  return runProgram(iradProgram(), arguments, timeoutSeconds);
}

RunResult runProgram(const std::string& program, const std::vector<std::string>& arguments, double timeoutSeconds) {
  const TemporaryFolder folder;
  const std::string out = folder.path / "out", err = folder.path / "err";
  RunResult result;
  try {
    Process process(program, arguments, out, err);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeoutSeconds);
    while (!process.poll() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (!process.poll()) result.err = fmt::format("killed after {} s\n", timeoutSeconds);
    result.status = process.kill();
  } catch (const WorkError& error) {
    result.err = error.what();
    return result;
  }
  result.out = slurp(out);
  result.err += slurp(err);
  return result;
}

std::vector<std::string> smallRender(const std::filesystem::path& out, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", "box",
                                     "--out",  out.string(),
                                     "--size", "64x48",
                                     "--view", "lit,irradiance",
                                     "--set",  "voxel.resolution=12",
                                     "--set",  "matrix.rays=16",
                                     "--set",  "light.shadow_resolution=64"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> quickRender(const std::filesystem::path& out) {
  return smallRender(out, {"--set", "matrix.hit_rule=thesis", "--set", "specular.mode=off"});
}

}  // namespace irad::test
