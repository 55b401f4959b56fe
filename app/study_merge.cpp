#include "app/study_merge.h"

#include <fmt/format.h>

#include "gi/study/results.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

namespace irad::app {

namespace fs = std::filesystem;

void mergeStudies(const std::vector<fs::path>& shards, const fs::path& out) {
  const StudyIdentity identity = readIdentity(shards.front());
  StudyResults results;
  for (const fs::path& shard : shards) {
    if (const std::string other = differences(readIdentity(shard), identity); !other.empty())
      throw InputError(fmt::format("{}: not the study of {}: {}", shard.string(), shards.front().string(), other));
    merge(results, readResults(shard), shard.string());
  }
  StudyFolder folder(out, identity);
  merge(results, folder.results, out.string());
  folder.results = std::move(results);
  folder.save();
  makeFolder(out / "pictures");
  for (const fs::path& shard : shards) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(shard / "pictures", ignored))
      fs::copy_file(entry.path(), out / "pictures" / entry.path().filename(), fs::copy_options::overwrite_existing,
                    ignored);
    fs::copy_file(shard / "notes.json", out / "notes.json", fs::copy_options::skip_existing, ignored);
  }
}

}  // namespace irad::app
