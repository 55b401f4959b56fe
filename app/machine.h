// What a process has for the commands that it runs: its program, and the device that the last command left. The program
// runs one command; the test programs run hundreds, and most of what a small command takes is a device's start and the
// driver's work on pipelines.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/device.h"
#include "renderer/shaders.h"

namespace irad {
class Context;
class PipelineCache;
class Timings;
}  // namespace irad

namespace irad::app {

/// A device with its shaders, and the pipelines that were made on it.
struct OpenDevice {
  explicit OpenDevice(const DeviceOptions& options);
  std::unique_ptr<Device> device;
  ShaderLibrary shaders;
  std::shared_ptr<PipelineCache> pipelines;  ///< none before its first context
  size_t messagesBefore = 0;                 ///< of validation, of those that it was opened for before

  /// On it; the next one finds the pipelines that this one makes.
  std::unique_ptr<Context> makeContext(Timings& timings);
  /// WorkError with the messages of validation, where that was asked for and there are any.
  void checkValidation() const;
};

class Machine {
 public:
  /// `program`: the executable, for what names it or starts it once more.
  explicit Machine(std::filesystem::path program = "/proc/self/exe");
  ~Machine();
  Machine(const Machine&) = delete;

  const std::filesystem::path program;
  const std::string& identity();  ///< programIdentity() of it
  /// A device that was left, where one is asked for as it was; another otherwise.
  std::unique_ptr<OpenDevice> open(const DeviceOptions& options);
  /// Takes a device back that nothing is on any more. One that was lost, whose shaders are others by now, or that was
  /// opened to provoke failures or with less memory, serves once.
  void leave(std::unique_ptr<OpenDevice> opened) noexcept;

 private:
  std::string identity_;
  std::vector<std::unique_ptr<OpenDevice>> left_;  ///< of different options
};

}  // namespace irad::app
