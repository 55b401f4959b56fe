#include "app/machine.h"

#include "app/version.h"
#include "renderer/base/error.h"
#include "renderer/frame/context.h"
#include "renderer/resources.h"

namespace irad::app {
namespace {

/// Whatever else is asked for, counts or messages of one command are not those of the next.
bool servesAgain(const DeviceOptions& options) {
  return options == DeviceOptions{.select = options.select};
}

}  // namespace

OpenDevice::OpenDevice(const DeviceOptions& options) : device(Device::create(options)) {}

Machine::Machine(std::filesystem::path program) : program(std::move(program)) {}

Machine::~Machine() = default;

const std::string& Machine::identity() {
  if (identity_.empty()) identity_ = programIdentity(program);
  return identity_;
}

std::unique_ptr<OpenDevice> Machine::open(const DeviceOptions& options) {
  if (left_ && left_->device->options == options) {
    left_->device->memory().forgetPeak();
    return std::move(left_);
  }
  return std::make_unique<OpenDevice>(options);
}

void Machine::leave(std::unique_ptr<OpenDevice> opened) noexcept {
  if (!opened || !servesAgain(opened->device->options)) return;
  try {
    opened->device->waitIdle();  // what was on it goes
    if (opened->device->memory().used() == 0) left_ = std::move(opened);
  } catch (const Error&) {  // it is lost, as the command has said
  }
}

}  // namespace irad::app
