#include "gi/study/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "gi/study/front.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

namespace fs = std::filesystem;

const char* const kErrorHead =
    "point,seed,relmse,rmse,mean_error,psnr,flip,facets,entries,matrix_mib,device_mib,"
    "h_relmse,h_rmse";
const char* const kTimeHead = "point,repeat,kind,stage,ms";
const char* const kFailureHead = "point,message";
const char* const kPeerHead = "peer,samples,seconds,relmse,rmse,mean_error,psnr,flip";

/// A CSV file's rows, field by field; no rows where there is no file.
class RowReader {
 public:
  RowReader(fs::path path, const std::string& head) : path_(std::move(path)), in_(path_) {
    if (!in_.is_open()) return;
    std::string line;
    std::getline(in_, line);
    if (line != head) throw InputError(fmt::format("{}: the first line is '{}', not '{}'", path_.string(), line, head));
    columns_ = csvFields(head).size();
  }
  bool next() {
    std::string line;
    ++line_;
    if (!std::getline(in_, line)) return false;
    fields_ = csvFields(line);
    if (fields_.size() != columns_)
      throw InputError(
          fmt::format("{}: row {} has {} fields instead of {}", path_.string(), line_, fields_.size(), columns_));
    at_ = 0;
    return true;
  }
  std::string text() { return fields_[at_++]; }
  /// A double, where the field is empty NaN: not measured.
  double numberOrNone() {
    if (!fields_[at_].empty()) return number<double>();
    ++at_;
    return std::numeric_limits<double>::quiet_NaN();
  }
  template <class T>
  T number() {
    const std::string& field = fields_[at_++];
    T value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size())
      throw InputError(fmt::format("{}: row {}: '{}' is no number", path_.string(), line_, field));
    return value;
  }

 private:
  fs::path path_;
  std::ifstream in_;
  size_t columns_ = 0, line_ = 0, at_ = 0;
  std::vector<std::string> fields_;
};

/// One line of CSV: what a device said may hold line ends.
std::string oneLine(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}
std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.4f}", value) : "";
}

}  // namespace

bool StudyResults::hasError(size_t point, uint32_t seed) const {
  return std::ranges::any_of(errors, [&](const ErrorRow& r) { return r.point == point && r.seed == seed; });
}
bool StudyResults::hasTimes(size_t point, uint32_t repeat) const {
  return std::ranges::any_of(times, [&](const TimeRow& r) { return r.point == point && r.repeat == repeat; });
}
bool StudyResults::hasFailed(size_t point) const {
  return std::ranges::any_of(failures, [&](const FailureRow& r) { return r.point == point; });
}
bool StudyResults::hasPeer(const std::string& name, uint32_t samples) const {
  return std::ranges::any_of(peers, [&](const PeerRow& r) { return r.name == name && r.samples == samples; });
}

void StudyResults::sort() {
  std::ranges::stable_sort(errors, {}, [](const ErrorRow& r) { return std::pair(r.point, r.seed); });
  std::ranges::stable_sort(times, {}, [](const TimeRow& r) { return std::pair(r.point, r.repeat); });
  std::ranges::stable_sort(failures, {}, [](const FailureRow& r) { return r.point; });
  std::ranges::stable_sort(peers, {}, [](const PeerRow& r) { return std::pair(r.name, r.samples); });
}

GridTexts gridsOf(const StudyIdentity& identity) {
  try {
    return nlohmann::ordered_json::parse(identity).at("sweeps").get<GridTexts>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("study.json: sweeps: {}", error.what()));
  }
}

SettingGrid gridOf(const StudyIdentity& identity) {
  try {
    Settings base;
    settingsFromJson(base, nlohmann::ordered_json::parse(identity).at("settings").dump());
    return {gridsOf(identity), base};
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("study.json: {}", error.what()));
  } catch (const UsageError& error) {
    throw InputError(fmt::format("study.json: {}", error.what()));
  }
}

namespace {

StudyIdentity withGrids(const StudyIdentity& identity, const GridTexts& grids) {
  auto json = nlohmann::ordered_json::parse(identity);
  json["sweeps"] = grids;
  return jsonText(json, 2);
}

bool beginsWith(const GridTexts& longer, const GridTexts& start) {
  return longer.size() >= start.size() && std::equal(start.begin(), start.end(), longer.begin());
}

}  // namespace

StudyFolder::StudyFolder(fs::path path, StudyIdentity identity)
    : path_(std::move(path)), identity_(std::move(identity)) {
  const fs::path file = path_ / "study.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    makeFolder(path_);
    writeFile(file, identity_);
    return;
  }
  const StudyIdentity there = readIdentity(path_);
  const GridTexts before = gridsOf(there), now = gridsOf(identity_);
  if (beginsWith(before, now)) identity_ = withGrids(identity_, before);
  const StudyIdentity& other = beginsWith(now, before) ? withGrids(there, now) : there;
  if (const std::string different = differences(other, identity_); !different.empty())
    throw UsageError(fmt::format("{} holds another study: {}; name another folder with --out, or remove it",
                                 path_.string(), different));
  if (now.size() > before.size()) writeFile(file, identity_);
  results = readResults(path_);
}

void StudyFolder::setGrids(const GridTexts& grids) {
  IRAD_CHECK(beginsWith(grids, gridsOf(identity_)), "a study loses no points");
  identity_ = withGrids(identity_, grids);
  writeFile(path_ / "study.json", identity_);
}

void StudyFolder::save() {
  results.sort();
  std::string errors = fmt::format("{}\n", kErrorHead), times = fmt::format("{}\n", kTimeHead),
              failures = fmt::format("{}\n", kFailureHead), peers = fmt::format("{}\n", kPeerHead);
  for (const ErrorRow& r : results.errors)
    errors +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.point, r.seed, r.relMse, r.rmse, r.meanError, r.psnr,
                    r.flip, r.facets, r.entries, r.matrixMib, r.deviceMib, number(r.hRelMse), number(r.hRmse));
  for (const TimeRow& r : results.times)
    times += fmt::format("{},{},{},{},{}\n", r.point, r.repeat, r.kind, csvField(r.stage), r.ms);
  for (const FailureRow& r : results.failures)
    failures += fmt::format("{},{}\n", r.point, csvField(oneLine(r.message)));
  for (const PeerRow& r : results.peers)
    peers += fmt::format("{},{},{},{},{},{},{},{}\n", csvField(r.name), r.samples, r.seconds, r.relMse, r.rmse,
                         r.meanError, r.psnr, r.flip);
  writeFile(path_ / "errors.csv", errors);
  writeFile(path_ / "times.csv", times);
  writeFile(path_ / "failures.csv", failures);
  writeFile(path_ / "peers.csv", peers);
}

StudyResults readResults(const fs::path& folder) {
  StudyResults out;
  for (RowReader rows(folder / "errors.csv", kErrorHead); rows.next();) {
    ErrorRow r;
    r.point = rows.number<size_t>(), r.seed = rows.number<uint32_t>();
    for (double* value : {&r.relMse, &r.rmse, &r.meanError, &r.psnr, &r.flip}) *value = rows.number<double>();
    r.facets = rows.number<uint64_t>(), r.entries = rows.number<uint64_t>();
    r.matrixMib = rows.number<double>(), r.deviceMib = rows.number<double>();
    r.hRelMse = rows.numberOrNone(), r.hRmse = rows.numberOrNone();
    out.errors.push_back(r);
  }
  for (RowReader rows(folder / "times.csv", kTimeHead); rows.next();) {
    TimeRow r;
    r.point = rows.number<size_t>(), r.repeat = rows.number<uint32_t>();
    r.kind = rows.text(), r.stage = rows.text(), r.ms = rows.number<double>();
    out.times.push_back(std::move(r));
  }
  for (RowReader rows(folder / "failures.csv", kFailureHead); rows.next();) {
    const auto point = rows.number<size_t>();
    out.failures.push_back({point, rows.text()});
  }
  for (RowReader rows(folder / "peers.csv", kPeerHead); rows.next();) {
    PeerRow r;
    r.name = rows.text(), r.samples = rows.number<uint32_t>();
    for (double* value : {&r.seconds, &r.relMse, &r.rmse, &r.meanError, &r.psnr, &r.flip})
      *value = rows.number<double>();
    out.peers.push_back(std::move(r));
  }
  return out;
}

StudyIdentity readIdentity(const fs::path& folder) {
  const fs::path file = folder / "study.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw InputError(fmt::format("{}: no such file: not a study's folder", file.string()));
  const OrderedJson json = readJsonFile(file);
  if (!json.is_object()) throw InputError(fmt::format("{}: expected a JSON object", file.string()));
  return jsonText(json, 2);
}

std::string differences(const StudyIdentity& a, const StudyIdentity& b) {
  const auto first = nlohmann::ordered_json::parse(a), second = nlohmann::ordered_json::parse(b);
  std::string out;
  const auto add = [&](const std::string& name, const std::string& there, const std::string& here) {
    out += fmt::format("{}{} {} instead of {}", out.empty() ? "" : ", ", name, there, here);
  };
  const auto valueOf = [](const nlohmann::ordered_json& json, const std::string& name) {
    return json.contains(name) ? json.at(name) : nlohmann::ordered_json();
  };
  for (const auto* names : {&first, &second})
    for (const auto& [name, ignored] : names->items()) {
      const nlohmann::ordered_json there = valueOf(first, name), here = valueOf(second, name);
      if (there == here || (names == &second && first.contains(name))) continue;
      if (!there.is_object() || !here.is_object()) {
        add(name, jsonText(there), jsonText(here));
        continue;
      }
      for (const auto& [member, value] : here.items())  // settings: only those that differ
        if (valueOf(there, member) != value) add(member, jsonText(valueOf(there, member)), jsonText(value));
    }
  return out;
}

void merge(StudyResults& into, const StudyResults& from, const std::string& nameOfFrom) {
  for (const ErrorRow& r : from.errors) {
    const auto same = std::ranges::find_if(
        into.errors, [&](const ErrorRow& other) { return other.point == r.point && other.seed == r.seed; });
    if (same == into.errors.end())
      into.errors.push_back(r);
    else if (same->relMse != r.relMse || same->rmse != r.rmse || same->flip != r.flip)
      throw InputError(fmt::format("{}: point {}, seed {}: relMSE {} is {} in another shard", nameOfFrom, r.point,
                                   r.seed, r.relMse, same->relMse));
    else if (number(same->hRelMse) != number(r.hRelMse))
      throw InputError(fmt::format("{}: point {}, seed {}: relMSE of H {} is {} in another shard", nameOfFrom, r.point,
                                   r.seed, r.hRelMse, same->hRelMse));
  }
  const StudyResults before = into;  // a shard's own repeats do not stand in each other's way
  for (const TimeRow& r : from.times)
    if (!before.hasTimes(r.point, r.repeat)) into.times.push_back(r);
  for (const FailureRow& r : from.failures)
    if (!before.hasFailed(r.point)) into.failures.push_back(r);
  for (const PeerRow& r : from.peers)
    if (!before.hasPeer(r.name, r.samples)) into.peers.push_back(r);
  into.sort();
}

TimeSpread spreadOf(std::vector<double> samples) {
  TimeSpread out;
  out.samples = samples.size();
  if (samples.empty()) return out;
  std::ranges::sort(samples);
  const auto rank = [&](double share) {  // nearest rank
    const auto n = static_cast<double>(samples.size());
    return samples[static_cast<size_t>(std::max(std::ceil(share * n), 1.0)) - 1];
  };
  out.p5 = rank(.05), out.p50 = rank(.5), out.p95 = rank(.95);
  return out;
}

double PointSummary::gpuMs(const std::string& kind) const {
  const auto found = gpu.find(kind);
  return found == gpu.end() ? std::numeric_limits<double>::quiet_NaN() : found->second.p50;
}

double PointSummary::firstPictureMs() const {
  return gpuMs("setup") + gpuMs("cold") + gpuMs("camera");
}

std::vector<PointSummary> summarize(const StudyResults& results, const std::vector<std::string>& labels) {
  std::vector<PointSummary> out(labels.size());
  for (size_t point = 0; point < out.size(); ++point) {
    PointSummary& p = out[point];
    p.point = point;
    p.label = labels[point];
    std::vector<double> relMse, rmse, meanError, psnr, flip, hRelMse, hRmse;
    for (const ErrorRow& r : results.errors) {
      if (r.point != point) continue;
      if (relMse.empty()) {
        p.facets = static_cast<double>(r.facets), p.entries = static_cast<double>(r.entries);
        p.matrixMib = r.matrixMib, p.deviceMib = r.deviceMib;
      }
      relMse.push_back(r.relMse), rmse.push_back(r.rmse), meanError.push_back(r.meanError);
      psnr.push_back(r.psnr), flip.push_back(r.flip);
      hRelMse.push_back(r.hRelMse), hRmse.push_back(r.hRmse);
    }
    p.seeds = relMse.size();
    if (p.seeds == 0) {
      p.failure = "not measured";
      for (MeanInterval* m : {&p.relMse, &p.rmse, &p.meanError, &p.psnr, &p.flip, &p.hRelMse, &p.hRmse})
        m->mean = std::numeric_limits<double>::quiet_NaN();
    } else {
      p.relMse = meanInterval(relMse), p.rmse = meanInterval(rmse), p.meanError = meanInterval(meanError);
      p.psnr = meanInterval(psnr), p.flip = meanInterval(flip);
      p.hRelMse = meanInterval(hRelMse), p.hRmse = meanInterval(hRmse);
    }
    for (const FailureRow& r : results.failures)
      if (r.point == point) p.failure = r.message;
    // A stage's time, and the sum of all stages, per repeat.
    std::map<std::pair<std::string, uint32_t>, double> sums;
    std::map<std::string, std::vector<double>> walls;
    std::map<std::pair<std::string, std::string>, std::vector<double>> stages;
    for (const TimeRow& r : results.times) {
      if (r.point != point) continue;
      if (r.stage == "wall") {
        walls[r.kind].push_back(r.ms);
        continue;
      }
      sums[{r.kind, r.repeat}] += r.ms;
      std::vector<double>& samples = stages[{r.kind, r.stage}];
      if (samples.empty()) p.stagesInOrder[r.kind].push_back(r.stage);
      samples.push_back(r.ms);
    }
    std::map<std::string, std::vector<double>> totals;
    for (const auto& [key, ms] : sums) totals[key.first].push_back(ms);
    for (const auto& [kind, samples] : totals) p.gpu[kind] = spreadOf(samples);
    for (const auto& [kind, samples] : walls) p.wall[kind] = spreadOf(samples);
    for (const auto& [key, samples] : stages) p.stages[key.first][key.second] = spreadOf(samples);
  }
  return out;
}

const std::vector<CostKind>& costKinds() {
  static const std::vector<CostKind> kinds{
      {"first_picture", "first picture (build, solve, frame), ms", "ms",
       [](const PointSummary& p) { return p.firstPictureMs(); }, true, true},
      {"build", "build, ms", "ms", [](const PointSummary& p) { return p.gpuMs("setup"); }, true, false},
      {"relight", "relight, ms", "ms", [](const PointSummary& p) { return p.gpuMs("relight"); }, true, false},
      {"frame", "frame, ms", "ms", [](const PointSummary& p) { return p.gpuMs("camera"); }, true, true},
      {"memory", "device memory, MiB", "MiB", [](const PointSummary& p) { return p.deviceMib; }, false, true}};
  return kinds;
}

std::string pointsCsv(const std::vector<PointSummary>& points, const std::vector<std::string>& names,
                      const std::vector<std::vector<std::string>>& values) {
  std::string out = "point";
  for (const std::string& name : names) out += "," + csvField(name);
  out +=
      ",status,seeds,relmse,relmse_ci95,rmse,rmse_ci95,mean_error,mean_error_ci95,psnr,psnr_ci95,flip,flip_ci95,"
      "h_relmse,h_relmse_ci95,h_rmse,h_rmse_ci95,facets,entries,matrix_mib,device_mib";
  const std::pair<const char*, const char*> kinds[] = {
      {"build", "setup"}, {"first_solve", "cold"}, {"relight", "relight"}, {"frame", "camera"}};
  for (const auto& [name, kind] : kinds) out += fmt::format(",{0}_p5_ms,{0}_p50_ms,{0}_p95_ms,{0}_wall_p50_ms", name);
  out += ",repeats";
  for (const CostKind& cost : costKinds()) out += fmt::format(",dominated_by_{}", cost.name);
  out += "\n";
  std::vector<std::vector<std::optional<size_t>>> dominated;
  for (const CostKind& cost : costKinds()) {
    std::vector<CostAndError> pairs;
    for (const PointSummary& p : points) pairs.push_back({cost.of(p), p.relMse.mean});
    dominated.push_back(dominators(pairs));
  }
  for (const PointSummary& p : points) {
    out += std::to_string(p.point);
    for (const std::string& value : values[p.point]) out += "," + csvField(value);
    out += fmt::format(",{},{}", csvField(p.failure.empty() ? "done" : p.failure), p.seeds);
    for (const MeanInterval& m : {p.relMse, p.rmse, p.meanError, p.psnr, p.flip, p.hRelMse, p.hRmse})
      out += fmt::format(",{},{}", number(m.mean), p.seeds > 0 && !std::isnan(m.mean) ? number(m.half) : "");
    if (p.seeds > 0)
      out += fmt::format(",{},{},{},{}", p.facets, p.entries, p.matrixMib, p.deviceMib);
    else
      out += ",,,,";
    size_t repeats = 0;
    for (const auto& [name, kind] : kinds) {
      const auto gpu = p.gpu.find(kind), wall = p.wall.find(kind);
      if (gpu == p.gpu.end()) {
        out += ",,,";
      } else {
        out += fmt::format(",{},{},{}", shown(gpu->second.p5), shown(gpu->second.p50), shown(gpu->second.p95));
        repeats = std::max(repeats, gpu->second.samples);
      }
      out += "," + (wall == p.wall.end() ? "" : shown(wall->second.p50));
    }
    out += fmt::format(",{}", repeats);
    for (const auto& by : dominated)
      out += by[p.point] ? fmt::format(",{}", *by[p.point]) : p.seeds > 0 ? ",front" : ",";
    out += "\n";
  }
  return out;
}

std::string stagesCsv(const std::vector<PointSummary>& points) {
  std::string out = "point,kind,stage,p5_ms,p50_ms,p95_ms,samples\n";
  for (const PointSummary& p : points)
    for (const auto& [kind, stages] : p.stagesInOrder)
      for (const std::string& stage : stages) {
        const TimeSpread& s = p.stages.at(kind).at(stage);
        out += fmt::format("{},{},{},{},{},{},{}\n", p.point, kind, csvField(stage), shown(s.p5), shown(s.p50),
                           shown(s.p95), s.samples);
      }
  return out;
}

}  // namespace irad
