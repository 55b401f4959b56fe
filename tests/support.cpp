#include "tests/support.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "renderer/error.h"

extern char** environ;

namespace irad::test {
namespace {

std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

Gpu& gpu() {
  // Shared by the tests of a suite's process; the order of members is the reverse order of destruction.
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
      variable ? std::filesystem::path(variable) : std::filesystem::path(IRAD_SOURCE_DIR).parent_path() / "shared";
  std::error_code ignored;
  if (!std::filesystem::is_directory(shared / "scenes", ignored)) return std::nullopt;
  return shared / "scenes";
}

std::filesystem::path assets() {
  return std::filesystem::path(IRAD_SOURCE_DIR) / "assets";
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "irad-test-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw WorkError(fmt::format("{}: cannot be made", pattern));
  path = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

RunResult runIrad(const std::vector<std::string>& arguments, double timeoutSeconds) {
  return runProgram(IRAD_BINARY, arguments, timeoutSeconds);
}

RunResult runProgram(const std::string& program, const std::vector<std::string>& arguments, double timeoutSeconds) {
  const TemporaryFolder folder;
  const std::string out = folder.path / "out", err = folder.path / "err";
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t pid = 0;
  const int failed = posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  RunResult result;
  if (failed) {
    result.err = fmt::format("{}: cannot be started ({})", program, failed);
    return result;
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeoutSeconds);
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      kill(pid, SIGKILL);
      waitpid(pid, &status, 0);
      result.err = fmt::format("killed after {} s\n", timeoutSeconds);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  // As a shell reports it: 128 + signal.
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = slurp(out);
  result.err += slurp(err);
  return result;
}

}  // namespace irad::test
