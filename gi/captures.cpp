#include "gi/captures.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/base/image_io.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

constexpr const char* kManifest = "manifest.json";

int64_t changed(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? int64_t{status.st_mtime} : 0;
}

Settings settingsOf(const fs::path& manifest, const std::string& json, const Settings& defaults) {
  Settings settings = defaults;
  try {
    settingsFromJson(settings, json);
  } catch (const UsageError& error) {  // which does not know the file
    throw InputError(fmt::format("{}: {}", manifest.string(), error.what()));
  }
  return settings;
}

std::vector<fs::path> contentOf(const fs::path& folder, std::error_code& error) {
  std::vector<fs::path> paths;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (!it->path().filename().string().starts_with('.')) paths.push_back(it->path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// VIEW.png or, of several cameras and what has no view, the first that there is; and the numbers beside it.
void findPictures(CaptureEntry& entry) {
  std::error_code ignored;
  if (!entry.config.views.empty()) entry.picture = entry.folder / (entry.config.views.front() + ".png");
  if (!fs::exists(entry.picture, ignored)) {
    const std::vector<fs::path> files = contentOf(entry.folder, ignored);
    const auto first = std::ranges::find_if(files, [](const fs::path& file) { return file.extension() == ".png"; });
    entry.picture = first != files.end() ? *first : fs::path();
  }
  if (entry.picture.empty()) return;
  entry.linear = fs::path(entry.picture).replace_extension(linearExtension());
  if (!fs::exists(entry.linear, ignored)) entry.linear.clear();
}

void add(CaptureList& list, const fs::path& folder, const std::string& name, const Settings& defaults) {
  std::error_code ignored;
  const fs::path manifest = folder / kManifest;
  const bool recording = fs::exists(folder / "frames.csv", ignored);
  if (!fs::exists(manifest, ignored)) {
    if (recording)
      list.entries.push_back({.folder = fs::absolute(folder).lexically_normal(),
                              .name = name,
                              .time = changed(folder / "frames.csv"),
                              .recording = true});
    return;
  }
  try {
    CaptureEntry entry = readCapture(manifest, defaults);
    entry.name = name;
    list.entries.push_back(std::move(entry));
  } catch (const Error& error) {
    list.problems.emplace_back(error.what());
  }
}

}  // namespace

CaptureEntry readCapture(const fs::path& manifest, const Settings& defaults) {
  CaptureEntry entry;
  entry.config = readConfigFile(manifest);
  if (!entry.config.manifest || !entry.config.scene)
    throw InputError(fmt::format("{}: {}: not there: no manifest of a run", manifest.string(),
                                 entry.config.manifest ? "scene" : "settings"));
  entry.settings = settingsOf(manifest, *entry.config.settings, defaults);
  if (entry.config.otherSettings) entry.other = settingsOf(manifest, *entry.config.otherSettings, defaults);
  if (!entry.config.views.empty()) {
    entry.view = findView(entry.config.views.front());
    if (!entry.view)
      throw InputError(fmt::format("{}: views: '{}' is no view", manifest.string(), entry.config.views.front()));
  }
  entry.folder = fs::absolute(manifest).lexically_normal().parent_path();
  entry.name = entry.folder.filename().string();
  entry.time = entry.config.time.value_or(changed(manifest));
  std::error_code ignored;
  entry.recording = fs::exists(entry.folder / "frames.csv", ignored);
  findPictures(entry);
  return entry;
}

CaptureList listCaptures(const fs::path& folder, const Settings& defaults) {
  CaptureList list;
  std::error_code error;
  if (!fs::exists(folder, error)) return list;
  const std::vector<fs::path> folders = contentOf(folder, error);
  if (error) list.problems.push_back(fmt::format("{}: {}", folder.string(), error.message()));
  for (const fs::path& one : folders) {
    if (!fs::is_directory(one, error)) continue;
    const std::string name = one.filename().string();
    add(list, one, name, defaults);
    for (const fs::path& part : contentOf(one, error))
      if (fs::is_directory(part, error)) add(list, part, name + "/" + part.filename().string(), defaults);
  }
  std::ranges::stable_sort(list.entries, std::ranges::greater(), &CaptureEntry::time);
  return list;
}

}  // namespace irad
