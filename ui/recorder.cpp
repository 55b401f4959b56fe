#include "ui/recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "gi/memory_report.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/recording.h"
#include "ui/session.h"

namespace irad {
namespace {

void listRecordings(Recorder& recorder, const std::filesystem::path& folder) {
  recorder.recordings.clear();
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (std::filesystem::exists(entry.path() / "frames.csv", none)) recorder.recordings.push_back(entry.path());
  std::sort(recorder.recordings.begin(), recorder.recordings.end());
}

std::string sceneName(const Session& session) {
  return session.pipeline->scene().path.filename().string();
}

void writeFrames(Session& session, const std::filesystem::path& folder) {
  session.context.finish();
  Recording recording{.device = session.context.device.info.name, .scene = sceneName(session), .frames = {}};
  for (const FrameSample& frame : session.context.timings.frames())
    if (frame.began >= *session.recorder.began) recording.frames.push_back(frame);
  session.recorder.began.reset();
  OutputFolder out(folder / "recording");
  writeRecording(out.temporary(), recording);
  session.note(fmt::format("Recorded {} frames: {}", recording.frames.size(), out.commit().string()));
  listRecordings(session.recorder, folder);
}

void writeMemory(Session& session, const std::filesystem::path& folder) {
  const Pipeline& p = *session.pipeline;
  OutputFolder out(folder / "memory");
  writeFile(out.temporary() / "memory.csv", memoryCsv(memoryReport(session.context.device.memory().rows(), p)));
  session.note(fmt::format("Saved {}", (out.commit() / "memory.csv").string()));
}

}  // namespace

void serveRecorder(Session& session, const std::filesystem::path& folder) {
  Recorder& recorder = session.recorder;
  try {
    if (std::exchange(recorder.toggle, false)) {
      if (recorder.began)
        writeFrames(session, folder);
      else
        recorder.began = session.context.timings.now();
    }
    if (std::exchange(recorder.memory, false) && session.built) writeMemory(session, folder);
    if (const auto compare = std::exchange(recorder.compare, std::nullopt)) {
      listRecordings(recorder, folder);
      recorder.changes = compareTimings(readRecording(compare->first), readRecording(compare->second));
      if (recorder.changes.empty()) session.note("The recordings have no stage in common.");
    }
  } catch (const Error& error) {
    session.error(error.what());
  }
  if (recorder.began) session.viewDirty = true;
}

}  // namespace irad
