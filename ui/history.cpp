#include "ui/history.h"

#include <algorithm>
#include <utility>

#include "renderer/base/error.h"

namespace irad {

void History::clear() {
  *this = {};
}

void History::push(const EditState& now, bool flight) {
  std::string name = std::exchange(called_, {});
  if (name.empty()) name = whatChanged(steps_[at_].state, now);
  steps_.resize(at_ + 1);
  steps_.push_back({std::move(name), now, flight});
  if (steps_.size() > kMost + 1) steps_.erase(steps_.begin());
  at_ = steps_.size() - 1;
}

/// A comparison begins or ends, which is no step. What comes before it belongs to A, or to the side that stays.
void History::reshape(const EditState& now) {
  const EditState here = steps_[at_].state;
  if (now.b && !here.b) {
    for (size_t i = at_; i < steps_.size(); ++i) steps_[i].state.b = now.b;
  } else if (!now.b && here.b) {
    const bool keepsB = now.a != here.a && now.a == *here.b;
    for (Step& step : steps_) {
      if (keepsB && step.state.b) step.state.a = *step.state.b;
      step.state.b.reset();
    }
    // Steps of the side that is gone lead nowhere.
    for (size_t i = steps_.size() - 1; i > 0; --i) {
      if (steps_[i].state != steps_[i - 1].state) continue;
      steps_.erase(steps_.begin() + static_cast<ptrdiff_t>(i));
      if (at_ >= i) --at_;
    }
  }
}

void History::see(const EditState& now, bool held) {
  if (steps_.empty()) {
    steps_.push_back({"the beginning", now});
    at_ = 0;
    return;
  }
  reshape(now);
  Step& here = steps_[at_];
  if (now == here.state) {
    // What was saved meanwhile is no step.
    here.state = now;
    if (!held) called_.clear();
    return;
  }
  if (held) return;
  if (now.sameWork(here.state) && canRedo()) {
    const EditState before = here.state;
    for (size_t i = at_; i < steps_.size(); ++i) {
      EditState& later = steps_[i].state;
      if (later.camera != before.camera || later.sceneCamera != before.sceneCamera || later.view != before.view) break;
      later.camera = now.camera;
      later.sceneCamera = now.sceneCamera;
      later.view = now.view;
    }
    called_.clear();
    return;
  }
  const bool flown = now.onlyFlown(here.state);
  if (flown && here.flight) {
    here.state = now;
    if (now != steps_[at_ - 1].state) return;
    steps_.pop_back();  // back where it began
    --at_;
    return;
  }
  push(now, flown);
}

void History::seeReturned(const EditState& now) {
  if (!steps_.empty()) reshape(now);
  if (steps_.empty() || now.sameWork(steps_[at_].state)) return see(now, /*held=*/false);
  for (size_t i = at_; i-- > 0;)
    if (now.sameWork(steps_[i].state)) {
      at_ = i;
      steps_[i].state.view = now.view;
      steps_[i].state.camera = now.camera;
      steps_[i].state.sceneCamera = now.sceneCamera;
      called_.clear();
      return;
    }
  see(now, /*held=*/false);
}

const EditState& History::go(size_t step) {
  IRAD_CHECK_OP(step, <, steps_.size());
  at_ = step;
  called_.clear();
  return steps_[at_].state;
}

}  // namespace irad
