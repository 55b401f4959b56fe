// SHA-256 of bytes, as 64 hex digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace irad {

std::string sha256(std::span<const uint8_t> bytes);
/// Of a file; InputError where it cannot be read.
std::string sha256File(const std::filesystem::path& path);

}  // namespace irad
