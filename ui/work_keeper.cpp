#include "ui/work_keeper.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/scene/sky_image.h"
#include "ui/session.h"
#include "ui/unsaved.h"

namespace irad {

WorkKeeper::WorkKeeper(const std::filesystem::path& preferences, BackgroundWorker& writer)
    : none_(preferences.empty()),
      writer_(writer),
      autosaves_(none_ ? std::filesystem::path() : preferences.parent_path() / "autosave") {}

void WorkKeeper::keep(Session& session) {
  if (none_ || writer_.busy() || !session.pipeline || session.history.steps().empty()) return;
  if (!unsavedBefore(session, {Leaving::What::Quit}).any()) {
    kept_.reset();
    failed_ = false;
    if (autosaves_.keeps())
      writer_.add([this]() -> BackgroundWorker::Result {
        autosaves_.removeKept();
        return [] {};
      });
    return;
  }
  const EditState& now = session.history.steps()[session.history.at()].state;
  if (kept_ && kept_->sameWork(now)) return;
  Autosave autosave{.scene = lastingPath(session.pipeline->scene().path),
                    .time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()),
                    .edits = session.edits.content(),
                    .settings = now.a.settings,
                    .view = now.view,
                    .camera = now.camera};
  if (now.b) autosave.other = now.b->settings;
  if (now.sky) autosave.sky = now.sky->path;
  if (now.reference) autosave.reference = now.reference->path;
  kept_ = now;  // where it fails, until the next edit
  failed_ = true;
  writer_.add([this, &session, autosave = std::move(autosave)]() -> BackgroundWorker::Result {
    try {
      autosaves_.keep(autosave);
      return [this] { failed_ = false; };
    } catch (const Error& error) {
      return [this, &session, text = std::string(error.what())] {
        if (!std::exchange(told_, true))
          session.error(fmt::format("Unsaved work is not kept against a crash. {}", text));
      };
    }
  });
}

bool WorkKeeper::keepNow(Session& session) {
  writer_.wait();
  keep(session);
  writer_.wait();
  writer_.take();
  return !none_ && session.pipeline && !failed_;
}

void WorkKeeper::removeFound() {
  writer_.wait();
  autosaves_.removeFound();
}
void WorkKeeper::leaveFound() {
  writer_.wait();
  autosaves_.leaveFound();
}
void WorkKeeper::end() {
  writer_.wait();
  autosaves_.removeKept();
}

void WorkKeeper::offer(Session& session) {
  writer_.wait();
  try {
    session.found = autosaves_.find();
  } catch (const Error& error) {
    session.error(fmt::format("Unsaved work of an earlier run cannot be offered. {}", error.what()));
  }
}

}  // namespace irad
