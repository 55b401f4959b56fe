#include "ui/autosave.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

constexpr int kAutosaveFormat = 1;

Autosave autosaveFromJson(const OrderedJson& parsed, const std::string& label) {
  if (!parsed.is_object() || parsed.value("format", OrderedJson()) != kAutosaveFormat)
    throw UsageError(fmt::format("{}: format: expected {}, not {}", label, kAutosaveFormat,
                                 parsed.is_object() ? parsed.value("format", OrderedJson()).dump() : "no object"));
  const JsonObject json(
      parsed, label,
      {"format", "scene", "time", "view", "camera", "edits", "sky", "reference", "settings", "other_settings"});
  Autosave autosave;
  autosave.scene = json.text("scene");
  if (!json.at("time").is_number_integer()) json.refuse("time", "expected whole seconds", json.at("time"));
  autosave.time = json.at("time").get<int64_t>();
  const std::optional<View> view = findView(json.text("view"));
  if (!view) json.refuse("view", "expected a view", json.at("view"));
  autosave.view = *view;
  autosave.camera = cameraFromJson(json.at("camera").dump(), label + ": camera");
  autosave.edits = sidecarFromJson(json.at("edits").dump(), label + ": edits");
  if (json.has("sky")) autosave.sky = json.text("sky");
  if (json.has("reference")) autosave.reference = json.text("reference");
  settingsFromJson(autosave.settings, json.at("settings").dump());
  if (json.has("other_settings")) settingsFromJson(autosave.other.emplace(), json.at("other_settings").dump());
  return autosave;
}

std::string listInWords(const char* one, const char* many, std::vector<std::string> names) {
  constexpr size_t most = 5;
  const size_t count = names.size(), more = count > most ? count - most : 0;
  names.resize(count - more);
  return fmt::format("{} {}: {}{}", count, count == 1 ? one : many, fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

template <class T>
std::string listInWords(const char* one, const char* many, const std::vector<T>& things, std::string T::*name) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back((thing.*name).empty() ? "(no name)" : thing.*name);
  return listInWords(one, many, std::move(names));
}

fs::path lockOf(const fs::path& file) {
  return fs::path(file).replace_extension(".lock");
}

}  // namespace

void writeAutosave(const fs::path& file, const Autosave& autosave) {
  OrderedJson json;
  json["format"] = kAutosaveFormat;
  json["scene"] = autosave.scene.string();
  json["time"] = autosave.time;
  json["view"] = viewInfo(autosave.view)->name;
  json["camera"] = OrderedJson::parse(cameraToJson(autosave.camera));
  json["edits"] = OrderedJson::parse(sidecarToJson(autosave.edits));
  if (autosave.sky) json["sky"] = autosave.sky->string();
  if (autosave.reference) json["reference"] = autosave.reference->string();
  json["settings"] = OrderedJson::parse(settingsToJson(autosave.settings));
  if (autosave.other) json["other_settings"] = OrderedJson::parse(settingsToJson(*autosave.other));
  makeFolder(file.parent_path());
  writeFile(file, jsonText(json, 2) + "\n");
}

Autosave readAutosave(const fs::path& file) {
  try {
    return autosaveFromJson(readJsonFile(file), file.string());
  } catch (const InputError&) {
    throw;
  } catch (const UsageError& error) {
    const std::string text = error.what();  // those of settings do not know the file
    throw InputError(text.starts_with(file.string()) ? text : fmt::format("{}: {}", file.string(), text));
  }
}

std::string timeInWords(int64_t time) {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm local{};
  char text[64] = "";
  if (!localtime_r(&seconds, &local) || std::strftime(text, sizeof(text), "%d %b %Y, %H:%M", &local) == 0)
    return "at an unknown time";
  return text[0] == '0' ? text + 1 : text;
}

std::vector<std::string> contentInWords(const Autosave& autosave, const Settings& present) {
  std::vector<std::string> lines;
  if (autosave.edits.lights) lines.push_back(listInWords("light", "lights", *autosave.edits.lights, &Light::name));
  if (!autosave.edits.materials.empty())
    lines.push_back(listInWords("material", "materials", autosave.edits.materials, &MaterialEdit::material));
  if (!autosave.edits.hidden.isolated.empty()) lines.push_back("isolated: " + autosave.edits.hidden.isolated);
  if (!autosave.edits.hidden.paths.empty())
    lines.push_back(listInWords("hidden object", "hidden objects", autosave.edits.hidden.paths));
  if (!autosave.edits.bookmarks.empty())
    lines.push_back(listInWords("bookmark", "bookmarks", autosave.edits.bookmarks, &Camera::name));
  if (autosave.sky) lines.push_back("picture of the sky: " + autosave.sky->filename().string());
  if (autosave.reference) lines.push_back("reference: " + autosave.reference->filename().string());
  if (autosave.edits.region) lines.emplace_back("scene.region: a box");
  const auto add = [&](const char* what, const Settings& settings) {
    std::vector<std::string> changed;
    for (const Setting& setting : settingTable())
      if (setting.get(settings) != setting.get(present))
        changed.push_back(fmt::format("{} {}", setting.name, setting.text(settings)));
    if (changed.empty()) return;
    constexpr size_t most = 5;
    const size_t more = changed.size() > most ? changed.size() - most : 0;
    changed.resize(changed.size() - more);
    lines.push_back(
        fmt::format("{}: {}{}", what, fmt::join(changed, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
  };
  add(autosave.other ? "settings of A" : "settings", autosave.settings);
  if (autosave.other) add("settings of B", *autosave.other);
  if (lines.empty()) lines.emplace_back("nothing that is not as it is now");
  return lines;
}

Autosaves::Autosaves(fs::path folder) : folder_(std::move(folder)) {}

Autosaves::~Autosaves() {
  release(own_, /*remove=*/false);
  release(found_, /*remove=*/false);
}

/// None where a living window has it.
std::optional<Autosaves::Claim> Autosaves::claim(const fs::path& file) {
  const int lock = ::open(lockOf(file).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0) throw WorkError(fmt::format("cannot create {}: {}", lockOf(file).string(), std::strerror(errno)));
  // A file system without locks cannot tell the living from the dead.
  const bool taken = ::flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  struct stat status {};
  if (!taken && ::fstat(lock, &status) == 0 && status.st_nlink > 0) return Claim{file, lock};
  ::close(lock);  // another window has it, or has just been done with it
  return {};
}

void Autosaves::release(std::optional<Claim>& claim, bool remove) {
  if (!claim) return;
  std::error_code ignored;
  if (remove) fs::remove(claim->file, ignored);
  if (remove || !fs::exists(claim->file, ignored)) fs::remove(lockOf(claim->file), ignored);
  ::close(claim->lock);
  claim.reset();
}

std::optional<Autosave> Autosaves::find() {
  if (folder_.empty()) return {};
  release(found_, /*remove=*/false);
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code error;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    const fs::file_time_type time = it->last_write_time(gone);
    if (!gone && it->path().extension() == ".json") files.emplace_back(time, it->path());
  }
  std::sort(files.rbegin(), files.rend());
  for (const auto& [time, file] : files) {
    if ((own_ && file == own_->file) || std::find(seen_.begin(), seen_.end(), file) != seen_.end()) continue;
    found_ = claim(file);
    if (!found_) continue;
    seen_.push_back(file);
    try {
      return readAutosave(file);
    } catch (...) {
      release(found_, /*remove=*/false);
      throw;
    }
  }
  return {};
}

void Autosaves::removeFound() {
  release(found_, /*remove=*/true);
}
void Autosaves::leaveFound() {
  release(found_, /*remove=*/false);
}

void Autosaves::keep(const Autosave& autosave) {
  if (folder_.empty()) return;
  if (!own_) {
    makeFolder(folder_);
    // The process id is another process's too, where several machines share the folder or ids begin anew.
    for (int n = 1; !own_; ++n) {
      const fs::path file = folder_ / fmt::format("{}.{}.json", ::getpid(), n);
      std::error_code ignored;
      if (!fs::exists(file, ignored)) own_ = claim(file);
    }
  }
  writeAutosave(own_->file, autosave);
}

void Autosaves::removeKept() {
  release(own_, /*remove=*/true);
}

}  // namespace irad
