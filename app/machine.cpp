#include "app/machine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/version.h"
#include "renderer/base/error.h"
#include "renderer/frame/context.h"
#include "renderer/resources.h"

namespace irad::app {
namespace {

/// What else can be asked for ends with the command: failures to come, and the memory that is left.
bool servesAgain(const OpenDevice& opened) {
  const DeviceOptions& options = opened.device->options;
  return options == DeviceOptions{.select = options.select,
                                  .validate = options.validate,
                                  .presentable = options.presentable} &&
         (opened.shaders.generation() == 0 || opened.shaders.modified().empty());
}

}  // namespace

OpenDevice::OpenDevice(const DeviceOptions& options) : device(Device::create(options)) {}

std::unique_ptr<Context> OpenDevice::makeContext(Timings& timings) {
  auto context = std::make_unique<Context>(*device, shaders, timings, pipelines);
  pipelines = context->pipelines();
  return context;
}

void OpenDevice::checkValidation() const {
  std::vector<std::string> messages = device->validationMessages();
  messages.erase(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(messagesBefore));
  if (device->options.validate && !messages.empty())
    throw WorkError(fmt::format("{} validation messages:\n{}", messages.size(), fmt::join(messages, "\n")));
}

Machine::Machine(std::filesystem::path program) : program(std::move(program)) {}

Machine::~Machine() = default;

const std::string& Machine::identity() {
  if (identity_.empty()) identity_ = programIdentity(program);
  return identity_;
}

std::unique_ptr<OpenDevice> Machine::open(const DeviceOptions& options) {
  const auto found = std::ranges::find_if(left_, [&](const auto& left) { return left->device->options == options; });
  if (found == left_.end()) return std::make_unique<OpenDevice>(options);
  std::unique_ptr<OpenDevice> opened = std::move(*found);
  left_.erase(found);
  opened->device->memory().forgetPeak();
  opened->messagesBefore = opened->device->validationMessages().size();
  return opened;
}

void Machine::leave(std::unique_ptr<OpenDevice> opened) noexcept {
  try {
    if (!opened || !servesAgain(*opened)) return;
    opened->device->waitIdle();  // what was on it goes
    if (opened->device->memory().used() == 0) left_.push_back(std::move(opened));
  } catch (const std::exception&) {  // it is lost, as the command has said
  }
}

}  // namespace irad::app
