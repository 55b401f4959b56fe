// The folders of a study's shards, put together.
#pragma once

#include <filesystem>
#include <vector>

namespace irad::app {

/// Makes, or goes on with, the study `out` from its shards. InputError where they are of different studies, or do not
/// agree in an error.
void mergeStudies(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out);

}  // namespace irad::app
