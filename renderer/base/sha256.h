// SHA-256 of bytes in memory (of a file: scene.h), as 64 hex digits.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "renderer/scene/scene.h"

namespace irad {

std::string sha256(std::span<const uint8_t> bytes);

}  // namespace irad
