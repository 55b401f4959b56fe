#include "gi/check/state_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <fstream>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"

namespace irad {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kLongestLine = size_t{16} << 20;

std::string digest(std::span<const std::byte> bytes) {
  return sha256({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

/// Of the line and of each array, one after the other.
template <class Arrays>
std::string digestOf(const std::string& line, const Arrays& arrays) {
  std::string all = digest(std::as_bytes(std::span(line)));
  for (const auto& values : arrays) all += digest(values);
  return digest(std::as_bytes(std::span(all)));
}

InputError refusal(const std::filesystem::path& path, const std::string& why) {
  return InputError(fmt::format("{}: {}", path.string(), why));
}

}  // namespace

void writeState(const std::filesystem::path& path, const std::string& kind, const nlohmann::ordered_json& json,
                const std::vector<std::span<const std::byte>>& arrays) {
  const std::string line = jsonText(json);
  OutputFile file(path);
  file.write(fmt::format("{}\n{}\n{}\n", kind, line, digestOf(line, arrays)));
  for (const auto& values : arrays) file.write(values);
  file.commit();
}

uint64_t wholeOf(const nlohmann::ordered_json& json, const std::filesystem::path& path, const char* name,
                 uint64_t most) {
  const auto& value = json.at(name);
  if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
    throw refusal(path, fmt::format("{}: unexpected value {}", name, jsonText(value)));
  return value.get<uint64_t>();
}

void readState(const std::filesystem::path& path, const std::string& kind,
               const std::function<uint64_t(const nlohmann::ordered_json& json)>& bytes,
               const std::function<std::vector<std::span<std::byte>>()>& arrays) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw refusal(path, "cannot be read");
  std::array<std::string, 3> lines;
  for (std::string& line : lines) {
    char c = 0;
    while (in.get(c) && c != '\n' && line.size() < kLongestLine) line += c;
    if (&line == lines.data() && line != kind) throw refusal(path, fmt::format("does not begin with '{}'", kind));
    if (c != '\n') throw refusal(path, "ends in the middle of what it says of itself");
  }
  uint64_t expected = 0;
  try {
    expected = bytes(parseJson(lines[1], path.string()));
  } catch (const nlohmann::json::exception& error) {
    throw refusal(path, error.what());
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  // Before anything of that size is allocated.
  const auto begin = in.tellg();
  in.seekg(0, std::ios::end);
  const auto there = static_cast<uint64_t>(in.tellg() - begin);
  if (there != expected) throw refusal(path, fmt::format("holds {} bytes of sums in place of {}", there, expected));
  in.seekg(begin);
  const std::vector<std::span<std::byte>> values = arrays();
  for (const auto& v : values) in.read(reinterpret_cast<char*>(v.data()), static_cast<std::streamsize>(v.size()));
  if (!in) throw refusal(path, "cannot be read to its end");
  if (digestOf(lines[1], values) != lines[2])
    throw refusal(path, "is damaged: its contents are not those that were written");
}

}  // namespace irad
