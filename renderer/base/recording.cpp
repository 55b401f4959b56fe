#include "renderer/base/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

constexpr std::array kOwnColumns{"frame", "kind", "began_ms", "cpu_ms"};

std::vector<std::string> stageNames(const std::deque<FrameSample>& frames) {
  std::vector<std::string> names;
  for (const FrameSample& frame : frames)
    for (const auto& [stage, ms] : frame.stages)
      if (std::find(names.begin(), names.end(), stage) == names.end()) names.push_back(stage);
  return names;
}

/// What to add to the device's clock to be on the CPU's. The two are not calibrated. No pass begins before the CPU
/// began its group; where the device was quickest to begin it is taken to have begun at once.
double clockOffset(const std::deque<FrameSample>& frames) {
  double offset = -std::numeric_limits<double>::infinity();
  for (const FrameSample& frame : frames)
    if (!frame.spans.empty()) offset = std::max(offset, frame.began - frame.spans.front().began);
  return offset;
}

std::string quoted(const std::string& text) {
  return jsonText(nlohmann::json(text));
}

/// A line of a recording, for messages.
struct Place {
  const std::filesystem::path& path;
  size_t line;
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("{}: line {}: {}", path.string(), line, why));
  }
  double number(const std::string& text, const std::string& column) const {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value) || value < 0)
      fail(fmt::format("{}: '{}' is no time", column, text));
    return value;
  }
};

FrameSample parseRow(const Place& at, const std::vector<std::string>& columns, const std::vector<std::string>& fields) {
  if (fields.size() != columns.size()) at.fail(fmt::format("{} fields, expected {}", fields.size(), columns.size()));
  FrameSample frame;
  frame.frame = static_cast<uint64_t>(at.number(fields[0], columns[0]));
  const auto kind = std::find(kWorkKinds.begin(), kWorkKinds.end(), fields[1]);
  if (kind == kWorkKinds.end()) at.fail(fmt::format("kind: '{}' is unknown", fields[1]));
  frame.kind = static_cast<WorkKind>(kind - kWorkKinds.begin());
  frame.began = at.number(fields[2], columns[2]);
  frame.cpuMs = at.number(fields[3], columns[3]);
  for (size_t i = kOwnColumns.size(); i < fields.size(); ++i)
    if (!fields[i].empty()) frame.stages.emplace_back(columns[i], at.number(fields[i], columns[i]));
  return frame;
}

}  // namespace

std::string framesCsv(const std::deque<FrameSample>& frames) {
  const std::vector<std::string> names = stageNames(frames);
  std::string out = fmt::format("{},{},{},{}", kOwnColumns[0], kOwnColumns[1], kOwnColumns[2], kOwnColumns[3]);
  for (const std::string& name : names) {
    out += ',';
    out += csvField(name);
  }
  out += '\n';
  for (const FrameSample& frame : frames) {
    out += fmt::format("{},{},{:.6f},{:.6f}", frame.frame, toString(frame.kind), frame.began, frame.cpuMs);
    for (const std::string& name : names) {
      out += ',';
      for (const auto& [stage, ms] : frame.stages)
        if (stage == name) out += fmt::format("{:.6f}", ms);
    }
    out += '\n';
  }
  return out;
}

std::string traceJson(const Recording& recording) {
  constexpr int kProcess = 1, kCpu = 1, kGpu = 2;
  std::string out = fmt::format(
      R"({{"displayTimeUnit":"ms","otherData":{{"device":{},"scene":{},)"
      R"("clocks":"GPU times are shifted so that no pass begins before the CPU began its group"{}}},"traceEvents":[)",
      quoted(recording.device), quoted(recording.scene),
      recording.manifest.empty() ? "" : ",\"manifest\":" + recording.manifest);
  const auto name = [&](const char* what, int thread, const std::string& is) {
    out += fmt::format(R"({{"ph":"M","pid":{},"tid":{},"name":"{}","args":{{"name":{}}}}})", kProcess, thread, what,
                       quoted(is));
  };
  const auto event = [&](int thread, const std::string& what, double began, double ms, uint64_t frame) {
    out += fmt::format(
        ",\n"
        R"({{"ph":"X","pid":{},"tid":{},"name":{},"ts":{:.3f},"dur":{:.3f},"args":{{"frame":{}}}}})",
        kProcess, thread, quoted(what), 1e3 * began, 1e3 * ms, frame);  // microseconds
  };
  name("process_name", kCpu, "irad");
  out += ",\n";
  name("thread_name", kCpu, "CPU");
  out += ",\n";
  name("thread_name", kGpu, "GPU");
  const double offset = clockOffset(recording.frames);
  for (const FrameSample& frame : recording.frames) {
    event(kCpu, toString(frame.kind), frame.began, frame.cpuMs, frame.frame);
    for (const FrameSample::Span& span : frame.spans)
      event(kGpu, span.stage, span.began + offset, span.ended - span.began, frame.frame);
  }
  return out + "]}\n";
}

void writeRecording(const std::filesystem::path& folder, const Recording& recording) {
  makeFolder(folder);
  writeFile(folder / "frames.csv", framesCsv(recording.frames));
  std::ostringstream summary;
  writeCsv(summary, timingRows(stageSamples(recording.frames)));
  writeFile(folder / "summary.csv", summary.str());
  writeFile(folder / "trace.json", traceJson(recording));
  if (!recording.manifest.empty()) writeFile(folder / "manifest.json", recording.manifest);
}

std::deque<FrameSample> readRecording(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "frames.csv";
  std::ifstream in(path);
  if (!in) throw InputError(fmt::format("{}: cannot be read: no recording?", path.string()));
  std::string line;
  Place at{path, 1};
  std::getline(in, line);
  const std::vector<std::string> columns = csvFields(line);
  if (columns.size() < kOwnColumns.size() || !std::equal(kOwnColumns.begin(), kOwnColumns.end(), columns.begin()))
    at.fail("not the columns of a recording");
  std::deque<FrameSample> frames;
  while (++at.line, std::getline(in, line)) frames.push_back(parseRow(at, columns, csvFields(line)));
  return frames;
}

}  // namespace irad
