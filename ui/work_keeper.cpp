#include "ui/work_keeper.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "ui/session.h"
#include "ui/unsaved.h"

namespace irad {

WorkKeeper::WorkKeeper(const std::filesystem::path& preferences)
    : none_(preferences.empty()),
      autosaves_(none_ ? std::filesystem::path() : preferences.parent_path() / "autosave") {}

bool WorkKeeper::keep(Session& session) {
  if (none_ || !session.pipeline || session.history.steps().empty()) return false;
  if (!unsavedBefore(session, {Leaving::What::Quit}).any()) {
    kept_.reset();
    autosaves_.removeKept();
    return true;
  }
  const EditState& now = session.history.steps()[session.history.at()].state;
  if (kept_ && kept_->sameWork(now)) return !failed_;
  Autosave autosave{.scene = lastingPath(session.pipeline->scene().path),
                    .time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()),
                    .edits = session.edits.content(),
                    .settings = now.a.settings,
                    .view = now.view,
                    .camera = now.camera};
  if (now.b) autosave.other = now.b->settings;
  kept_ = now;  // where it fails, until the next edit
  failed_ = true;
  try {
    autosaves_.keep(autosave);
    failed_ = false;
  } catch (const Error& error) {
    if (!std::exchange(told_, true))
      session.error(fmt::format("Unsaved work is not kept against a crash. {}", error.what()));
  }
  return !failed_;
}

void WorkKeeper::offer(Session& session) {
  try {
    session.found = autosaves_.find();
  } catch (const Error& error) {
    session.error(fmt::format("Unsaved work of an earlier run cannot be offered. {}", error.what()));
  }
}

}  // namespace irad
