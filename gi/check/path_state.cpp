#include "gi/check/path_state.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"

namespace irad {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(glm::dvec3) == 24);

constexpr const char* kFirstLine = "irad reference sums 1";
constexpr uint64_t kMostPixels = uint64_t{1} << 28;
constexpr size_t kArrays = 6, kLongestLine = size_t{16} << 20;

/// Of both lights: the two halves, the squares.
template <class Sums>
auto arraysOf(Sums& sums) {
  return std::array{&sums.lit.half[0],      &sums.lit.half[1],      &sums.lit.squares,
                    &sums.indirect.half[0], &sums.indirect.half[1], &sums.indirect.squares};
}

std::string digest(std::span<const std::byte> bytes) {
  return sha256({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

/// Of the line and of each array, one after the other.
std::string digestOf(const std::string& line, const TracedSums& sums) {
  std::string all = digest(std::as_bytes(std::span(line)));
  for (const auto* values : arraysOf(sums)) all += digest(std::as_bytes(std::span(*values)));
  return digest(std::as_bytes(std::span(all)));
}

}  // namespace

void writeSums(const std::filesystem::path& path, const SavedSums& saved) {
  const TracedSums& sums = saved.sums;
  nlohmann::ordered_json json;
  json["width"] = sums.size.x;
  json["height"] = sums.size.y;
  json["samples"] = sums.samples;
  json["rays"] = sums.rays;
  json["seconds"] = sums.seconds;
  json["made"] = nlohmann::ordered_json::parse(saved.made);
  const std::string line = json.dump();
  OutputFile file(path);
  file.write(fmt::format("{}\n{}\n{}\n", kFirstLine, line, digestOf(line, sums)));
  for (const auto* values : arraysOf(sums)) file.write(std::as_bytes(std::span(*values)));
  file.commit();
}

SavedSums readSums(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError(fmt::format("{}: {}", path.string(), why));
  };
  std::ifstream in(path, std::ios::binary);
  if (!in) throw refuse("cannot be read");
  std::array<std::string, 3> lines;
  for (std::string& line : lines) {
    char c = 0;
    while (in.get(c) && c != '\n' && line.size() < kLongestLine) line += c;
    if (&line == lines.data() && line != kFirstLine) throw refuse(fmt::format("does not begin with '{}'", kFirstLine));
    if (c != '\n') throw refuse("ends in the middle of what it says of itself");
  }
  SavedSums saved;
  TracedSums& sums = saved.sums;
  try {
    const OrderedJson json = parseJson(lines[1], path.string());
    const auto whole = [&](const char* name, uint64_t most) {
      const auto& value = json.at(name);
      if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
        throw refuse(fmt::format("{}: unexpected value {}", name, value.dump()));
      return value.get<uint64_t>();
    };
    sums.size = {whole("width", kMostPixels), whole("height", kMostPixels)};
    sums.samples = static_cast<uint32_t>(whole("samples", UINT32_MAX));
    sums.rays = whole("rays", UINT64_MAX);
    sums.seconds = json.at("seconds").get<double>();
    saved.made = json.at("made").dump();
  } catch (const nlohmann::json::exception& error) {
    throw refuse(error.what());
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  const uint64_t pixels = uint64_t{sums.size.x} * sums.size.y;
  if (pixels < 1 || pixels > kMostPixels || sums.samples < 1)
    throw refuse(fmt::format("{} x {} pixels of {} samples", sums.size.x, sums.size.y, sums.samples));
  // Before anything of that size is allocated.
  const auto begin = in.tellg();
  in.seekg(0, std::ios::end);
  const auto there = static_cast<uint64_t>(in.tellg() - begin), expected = pixels * kArrays * sizeof(glm::dvec3);
  if (there != expected) throw refuse(fmt::format("holds {} bytes of sums in place of {}", there, expected));
  in.seekg(begin);
  for (auto* values : arraysOf(sums)) {
    values->resize(pixels);
    in.read(reinterpret_cast<char*>(values->data()), static_cast<std::streamsize>(pixels * sizeof(glm::dvec3)));
  }
  if (!in) throw refuse("cannot be read to its end");
  if (digestOf(lines[1], sums) != lines[2]) throw refuse("is damaged: its contents are not those that were written");
  return saved;
}

}  // namespace irad
