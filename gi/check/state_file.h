// What a long computation has come to so far, in a file from which a later run goes on: a line that says what it is, a
// line of JSON, a line of SHA-256 of all the rest, then arrays of little-endian numbers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace irad {

/// Appears whole or not at all; WorkError.
void writeState(const std::filesystem::path& path, const std::string& kind, const nlohmann::ordered_json& json,
                const std::vector<std::span<const std::byte>>& arrays);
/// `arrays`: where they are to be read to, by what the JSON says, asked for when the file is known to hold as many
/// bytes as `bytes` says; json::exception in either names what is wrong. InputError names the file: every bit that was
/// written is vouched for.
void readState(const std::filesystem::path& path, const std::string& kind,
               const std::function<uint64_t(const nlohmann::ordered_json& json)>& bytes,
               const std::function<std::vector<std::span<std::byte>>()>& arrays);
/// A whole number, at most `most`; InputError.
uint64_t wholeOf(const nlohmann::ordered_json& json, const std::filesystem::path& path, const char* name,
                 uint64_t most);

}  // namespace irad
