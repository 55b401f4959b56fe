#include "app/interrupts.h"

#include "renderer/base/error.h"

namespace irad::app {
namespace {

volatile sig_atomic_t stoppedBy = 0;

}  // namespace

StopOnSignal::StopOnSignal() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { stoppedBy = signal; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  stoppedBy = 0;
  ::sigaction(SIGINT, &action, &interrupt_);
  ::sigaction(SIGTERM, &action, &terminate_);
}

StopOnSignal::~StopOnSignal() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
  stoppedBy = 0;
}

bool StopOnSignal::came() const {
  return stoppedBy != 0;
}

bool isStopped() {
  return stoppedBy != 0;
}

void throwIfStopped() {
  if (isStopped()) throw WorkError("stopped by a signal; the same command goes on from here");
}

}  // namespace irad::app
