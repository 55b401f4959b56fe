#include "ui/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gi/memory_report.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/base/recording.h"
#include "ui/capture.h"
#include "ui/session.h"
#include "ui/words.h"

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

/// How to record the like of it without the window, and what it is of.
std::string manifestJson(Session& session, const Recording& recording, double seconds, const Program& program) {
  Manifest manifest = manifestOf(session, *session.sideA().pipeline, "bench", program);
  const ViewInfo& view = *viewInfo(session.view);
  manifest.views.emplace_back(view.name);
  if (!view.isFrom(FROM_PICTURE | FROM_ORACLE)) manifest.reference = nullptr;  // which bench has no option for
  manifest.frames = static_cast<uint32_t>(std::max<size_t>(recording.frames.size(), 1));
  manifest.arguments = {"--record", "recording"};
  manifest.files = {"frames.csv", "summary.csv", "trace.json"};
  nlohmann::ordered_json of{{"frames", recording.frames.size()}, {"seconds", seconds}};
  if (const auto& from = session.recorder.from)
    if (const std::string changed = whatChanged(*from, editStateOf(session)); !changed.empty())
      of["changed_meanwhile"] = changed;
  manifest.details.emplace_back("recording", jsonText(of));
  if (session.comparison)
    manifest.details.emplace_back("other_settings", settingsToJson(session.sideB().pipeline->settings()));
  return manifest.toJson();
}

void writeFrames(Session& session, const std::filesystem::path& folder, const Program& program) {
  session.context.finish();
  Recorder& recorder = session.recorder;
  Recording recording{.device = session.context.device.info.name, .scene = sceneName(session), .frames = {}};
  const double began = *std::exchange(recorder.began, std::nullopt);
  for (const FrameSample& frame : session.context.timings.frames())
    if (frame.began >= began) recording.frames.push_back(frame);
  recording.manifest = manifestJson(session, recording, 1e-3 * (session.context.timings.now() - began), program);
  recorder.from.reset();
  OutputFolder out(folder / "recording");
  writeRecording(out.temporary(), recording);
  const std::filesystem::path where = std::filesystem::absolute(out.commit()).lexically_normal();
  session.note(fmt::format("Recorded {}: {}", counted(recording.frames.size(), "frame"), where.string()), where);
  listRecordings(session.recorder, folder);
}

void writeMemory(Session& session, const std::filesystem::path& folder) {
  const Pipeline& p = *session.pipeline;
  OutputFolder out(folder / "memory");
  writeFile(out.temporary() / "memory.csv", memoryCsv(memoryReport(session.context.device.memory().rows(), p)));
  const std::filesystem::path where = std::filesystem::absolute(out.commit()).lexically_normal();
  session.note(fmt::format("Saved {}", (where / "memory.csv").string()), where);
}

}  // namespace

void serveRecorder(Session& session, const std::filesystem::path& folder, const Program& program) {
  Recorder& recorder = session.recorder;
  try {
    if (std::exchange(recorder.toggle, false)) {
      if (recorder.began) {
        writeFrames(session, folder, program);
      } else if (session.built) {
        recorder.began = session.context.timings.now();
        recorder.from = editStateOf(session);
      }
    }
    if (std::exchange(recorder.memory, false) && session.built) writeMemory(session, folder);
    if (const auto compare = std::exchange(recorder.compare, std::nullopt)) {
      listRecordings(recorder, folder);
      recorder.changes.clear();
      try {
        recorder.changes = compareTimings(readRecording(compare->first), readRecording(compare->second));
        recorder.problem = recorder.changes.empty() ? "The recordings have no stage in common." : "";
      } catch (const Error& error) {
        recorder.problem = error.what();
      }
    }
  } catch (const Error& error) {
    session.error(error.what());
  }
  if (recorder.began) session.viewDirty = true;
}

}  // namespace irad
