#include "renderer/shaders.h"

#include <algorithm>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/base/parallel.h"
#include "shaders/embedded.h"

namespace irad {
namespace {

/// Levenshtein's edit distance.
size_t distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

bool sameInterface(const ShaderModule& a, const ShaderModule& b) {
  return a.pushBytes == b.pushBytes && a.addressOffsets == b.addressOffsets &&
         std::equal(a.bindings.begin(), a.bindings.end(), b.bindings.begin(), b.bindings.end(),
                    [](const ShaderBinding& x, const ShaderBinding& y) { return x.sameAs(y); });
}

}  // namespace

ShaderLibrary::ShaderLibrary() {
  for (const EmbeddedShader& shader : embeddedShaders())
    modules_.emplace(shader.name, reflect(shader.name, {shader.spirv.begin(), shader.spirv.end()}));
}

const ShaderModule& ShaderLibrary::get(std::string_view name) const {
  if (const auto it = modules_.find(name); it != modules_.end()) return it->second;
  std::vector<std::string> near = names();
  std::sort(near.begin(), near.end(),
            [&](const auto& a, const auto& b) { return distance(a, name) < distance(b, name); });
  near.resize(std::min<size_t>(near.size(), 3));
  std::string list;
  for (const std::string& n : near) list += (list.empty() ? "" : ", ") + n;
  invariantFailed(__FILE__, __LINE__, fmt::format("no shader '{}'; near: {}", name, list));
}

std::vector<std::string> ShaderLibrary::names() const {
  std::vector<std::string> names;
  for (const auto& [name, module] : modules_) names.push_back(name);
  return names;
}

std::vector<std::string> ShaderLibrary::modified() const {
  std::vector<std::string> names;
  for (const EmbeddedShader& shader : embeddedShaders())
    if (withoutDebugInfo(get(shader.name).spirv) != withoutDebugInfo(shader.spirv)) names.emplace_back(shader.name);
  return names;
}

void ShaderLibrary::add(std::string name, std::vector<uint32_t> spirv) {
  ShaderModule module = reflect(name, std::move(spirv));
  modules_.insert_or_assign(std::move(name), std::move(module));
  ++generation_;
}

ShaderReload ShaderLibrary::reload(const std::filesystem::path& sources) {
  struct Job {
    const ShaderModule& old;
    std::string source, definition, error;
    std::optional<ShaderModule> changed;
  };
  std::vector<Job> jobs;
  for (const auto& [name, module] : modules_) {
    const auto embedded = std::ranges::find(embeddedShaders(), name, [](const EmbeddedShader& s) { return s.name; });
    const bool added = embedded == embeddedShaders().end();
    std::string source = added ? name : embedded->source;
    if (!std::filesystem::exists(sources / source)) continue;
    jobs.push_back({.old = module, .source = std::move(source), .definition = added ? "" : embedded->definition});
  }
  // On all cores: one alone takes some seconds, in which a window that asked for it stands still.
  parallelFor(jobs.size(), [&](size_t i) {
    Job& job = jobs[i];
    try {
      ShaderModule compiled = reflect(job.old.name, compileGlsl(sources, job.source, job.definition));
      if (withoutDebugInfo(compiled.spirv) == withoutDebugInfo(job.old.spirv)) return;
      if (!sameInterface(compiled, job.old))
        throw WorkError(
            fmt::format("{}: its images or push constants have changed: build the program again", job.old.name));
      job.changed = std::move(compiled);
    } catch (const WorkError& error) {
      job.error = error.what();
    }
  });
  ShaderReload result;
  for (const Job& job : jobs) {
    if (!job.error.empty()) result.errors += job.error + "\n";
    if (job.changed) result.changed.push_back(job.old.name);
  }
  if (jobs.empty()) result.errors = fmt::format("no shader sources in {}\n", sources.string());
  if (!result.errors.empty()) return {.errors = std::move(result.errors), .changed = {}};
  if (result.changed.empty()) return result;
  for (Job& job : jobs)
    if (job.changed) modules_.insert_or_assign(std::string(job.old.name), std::move(*job.changed));
  ++generation_;
  return result;
}

}  // namespace irad
