// A recording of timings, for other programs and for comparisons: a folder with
//   frames.csv   a row per group: frame,kind,began_ms,cpu_ms and a column of milliseconds per stage, empty where the
//                stage did not run
//   summary.csv  statistics per stage (renderer/timings.h, writeCsv)
//   trace.json   Chrome's trace event format, which Perfetto opens: a track of the CPU's groups, one of the GPU's
//   passes; the manifest in its metadata
//   manifest.json what was recorded, where it is known: as the maker of the recording says it
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/base/timings.h"

namespace irad {

struct Recording {
  std::string device, scene;  ///< said in the trace
  std::deque<FrameSample> frames;
  std::string manifest = {};  ///< JSON; empty: none
};

/// Makes the folder; each file appears whole or not at all. Throws WorkError naming the file.
void writeRecording(const std::filesystem::path& folder, const Recording& recording);

/// What frames.csv holds: the spans are in the trace alone. Throws InputError naming file, line and value.
std::deque<FrameSample> readRecording(const std::filesystem::path& folder);

// Each file's text.
std::string framesCsv(const std::deque<FrameSample>& frames);
std::string traceJson(const Recording& recording);

}  // namespace irad
